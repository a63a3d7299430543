"""The classic local model: Phong's highlight, Blinn's, and their dials."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk import models, terms
from lesk.figures._sheet import Ball, Evaluator, half_vector, outline, show, undone
from lesk.plot._figure import CURVES, INK, Array, Plot, direction, figure, style

COLOR = (0.18, 0.38, 0.8)
"""C_D, the colour of the surface; lights and highlights are white."""


def classic(k_d: float, k_s: float, h: float, color: Sequence[float] = COLOR) -> Evaluator:
    """The classic model I_D + I_S = C_L (C_D k_D cos alpha + C_S k_S cos^h beta) as `phong`.

    `Ball.lit` multiplies f by pi cos(theta_i), so that its k_S is pi times that of `phong`.
    """
    return models.phong(diffuse=k_d * np.asarray(color), specular=k_s / np.pi, shininess=h)


def phong_table(*, h: float = 50, resolution: int = 190) -> Plot:
    """Phong's model: k_S against k_D.

    Nine balls with k_S and k_D in {0, 0.5, 1}, k_A = 0, h = 50, in a light of colour 1. Linear values above 1 cannot be
    shown: an orange line marks where they are clipped, in each ball with k_S = 1 and k_D above 0. The practical
    rule k_A + k_D + k_S ≤ 1 avoids it.

    Parameters
    ----------
    h : float
        Shininess.
    resolution : int
        Pixels per ball.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    ball = Ball(resolution)
    dials = (0.0, 0.5, 1.0)
    with style():
        fig = figure(5.6, 6.4)
        grid = fig.subplots(3, 3)
        for row, k_s in enumerate(dials):
            for column, k_d in enumerate(dials):
                axes = grid[row, column]
                title = f"$k_D$ = {k_d:g}" if row == 0 else ""
                clipping_ball(axes, ball, classic(k_d, k_s, h), title)
                if column == 0:
                    axes.set_ylabel(f"$k_S$ = {k_s:g}", fontsize=10)
        fig.suptitle(f"$I = I_D + I_S$ with $k_A$ = 0, h = {h:g}; orange: above 1, clipped", fontsize=11)
    return fig


