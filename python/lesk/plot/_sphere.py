"""A sphere of the model in a studio, traced through the model's own draws."""

from __future__ import annotations

import textwrap
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk._model import Model, Sample
from lesk.plot._figure import Plot, figure, label, listed, style

Single = npt.NDArray[np.float32]
AnyFloat = TypeVar("AnyFloat", npt.NDArray[np.float32], npt.NDArray[np.float64])


class Scatterer(Protocol):
    """What can be traced: anything that draws directions as a model does."""

    def sample(self, wo: npt.ArrayLike, u: npt.ArrayLike | None = None) -> Sample:
        """Draw directions to the light, see `Model.sample`."""


_BOUNCES = 6
"""Scattering events of a path; more than one happens inside glass only."""


def sphere(
    model: Model, *, resolution: int = 320, samples: int = 64, exposure: float = 1.0, title: bool = True
) -> Plot:
    """Plot a sphere of the model, lit by a studio of two soft boxes, a sky and a floor.

    Parameters
    ----------
    model : Model
        The model; the tangent runs around the vertical axis.
    resolution : int
        Pixels per side.
    samples : int
        Paths per pixel.
    exposure : float
        Factor before the picture is tone mapped.
    title : bool
        Whether the figure has a title.

    Returns
    -------
    Plot
        A matplotlib figure with the picture.
    """
    from lesk.image import develop

    (model,) = listed(model)
    picture = trace(model, resolution, samples)
    # EV100 at which a luminance of 1 saturates the sensor: 1.2 * 2^EV = 1
    shown = develop(picture, ev100=-float(np.log2(1.2 * exposure)), mapper="agx")
    with style():
        fig = figure(3.6, 3.9 if title else 3.6)
        axes = fig.add_subplot()
        axes.imshow(np.clip(shown, 0, 1), interpolation="lanczos")
        axes.set_axis_off()
        if title:
            axes.set_title(textwrap.fill(label(model), 46), fontsize=9)
    return fig


def trace(model: Scatterer, resolution: int, samples: int) -> Single:
    """Mean light of all pixels, shape (resolution, resolution, 3), linear."""
    total = np.zeros((resolution * resolution, 3), np.float64)
    jitter = _lesk.sobol(0, samples, 7).reshape(samples, 3)
    shift = np.random.default_rng(1).random((resolution * resolution, 3), np.float32)
    y, x = np.divmod(np.arange(resolution * resolution, dtype=np.float32), np.float32(resolution))
    for index in range(samples):
        px = 2.3 * ((x + jitter[index, 0]) / resolution - 0.5)
        py = 2.3 * (0.5 - (y + jitter[index, 1]) / resolution)
        inside = px * px + py * py < 0.9995
        z = np.sqrt(np.maximum(1 - px * px - py * py, 0))
        points = np.stack([px, py, z], axis=-1).astype(np.float32)
        total[~inside] += _backdrop(py[~inside])
        u = (_lesk.sobol(index, 1, 3) + shift[inside]) % 1
        total[inside] += _scatter(model, points[inside], np.minimum(u, np.float32(0.9999999)), index)
    return (total / samples).reshape(resolution, resolution, 3).astype(np.float32)


def _scatter(model: Scatterer, points: Single, u: Single, index: int) -> Single:
    """Light that leaves points of the unit sphere towards the camera at +z."""
    light = np.zeros_like(points)
    weight = np.ones_like(points)
    wo = np.broadcast_to(np.array([0, 0, 1], np.float32), points.shape)
    active = np.arange(len(points))
    for bounce in range(_BOUNCES):
        frame = frames(points)
        local = _unit(np.einsum("nij,nj->ni", frame, wo))
        drawn = model.sample(local, u[active])
        direction = np.einsum("nij,ni->nj", frame, drawn.wi)
        weight = np.asarray(weight * drawn.weight, np.float32)
        leaves, alive = drawn.wi[:, 2] > 0, drawn.pdf > 0
        out = leaves & alive
        light[active[out]] += weight[out] * _studio(direction[out])
        goes_on = ~leaves & alive
        if not goes_on.any():
            break
        # through the ball to the other side
        active, weight, inward = active[goes_on], weight[goes_on], direction[goes_on]
        start = points[goes_on]
        points = _unit(start - 2 * np.sum(start * inward, axis=-1, keepdims=True) * inward)
        wo = -inward
        rng = np.random.default_rng(index * _BOUNCES + bounce)
        u = u.copy()
        u[active] = rng.random((len(active), 3), np.float32)
    return light


def _unit(v: AnyFloat) -> AnyFloat:
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True), v.dtype)


def frames(normals: AnyFloat) -> AnyFloat:
    """Rows tangent, bitangent, normal, shape (N, 3, 3); the tangent runs around the vertical axis."""
    tangent = np.stack([normals[:, 2], np.zeros(len(normals), normals.dtype), -normals[:, 0]], axis=-1)
    tangent = _unit(tangent + np.asarray(1e-6, normals.dtype))
    tangent = _unit(tangent - np.sum(tangent * normals, axis=-1, keepdims=True) * normals)
    return np.stack([tangent, np.cross(normals, tangent), normals], axis=1)


def _studio(d: Single) -> Single:
    """Radiance from a direction: floor, sky, a large warm and a small cool soft box."""
    x, y, z = np.moveaxis(d, -1, 0)
    sky = np.float32(0.16) + np.float32(0.3) * np.clip(y, 0, 1)
    light = np.stack([0.95 * sky, sky, 1.08 * sky], axis=-1).astype(np.float32)
    floor = 1 / np.maximum(-y, 1e-3)
    checker = (np.floor(1.2 * x * floor) + np.floor(1.2 * z * floor)) % 2
    fade = np.clip(-3 * y, 0, 1)
    ground = (0.16 - 0.11 * fade * checker)[:, np.newaxis] * np.array([1.0, 0.97, 0.92], np.float32)
    light = np.where((y < 0)[:, np.newaxis], ground, light)
    light = light + _box(d, (-0.62, 0.62, 0.5), 0.75, 0.55) * np.array([4.2, 3.9, 3.5], np.float32)
    light = light + _box(d, (0.9, 0.3, -0.05), 0.22, 0.6) * np.array([2.4, 2.8, 3.4], np.float32)
    return np.asarray(light, np.float32)


def _box(d: Single, center: tuple[float, float, float], width: float, height: float) -> Any:
    """Share of a soft-edged rectangle around a direction."""
    c = np.array(center) / np.linalg.norm(center)
    right = np.cross((0, 1, 0), c)
    right /= np.linalg.norm(right)
    up = np.cross(c, right)
    front = d @ c
    safe = np.maximum(front, 1e-3)
    edge = [np.clip((half - np.abs(d @ axis) / safe) * 14 + 0.5, 0, 1) for axis, half in ((right, width), (up, height))]
    return ((front > 0) * edge[0] * edge[1])[:, np.newaxis]


def _backdrop(y: Single) -> Single:
    """A grey wall behind the sphere."""
    level = 0.24 + 0.1 * y
    return np.stack([level, level, 1.03 * level], axis=-1).astype(np.float32)
