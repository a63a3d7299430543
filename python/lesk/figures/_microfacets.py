"""Microfacets: roughness, the terms D, F and G, and their product."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk import models, terms
from lesk.figures._sheet import Ball, arrow, bare, half_vector, show, undone
from lesk.plot._figure import CURVES, FAINT, INK, LIGHT, Array, Plot, direction, figure, style

COPPER = (0.955, 0.638, 0.538)
"""F0 of copper, see `lesk.f0`."""


def microfacets(*, alphas: Sequence[float] = (0.1, 0.2, 0.3, 0.5), resolution: int = 190) -> Plot:
    """Smoother and rougher microfacets.

    The same metal with slopes of growing width alpha. Above, a cut through the surface, its facets drawn with the slopes
    that alpha stands for (standard deviation alpha/√2 in the cut), and parallel rays reflected once. In the middle
    f cos θr, over its own maximum. Below, balls in one light, all at one exposure: a smooth surface focuses the highlight,
    a rough one makes it larger and dimmer.

    Parameters
    ----------
    alphas : sequence of float
        Widths of the slopes.
    resolution : int
        Pixels per ball.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    ball = Ball(resolution)
    count = len(alphas)
    lights = [ball.lit(models.cook_torrance(f0=COPPER, alpha=alpha)) for alpha in alphas]
    # the second of them just reaches white
    exposure = 1 / lights[min(1, count - 1)].max()
    with style():
        fig = figure(1.95 * count, 4.9)
        grid = fig.subplots(3, count, height_ratios=(1.0, 1.0, 1.9), squeeze=False)
        for column, (alpha, values) in enumerate(zip(alphas, lights, strict=True)):
            _profile(grid[0, column], alpha)
            _lobe(grid[1, column], models.cook_torrance(f0=COPPER, alpha=alpha))
            show(grid[2, column], ball.picture(exposure * values), below=f"peak {values.max():.3g}")
            grid[0, column].set_title(f"α = {alpha:g}", fontsize=10)
        for row, name in enumerate(("cut", "f cos θr", "one exposure")):
            grid[row, 0].set_ylabel(name, fontsize=9)
        fig.suptitle("Smoother surfaces focus the highlight, rougher ones make it larger and dimmer", fontsize=11)
    return fig


def slopes(alpha: float, count: int, seed: int = 3) -> Array:
    """Slopes of facets in a cut: for Beckmann's distribution they are normal with deviation alpha/sqrt(2)."""
    return np.random.default_rng(seed).normal(0, alpha / np.sqrt(2), count)


def _profile(axes: Any, alpha: float) -> None:
    """A cut through facets, with rays from the left that are reflected at every third facet."""
    count = 14
    slope = slopes(alpha, count)
    slope -= slope.mean()
    x = np.linspace(0, 2, count + 1)
    y = np.concatenate([[0], np.cumsum(slope * np.diff(x))])
    axes.fill_between(x, y, -0.45, color=FAINT, linewidth=0)
    axes.plot(x, y, color=INK, linewidth=1.2)
    incoming = np.array([1, -1]) / np.sqrt(2)
    for facet in range(2, count - 2, 3):
        at = np.array([x[facet : facet + 2].mean(), y[facet : facet + 2].mean()])
        normal = np.array([-slope[facet], 1]) / np.hypot(slope[facet], 1)
        out = incoming - 2 * (incoming @ normal) * normal
        axes.plot(*np.stack([at - 0.75 * incoming, at], axis=-1), color=LIGHT, linewidth=1)
        arrow(axes, at, at + 0.6 * out, CURVES[0], linewidth=1, mutation_scale=7)
    axes.set(xlim=(-0.05, 2.3), ylim=(-0.45, 0.75), aspect="equal")
    bare(axes)