def shininess(*, exponents: Sequence[float] = (1, 5, 10, 50, 100), resolution: int = 190) -> Plot:
    """Phong's shininess h.

    A row of balls with k_A = 0, k_D = 0.5, k_S = 1 and h = 1, 5, 10, 50, 100: the higher h, the smaller the highlight.
    Its height stays 1, so that a polished ball reflects less light in all than a dull one. Orange lines mark clipped
    values.

    Parameters
    ----------
    exponents : sequence of float
        The values of h.
    resolution : int
        Pixels per ball.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    ball = Ball(resolution)
    with style():
        fig = figure(1.75 * len(exponents), 2.5)
        for axes, h in zip(fig.subplots(1, len(exponents), squeeze=False)[0], exponents, strict=True):
            clipping_ball(axes, ball, classic(0.5, 1.0, h), f"h = {h:g}")
        fig.suptitle("Phong, $k_A$ = 0, $k_D$ = 0.5, $k_S$ = 1; orange: above 1, clipped", fontsize=11)
    return fig


def clipping_ball(axes: Any, ball: Ball, surface: Evaluator, title: str = "") -> None:
    """Show a ball with its clipped part marked and told in numbers."""
    values = ball.lit(surface)
    clipped = np.asarray((values > 1 + 1e-9).any(axis=-1))
    below = f"max {values.max():.2f}"
    if clipped.any():
        below += f", clipped {100 * clipped.mean():.1f} %"
    show(axes, ball.picture(values), title, below)
    outline(axes, ball, clipped)


def highlights(theta_i_deg: float, off_deg: npt.ArrayLike, plane: str, h: float) -> tuple[Array, Array]:
    """Phong's cos^h(beta) and Blinn's cos^h(gamma) at angles from the mirror direction.

    Parameters
    ----------
    theta_i_deg : float
        Angle of the light to the normal, degrees.
    off_deg : array_like of shape (N,)
        Angle of the viewer to the mirror direction, degrees.
    plane : str
        `incidence`, or `across` it: on the great circle at right angles to it.
    h : float
        Exponent of both.

    Returns
    -------
    tuple of ndarray of shape (N,)
        Phong's and Blinn's highlight, dimensionless.
    """
    theta, off = np.radians(theta_i_deg), np.radians(np.asarray(off_deg, float))
    wi = direction(-theta)
    if plane == "incidence":
        wo = direction(theta + off)
    else:
        across = np.array([0.0, 1.0, 0.0])
        wo = np.cos(off)[..., np.newaxis] * direction(theta) + np.sin(off)[..., np.newaxis] * across
    cosines = (terms.lobe.cos_mirror(wi, wo), half_vector(wi, wo)[..., 2])
    phong, blinn = (np.asarray(terms.lobe.cos_power(cosine, h), float) for cosine in cosines)
    return phong, blinn


class Highlight:
    """A highlight alone, k_S = 1, scaled for `Ball.lit`."""

    def __init__(self, blinn: bool, h: float) -> None:
        self._blinn, self._h = blinn, h

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """cos^h / (pi cos(theta_i)), shape (N, 3)."""
        wi, wo = np.asarray(wi), np.asarray(wo)
        cosine = half_vector(wi, wo)[:, 2] if self._blinn else terms.lobe.cos_mirror(wi, wo)
        power = terms.lobe.cos_power(cosine, self._h)
        return undone(np.repeat(power[:, np.newaxis], 3, axis=1), wi)


def phong_blinn(*, h: float = 50, theta_i_deg: float = 60, resolution: int = 220) -> Plot:
    """Phong against Blinn-Phong.

    Phong measures the angle β from the mirror direction, Blinn the angle γ between normal and half vector, which is half
    as large in the plane of incidence: with 4 times the exponent both highlights agree there. Across the plane they do
    not: at θ_i = 60°, 10° off the mirror, h = 50 gives .4651 and 4h gives .4665 in the plane, but .4651 and .0482 across
    it. Blinn's highlight is stretched along the plane, as real ones are at grazing angles.

    Parameters
    ----------
    h : float
        Phong's exponent.
    theta_i_deg : float
        Angle of the light to the normal in the curves, degrees.
    resolution : int
        Pixels per ball.

    Returns
    -------
    Plot
        A matplotlib figure: above balls with the light 100° from the viewer, below curves.
    """
    ball = Ball(resolution)
    light = direction(np.radians(100), np.radians(125))
    kinds = (
        (False, h, f"Phong, h = {h:g}"),
        (True, h, f"Blinn-Phong, h = {h:g}"),
        (True, 4 * h, f"Blinn-Phong, h = {4 * h:g}"),
    )
    off = np.linspace(-30, 30, 601)
    with style():
        fig = figure(7.4, 5.6)
        top, bottom = cast("Any", fig.subfigures(2, 1, height_ratios=(2.2, 3)))
        for axes, (blinn, exponent, title) in zip(top.subplots(1, 3), kinds, strict=True):
            matte = ball.lit(classic(0.25, 0, 1), light) + 0.05 * np.asarray(COLOR)
            show(axes, ball.picture(matte + ball.lit(Highlight(blinn, exponent), light)), title)
        for axes, plane in zip(bottom.subplots(1, 2, sharey=True), ("incidence", "across"), strict=True):
            for index, (blinn, exponent, title) in enumerate(kinds):
                curve = highlights(theta_i_deg, off, plane, exponent)[int(blinn)]
                axes.plot(off, curve, color=CURVES[index], linestyle=("-", ":", "--")[index], label=title)
            _marks(axes, theta_i_deg, plane, h)
            axes.set_title({"incidence": "in the plane of incidence", "across": "across it"}[plane], fontsize=10)
            axes.set(xlabel="angle to the mirror direction, degrees", xlim=(-30, 30), ylim=(0, 1.05))
        bottom.axes[0].set_ylabel("highlight $\\cos^h$")
        bottom.legend(*bottom.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=9)
        fig.suptitle(
            f"“Use 4 times higher h”: true in the plane of incidence only (light from {theta_i_deg:g}°)", fontsize=11
        )
    return fig


def _marks(axes: Any, theta_i_deg: float, plane: str, h: float) -> None:
    """Points and numbers at 10 degrees off the mirror direction."""
    at = 10.0
    phong, blinn = (highlights(theta_i_deg, [at], plane, n)[i][0] for i, n in ((0, h), (1, 4 * h)))
    axes.plot([at, at], [phong, blinn], "o", color=INK, markersize=4, zorder=4)
    text = f"at {at:g}°:\nPhong {phong:.4f}\nBlinn 4h {blinn:.4f}".replace(" 0.", " .")
    axes.text(0.02, 0.98, text, transform=axes.transAxes, fontsize=8.5, va="top")
