"""Real and auxiliary edges, on meshes that the rasteriser shades."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from lesk._raster import Classic, shade
from lesk.errors import ParameterError
from lesk.figures._sheet import MARK, arrow, bare, encoded
from lesk.mesh import KINDS, edges
from lesk.plot._figure import CURVES, FAINT, INK, Array, Plot, figure, style
from lesk.scene import parse

_STAGE = """
version = 1
[camera]
eye = {eye}
target = {target}
up = {up}
fov = "{fov} deg"
[film]
size = [{width}, {height}]
[materials.clay]
model = "lambert"
[[objects]]
shape = "mesh"
file = {file}
material = "clay"
"""
_FAR = 60.0
"""Distance of the camera, metres: its view is parallel but for a few hundredths."""


def shaded(
    obj: str, limit_deg: float, light: Sequence[float], towards: Array, up: Array, target: Array, half: float, size: Any
) -> tuple[Array, Any]:
    """Shade a mesh with the crease angle in matte white, seen from afar.

    Parameters
    ----------
    obj : str
        Text of an OBJ file.
    limit_deg : float
        The crease angle, degrees.
    light : sequence of float
        Direction to the light.
    towards, up, target : ndarray of shape (3,)
        Unit direction to the viewer, what is up, and the middle of the picture in metres.
    half : float
        Half the width of the picture, metres.
    size : tuple of int
        Width and height, pixels.

    Returns
    -------
    ndarray of shape (height, width, 3)
        Linear values; -1 where there is no face.
    Edges
        The edges of the mesh with their kinds.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.obj"
        path.write_text(obj, encoding="utf-8")
        text = _STAGE.format(
            eye=[float(x) for x in target + _FAR * towards],
            target=[float(x) for x in target],
            up=[float(x) for x in up],
            fov=2 * np.degrees(np.arctan(half / _FAR)),
            width=size[0],
            height=size[1],
            file=json.dumps(str(path)),
        )
        matte = Classic(ka=0.06, kd=0.9, ks=0, lights=[(tuple(light), (1.0, 1.0, 1.0))])
        picture = shade(
            parse(text), normals="mean", crease_angle_deg=limit_deg, classic=matte, supersampling=2, aovs=True
        )
        mesh = edges(path, crease_angle_deg=limit_deg)
    empty = picture.layers["depth.Z"] <= 0
    return np.where(empty[..., np.newaxis], -1.0, picture.rgb.astype(float)), mesh


def prism(sides: int) -> str:
    """Give an upright prism around the z axis, of radius and height 1 m, as an OBJ file."""
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = [(np.cos(a), np.sin(a)) for a in turn]
    lines = [f"v {x:.9f} {y:.9f} {z}" for z in (0, 1) for x, y in ring]
    for side in range(sides):
        low, high = side + 1, (side + 1) % sides + 1
        lines.append(f"f {low} {high} {high + sides} {low + sides}")
    lines.append("f " + " ".join(str(sides + k) for k in range(1, sides + 1)))
    lines.append("f " + " ".join(str(k) for k in range(sides, 0, -1)))
    return "\n".join(lines) + "\n"


