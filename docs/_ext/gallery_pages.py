"""The gallery of the lecture's figures and the page of its errata, made by `lesk figure` and `lesk lecture`."""

import json
import subprocess
from pathlib import Path

from model_pages import table


def answer(*words):
    """Ask the command line; give its JSON."""
    done = subprocess.run(["lesk", *words, "--json"], check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def newest_source():
    """Time of the newest file of the package: what is older was made by another version."""
    import lesk

    return max(path.stat().st_mtime for folder in lesk.__path__ for path in Path(folder).rglob("*") if path.is_file())


def draw(folder, names, since):
    """Make the figures that are not there or older than the package."""
    for name in names:
        path = folder / f"{name}.png"
        if not path.exists() or path.stat().st_mtime < since:
            answer("figure", name, "-o", str(path))


def entry(idea, figures, shown):
    """Write the part of an idea; a figure appears once, with the first idea that has it."""
    lines = [f"## {idea['slide']}", "", f"{idea['says']}.", ""]
    for name in idea["figures"]:
        figure = figures[name]
        if name in shown:
            lines += [f"See [{figure['title']}](#figure-{name}).", ""]
            continue
        shown.add(name)
        lines += [
            f"(figure-{name})=",
            f"```{{figure}} {name}.png",
            f":alt: {figure['title']}",
            "",
            figure["caption"],
            "```",
            "",
        ]
        lines += ["```console", f"$ lesk figure {name} -o {name}.png", "```", ""]
    if idea["commands"]:
        lines += ["```console", *(f"$ {command}" for command in idea["commands"]), "```", ""]
    if idea["open"]:
        lines += [f"*Open:* {idea['open']}.", ""]
    return "\n".join(lines)


def gallery(ideas, figures):
    """Write the page of all ideas."""
    shown = set()
    parts = [entry(idea, figures, shown) for idea in ideas]
    return (
        "# Gallery\n\n"
        "The ideas of Jiří Bittner's lecture *Light & Shading* (CTU in Prague), each with a figure or a command of Lesk.\n"
        "Every picture here was made by the command below it when this book was built; "
        "in Python `lesk.figures.NAME()` gives the same as a matplotlib figure, with its parameters as arguments.\n"
        "`lesk lecture` prints this list.\n\n" + "\n".join(parts)
    )


def errata(rows):
    """Write the page of the differences between slides and papers."""

    def number(row, key):
        return f"{row[key]:.6g} {row['unit']}".strip()

    parts = [
        f"## {row['slide']} (`{row['id']}`)\n\n{row['difference']}.\n\n"
        + table(["case", "slide", "paper"], [(row["case"], number(row, "slide_value"), number(row, "paper_value"))])
        + "\n```console\n"
        + "".join(f"$ {command}\n" for command in dict.fromkeys([f"lesk lecture errata {row['id']}", row["command"]]))
        + "```\n"
        for row in rows
    ]
    return (
        "# Errata\n\n"
        "Where a slide of the lecture and its paper differ, Lesk implements the paper.\n"
        "Both numbers are computed when this book is built; `lesk lecture errata ID` computes them again, the second command, "
        "where there is one, shows the paper's in another way.\n"
        "A test holds each number to the published one or to a closed form.\n\n" + "\n".join(parts)
    )


def write(folder):
    """Write both pages and all pictures."""
    folder.mkdir(exist_ok=True)
    figures = {figure["id"]: figure for figure in answer("figure")["figures"]}
    draw(folder, figures, newest_source())
    pages = {
        "index.md": gallery(answer("lecture")["ideas"], figures),
        "errata.md": errata(answer("lecture", "errata")["errata"]),
    }
    for name, text in pages.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def setup(app):
    """Write pages and pictures when the build starts."""
    app.connect("builder-inited", lambda app: write(Path(app.srcdir) / "gallery"))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
