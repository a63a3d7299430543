"""Directional albedo over the angle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lesk._model import Model
from lesk.plot._figure import (
    CHANNELS,
    CURVES,
    INK,
    Plot,
    direction,
    figure,
    is_grey,
    label,
    listed,
    luminance,
    style,
)


def albedo(model: Model | Sequence[Model], *, phi_deg: float = 0, samples: int = 4096) -> Plot:
    """Plot which share of the light is scattered, over its angle.

    Parameters
    ----------
    model : Model or sequence of Model
        One model, in its colours, or several to compare by luminance.
    phi_deg : float
        Azimuth of the light about the tangent, degrees.
    samples : int
        Draws per angle.

    Returns
    -------
    Plot
        A matplotlib figure. Above 1 a model makes light from nothing.
    """
    models = listed(model)
    theta = np.radians(np.concatenate([np.linspace(0, 80, 33), np.linspace(81, 89.5, 18)]))
    w = direction(theta, np.radians(phi_deg))
    with style():
        fig = figure(6.0, 3.9)
        axes = fig.add_subplot()
        top = 1.0
        for index, m in enumerate(models):
            rgb = m.albedo(w, samples=samples)
            top = max(top, float(rgb.max()))
            if len(models) > 1 or is_grey(rgb):
                axes.plot(np.degrees(theta), luminance(rgb), color=CURVES[index % len(CURVES)], label=label(m))
            else:
                for channel, name in enumerate(("red", "green", "blue")):
                    axes.plot(np.degrees(theta), rgb[:, channel], color=CHANNELS[channel], label=name)
        axes.axhline(1, color=INK, linewidth=1, linestyle=(0, (4, 3)), zorder=1)
        axes.annotate("energy limit", (1, 1), (0, 4), textcoords="offset points", fontsize=8, color=INK)
        axes.set(xlabel="angle to the normal, degrees", ylabel="directional albedo")
        axes.set(xlim=(0, 90), ylim=(0, 1.08 * top), xticks=range(0, 91, 15))
        name = label(models[0]) if len(models) == 1 else "Comparison"
        fig.suptitle(f"{name}\nshare of the light that is scattered", fontsize=11)
        if len(axes.get_legend_handles_labels()[0]) > 1:
            axes.legend(loc="best")
    return fig
