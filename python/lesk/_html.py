"""How a model shows itself in a notebook: its parameters beside a polar cut."""

from __future__ import annotations

import html
import math
import re
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lesk._model import Model

_THETA_DEG = 45.0
_RADIUS = 100.0


def describe(model: Model) -> str:
    """Write a model as HTML."""
    info = model.info
    rows = []
    for spec in info["parameters"]:
        value = model.params[spec["name"]]
        shown = f"{value:g}" if value.ndim == 0 else np.array2string(value, precision=4, threshold=9)
        cells = (f"<code>{spec['name']}</code>", html.escape(shown), spec["unit"], _plain(spec["doc"]))
        rows.append("<tr>" + "".join(f"<td style='text-align:left'>{c}</td>" for c in cells) + "</tr>")
    head = f"<b>{html.escape(info['title'])}</b> ({info['year']}), <code>{model.id}</code>"
    table = f"<table>{''.join(rows)}</table>"
    return f"<div style='display:flex;align-items:center;gap:2em'><div>{head}{table}</div>{polar_svg(model)}</div>"


def polar_svg(model: Model) -> str:
    """Draw a polar cut of f for light from 45 degrees; empty for models whose parameters are arrays."""
    if any(a.size > 3 for a in model.params.values()):
        return ""
    theta = np.radians(np.linspace(-89.9, 89.9, 720))
    wo = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
    angle = math.radians(_THETA_DEG)
    wi = np.array([-math.sin(angle), 0.0, math.cos(angle)])
    f = model.eval(wi, wo) @ [0.2126, 0.7152, 0.0722]
    peak = float(f.max())
    r = _RADIUS * f / peak if peak > 0 else f
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(r * wo[:, 0], -r * wo[:, 2], strict=True))
    lobes = "".join(_delta_line(model, wi))
    caption = f"f up to {peak:.3g} 1/sr, light from {_THETA_DEG:g}°" if peak > 0 else "delta lobes only"
    x, y = (1.08 * _RADIUS * v for v in (wi[0], -wi[2]))
    return (
        "<svg xmlns='http://www.w3.org/2000/svg' width='230' height='140' viewBox='-115 -112 230 140' "
        "fill='none' stroke='currentColor' stroke-width='1' font-family='sans-serif'>"
        f"<path d='M-{_RADIUS},0 A{_RADIUS},{_RADIUS} 0 0 1 {_RADIUS},0 Z' opacity='.25'/>"
        f"<line x1='{x:.1f}' y1='{y:.1f}' x2='0' y2='0' stroke='#e69f00' stroke-width='2'/>"
        f"<polygon points='0,0 {points}' fill='#0072b2' fill-opacity='.3' stroke='#0072b2' "
        f"stroke-width='1.5'/>{lobes}"
        f"<text x='0' y='20' text-anchor='middle' font-size='11' fill='currentColor' stroke='none'>"
        f"{caption}</text></svg>"
    )


def _delta_line(model: Model, wi: np.ndarray) -> list[str]:
    # the lobes towards the mirror image of the light
    lobes = model.delta(wi)
    lines = []
    for direction, probability in zip(lobes.wi, lobes.probability, strict=True):
        if probability > 0 and direction[2] > 0:
            x, y = _RADIUS * direction[0], -_RADIUS * direction[2]
            lines.append(f"<line x1='0' y1='0' x2='{x:.1f}' y2='{y:.1f}' stroke='#0072b2' stroke-width='3'/>")
    return lines


def _plain(doc: str) -> str:
    """Turn backquotes into code; formulas stay as they are."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(" ".join(doc.split())))