def _lobe(axes: Any, surface: Any, theta_i_deg: float = 45) -> None:
    """A polar cut of f cos over its own maximum, with the light."""
    theta = np.radians(np.linspace(-89.9, 89.9, 1801))
    wi = direction(-np.radians(theta_i_deg))
    f = surface.eval(wi, direction(theta))[:, 0] * np.cos(theta)
    x, z = np.sin(theta) * f / f.max(), np.cos(theta) * f / f.max()
    axes.fill(x, z, color=CURVES[0], alpha=0.25, linewidth=0)
    axes.plot(x, z, color=CURVES[0], linewidth=1.4)
    axes.plot([-1, 1.1], [0, 0], color=INK, linewidth=1)
    arrow(axes, 0.95 * wi[[0, 2]], 0.05 * wi[[0, 2]], LIGHT)
    axes.set(xlim=(-1.1, 1.15), ylim=(-0.08, 1), aspect="equal")
    bare(axes)


def microfacet_terms() -> Plot:
    """D, F and G alone.

    The three factors of f = D F G / (4 cos θi cos θr). D (Beckmann) says how many facets face the half vector: its width
    is α. F (Schlick) says how much they reflect: a metal keeps its colour but at grazing angles, a dielectric goes from
    4 % to all. G (V-grooves) says which part of them is neither shadowed nor masked.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    theta = np.linspace(0, 90, 901)
    with style():
        fig = figure(9.2, 3.4)
        left, middle, right = fig.subplots(1, 3)
        for color, alpha in zip(CURVES, (0.1, 0.2, 0.4), strict=False):
            left.plot(
                theta,
                terms.ndf.beckmann(direction(np.radians(theta)), alpha, alpha),
                color=color,
                label=f"α = {alpha:g}",
            )
        left.set(title="D: facets, Beckmann", xlabel="θh, degrees", ylabel="D, 1/sr", xlim=(0, 60), ylim=(0, None))
        for color, (name, f0) in zip(
            CURVES, (("silver, red", 0.972), ("iron, red", 0.562), ("plastic", 0.04)), strict=False
        ):
            middle.plot(
                theta,
                terms.fresnel.schlick(f0, np.cos(np.radians(theta)))[:, 0],
                color=color,
                label=f"{name}, F0 = {f0:g}",
            )
        middle.set(title="F: Fresnel, Schlick", xlabel="θd, degrees", ylabel="F", xlim=(0, 90), ylim=(0, 1.03))
        for color, theta_i in zip(CURVES, (30, 60, 75), strict=False):
            degrees = np.linspace(-89.9, 89.9, 1799)
            right.plot(degrees, shadowing(theta_i, degrees), color=color, label=f"θi = {theta_i}°")
        right.set(
            title="G: shadowing and masking",
            xlabel="θr, degrees (light at −θi)",
            ylabel="G",
            xlim=(-90, 90),
            ylim=(0, 1.03),
        )
        right.set_xticks(range(-90, 91, 45))
        for axes, place in ((left, "upper right"), (middle, (0.03, 0.62)), (right, "lower center")):
            for line, dash in zip(axes.lines, ("-", "--", "-."), strict=True):
                line.set_linestyle(dash)
            axes.legend(fontsize=8.5, loc=place)
    return fig


def shadowing(theta_i_deg: float, theta_r_deg: npt.ArrayLike) -> Array:
    """G of V-grooves in the plane of incidence; the light stands at -theta_i, degrees."""
    wi, wo = direction(-np.radians(theta_i_deg)), direction(np.radians(np.asarray(theta_r_deg, float)))
    return cast("Array", terms.masking.v_groove(wi, wo, wi + wo))


class _Factor:
    """One factor of Cook-Torrance, scaled for `lit` to show as it is."""

    def __init__(self, name: str, alpha: float) -> None:
        self._name, self._alpha = name, alpha

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """The factor over pi cos(theta_i), shape (N, 3)."""
        wi, wo = np.asarray(wi), np.asarray(wo)
        half = half_vector(wi, wo)
        if self._name == "D":
            peak = terms.ndf.beckmann(np.array([0.0, 0.0, 1.0]), self._alpha, self._alpha)
            value = np.repeat((terms.ndf.beckmann(half, self._alpha, self._alpha) / peak)[:, np.newaxis], 3, axis=1)
        elif self._name == "F":
            value = np.asarray(terms.fresnel.schlick(np.array(COPPER), np.sum(half * wi, axis=-1)), float)
        else:
            up = wi[:, 2] > 1e-4
            value = np.zeros((len(wi), 3))
            value[up] = terms.masking.v_groove(wi[up], wo[up], (wi + wo)[up])[:, np.newaxis]
        return undone(value, wi)


def cook_torrance(*, alpha: float = 0.3, resolution: int = 180) -> Plot:
    """Cook-Torrance: D, F and G on a ball.

    A copper ball under a light that moves from the viewer's side behind the ball: the angle between them is 40°, 90° and
    135°. D, over its peak, makes the highlight. F colours it and turns to white at grazing angles; it depends only on the
    angle between light and half vector, which is the same all over the ball. G darkens the rims. Last their product
    f cos θi, which goes into the picture; its peak is given with the factor π of a white matte surface.

    Parameters
    ----------
    alpha : float
        Width of the slopes.
    resolution : int
        Pixels per ball.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    ball = Ball(resolution)
    copper = models.cook_torrance(f0=COPPER, alpha=alpha)
    with style():
        fig = figure(7.4, 5.9)
        for line, angle in zip(fig.subplots(3, 4), (40, 90, 135), strict=True):
            light = direction(np.radians(angle), np.radians(130))
            for axes, name in zip(line, "DFG", strict=False):
                show(axes, ball.picture(ball.lit(_Factor(name, alpha), light)))
            whole = ball.lit(copper, light)
            show(line[3], ball.picture(whole / whole.max()), below=f"peak {whole.max():.3g}")
            line[0].set_ylabel(f"light at {angle}°", fontsize=10)
        titles = ("D over its peak", "F", "G", "D F G / (4 cos θr)\nover its peak")
        for axes, title in zip(fig.axes[:4], titles, strict=True):
            axes.set_title(title, fontsize=10)
        fig.suptitle(f"Copper, Beckmann facets with α = {alpha:g}", fontsize=11)
    return fig


