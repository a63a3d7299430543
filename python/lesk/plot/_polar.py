"""Polar cut: f over the viewer's angle in one plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lesk._model import Model
from lesk.errors import ParameterError
from lesk.plot._figure import (
    CHANNELS,
    CURVES,
    INK,
    LIGHT,
    Array,
    Plot,
    direction,
    figure,
    is_grey,
    label,
    listed,
    luminance,
    polar_angle,
    style,
    warped,
)

_PLANES = {"incidence": 0.0, "across": 90.0}


def polar(
    model: Model | Sequence[Model],
    *,
    theta_i_deg: float = 45,
    phi_i_deg: float = 0,
    plane: str | float = "incidence",
    cosine: bool = False,
) -> Plot:
    """Plot f over the angle of the viewer, as the distance from the origin.

    Parameters
    ----------
    model : Model or sequence of Model
        One model, in its colours, or several to compare by luminance.
    theta_i_deg : float
        Polar angle of the light, degrees; it comes from the left.
    phi_i_deg : float
        Azimuth of the plane of incidence about the tangent, degrees.
    plane : str or float
        Plane of the viewer: `incidence`, `across` it, or its angle to the plane of incidence in degrees.
    cosine : bool
        Plot f cos θo instead of f: the share of the light that goes there.

    Returns
    -------
    Plot
        A matplotlib figure. Delta lobes are lines to the edge.
    """
    models = listed(model)
    theta_i = polar_angle("theta_i_deg", theta_i_deg)
    if isinstance(plane, str) and plane not in _PLANES:
        raise ParameterError(f"`plane` is `{plane}`, but `incidence`, `across` or an angle in degrees is accepted")
    turn = np.radians(_PLANES[plane] if isinstance(plane, str) else plane)
    phi = np.radians(phi_i_deg)
    below = any(m.info["domain"] != "upper" for m in models)
    wi = direction(-theta_i, phi)
    with style():
        fig = figure(6.4, 6.8 if below else 4.2)
        # a fixed frame: the automatic one leaves half circles small
        fig.set_layout_engine("none")
        frame = (0.07, 0.08, 0.86, 0.76) if below else (0.07, -0.2, 0.86, 1.3)
        axes = fig.add_axes(frame, projection="polar")
        _frame(axes, below)
        peak = max(_curves(axes, m, wi, theta_i, phi + turn, cosine, len(models) > 1, i) for i, m in enumerate(models))
        top = 1.08 * peak if peak > 0 else 1.0
        _radii(axes, top, peak > 0)
        axes.plot([-theta_i, -theta_i], [0, top], color=LIGHT, linewidth=2.2, zorder=2, clip_on=False)
        axes.annotate(
            "light",
            (-theta_i, top),
            (-14, 5),
            textcoords="offset points",
            ha="right",
            color=LIGHT,
            annotation_clip=False,
        )
        if turn == 0:
            for i, m in enumerate(models):
                _deltas(axes, m, wi, phi, top, CURVES[i % len(CURVES)])
        quantity = "f cos θo" if cosine else "f"
        where = "" if turn == 0 else f", viewer {np.degrees(turn):g}° off the plane of incidence"
        name = label(models[0]) if len(models) == 1 else "Comparison"
        fig.suptitle(f"{name}\n{quantity} in 1/sr, light from {theta_i_deg:g}°{where}", fontsize=11)
        if axes.get_legend_handles_labels()[0]:
            fig.legend(loc="lower center", ncols=3)
    return fig


def _frame(axes: Any, below: bool) -> None:
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    if below:
        axes.set_thetalim(-np.pi, np.pi)
        ticks = np.arange(-150, 181, 30)
    else:
        axes.set_thetalim(-np.pi / 2, np.pi / 2)
        ticks = np.arange(-90, 91, 30)
    axes.set_xticks(np.radians(ticks), [f"{abs(t):d}°" for t in ticks])
    axes.plot([-np.pi / 2, 0, np.pi / 2], [1e9, 0, 1e9], color=INK, linewidth=1.2, zorder=1.5)
    axes.spines["polar"].set_visible(False)


def _radii(axes: Any, top: float, labelled: bool) -> None:
    axes.set_rlim(0, top)
    if not labelled:
        axes.set_yticks([])
        return
    from matplotlib.ticker import MaxNLocator

    ticks = [t for t in MaxNLocator(4).tick_values(0, top) if 0 < t < 0.99 * top]
    axes.set_yticks(ticks, [f"{t:.3g}" for t in ticks], fontsize=8)
    axes.set_rlabel_position(0)
    for text in axes.get_yticklabels():
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.6})


def _curves(
    axes: Any, model: Model, wi: Array, theta_i: float, phi: float, cosine: bool, compare: bool, index: int
) -> float:
    """Draw a model; give the largest radius."""
    edge = np.pi if model.info["domain"] != "upper" else np.pi / 2
    theta = np.union1d(warped(theta_i, -edge, edge, 1201), np.linspace(-edge, edge, 721))
    wo = direction(theta, phi)
    f = model.eval(wi, wo)
    if cosine:
        f = f * np.abs(wo[:, 2:])
    if compare or is_grey(f):
        color = CURVES[index % len(CURVES)]
        radius = luminance(f)
        axes.fill(theta, radius, color=color, alpha=0.12 if compare else 0.2, linewidth=0)
        axes.plot(theta, radius, color=color, label=label(model) if compare else None, zorder=3)
    else:
        for channel, (color, name) in enumerate(zip(CHANNELS, ("red", "green", "blue"), strict=True)):
            axes.plot(theta, f[:, channel], color=color, label=name, zorder=3)
    return float(f.max())


def _deltas(axes: Any, model: Model, wi: Array, phi: float, top: float, color: str) -> None:
    lobes = model.delta(wi)
    along = direction(np.pi / 2, phi)
    for lobe, probability in zip(lobes.wi, lobes.probability, strict=True):
        if probability > 0:
            angle = float(np.arctan2(lobe @ along, lobe[2]))
            axes.plot([angle, angle], [0, top], color=color, linewidth=3, zorder=3, clip_on=False)
            axes.annotate(
                "δ", (angle, top), (10, 4), textcoords="offset points", color=color, fontsize=13, annotation_clip=False
            )