def auxiliary_edges(*, sides: int = 12, size: int = 300) -> Plot:
    """Real and auxiliary edges.

    A prism, shaded by the rasteriser with three crease angles. Left every edge is real: each face has one normal. In the
    middle the edges of the mantle are auxiliary (dashed: they only approximate the surface), those of the cap real: it looks
    round, and the cap flat. Right all edges are auxiliary: the mantle shades as if it bent over into the cap.

    Parameters
    ----------
    sides : int
        Faces of the mantle, 6 or more.
    size : int
        Pixels per side of a picture.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    if sides < 6:
        raise ParameterError(f"`sides` is {sides}, but 6 or more is accepted")
    cases = (("all edges real", 0), ("mantle auxiliary, cap real", 75), ("all edges auxiliary", 180))
    towards = np.array([0.0, -np.cos(np.radians(24)), np.sin(np.radians(24))])
    up, target, half = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 0.45]), 1.15
    with style():
        fig = figure(8.2, 3.2)
        for axes, (title, limit) in zip(fig.subplots(1, 3), cases, strict=True):
            values, mesh = shaded(prism(sides), limit, (-0.5, -0.75, 0.55), towards, up, target, half, (size, size))
            empty = (values < 0).any(axis=-1, keepdims=True)
            axes.imshow(np.where(empty, 1.0, encoded(np.maximum(values, 0))), extent=(-half, half, -half, half))
            _lines(axes, mesh, towards, up, target)
            axes.set(xlim=(-half, half), ylim=(-0.9, 1.0), aspect="equal", title=title)
            axes.title.set_fontsize(10)
            bare(axes)
    return fig


def _lines(axes: Any, mesh: Any, towards: Array, up: Array, target: Array) -> None:
    """Draw the edges of faces that show their front: real ones solid, auxiliary ones dashed."""
    right = np.cross(up, towards)
    across = np.stack([right / np.linalg.norm(right), np.cross(towards, right / np.linalg.norm(right))], axis=1)
    places = mesh.positions.astype(float)
    shown = set()
    for face in np.split(mesh.corners, np.cumsum(mesh.sizes, dtype=np.int64)[:-1]):
        corners = places[face]
        if np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0) @ towards > 1e-9:
            shown |= {frozenset((int(a), int(b))) for a, b in zip(face, np.roll(face, -1), strict=True)}
    for ends, kind in zip(mesh.edges, mesh.kinds, strict=True):
        if frozenset(int(e) for e in ends) in shown:
            dash: Any = (0, (4, 3)) if KINDS[kind] == "auxiliary" else "-"
            axes.plot(*((places[ends] - target) @ across).T, color=INK, linewidth=1.0, linestyle=dash)


_PROFILE = np.array([(0.0, 0.2), (1.2, 0.45), (2.3, 1.0), (3.1, 1.9), (4.3, 1.9), (4.6, 0.5), (5.8, 0.3), (7.0, 0.35)])


def folds_of(profile: Array) -> Array:
    """Angle between the faces at each inner vertex of a profile, degrees."""
    run = np.diff(profile, axis=0)
    heading = np.degrees(np.arctan2(run[:, 1], run[:, 0]))
    return cast("Array", np.abs(np.diff(heading)))


def crease_angle(*, limit_deg: float = 40) -> Plot:
    """Crease angle.

    A cut through a surface. Where two faces meet at less than the crease angle, the edge is auxiliary and the vertex has one
    normal, their mean; where they meet at more, the edge is real and the vertex has a normal for each face. Below, the surface
    as the rasteriser shades it from above, in light from the upper left: smooth over auxiliary edges, with a step at real ones.

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
        for index, angle in enumerate(angles, 1):
            real = angle > limit_deg
            mean = normals[index - 1] + normals[index]
            mean /= np.linalg.norm(mean)
            at, color = _PROFILE[index], MARK if real else CURVES[0]
            for normal in (normals[index - 1], normals[index]) if real else (mean,):
                arrow(axes, at, at + 0.7 * normal, color)
            axes.plot(*at, "s" if real else "o", color=color, markersize=6)
            axes.annotate(
                f"{angle:.0f}°",
                tuple(at),
                tuple(-19 * mean),
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize=9,
                color=color,
            )
        axes.plot([], [], "o", color=CURVES[0], label=f"auxiliary: up to {limit_deg:g}°, one normal")
        axes.plot([], [], "s", color=MARK, label=f"real: above {limit_deg:g}°, two normals")
        axes.legend(loc="upper left", fontsize=9)
        axes.imshow(encoded(strip(limit_deg)), extent=(_PROFILE[0, 0], _PROFILE[-1, 0], -1.1, -0.55), aspect="auto")
        axes.set(xlim=(-0.1, 7.1), ylim=(-1.15, 3.2), aspect="equal")
        bare(axes)
        axes.set_xlabel("the surface from above, light from the upper left", fontsize=9)
    return fig


def strip(limit_deg: float, width: int = 1400) -> Array:
    """Shade the profile, drawn out to a strip, with a crease angle, from above; linear, shape (height, width, 3)."""
    lines = [f"v {x} {y} {z}" for y in (-1, 1) for x, z in _PROFILE]
    count = len(_PROFILE)
    lines += [f"f {k} {k + 1} {k + 1 + count} {k + count}" for k in range(1, count)]
    low, high = _PROFILE[[0, -1], 0]
    values, _ = shaded(
        "\n".join(lines) + "\n",
        limit_deg,
        (-0.8, 0.0, 0.6),
        np.array([0.0, 0.0, 1.0]),
        np.array([0.0, 1.0, 0.0]),
        np.array([(low + high) / 2, 0.0, 0.0]),
        (high - low) / 2,
        (width, 24),
    )
    return np.maximum(values, 0)