def fresnel(*, etas: Sequence[float] = (1.33, 1.5, 2.42)) -> Plot:
    """Fresnel's equations against Schlick's approximation.

    Reflectance of smooth boundaries with the refractive indices of water, glass and diamond: exact (solid) and Schlick's
    approximation (dotted), both from F0 at normal incidence. Right the difference: for η = 1.5 it is largest at 85°, .036.

    Parameters
    ----------
    etas : sequence of float
        Refractive indices.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    theta = np.linspace(0, 90, 9001)
    with style():
        fig = figure(8.2, 3.7)
        left, right = fig.subplots(1, 2)
        for color, eta in zip(CURVES, etas, strict=False):
            exact, schlick = boundary(eta, theta)
            left.plot(theta, exact, color=color, label=f"η = {eta:g}")
            left.plot(theta, schlick, color=color, linestyle=":")
            right.plot(theta, schlick - exact, color=color)
            worst = int(np.argmax(np.abs(schlick - exact)))
            error = (schlick - exact)[worst]
            right.plot(theta[worst], error, "o", color=color, markersize=4)
            right.annotate(
                f"η = {eta:g}: {error:+.3f} at {theta[worst]:.0f}°",
                (theta[worst], error),
                (-58, 0),
                textcoords="offset points",
                ha="right",
                va="center",
                fontsize=8.5,
                color=color,
            )
        left.plot([], [], color=INK, label="exact")
        left.plot([], [], color=INK, linestyle=":", label="Schlick")
        left.set(xlabel="θi, degrees", ylabel="reflectance F", xlim=(0, 90), ylim=(0, 1), xticks=range(0, 91, 15))
        left.legend()
        right.axhline(0, color=INK, linewidth=0.8)
        right.set(xlabel="θi, degrees", ylabel="Schlick minus exact", xlim=(0, 90), xticks=range(0, 91, 15))
        fig.suptitle("Fresnel: exact (solid) and Schlick's approximation (dotted)", fontsize=11)
    return fig


def boundary(eta: float, theta_deg: npt.ArrayLike) -> tuple[Array, Array]:
    """Reflectance of a boundary, exact and by Schlick, at angles in degrees."""
    cosine = np.cos(np.radians(np.asarray(theta_deg, float)))
    f0 = ((eta - 1) / (eta + 1)) ** 2
    exact, schlick = terms.fresnel.dielectric(eta, cosine), terms.fresnel.schlick(f0, cosine)[..., 0]
    return np.asarray(exact, float), np.asarray(schlick, float)
