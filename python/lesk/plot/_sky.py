"""Skies as a fisheye lens sees them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lesk._sky import HosekSky
from lesk.plot._figure import Plot, figure, style

_ACROSS = 4
"""Most pictures in one row."""


def sky(skies: HosekSky | Sequence[HosekSky], *, across: int = _ACROSS, resolution: int = 256) -> Plot:
    """Draw skies as a fisheye lens sees them that looks at the zenith: the distance from the middle is the angle.

    Parameters
    ----------
    skies : HosekSky or sequence of HosekSky
        One, or several that are shown with the same exposure.
    across : int
        Pictures in one row.
    resolution : int
        Pixels across one picture.

    Returns
    -------
    Plot
        A matplotlib figure: north is up, east to the left, as when one looks up; without the sun's disk.
    """
    listed = [skies] if isinstance(skies, HosekSky) else list(skies)
    columns = min(across, len(listed))
    rows = -(-len(listed) // columns)
    pictures = [_fisheye(one, resolution) for one in listed]
    # a white of the brightest twentieth of all skies
    white = float(np.quantile(np.concatenate([p[np.isfinite(p)] for p in pictures]), 0.95))
    with style():
        fig = figure(2.3 * columns + 0.2, 2.62 * rows + 0.3)
        axes: Any = fig.subplots(rows, columns, squeeze=False)
        for panel in axes.ravel():
            panel.set_axis_off()
        for panel, one, picture in zip(axes.ravel(), listed, pictures, strict=False):
            linear = np.clip(picture / white, 0, 1)
            shown = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
            panel.imshow(np.where(np.isfinite(shown), shown, 1.0))
            panel.set_title(
                f"turbidity {one.turbidity:g}, sun at {one.elevation_deg:g}°\n{one.illuminance_lx / 1000:.3g} klx",
                fontsize=9,
            )
        fig.suptitle(f"Cloudless skies; white is {white / 1000:.2g} kcd/m² in each channel", fontsize=10)
    return fig


def _fisheye(one: HosekSky, resolution: int) -> Any:
    """Linear Rec.709 in cd/m², NaN outside the circle."""
    at = (np.arange(resolution) + 0.5) / resolution * 2 - 1
    x, y = np.meshgrid(at, -at)
    radius = np.hypot(x, y)
    rgb = one.rgb(np.minimum(radius, 1) * 90, np.degrees(np.arctan2(-x, y)))
    rgb[radius > 1] = np.nan
    return rgb
