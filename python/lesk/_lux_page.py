"""The report of `lesk lux` as a page that needs no other file."""

from __future__ import annotations

import base64
import html
import io
from typing import Any

from lesk._lux import EDITION, METHOD, LuxReport
from lesk._measure import Readings
from lesk.scene import Scene

_STYLE = """
:root { color-scheme: light; --ink: #1f2328; --faint: #59636e; --line: #d8dee4; --good: #1a7f37; --bad: #cf222e }
body { margin: 0; font: 16px/1.55 system-ui, sans-serif; color: var(--ink); background: #fff }
main { max-width: 1100px; margin: 0 auto; padding: 8px 24px 64px }
h1 { font-size: 1.9rem; margin: 1.4rem 0 .2rem } h2 { margin: 2.4rem 0 .6rem; font-size: 1.3rem }
p.lead, .note { color: var(--faint); max-width: 52rem } p.lead { margin-top: 0 }
.scroll { overflow-x: auto } table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums }
th, td { text-align: right; padding: .4rem .9rem .4rem 0; border-bottom: 1px solid var(--line); white-space: nowrap }
th { color: var(--faint); font-weight: 500 } th:first-child, td:first-child, td.text { text-align: left; white-space: normal }
.yes { color: var(--good); font-weight: 600 } .no { color: var(--bad); font-weight: 600 }
img { max-width: 100%; height: auto; display: block; margin: .6rem 0 }
"""


def page(report: LuxReport, scene: Scene | None = None) -> str:
    """Write the page; a scene gives its plans the outlines of objects."""
    found = report.measurement
    title = html.escape(report.title or "Lighting")
    verdict = "<span class='yes'>all requirements are met</span>"
    if not report.passed:
        verdict = "<span class='no'>a requirement is not met</span>"
    elif not report.checks:
        verdict = "no requirement is stated"
    method = found.settings
    plans = "".join(_plan(report, s, scene) for s in found.sensors if s.form in ("grid", "line"))
    return (
        f"<!doctype html><html lang='en'><meta charset='utf-8'><title>{title}: lighting</title>"
        f"<meta name='viewport' content='width=device-width'><style>{_STYLE}</style><main><h1>{title}</h1>"
        f"<p class='lead'>{verdict}. Maintained values: maintenance factor {report.maintenance_factor:g}. "
        f"Requirements: {html.escape(EDITION)}.</p>"
        f"<h2>Surfaces</h2><div class='scroll'>{_surfaces(report)}</div>{_glare(report)}{plans}"
        f"<h2>How it was measured</h2><p class='note'>{METHOD}. Wished relative standard error "
        f"{100 * method['error']:g} %, at most {method['max_depth']} reflections, seed {method['seed']}; "
        f"{found.ended} after {found.seconds:.1f} s.</p></main></html>\n"
    )


def _surfaces(report: LuxReport) -> str:
    head = (
        "surface",
        "points",
        "mean",
        "± standard error",
        "min",
        "max",
        "U0 = min/mean",
        "Ud = min/max",
        "demanded",
        "",
    )
    rows = [_surface(row) for row in report.rows() if row["form"] != "glare"]
    return "<table><tr>" + "".join(f"<th>{name}</th>" for name in head) + "</tr>" + "".join(rows) + "</table>"


def _surface(row: dict[str, Any]) -> str:
    unit = row["unit"].replace("m2", "m²")
    numbers = [str(row["points"]), f"{row['mean']:.4g} {unit}", f"{row['mean_standard_error']:.2g}"]
    numbers += [f"{row[key]:.4g}" for key in ("min", "max")]
    numbers += ["" if row[key] is None or row["points"] == 1 else f"{row[key]:.2f}" for key in ("u0", "ud")]
    wanted = ", ".join(f"{c['what']} ≥ {c['limit']:g}" for c in row["checks"])
    task = f"<br><small>{html.escape(row['task_name'])}</small>" if row["task_name"] else ""
    cells = "".join(f"<td>{n}</td>" for n in numbers)
    return f"<tr><td>{html.escape(row['name'])}{task}</td>{cells}<td class='text'>{wanted}</td>{_verdict(row)}</tr>"


def _verdict(row: dict[str, Any]) -> str:
    if row["met"] is None:
        return "<td></td>"
    unsure = " (within its error)" if any(c["within_error"] for c in row["checks"]) else ""
    return f"<td class='{'yes' if row['met'] else 'no'}'>{'met' if row['met'] else 'not met'}{unsure}</td>"


def _glare(report: LuxReport) -> str:
    rows = [row for row in report.rows() if row["form"] == "glare"]
    if not rows:
        return ""
    lines = []
    for row in rows:
        glare = report.measurement[row["name"]].glare
        assert glare is not None
        ugr = "no glare" if row["ugr"] is None else f"{row['ugr']:.1f} ± {row['ugr_standard_error']:.1g}"
        wanted = ", ".join(f"≤ {c['limit']:g}" for c in row["checks"])
        cells = f"<td>{ugr}</td><td>{glare.background:.3g} cd/m²</td><td>{len(glare.sources)}</td>"
        lines.append(
            f"<tr><td>{html.escape(row['name'])}</td>{cells}<td class='text'>{wanted}</td>{_verdict(row)}</tr>"
        )
    head = "".join(f"<th>{name}</th>" for name in ("observer", "UGR", "background", "sources in sight", "demanded", ""))
    return f"<h2>Glare</h2><div class='scroll'><table><tr>{head}</tr>{''.join(lines)}</table></div>"


def _plan(report: LuxReport, sensor: Readings, scene: Scene | None) -> str:
    from lesk.plot import plan

    buffer = io.BytesIO()
    plan(sensor, factor=report.factor(sensor), scene=scene).savefig(buffer, format="png")
    data = base64.b64encode(buffer.getvalue()).decode()
    name = html.escape(sensor.name)
    return f"<h2>{name}</h2><img src='data:image/png;base64,{data}' alt='readings of {name} in false colours'>"
