"""Luminaires: polar diagram and web of intensities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lesk.light import Luminaire
from lesk.plot._figure import CURVES, INK, Plot, figure, style


def intensity(luminaires: Luminaire | Sequence[Luminaire], *, names: Sequence[str] = ()) -> Plot:
    """Plot intensities over the angle from nadir, in the planes C0-C180 and C90-C270.

    Parameters
    ----------
    luminaires : Luminaire or sequence of Luminaire
        One, or several to compare.
    names : sequence of str
        What they are called in the legend.

    Returns
    -------
    Plot
        A matplotlib figure; the radius is cd (mW/sr where the file counts watts), nadir is below.
    """
    listed = [luminaires] if isinstance(luminaires, Luminaire) else list(luminaires)
    with style():
        fig = figure(6.4, 6.6)
        axes: Any = fig.add_subplot(projection="polar")
        axes.set_theta_zero_location("S")
        axes.set_theta_direction(1)
        axes.set_thetalim(-np.pi, np.pi)
        angles = np.linspace(-180, 180, 1441)
        top = 0.0
        for i, lamp in enumerate(listed):
            color = CURVES[i % len(CURVES)]
            label = names[i] if i < len(names) else ""
            flat = lamp.symmetry == "rotational"
            for across, line in ((0.0, "-"), (90.0, "--")):
                if flat and across:
                    continue
                values = _cut(lamp, angles, across)
                plane = "all planes" if flat else f"C{across:g}-C{across + 180:g}"
                axes.plot(np.radians(angles), values, line, color=color, label=f"{label} {plane}".strip(), zorder=3)
                if len(listed) == 1:
                    axes.fill(np.radians(angles), values, color=color, alpha=0.12, linewidth=0)
                top = max(top, float(values.max()))
        _frame(axes, top, listed)
        fig.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return fig


def _cut(lamp: Luminaire, angles: Any, across: float) -> Any:
    """Intensities from -180 to 180 degrees in one plane; positive angles lie on its first half."""
    values = np.asarray(lamp.candela(np.abs(angles), np.where(angles >= 0, across, across + 180.0)))
    return values if lamp.flux_lm is not None else 1e3 * values


def _frame(axes: Any, top: float, listed: list[Luminaire]) -> None:
    from matplotlib.ticker import MaxNLocator

    axes.set_xticks(np.radians(np.arange(-150, 181, 30)), [f"{abs(a)}°" for a in range(-150, 181, 30)])
    axes.set_rlim(0, 1.05 * top if top > 0 else 1)
    ticks = [t for t in MaxNLocator(4).tick_values(0, top) if 0 < t < 1.02 * top]
    axes.set_yticks(ticks, [f"{t:g}" for t in ticks], fontsize=8)
    axes.set_rlabel_position(45)
    for text in axes.get_yticklabels():
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.6})
    axes.spines["polar"].set_color(INK)
    unit = "cd" if listed[0].flux_lm is not None else "mW/sr"
    title = f"Intensity in {unit}"
    if len(listed) == 1:
        facts = listed[0].facts
        flux = f"{facts['flux_lm']:.5g} lm" if facts["flux_lm"] is not None else f"{facts['flux_mw']:.5g} mW"
        title += f" · {flux}"
    axes.set_title(title, pad=16)


def web(luminaire: Luminaire) -> Plot:
    """Draw the distribution as a surface: the distance from the centre is the intensity.

    Parameters
    ----------
    luminaire : Luminaire
        The luminaire; nadir is below, C0 to the front right.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    theta, phi = np.meshgrid(np.linspace(0, 180, 91), np.linspace(0, 360, 145))
    r = np.asarray(luminaire.candela(theta, phi))
    peak = float(r.max()) or 1.0
    t, p = np.radians(theta), np.radians(phi)
    x, y, z = (r / peak * part for part in (np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), -np.cos(t)))
    with style():
        fig = figure(6.4, 6.0)
        axes: Any = fig.add_subplot(projection="3d")
        from matplotlib import colormaps

        axes.plot_surface(
            x, y, z, facecolors=colormaps["viridis"](r / peak), rstride=1, cstride=1, linewidth=0, shade=True
        )
        reach = 1.1
        for label, d in (("C0", (reach, 0, 0)), ("C90", (0, reach, 0)), ("nadir", (0, 0, -reach))):
            axes.plot(*zip((0, 0, 0), d, strict=True), color=INK, linewidth=0.8)
            axes.text(*d, label, fontsize=9)
        limits = (
            [float(min(part.min(), 0.0)) for part in (x, y, z)],
            [float(max(part.max(), 0.0)) for part in (x, y, z)],
        )
        spans = [(low - 0.05, high + 0.05) for low, high in zip(*limits, strict=True)]
        axes.set_xlim(*spans[0])
        axes.set_ylim(*spans[1])
        axes.set_zlim(*spans[2])
        axes.set_box_aspect([high - low for low, high in spans])
        axes.set_axis_off()
        axes.view_init(elev=18, azim=-60)
        # the largest of the file, which may lie between the points of the surface
        cd, mw_sr = luminaire.facts["peak_cd"], luminaire.facts["peak_mw_sr"]
        fig.suptitle("Intensities, largest " + (f"{cd:.5g} cd" if cd is not None else f"{mw_sr:.5g} mW/sr"))
    return fig
