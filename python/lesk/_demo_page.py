"""The page of `lesk demo`."""

from __future__ import annotations

import html
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lesk import plot
from lesk._check import CheckReport, check
from lesk._registry import find
from lesk._render import Render
from lesk.models import create
from lesk.scene import Scene

_STYLE = """
:root { color-scheme: light; --ink: #1f2328; --faint: #59636e; --line: #d8dee4; --good: #1a7f37; --bad: #cf222e }
* { box-sizing: border-box }
body { margin: 0; font: 16px/1.55 system-ui, sans-serif; color: var(--ink); background: #fff }
main { max-width: 1200px; margin: 0 auto; padding: 0 24px 64px }
header img { display: block; width: 100%; height: auto }
header { background: #111; text-align: center }
header img { max-width: 1400px; margin: 0 auto }
h1 { font-size: 2.2rem; margin: 2rem 0 .2rem; letter-spacing: -.02em }
h2 { margin: 3rem 0 1rem; font-size: 1.4rem }
p.lead { color: var(--faint); margin-top: 0; max-width: 46rem }
dl { display: flex; flex-wrap: wrap; gap: .4rem 2.4rem; margin: 1rem 0 }
dt { color: var(--faint); font-size: .8rem } dd { margin: 0; font-variant-numeric: tabular-nums }
.models { display: grid; grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); gap: 20px }
article { border: 1px solid var(--line); border-radius: 10px; overflow: hidden }
article .pair { display: grid; grid-template-columns: 2fr 3fr; align-items: center }
article img { width: 100%; height: 150px; display: block; object-fit: contain; padding: 8px 4px 0 }
article h3 { margin: .8rem 1rem 0; font: 600 1rem ui-monospace, monospace }
article p { margin: .1rem 1rem 1rem; font-size: .85rem; color: var(--faint) }
.scroll { overflow-x: auto } table { border-collapse: collapse; font-size: .85rem; width: 100% }
th, td { text-align: left; padding: .4rem .8rem .4rem 0; border-bottom: 1px solid var(--line); white-space: nowrap }
td code { font-size: .8rem } .yes { color: var(--good) } .no { color: var(--bad); font-weight: 600 } .not { color: var(--faint) }
"""

_VERDICTS = {
    "held": ("yes", "holds"),
    "refuted_outside": ("not", "fails outside, as it should"),
    "refuted_as_stored": ("not", "not claimed, refuted"),
    "failed": ("no", "FAILED"),
}


def write(
    folder: Path, picture: Render, scene: Scene, models: list[str], *, quick: bool, say: Callable[[str], None]
) -> bool:
    """Write plots, checks and the page; give whether all checks passed."""
    cards, reports = [], []
    for name in models:
        say(f"  {name}")
        model = create(name)
        resolution, samples = (120, 16) if quick else (180, 48)
        plot.sphere(model, resolution=resolution, samples=samples, title=False).savefig(folder / f"{name}-sphere.png")
        plot.polar(model).savefig(folder / f"{name}-polar.svg")
        reports.append(check(name))
        cards.append(_card(name))
    report = CheckReport([model for found in reports for model in found.models])
    (folder / "checks.html").write_text(report.html(), encoding="utf-8")
    body = _page(picture, scene, cards, report)
    (folder / "index.html").write_text(body, encoding="utf-8")
    return report.passed


def _page(picture: Render, scene: Scene, cards: list[str], report: CheckReport) -> str:
    title = html.escape(scene.title or "Lesk")
    return (
        f"<!doctype html><html lang='en'><meta charset='utf-8'><title>Lesk: {title}</title>"
        f"<meta name='viewport' content='width=device-width'><style>{_STYLE}</style>"
        f"<header><img src='picture.png' alt='{title}'></header><main><h1>{title}</h1>"
        "<p class='lead'>Every reflectance model is written once, as its paper states it. The picture, the plots and the "
        f"checks below come from that one definition.</p>{_facts(picture, scene)}"
        f"<h2>The models of the picture</h2><section class='models'>{''.join(cards)}</section>"
        "<h2>Their checks</h2><p class='lead'>A claim is a test. What a model does not claim must be refuted. "
        f"<a href='checks.html'>All checks in detail</a></p>{_checks(report)}</main></html>\n"
    )


def _facts(picture: Render, scene: Scene) -> str:
    width, height = scene.size
    error = picture.relative_error
    facts = {
        "size": f"{width} × {height} pixels",
        "samples per pixel": f"{picture.layers['samples.Y'].mean():.0f}",
        "time": f"{picture.seconds:.0f} s",
        "exposure": "none" if picture.ev100 is None else f"EV100 {picture.ev100:.2f}",
        "relative error": "unknown" if error is None else f"{100 * error:.2f} %",
        "linear picture": "<a href='picture.exr'>picture.exr</a>, cd/m²",
    }
    return "<dl>" + "".join(f"<div><dt>{name}</dt><dd>{value}</dd></div>" for name, value in facts.items()) + "</dl>"


def _card(name: str) -> str:
    info = find(name)
    return (
        f"<article><div class='pair'><img src='{name}-sphere.png' alt='a sphere of {name}'>"
        f"<img src='{name}-polar.svg' alt='polar cut of {name}'></div><h3>{name}</h3>"
        f"<p>{html.escape(info['title'])}, {info['year']}</p></article>"
    )


def _checks(report: CheckReport) -> str:
    rows = "".join(_row(model["id"], row) for model in report.models for row in model["rows"])
    head = "".join(f"<th>{name}</th>" for name in ("model", "property", "condition", "result", "worst", "allowed"))
    return f"<div class='scroll'><table><tr>{head}</tr>{rows}</table></div>"


def _row(name: str, row: dict[str, Any]) -> str:
    kind, text = _VERDICTS[row["verdict"]]
    numbers = ["" if row[key] is None else f"{row[key]:.3g}" for key in ("value", "allowed")]
    condition = html.escape(row["condition"] or "always")
    return (
        f"<tr><td><code>{name}</code></td><td>{row['property'].replace('_', ' ')}</td><td>{condition}</td>"
        f"<td class='{kind}'>{text}</td><td>{numbers[0]}</td><td>{numbers[1]}</td></tr>"
    )
