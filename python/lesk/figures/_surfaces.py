"""Surfaces: kinds of reflection, rough matte ones, satin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk import models
from lesk._model import Sample
from lesk.figures._sheet import VIEW, Ball, Evaluator, arrow, bare, encoded, lit, show
from lesk.plot._figure import CURVES, INK, LIGHT, Array, Plot, direction, figure, style
from lesk.plot._sphere import trace


class Retro:
    """A reflector that sends light back: `modified_phong` with the viewer mirrored at the normal."""

    def __init__(self, shininess: float = 60, specular: float = 0.75) -> None:
        self._model = models.modified_phong(diffuse=0.1, specular=specular, shininess=shininess)

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Any:
        """Value f in 1/sr, shape (..., 3)."""
        return self._model.eval(wi, mirrored(wo))

    def sample(self, wo: npt.ArrayLike, u: npt.ArrayLike | None = None) -> Sample:
        """Draw directions to the light, see `Model.sample`."""
        return self._model.sample(mirrored(wo), u)


def mirrored(w: npt.ArrayLike) -> Array:
    """The mirror images of directions about the normal, local frame."""
    w = np.asarray(w)
    return cast("Array", w * np.array([-1, -1, 1], w.dtype))


def _kinds() -> list[tuple[str, Any]]:
    return [
        ("ideal diffuse", models.lambert(reflectance=0.7)),
        ("ideal specular", models.mirror(reflectance=0.85)),
        ("glossy", models.ggx(f0=0.85, alpha_x=0.25, alpha_y=0.25)),
        ("retro-reflection", Retro()),
        ("real", models.disney_2012(base_color=[0.6, 0.12, 0.08], roughness=0.35)),
    ]


def reflection_types(*, resolution: int = 160, samples: int = 64) -> Plot:
    """Types of reflection.

    Five surfaces: their lobes for light from 45° (f over its peak in the plane of incidence) and a ball of each in the
    same studio with a weak lamp beside the camera. Retro-reflection sends light back to where it came from, here to the
    lamp; a real surface mixes all of them.

    Parameters
    ----------
    resolution : int
        Pixels per ball.
    samples : int
        Paths per pixel.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    kinds = _kinds()
    with style():
        fig = figure(1.85 * len(kinds), 3.4)
        grid = fig.subplots(2, len(kinds), height_ratios=(1, 1.75))
        for (name, surface), (above, below) in zip(kinds, grid.T, strict=True):
            _lobe(above, surface)
            above.set_title(name, fontsize=10)
            show(below, encoded(trace(surface, resolution, samples) + _lamp(surface, resolution)))
    return fig


def _lamp(surface: Any, resolution: int, strength: float = 0.025) -> Array:
    """What a lamp beside the camera adds to the ball of `trace`; delta lobes miss it."""
    line = 2.3 * ((np.arange(resolution) + 0.5) / resolution - 0.5)
    x, y = np.meshgrid(line, -line)
    inside = x * x + y * y < 0.9995
    x, y = x[inside], y[inside]
    added = np.zeros((resolution, resolution, 3))
    added[inside] = strength * lit(surface, np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=-1), VIEW)
    return added


def _lobe(axes: Any, surface: Any) -> None:
    """A polar cut over its own peak, or the arrow of a mirror, with the light."""
    wi = direction(-np.radians(45))
    theta = np.radians(np.linspace(-89.9, 89.9, 1801))
    f = surface.eval(wi, direction(theta)) @ np.array([0.2126, 0.7152, 0.0722])
    axes.plot([-1.05, 1.05], [0, 0], color=INK, linewidth=1.2)
    arrow(axes, 1.02 * wi[[0, 2]], (0, 0), LIGHT)
    if f.max() > 0:
        x, z = np.sin(theta) * f / f.max(), np.cos(theta) * f / f.max()
        axes.fill(x, z, color=CURVES[0], alpha=0.25, linewidth=0)
        axes.plot(x, z, color=CURVES[0], linewidth=1.4)
    else:
        arrow(axes, (0, 0), -1.02 * wi[[0, 2]] * [1, -1], CURVES[0])
    axes.set(xlim=(-1.1, 1.1), ylim=(-0.06, 1.08), aspect="equal")
    bare(axes)


