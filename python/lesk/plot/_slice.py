"""Slice of half and difference angle."""

from __future__ import annotations

from typing import cast

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LogNorm

from lesk._model import Model
from lesk.plot._figure import FAINT, INK, Array, Plot, figure, label, listed, luminance, style


def slice(model: Model, *, phi_d_deg: float = 90, resolution: int = 361) -> Plot:
    """Plot f over half angle and difference angle, as an image (after Rusinkiewicz 1998, burley2012).

    Parameters
    ----------
    model : Model
        The model.
    phi_d_deg : float
        Azimuth of the difference angle, degrees; 90 is the slice of the literature.
    resolution : int
        Points per axis.

    Returns
    -------
    Plot
        A matplotlib figure: highlights at the left edge, grazing retro-reflection at the top left, Fresnel peak at the
        top. Grey is below the horizon.
    """
    (model,) = listed(model)
    edges = np.linspace(0, np.pi / 2, resolution + 1)
    centers = 0.5 * (edges[1:] + edges[:-1])
    wi, wo = half_difference(centers[np.newaxis, :], centers[:, np.newaxis], float(np.radians(phi_d_deg)))
    f = np.ma.masked_where((wi[..., 2] <= 0) | (wo[..., 2] <= 0), luminance(model.eval(wi, wo)))
    positive = f[f > 0].compressed()
    with style():
        fig = figure(5.6, 4.7)
        axes = fig.add_subplot()
        axes.grid(False)
        axes.set_facecolor(FAINT)
        axes.set(xlabel="half angle θh, degrees", ylabel="difference angle θd, degrees", aspect="equal")
        axes.set(xticks=range(0, 91, 15), yticks=range(0, 91, 15))
        fig.suptitle(f"{label(model)}\nf at azimuth of difference φd = {phi_d_deg:g}°", fontsize=11)
        if positive.size == 0:
            axes.set(xlim=(0, 90), ylim=(0, 90))
            axes.text(45, 45, "no continuous part", ha="center", color=INK)
            return fig
        # the highest values stand on a few points at grazing angles: they must not take the scale
        high = float(np.quantile(positive, 0.995))
        low = max(float(positive.min()), 1e-3 * high)
        norm = LogNorm(min(low, 0.8 * high), high)
        colors = colormaps["viridis"].copy()
        image = axes.pcolormesh(np.degrees(edges), np.degrees(edges), f, norm=norm, cmap=colors, rasterized=True)
        bar = fig.colorbar(image, ax=axes, label="f, 1/sr", extend="both" if low > positive.min() else "max")
        bar.outline.set_visible(False)
    return fig


def half_difference(theta_h: Array, theta_d: Array, phi_d: float) -> tuple[Array, Array]:
    """Directions from half and difference angles (rusinkiewicz1998); the half vector lies over the tangent."""
    theta_h, theta_d = np.broadcast_arrays(theta_h, theta_d)
    dx, dy = np.sin(theta_d) * np.cos(phi_d), np.sin(theta_d) * np.sin(phi_d)
    dz, sin, cos = np.cos(theta_d), np.sin(theta_h), np.cos(theta_h)
    wi = np.stack([cos * dx + sin * dz, dy, cos * dz - sin * dx], axis=-1)
    # wo mirrors wi at the half vector: the part across it changes its sign
    wo = np.stack([-cos * dx + sin * dz, -dy, cos * dz + sin * dx], axis=-1)
    return cast("Array", wi), cast("Array", wo)
