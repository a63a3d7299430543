"""Drawn principles of shading: interpolation, vertex normals, edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt
from matplotlib.collections import PolyCollection

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


_PROFILE = np.array([(0.0, 0.2), (1.2, 0.45), (2.3, 1.0), (3.1, 1.9), (4.3, 1.9), (4.6, 0.5), (5.8, 0.3), (7.0, 0.35)])


def folds_of(profile: Array) -> Array:
    """Angle between the faces at each inner vertex of a profile, degrees."""
    run = np.diff(profile, axis=0)
    heading = np.degrees(np.arctan2(run[:, 1], run[:, 0]))
    return cast("Array", np.abs(np.diff(heading)))


def crease_angle(*, limit_deg: float = 40) -> Plot:
    """Crease angle.

    A cut through a surface. Where two faces meet at less than the crease angle, the edge is auxiliary and the vertex has one
    normal, their mean; where they meet at more, the edge is real and the vertex has a normal for each face. Below, the
    brightness that follows, in light from the upper left: smooth over auxiliary edges, with a step at real ones.

    Parameters
    ----------
    limit_deg : float
        The crease angle, degrees.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    if not 0 <= limit_deg <= 180:
        raise ParameterError(f"`limit_deg` is {limit_deg:g}, but 0 to 180 degrees is accepted")
    angles = folds_of(_PROFILE)
    run = np.diff(_PROFILE, axis=0)
    normals = np.stack([-run[:, 1], run[:, 0]], axis=-1) / np.linalg.norm(run, axis=-1, keepdims=True)
    with style():
        fig = figure(8.2, 5.0)
        axes = fig.add_subplot()
        axes.fill_between(_PROFILE[:, 0], _PROFILE[:, 1], -0.4, color=FAINT, linewidth=0, alpha=0.6)
        axes.plot(*_PROFILE.T, color=INK, linewidth=1.6)
        ends = [[normals[0], normals[0]], *([None, None] for _ in angles), [normals[-1], normals[-1]]]
        for index, angle in enumerate(angles, 1):
            real = angle > limit_deg
            mean = normals[index - 1] + normals[index]
            mean /= np.linalg.norm(mean)
            ends[index] = [normals[index - 1], normals[index]] if real else [mean, mean]
            at, color = _PROFILE[index], MARK if real else CURVES[0]
            for normal in ends[index] if real else [mean]:
                arrow(axes, at, at + 0.7 * normal, color)
            axes.plot(*at, "s" if real else "o", color=color, markersize=6)
            axes.annotate(
                f"{angle:.0f}°", tuple(at), (0, -17), textcoords="offset points", ha="center", fontsize=9, color=color
            )
        axes.plot([], [], "o", color=CURVES[0], label=f"auxiliary: up to {limit_deg:g}°, one normal")
        axes.plot([], [], "s", color=MARK, label=f"real: above {limit_deg:g}°, two normals")
        axes.legend(loc="upper left", fontsize=9)
        _strip(axes, ends)
        axes.set(xlim=(-0.1, 7.1), ylim=(-1.15, 3.2), aspect="equal")
        bare(axes)
        axes.set_xlabel("brightness along the cut, light from the upper left", fontsize=9)
    return fig


def _strip(axes: Any, ends: list[Any]) -> None:
    """Brightness n.l along the profile, normals interpolated."""
    light = np.array([-0.8, 0.6])
    light /= np.linalg.norm(light)
    line = np.linspace(_PROFILE[0, 0], _PROFILE[-1, 0], 1400)
    shade = np.empty_like(line)
    for index in range(len(_PROFILE) - 1):
        low, high = _PROFILE[index, 0], _PROFILE[index + 1, 0]
        inside = (line >= low) & (line <= high)
        t = ((line[inside] - low) / (high - low))[:, np.newaxis]
        normal = (1 - t) * ends[index][1] + t * ends[index + 1][0]
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        shade[inside] = np.maximum(normal @ light, 0)
    pixels = encoded(np.repeat(shade[np.newaxis, :, np.newaxis], 3, axis=2))
    axes.imshow(pixels, extent=(line[0], line[-1], -1.1, -0.55), aspect="auto")


