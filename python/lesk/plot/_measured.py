"""False-colour plans of measured grids, with isolux lines and a scale."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.colors import ListedColormap, LogNorm, Normalize

from lesk import _lesk
from lesk._measure import Readings
from lesk.errors import ParameterError
from lesk.plot._figure import INK, Plot, style
from lesk.scene import Scene

Array = npt.NDArray[np.float64]

_STEPS = 256
_NUMBERS = 60
"""Grids of up to so many points show their numbers, larger ones isolux lines."""
LEVELS = (1, 2, 3, 5, 7.5, 10)
"""Isolux lines are drawn at these times powers of ten: the scale of illuminances of EN 12464-1, thinned."""


def colormap() -> ListedColormap:
    """Viridis, from the table that the pictures use."""
    ramp = np.repeat(np.linspace(0, 1, _STEPS, dtype=np.float32)[None, :, None], 3, axis=2)
    colors = _lesk.false_color(ramp, 0.0, 1.0, False)[0]
    return ListedColormap(np.clip(colors, 0, 1), name="lesk-viridis")


def norm(low: float, high: float, log: bool) -> Any:
    """Map numbers from `low` to `high` to the scale."""
    return LogNorm(low, high) if log else Normalize(low, high)


def levels(low: float, high: float) -> list[float]:
    """Give round numbers from `low` to `high`, at most about eight."""
    if not (high > low >= 0):
        return []
    powers = range(-6, 8)
    scale = [step * 10.0**power for power in powers for step in LEVELS[:-1]]
    if high < 20 * low:
        step = 10.0 ** np.floor(np.log10(high - low))
        step *= next(f for f in (0.1, 0.2, 0.5, 1, 2) if (high - low) / (f * step) <= 8)
        return [float(v) for v in np.arange(np.ceil(low / step), high / step) * step if v > 0]
    return [v for v in scale if low < v < high][-8:]


def plan(sensor: Readings, *, factor: float = 1.0, scene: Scene | None = None) -> Plot:
    """Draw the readings of a grid as a plan with isolux lines; of a line as a curve.

    Parameters
    ----------
    sensor : Readings
        Of a grid or a line.
    factor : float
        Of the readings, the maintenance factor.
    scene : Scene, optional
        Draws the outlines of its objects.

    Returns
    -------
    Plot
    """
    if sensor.form == "line":
        return _curve(sensor, factor)
    if sensor.form != "grid":
        raise ParameterError(f"sensor `{sensor.name}` is a {sensor.form}, but a grid or a line is accepted")
    x, y, along = _plane(sensor.positions)
    value = factor * sensor.value
    width, height = np.ptp(x) + _cell(x), np.ptp(y) + _cell(y.T)
    wide = 5.6 * min(1.0, max(0.45, width / height))
    with style():
        figure = Plot(figsize=(wide + 1.9, wide * height / width + 1.1), layout="constrained")
        axes = figure.add_subplot()
        image = _colored(axes, x, y, value, sensor.unit, figure)
        _outlines(axes, scene, sensor, along)
        lines = levels(float(value.min()), float(value.max()))
        if value.size > _NUMBERS and min(value.shape) > 1 and lines:
            contours = axes.contour(x, y, value, levels=lines, colors="white", linewidths=1.1)
            named = _prune(contours, smallest=1.5 * _cell(x), long=0.25 * min(width, height))
            axes.clabel(contours, fmt="%g", fontsize=8, colors="white", manual=named)
            image.colorbar.add_lines(contours, erase=True)
        axes.set(aspect="equal", xlabel=f"{along[0]} (m)", ylabel=f"{along[1]} (m)", title=sensor.name)
        axes.grid(False)
    return figure


def _prune(contours: Any, smallest: float, long: float) -> list[tuple[float, float]]:
    """Take out the specks that noise makes; give the middles of the long lines, which bear their number."""
    from matplotlib.path import Path

    kept, middles = [], []
    for path in contours.get_paths():
        lines = [(line, float(np.ptp(line, axis=0).max())) for line in path.to_polygons(closed_only=False)]
        lines = [(line, extent) for line, extent in lines if extent >= smallest]
        middles += [tuple(line[len(line) // 2]) for line, extent in lines if extent >= long]
        kept.append(Path.make_compound_path(*(Path(line) for line, _ in lines)))
    contours.set_paths(kept)
    return middles


def _colored(axes: Any, x: Array, y: Array, value: Array, unit: str, figure: Plot) -> Any:
    low, high = float(value.min()), float(value.max())
    if not high > low:
        low, high = low - 0.5, high + 0.5
    image = axes.pcolormesh(x, y, value, cmap=colormap(), norm=norm(low, high, log=False), shading="nearest")
    for place in np.ndindex(value.shape):
        if value.size <= _NUMBERS:
            shade = (value[place] - low) / (high - low)
            color = "black" if shade > 0.62 else "white"
            axes.text(x[place], y[place], f"{value[place]:.0f}", ha="center", va="center", fontsize=6.5, color=color)
    figure.colorbar(image, ax=axes, label=unit.replace("m2", "m²"), shrink=0.9)
    return image


def _outlines(axes: Any, scene: Scene | None, sensor: Readings, along: Sequence[str]) -> None:
    """Objects wider than a board and smaller than the view, as rectangles: lamps dashed, furniture solid."""
    from matplotlib.patches import Rectangle

    if scene is None or "".join(along) != "xy":
        return
    low, high = sensor.positions.min((0, 1)), sensor.positions.max((0, 1))
    for _, smallest, largest, shines in scene.boxes():
        size = np.subtract(largest, smallest)[:2]
        inside = np.all(np.greater(largest[:2], low[:2]) & np.less(smallest[:2], high[:2]))
        if inside and np.all(size > 0.08) and np.all(size < 0.7 * (high - low)[:2]):
            edge = "#ffffff" if shines else INK
            axes.add_patch(
                Rectangle(
                    (smallest[0], smallest[1]),
                    size[0],
                    size[1],
                    fill=False,
                    edgecolor=edge,
                    linewidth=1,
                    linestyle="--" if shines else "-",
                )
            )


def _plane(positions: Array) -> tuple[Array, Array, list[str]]:
    """The two world axes that a grid lies along, else its own two edges in metres."""
    rows = positions[-1, 0] - positions[0, 0]
    columns = positions[0, -1] - positions[0, 0]
    axes = [int(np.abs(edge).argmax()) for edge in (columns, rows)]
    straight = all(np.abs(edge).sum() - np.abs(edge).max() < 1e-9 for edge in (columns, rows))
    if straight and axes[0] != axes[1]:
        first, second = sorted(axes)
        return positions[..., first], positions[..., second], ["xyz"[first], "xyz"[second]]
    u = np.linalg.norm(positions - positions[:1, :1], axis=-1)
    return np.broadcast_to(u[:1], u.shape), np.broadcast_to(u[:, :1], u.shape), ["u", "v"]


def _cell(x: Array) -> float:
    steps = np.abs(np.diff(x, axis=1))
    if steps.size and steps.max() > 0:
        return float(steps.max())
    steps = np.abs(np.diff(x, axis=0))
    return float(steps.max()) if steps.size and steps.max() > 0 else 1.0


def _curve(sensor: Readings, factor: float) -> Plot:
    from lesk.plot._figure import CURVES

    positions = sensor.positions[0]
    distance = np.linalg.norm(positions - positions[0], axis=-1)
    value, half = factor * sensor.value[0], factor * sensor.half_interval[0]
    with style():
        figure = Plot(figsize=(6.4, 3.4), layout="constrained")
        axes = figure.add_subplot()
        axes.fill_between(distance, value - half, value + half, color=CURVES[0], alpha=0.25, linewidth=0)
        axes.plot(distance, value, color=CURVES[0])
        axes.set(xlabel="along the line (m)", ylabel=sensor.unit.replace("m2", "m²"), title=sensor.name)
        axes.set_ylim(bottom=0)
    return figure


def false_color(
    value: Array, unit: str, *, low: float | None = None, high: float | None = None, log: bool = False, title: str = ""
) -> Plot:
    """Draw a picture of numbers in false colours beside their scale.

    Parameters
    ----------
    value : array of shape (height, width)
        Numbers in `unit`; row 0 is the top row.
    unit : str
        For the label of the scale.
    low, high : float, optional
        Ends of the scale; without them, 1 % and 99 % of the pixels lie outside.
    log : bool
        Steps of equal ratio.
    title : str
        Above the picture.

    Returns
    -------
    Plot
    """
    lit = value[value > 0] if log else value[np.isfinite(value)]
    if lit.size == 0:
        lit = np.array([0.1, 1.0])
    ends = [float(np.percentile(lit, at)) if given is None else given for given, at in ((low, 1), (high, 99))]
    if low is None and high is None and not ends[1] > ends[0]:
        # all pixels alike
        ends[1] = ends[0] * 1.01 + 1e-9
    if not (np.isfinite(ends).all() and ends[0] < ends[1] and (ends[0] > 0 or not log)):
        accepted = "0 < low < high" if log else "low < high"
        raise ParameterError(f"the scale goes from {ends[0]:g} to {ends[1]:g}, but {accepted} is accepted")
    rows, columns = value.shape
    wide = 7.2
    with style():
        figure = Plot(figsize=(wide + 1.1, wide * rows / columns + 0.5), layout="constrained")
        axes = figure.add_subplot()
        image = axes.imshow(value, cmap=colormap(), norm=norm(ends[0], ends[1], log), interpolation="nearest")
        axes.set_axis_off()
        if title:
            axes.set_title(title)
        bar = figure.colorbar(image, ax=axes, label=unit.replace("m2", "m²"), shrink=0.92, pad=0.02, extend="both")
        if log:
            ticks = [step * 10.0**power for power in range(-6, 10) for step in (1, 2, 5)]
            bar.set_ticks([t for t in ticks if ends[0] <= t <= ends[1]])
            bar.ax.minorticks_off()
            bar.ax.yaxis.set_major_formatter(lambda v, _: f"{v:g}")
    return figure
