"""What the figures share: lit balls, pictures side by side, marks."""

from __future__ import annotations

from typing import Any, Protocol, cast

import numpy as np
import numpy.typing as npt

from lesk.plot._figure import CURVES, Array
from lesk.plot._sphere import frames

VIEW = np.array([0.0, 0.0, 1.0])
"""The viewer of all balls, far away."""
LIGHT_ABOVE = np.array([-1.0, 1.2, 1.3]) / np.linalg.norm([-1.0, 1.2, 1.3])
"""A light from the upper left."""
MARK = CURVES[1]
"""Colour of marks on pictures."""

_SUPERSAMPLING = 3


class Evaluator(Protocol):
    """What can be lit: anything with the f of a model."""

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Any:
        """Value f in 1/sr, shape (..., 3), see `Model.eval`."""


class Ball:
    """A sphere seen by a far viewer: the normals of its pixels."""

    def __init__(self, resolution: int) -> None:
        self.resolution = resolution
        size = resolution * _SUPERSAMPLING
        line = 1.02 * (2 * (np.arange(size) + 0.5) / size - 1)
        x, y = np.meshgrid(line, -line)
        self.inside = x * x + y * y < 1
        x, y = x[self.inside], y[self.inside]
        self.normals: Array = np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=-1)

    def lit(self, surface: Evaluator, light: Array = LIGHT_ABOVE) -> Array:
        """Light of all points, shape (N, 3): 1 is what a white matte surface sends that faces the light.

        With the light C_L = 1 of the classic model, whose irradiance is pi, this is C = pi f cos(theta_i).
        """
        return lit(surface, self.normals, light)

    def picture(self, values: Array) -> Array:
        """A picture with a transparent ground, shape (resolution, resolution, 4), sRGB-encoded, clipped at 1."""
        size = self.resolution * _SUPERSAMPLING
        planes = np.zeros((size, size, 4))
        planes[self.inside, :3] = np.clip(values, 0, 1)
        planes[self.inside, 3] = 1
        blocks = planes.reshape(self.resolution, _SUPERSAMPLING, self.resolution, _SUPERSAMPLING, 4)
        planes = blocks.mean(axis=(1, 3))
        cover = np.maximum(planes[..., 3:], 1e-9)
        return np.concatenate([encoded(planes[..., :3] / cover), planes[..., 3:]], axis=-1)

    def mask(self, marked: npt.NDArray[np.bool_]) -> Array:
        """Points as a picture of 0 and 1, for a contour."""
        plane = np.zeros(self.inside.shape)
        plane[self.inside] = marked
        return plane


def lit(surface: Evaluator, normals: Array, light: Array, tangents: Array | None = None) -> Array:
    """Light that points with these normals send to the viewer, as `Ball.lit` says."""
    frame = frames(normals)
    if tangents is not None:
        along = tangents - np.sum(tangents * normals, axis=-1, keepdims=True) * normals
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        frame = np.stack([along, np.cross(normals, along), normals], axis=1)
    wi, wo = frame @ light, frame @ VIEW
    f = surface.eval(wi, wo)
    return cast("Array", np.pi * f * np.maximum(wi[:, 2:], 0))


def half_vector(wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
    """Unit vectors in the middle of two directions, shape (..., 3)."""
    middle: Array = np.asarray(wi, float) + np.asarray(wo, float)
    unit: Array = middle / np.linalg.norm(middle, axis=-1, keepdims=True)
    return unit


def undone(values: Array, wi: Array) -> Array:
    """Divide values of shape (N, 3) by pi cos(theta_i), by which `lit` multiplies: it shows them as they are."""
    safe = np.where(wi[:, 2:] > 1e-4, wi[:, 2:], np.inf)
    return values / (np.pi * safe)


def encoded(linear: npt.ArrayLike) -> Array:
    """Encode linear values as sRGB, clipped to 0 to 1."""
    from lesk.image import develop

    pixels = np.asarray(linear, np.float32)
    # EV100 at which 1 saturates the sensor: 1.2 * 2^EV = 1
    rows = pixels if pixels.ndim == 3 else pixels.reshape(1, -1, 3)
    shown = develop(rows, ev100=-float(np.log2(1.2)))
    return np.clip(shown, 0, 1).reshape(pixels.shape).astype(np.float64)


def show(axes: Any, picture: Array, title: str = "", below: str = "") -> None:
    """Put a picture without a frame into axes, with a title above and a line below."""
    axes.imshow(picture, interpolation="lanczos")
    bare(axes)
    if title:
        axes.set_title(title, fontsize=10)
    if below:
        axes.set_xlabel(below, fontsize=8.5)


def bare(axes: Any) -> None:
    """Remove frame, grid and ticks."""
    axes.grid(False)
    axes.set(xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_visible(False)


def outline(axes: Any, ball: Ball, marked: npt.NDArray[np.bool_]) -> None:
    """Draw a line around marked points of a ball."""
    if marked.any():
        # pixel centres of the picture: the mask is finer
        step = 1 / _SUPERSAMPLING
        at = step * (np.arange(ball.inside.shape[0]) + 0.5) - 0.5
        axes.contour(at, at, ball.mask(marked), [0.5], colors=MARK, linewidths=1.2)


def arrow(axes: Any, start: npt.ArrayLike, end: npt.ArrayLike, color: str, **options: Any) -> None:
    """Draw an arrow between two points of the data."""
    style = {"arrowstyle": "-|>", "color": color, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0, **options}
    axes.annotate("", tuple(np.asarray(end, float)), tuple(np.asarray(start, float)), arrowprops=style)