def auxiliary_edges(*, sides: int = 12) -> Plot:
    """Real and auxiliary edges.

    A cylinder of flat faces. Left every edge is real: each face has one normal. In the middle the edges of the mantle
    are auxiliary (dashed: they only approximate the surface), those of the cap real: it looks round, and the cap flat. Right
    all edges are auxiliary: the mantle shades as if it bent over into the cap.

    Parameters
    ----------
    sides : int
        Faces of the mantle, 6 or more.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    if sides < 6:
        raise ParameterError(f"`sides` is {sides}, but 6 or more is accepted")
    cases = (("all edges real", "flat"), ("mantle auxiliary, cap real", "right"), ("all edges auxiliary", "all"))
    with style():
        fig = figure(8.2, 3.6)
        for axes, (title, kind) in zip(fig.subplots(1, 3), cases, strict=True):
            _cylinder(axes, sides, kind)
            axes.set_title(title, fontsize=10)
            axes.set(xlim=(-1.15, 1.15), ylim=(-0.5, 2.2), aspect="equal")
            bare(axes)
    return fig


_SUN = np.array([-0.5, -0.75, 0.55]) / np.linalg.norm([-0.5, -0.75, 0.55])


def _seen(points: Array) -> Array:
    """View from the front (-y), a little from above."""
    return np.stack([points[..., 0], 1.6 * points[..., 2] + 0.32 * points[..., 1]], axis=-1)


def _cylinder(axes: Any, sides: int, kind: str) -> None:
    turn = 2 * np.pi * np.arange(sides + 1) / sides
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
    up = np.array([0.0, 0.0, 1.0])
    middle = ring[:-1] + ring[1:]
    flat = middle / np.linalg.norm(middle, axis=-1, keepdims=True)
    # where all edges are auxiliary, the rim bends outwards by half of the right angle between mantle and cap
    rim = (ring + up) / np.sqrt(2) if kind == "all" else ring
    cells: list[tuple[Array, Array]] = []
    dash: Any = "-" if kind == "flat" else (0, (4, 3))
    for side in range(sides):
        if flat[side, 1] >= 0.32:
            continue  # it faces away
        normals = np.array([ring[side], ring[side + 1], rim[side + 1], rim[side]])
        corners = np.array([ring[side], ring[side + 1], ring[side + 1] + up, ring[side] + up])
        cells += _cells(corners, np.repeat(flat[side : side + 1], 4, axis=0) if kind == "flat" else normals)
        for end in (side, side + 1):
            if ring[end, 1] < 0.32:
                axes.plot(*_seen(np.stack([ring[end], ring[end] + up])).T, color=INK, linewidth=1.0, linestyle=dash)
    for side in range(sides):
        corners = np.array([up, ring[side] + up, ring[side + 1] + up, up])
        normals = (
            np.array([up, rim[side], rim[side + 1], up]) if kind == "all" else np.repeat(up[np.newaxis], 4, axis=0)
        )
        cells += _cells(corners, normals)
    colors = [_shaded(normal) for _, normal in cells]
    axes.add_collection(
        PolyCollection([_seen(c) for c, _ in cells], facecolors=colors, edgecolors=colors, linewidths=0.4)
    )
    dash = (0, (4, 3)) if kind == "all" else "-"
    axes.plot(*_seen(ring + up).T, color=INK, linewidth=1.0, linestyle=dash)


def _cells(corners: Array, normals: Array, count: int = 10) -> list[tuple[Array, Array]]:
    """A quad in small cells: their corners, and the normal at their middle, interpolated bilinearly."""
    cells = []
    for i in range(count):
        for j in range(count):
            at = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            cells.append(
                (_mixed(corners, np.array(at) / count), _mixed(normals, np.array([(i + 0.5, j + 0.5)]) / count)[0])
            )
    return cells


def _mixed(values: Array, at: Array) -> Array:
    """Values at the corners of a quad, interpolated at places of shape (N, 2) in it."""
    s, t = at[:, :1], at[:, 1:]
    return cast("Array", (1 - t) * ((1 - s) * values[0] + s * values[1]) + t * ((1 - s) * values[3] + s * values[2]))


def _shaded(normal: Array) -> tuple[float, ...]:
    shade = 0.06 + 0.9 * max(float(normal @ _SUN) / float(np.linalg.norm(normal)), 0)
    return tuple(encoded([shade, 0.97 * shade, 0.9 * shade]))
