"""Drawn principles of shading: interpolation, vertex normals, edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk.errors import ParameterError
from lesk.figures._sheet import MARK, arrow, bare, encoded
from lesk.plot._figure import CURVES, FAINT, INK, Array, Plot, figure, style

_QUAD = {"A": (0.9, 4.2), "B": (4.6, 5.2), "C": (0.2, 0.8), "D": (5.6, 0.3)}
_VALUES = {"A": 0.9, "B": 0.5, "C": 0.1, "D": 0.7}


def interpolated(values: Sequence[float], alpha: float, beta: float, gamma: float) -> float:
    """The lecture's bilinear interpolation of the values at A, B, C, D.

    f_X = (1 - gamma) [(1 - alpha) f_A + alpha f_C] + gamma [(1 - beta) f_B + beta f_D], alpha along the edge AC, beta
    along BD, gamma along the span.
    """
    a, b, c, d = values
    return (1 - gamma) * ((1 - alpha) * a + alpha * c) + gamma * ((1 - beta) * b + beta * d)


def bilinear(*, y: float = 2.6, gamma: float = 0.6) -> Plot:
    """Principle of bilinear interpolation.

    A scan line meets the edges AC and BD; the value is interpolated along each edge (α, β), then along the span between
    them (γ). Gouraud's shading interpolates colours so, Phong's normals.

    Parameters
    ----------
    y : float
        Height of the scan line, in units of the drawing, 0.8 to 4.2.
    gamma : float
        Place of X on the span, 0 to 1.

    Returns
    -------
    Plot
        A matplotlib figure; the result below is computed from the four values shown.
    """
    a, b, c, d = (np.array(_QUAD[name]) for name in "ABCD")
    if not c[1] <= y <= a[1]:
        raise ParameterError(f"`y` is {y:g}, but {c[1]:g} to {a[1]:g} is accepted: the scan line must meet both edges")
    alpha, beta = (a[1] - y) / (a[1] - c[1]), (b[1] - y) / (b[1] - d[1])
    left, right = a + alpha * (c - a), b + beta * (d - b)
    x = left + gamma * (right - left)
    with style():
        fig = figure(6.2, 5.2)
        axes = fig.add_subplot()
        _filled(axes, a, b, c, d)
        axes.plot(*np.stack([a, b, d, c, a], axis=-1), color=INK, linewidth=1.4)
        axes.plot([-0.7, 6.5], [y, y], color=FAINT, linewidth=1, zorder=0)
        for start, end in ((left, x), (a, left), (b, right)):
            axes.plot(*np.stack([start, end], axis=-1), color=MARK, linewidth=3)
        for name, point, shift in zip("ABCD", (a, b, c, d), ((-34, 4), (4, 6), (-34, -16), (6, -14)), strict=True):
            _point(axes, point, f"{name}  {_VALUES[name]:g}", shift)
        _point(axes, x, "X", (-4, 8), CURVES[0])
        for start, end, text, shift in ((a, left, "α", (-14, 0)), (b, right, "β", (6, 0)), (left, x, "γ", (0, -16))):
            axes.annotate(text, tuple((start + end) / 2), shift, textcoords="offset points", color=MARK, fontsize=12)
        axes.annotate(
            "scan line", (6.5, y), (2, 3), textcoords="offset points", ha="right", fontsize=9, color="#57606a"
        )
        axes.set(xlim=(-0.8, 6.6), ylim=(-0.3, 5.8), aspect="equal")
        bare(axes)
        result = interpolated([_VALUES[n] for n in "ABCD"], alpha, beta, gamma)
        axes.set_xlabel(
            "$f_X = (1-γ)[(1-α) f_A + α f_C] + γ[(1-β) f_B + β f_D]$\n"
            f"α = {alpha:.3f}, β = {beta:.3f}, γ = {gamma:.3f}:  $f_X$ = {result:.4f}",
            fontsize=10,
        )
    return fig


def _filled(axes: Any, a: Array, b: Array, c: Array, d: Array) -> None:
    """The interpolated values inside the quad, line by line."""
    size = 300
    rows = np.linspace(min(c[1], d[1]), max(a[1], b[1]), size)
    columns = np.linspace(0, 6, size)
    picture = np.full((size, size), np.nan)
    for row, y in enumerate(rows):
        # above A or below C the span is cut by the edges AB and CD: there the drawing stays white
        if c[1] <= y <= a[1]:
            alpha, beta = (a[1] - y) / (a[1] - c[1]), (b[1] - y) / (b[1] - d[1])
            start, end = a[0] + alpha * (c[0] - a[0]), b[0] + beta * (d[0] - b[0])
            gamma = (columns - start) / (end - start)
            inside = (gamma >= 0) & (gamma <= 1)
            picture[row, inside] = [interpolated([_VALUES[n] for n in "ABCD"], alpha, beta, g) for g in gamma[inside]]
    axes.imshow(
        picture, origin="lower", extent=(0, 6, rows[0], rows[-1]), cmap="gray", vmin=-0.6, vmax=1.1, zorder=0, alpha=0.8
    )


def _point(axes: Any, at: Array, text: str, shift: tuple[float, float], color: str = INK) -> None:
    axes.plot(*at, "o", color=color, markersize=5, zorder=4)
    axes.annotate(text, tuple(at), shift, textcoords="offset points", fontsize=11, color=color, zorder=5)


def _projected(points: npt.ArrayLike) -> Array:
    """Oblique view of points of space, z up."""
    p = np.asarray(points, float)
    return np.stack([p[..., 0] - 0.35 * p[..., 1], p[..., 2] + 0.4 * p[..., 1]], axis=-1)


def _face_normal(corners: Array) -> Array:
    """Unit normal of a face, its corners counter-clockwise from above (Newell's sum)."""
    total = np.sum(np.cross(corners, np.roll(corners, -1, axis=0)), axis=0)
    return cast("Array", total / np.linalg.norm(total))


def vertex_normals() -> Plot:
    """Normals of vertices.

    From left: analytic, from the definition of the surface; as the mean of the faces around a vertex,
    N = (N1 + N2 + N3 + N4)/4, normalised; at a real edge the mean over the faces of one side only, N = (N2 + N3)/2, so that
    the edge stays sharp.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    with style():
        fig = figure(9.6, 3.3)
        left, middle, right = fig.subplots(1, 3)
        turn = np.radians(np.linspace(20, 160, 100))
        left.plot(np.cos(turn), np.sin(turn), color=FAINT, linewidth=3)
        corners = np.radians(np.linspace(20, 160, 6))
        left.plot(np.cos(corners), np.sin(corners), color=INK, marker="o", markersize=4, linewidth=1.2)
        for angle in corners:
            at = np.array([np.cos(angle), np.sin(angle)])
            arrow(left, at, 1.4 * at, CURVES[0])
        left.set(xlim=(-1.5, 1.5), ylim=(0, 1.55), aspect="equal")
        left.set_title("analytic: N = (P − C)/r on a sphere", fontsize=10)
        _tent(middle, 0.45, [0, 1, 2, 3], "N = (N1 + N2 + N3 + N4)/4")
        _tent(right, 1.5, [1, 2], "at a real edge: N = (N2 + N3)/2", edge=True)
        for axes in (left, middle, right):
            axes.set_anchor("N")
            bare(axes)
    return fig


def tent(left_slope: float) -> list[Array]:
    """Four faces around the vertex (1, 1, z): 1 left front, 2 right front, 3 right back, 4 left back."""

    def height(x: float, y: float) -> float:
        return (left_slope if x < 1 else -0.45) * (x - 1) - 0.3 * (y - 1) ** 2

    def face(x: int, y: int) -> Array:
        corners = ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1))
        return np.array([(u, v, height(u, v)) for u, v in corners])

    # the faces left of the vertex use the left slope at x = 0, all share the heights at x = 1
    return [face(0, 0), face(1, 0), face(1, 1), face(0, 1)]


def _tent(axes: Any, left_slope: float, taken: Sequence[int], title: str, *, edge: bool = False) -> None:
    faces = tent(left_slope)
    normals = [_face_normal(corners) for corners in faces]
    for index in (2, 3, 1, 0):
        corners, normal = faces[index], normals[index]
        shade = 0.25 + 0.7 * max(float(normal @ (np.array([-0.4, -0.5, 0.77]))), 0)
        axes.fill(*_projected(corners).T, facecolor=tuple(encoded([shade] * 3)), edgecolor=INK, linewidth=1)
    for index, (corners, normal) in enumerate(zip(faces, normals, strict=True)):
        center = corners.mean(axis=0)
        color = CURVES[0] if index in taken else "#8c959f"
        tip = _projected(center + 0.55 * normal)
        arrow(axes, _projected(center), tip, color)
        axes.annotate(f"N{index + 1}", tuple(tip), (3, 2), textcoords="offset points", fontsize=9, color=color)
    vertex = np.array([1.0, 1.0, 0.0])
    mean = np.mean([normals[i] for i in taken], axis=0)
    tip = _projected(vertex + 0.95 * mean / np.linalg.norm(mean))
    arrow(axes, _projected(vertex), tip, MARK, linewidth=2.2)
    axes.annotate("N", tuple(tip), (4, 2), textcoords="offset points", color=MARK, weight="bold")
    axes.plot(*_projected(vertex), "o", color=MARK, markersize=5, zorder=5)
    if edge:
        ridge = np.array([(1, y, -0.3 * (y - 1) ** 2) for y in (0, 1, 2)])
        axes.plot(*_projected(ridge).T, color=MARK, linewidth=2.4, zorder=3)
    axes.set(xlim=(-0.9, 2.3), ylim=(-1.9, 1.75), aspect="equal")
    axes.set_title(title, fontsize=10)
