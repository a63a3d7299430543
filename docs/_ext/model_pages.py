"""One page per model, written from `lesk models --json` before the book is read."""

import json
import subprocess
from pathlib import Path

PROPERTIES = {
    "reciprocal": "Swapping the directions changes nothing but the squared index (Helmholtz).",
    "passive": "No more power leaves than arrives.",
    "samples_itself": "The density that `pdf` reports is the one that `sample` draws from.",
    "isotropic": "Turning both directions about the normal changes nothing.",
    "non_negative": "The value is never negative.",
    "smooth": "No delta lobe, and a continuous gradient except on listed seams.",
}


def registry():
    """Ask the command line for the models, in reading order."""
    command = ["lesk", "models", "--json"]
    answer = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(answer.stdout)["models"]


def table(head, rows):
    """Write a Markdown table; bars inside cells are escaped."""

    def line(cells):
        return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"

    return "\n".join([line(head), line(["---"] * len(head)), *map(line, rows)]) + "\n"


def number(value):
    """Write a number, or the three of a colour, as short as it can be."""
    if isinstance(value, list):
        return ", ".join(f"{v:g}" for v in value)
    return f"{value:g}"


def parameter_rows(model):
    """One row per parameter: name, kind, unit, default, legal values, meaning."""
    for p in model["parameters"]:
        low, high = p["range"]
        legal = f"{number(low)} to {number(high)}"
        meaning = " ".join(p["doc"].split())
        yield f"`{p['name']}`", p["kind"], p["unit"] or "1", number(p["default"]), legal, meaning


def claim_rows(model):
    """One row per property: whether it is claimed, under which condition, or why it fails."""
    claims = {claim["property"]: claim["when"] for claim in model["claims"]}
    refuted = {c["property"]: c["because"] for c in model.get("counterexamples", [])}
    if unknown := (claims.keys() | refuted.keys()) - PROPERTIES.keys():
        raise KeyError(f"no meaning is written for the properties {sorted(unknown)}")
    for name, meaning in PROPERTIES.items():
        if name in claims:
            holds = f"where `{claims[name]}`" if claims[name] else "always"
        else:
            holds = f"no: {refuted[name]}" if name in refuted else "not claimed"
        yield name.replace("_", " "), holds, meaning


def pictures(name):
    """A lit sphere, a polar cut and the albedo, for the default parameters."""
    alts = {"sphere": "a lit sphere", "polar": "polar cut of f", "albedo": "albedo over the angle"}
    shown = [f"![{alt}](../pictures/{name}-{kind}.png)" for kind, alt in alts.items()]
    return "```{container} plots\n" + "\n".join(shown) + "\n```\n"


def page(model):
    """Write the page of a model."""
    name = model["id"]
    return f"""# {model["title"]}

`{name}`, {{cite:t}}`{model["paper"]}`

{model["doc"].strip()}

{pictures(name)}
## Parameters

{table(["name", "kind", "unit", "default", "legal values", "meaning"], parameter_rows(model))}
## Checked properties

{table(["property", "holds", "meaning"], claim_rows(model))}
`lesk check {name}` runs the test of each.

## Use

```python
import lesk

model = lesk.models.{name}()
f = model.eval(wi=[0.6, 0.0, 0.8], wo=[0.0, 0.0, 1.0])  # 1/sr
```

```console
$ lesk plot {name} -o {name}.png
$ lesk shader {name} --to glsl
```
"""


def index(models):
    """Write the list of all models, and the contents that the pages hang on."""
    rows = [(f"[{m['title']}]({m['id']}.md)", f"`{m['id']}`", m["year"]) for m in models]
    names = "\n".join(m["id"] for m in models)
    return f"""# Models

{table(["model", "name", "year"], rows)}
```{{toctree}}
:hidden:

{names}
```
"""


def claims_matrix(models):
    """Write which model claims what."""
    mark = {True: "yes", False: "if"}
    rows = []
    for model in models:
        claims = {claim["property"]: claim["when"] is None for claim in model["claims"]}
        marks = (mark[claims[name]] if name in claims else "–" for name in PROPERTIES)
        rows.append((f"[{model['id']}](models/{model['id']}.md)", *marks))
    return table(["model", *(name.replace("_", " ") for name in PROPERTIES)], rows)


def write(folder, models):
    """Write all pages; a page that has not changed keeps its time, so that it is not read again."""
    pages = {f"{m['id']}.md": page(m) for m in models}
    pages |= {"index.md": index(models), "claims.txt": claims_matrix(models)}
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        if old.name not in pages:
            old.unlink()
    for name, text in pages.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def setup(app):
    """Write the pages when the build starts."""
    app.connect("builder-inited", lambda app: write(Path(app.srcdir) / "models", registry()))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
