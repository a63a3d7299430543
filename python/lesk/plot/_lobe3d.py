"""The lobe: f over all directions of the viewer, as a surface."""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LightSource, Normalize

from lesk._model import Model
from lesk.plot._figure import (
    FAINT,
    INK,
    LIGHT,
    Plot,
    direction,
    figure,
    label,
    listed,
    luminance,
    polar_angle,
    style,
    warped,
)


def lobe3d(model: Model, *, theta_i_deg: float = 45, phi_i_deg: float = 0, resolution: int = 121) -> Plot:
    """Plot f over all directions of the viewer as a surface whose distance from the origin is f.

    Parameters
    ----------
    model : Model
        The model.
    theta_i_deg : float
        Polar angle of the light, degrees; it comes from the left.
    phi_i_deg : float
        Azimuth of the plane of incidence about the tangent, degrees.
    resolution : int
        Lines of the surface per axis.

    Returns
    -------
    Plot
        A matplotlib figure; colour and distance show f in 1/sr.
    """
    (model,) = listed(model)
    theta_i, phi = polar_angle("theta_i_deg", theta_i_deg), float(np.radians(phi_i_deg))
    wi = direction(-theta_i, phi)
    depth = np.pi if model.info["domain"] != "upper" else np.pi / 2
    # dense where the lobe is narrow
    theta = warped(theta_i, 0, depth, resolution, 3.0)
    azimuth = warped(0, -np.pi, np.pi, resolution, 3.0)
    grid_theta, grid_phi = np.meshgrid(theta, azimuth)
    f = luminance(model.eval(wi, direction(grid_theta, grid_phi + phi)))
    peak = float(f.max())
    scale = peak if peak > 0 else 1.0
    points = direction(grid_theta, grid_phi) * (f / scale)[..., np.newaxis]
    with style():
        fig = figure(6.0, 4.6)
        axes = fig.add_subplot(projection="3d", computed_zorder=False)
        axes.set_axis_off()
        turn = np.linspace(0, 2 * np.pi, 181)
        for radius in (0.5, 1.0):
            axes.plot(radius * np.cos(turn), radius * np.sin(turn), 0, color=FAINT, linewidth=1, zorder=0)
        axes.plot([-1, 1], [0, 0], [0, 0], color=FAINT, linewidth=1, zorder=0)
        colors = colormaps["viridis"](0.1 + 0.9 * f / scale)
        shaded = LightSource(225, 50).shade_rgb(
            colors[..., :3], points[..., 2], vert_exag=1.2, fraction=0.6, blend_mode="soft"
        )
        x, y, z = np.moveaxis(points, -1, 0)
        axes.plot_surface(x, y, z, facecolors=shaded, rcount=resolution, ccount=resolution, shade=False, zorder=2)
        light = 1.15 * direction(-theta_i)
        axes.plot(*np.stack([light, 0 * light], axis=-1), color=LIGHT, linewidth=2.5, zorder=3)
        axes.text(*(1.08 * light), "light", color=LIGHT, ha="right", zorder=3)
        axes.plot([0, 0], [0, 0], [0, 1.1], color=INK, linewidth=1, zorder=1)
        axes.text(0, 0, 1.14, "n", color=INK, ha="center")
        low = -1.0 if depth > 2 else 0.0
        axes.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(low, 1.1))
        axes.set_box_aspect((2, 2, 1.1 - low), zoom=1.45)
        axes.view_init(elev=20, azim=-72)
        if peak > 0:
            mappable = ScalarMappable(Normalize(0, peak), "viridis")
            bar = fig.colorbar(mappable, ax=axes, label="f, 1/sr", shrink=0.6, pad=0.0)
            bar.outline.set_visible(False)
        fig.suptitle(f"{label(model)}\nf for light from {theta_i_deg:g}°", fontsize=11)
    return fig