def oren_nayar(*, sigmas: Sequence[float] = (0.0, 0.1, 0.3), resolution: int = 190) -> Plot:
    """Oren and Nayar: rough matte surfaces.

    Above, balls lit from the viewer, reflectance 0.7, σ = 0, 0.1, 0.3 rad: the rougher, the flatter, as the full moon is.
    Below left their cut from the centre to the rim. Below right a clay surface of σ = 40°: V-grooves integrated
    numerically (they stand for the image that the model was made for), Lambert's surface, and the model.

    Parameters
    ----------
    sigmas : sequence of float
        Deviations of the facets' angle, rad.
    resolution : int
        Pixels per ball.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    ball = Ball(resolution)
    theta = np.linspace(0, 88, 45)
    with style():
        fig = figure(7.4, 5.9)
        top, bottom = cast("Any", fig.subfigures(2, 1, height_ratios=(2.1, 3)))
        for axes, sigma in zip(top.subplots(1, len(sigmas), squeeze=False)[0], sigmas, strict=True):
            model = models.oren_nayar(reflectance=0.7, sigma=sigma)
            show(axes, ball.picture(ball.lit(model, VIEW)), f"σ = {sigma:g} rad")
        left, right = bottom.subplots(1, 2, sharey=True)
        for index, sigma in enumerate(sigmas):
            left.plot(
                theta,
                moon(sigma, theta),
                color=CURVES[index],
                label=f"σ = {sigma:g} rad",
                linestyle=("-", "--", "-.")[index % 3],
            )
        _limb(left, "light from the viewer")
        left.set_ylabel("light, 1 is white facing light")
        sigma = float(np.radians(40))
        right.plot(theta, grooves(sigma, theta), "o", color=INK, markersize=3.5, label="image: V-grooves")
        right.plot(theta, moon(0.0, theta), color=CURVES[0], label="Lambertian")
        right.plot(theta, moon(sigma, theta), color=CURVES[1], linestyle="--", label="model")
        _limb(right, "σ = 40° = 0.70 rad")
    return fig


def _limb(axes: Any, title: str) -> None:
    axes.set(xlim=(0, 90), ylim=(0, 0.75), xticks=range(0, 91, 15), xlabel="θi = θr, degrees")
    axes.set_title(title, fontsize=10)
    axes.legend(fontsize=9, loc="lower left")


def moon(sigma: float, theta_deg: npt.ArrayLike) -> Array:
    """Light pi f cos(theta_i) of Oren and Nayar's model with reflectance 0.7, light and viewer at the same angle, degrees."""
    w = direction(np.radians(np.asarray(theta_deg, float)))
    f = models.oren_nayar(reflectance=0.7, sigma=sigma).eval(w, w)
    return np.asarray(np.pi * f[:, 0] * w[:, 2], float)


def grooves(sigma: float, theta_deg: npt.ArrayLike, reflectance: float = 0.7) -> Array:
    """The same of Lambert's V-grooves themselves, integrated over their facets (oren1994), without interreflection.

    A facet a sends rho (s.a)(v.a) G / ((a.n)(v.n)), weighed by its share of the projected area, a Gaussian of its angle; G
    is the masking of torrance1967.
    """
    count = 200
    nodes, weights = np.polynomial.legendre.leggauss(count)
    facet, azimuth = np.meshgrid((nodes + 1) * np.pi / 4, (nodes + 1) * np.pi, indexing="ij")
    area = np.outer(weights, weights) * (np.pi / 4) * np.pi * np.sin(facet)
    density = np.exp(-0.5 * (facet / sigma) ** 2)
    density /= np.sum(density * area)
    a = direction(facet, azimuth)
    result = []
    for w in direction(np.radians(np.asarray(theta_deg, float))):
        cosine = np.maximum(a @ w, 1e-12)
        masked = np.clip(2 * w[2] * a[..., 2] / cosine, 0, 1)
        sent = np.where(a @ w > 0, cosine**2 * masked / a[..., 2], 0.0)
        result.append(reflectance * np.sum(density * sent * area) / w[2])
    return np.array(result)


def ward_satin(*, alpha_narrow: float = 0.1, alpha_wide: float = 0.5, resolution: int = 300) -> Plot:
    """Ward's model: satin.

    A cloth of folds in one light. Left a highlight of equal widths; then the same cloth with threads along and across
    the folds: the highlight is narrow along the threads and wide across them, which makes satin shimmer.

    Parameters
    ----------
    alpha_narrow, alpha_wide : float
        Widths of the slopes along and across the threads.
    resolution : int
        Pixels per cloth.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    normals = folds(2 * resolution)
    even = float(np.sqrt(alpha_narrow * alpha_wide))
    cloths = (
        (f"isotropic, α = {even:.2g}", even, even),
        ("threads along x", alpha_narrow, alpha_wide),
        ("threads along y", alpha_wide, alpha_narrow),
    )
    light = np.array([-0.35, 0.45, 0.82])
    light /= np.linalg.norm(light)
    with style():
        fig = figure(8.4, 3.2)
        for axes, (name, x, y) in zip(fig.subplots(1, 3), cloths, strict=True):
            satin = models.ward(diffuse=[0.22, 0.02, 0.05], specular=[0.3, 0.16, 0.18], alpha_x=x, alpha_y=y)
            title = name if x == y else f"{name}, α = {x:g}, {y:g}"
            show(axes, cloth(satin, normals, light), title)
        fig.suptitle("Ward's model on a folded cloth, light from the upper left", fontsize=11)
    return fig


def folds(size: int) -> Array:
    """Normals of a folded cloth, shape (size, size, 3)."""
    line = np.linspace(-1, 1, size)
    x, y = np.meshgrid(line, -line)
    bend = x + 0.35 * np.sin(2.1 * y + 0.4) + 0.12 * np.sin(5 * y + 2 * x)
    height = 0.1 * np.sin(5 * bend) + 0.02 * np.sin(11 * bend + 2 * y) + 0.08 * np.sin(2.6 * y - 1.2 * x)
    down, right = np.gradient(height, 2 / (size - 1))
    normals = np.stack([-right, down, np.ones_like(height)], axis=-1)
    return cast("Array", normals / np.linalg.norm(normals, axis=-1, keepdims=True))


def cloth(surface: Evaluator, normals: Array, light: Array) -> Array:
    """A picture of a cloth, half as large as its normals, whose threads run along x."""
    size = normals.shape[0]
    flat = normals.reshape(-1, 3)
    tangents = np.broadcast_to(np.array([1.0, 0.0, 0.0]), flat.shape)
    values = np.clip(lit(surface, flat, light, tangents), 0, 1).reshape(size, size, 3)
    return encoded(values.reshape(size // 2, 2, size // 2, 2, 3).mean(axis=(1, 3)))
