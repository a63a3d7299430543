"""Mesh files: faces, edges by kind, places that are not manifold, normals.

>>> import lesk
>>> report = lesk.mesh.report("bunny.obj")  # doctest: +SKIP
>>> report["meshes"][0]["edges"]  # doctest: +SKIP
{'real': 0, 'auxiliary': 104288, 'boundary': 223, 'non_manifold': 0}
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import ParameterError

__all__ = ["KINDS", "Edges", "draw", "edges", "report"]

KINDS = ("real", "auxiliary", "boundary", "non_manifold")
"""Kinds of edges, in the order of `Edges.kinds`."""

_COLORS = {"real": "#c0392b", "auxiliary": "#8fa3b5", "boundary": "#e08a00", "non_manifold": "#8e2fbf"}
_WIDTHS = {"real": 1.6, "auxiliary": 0.6, "boundary": 1.6, "non_manifold": 2.2}
_MOST_FACES = 60_000


class Edges(NamedTuple):
    """All edges of a file."""

    positions: npt.NDArray[np.float32]
    """Shape (N, 3), metres."""
    edges: npt.NDArray[np.uint32]
    """Numbers of the positions at both ends, shape (M, 2)."""
    kinds: npt.NDArray[np.uint8]
    """Number of the kind in `KINDS`, shape (M,)."""
    corners: npt.NDArray[np.uint32]
    """Numbers of the positions of all faces, face after face."""
    sizes: npt.NDArray[np.uint32]
    """Corners of each face."""


def report(path: str | Path, *, crease_angle_deg: float | None = None) -> dict[str, Any]:
    """Say what there is in a mesh file.

    Parameters
    ----------
    path : path-like
        An OBJ, PLY, glTF or GLB file.
    crease_angle_deg : float, optional
        Edges with a larger angle between their faces are real, 0 to 180 degrees. Without it, edges are as stored (by
        smoothing groups, normals); 30 degrees where nothing is stored.

    Returns
    -------
    dict
        `meshes`: per mesh its numbers of positions, faces (also by their corners), triangles, edges by kind, places
        that are not manifold (first 20 of each kind, metres), faces that are bent or have no area, area in m²,
        normals that point to the back of their face, the largest angle between a normal and its face in degrees.
        `warnings`: what the reader repaired.

    Raises
    ------
    FileError, ParameterError
        What was given and what is accepted.
    """
    facts: dict[str, Any] = json.loads(_lesk.mesh_report_json(Path(path), _angle(crease_angle_deg)))
    return facts


def edges(path: str | Path, *, crease_angle_deg: float | None = None) -> Edges:
    """Give all edges of a mesh file with their kinds; parameters and errors as for `report`."""
    return Edges(*_lesk.mesh_edges(Path(path), _angle(crease_angle_deg)))


def _angle(degrees: float | None) -> float | None:
    if degrees is not None and not 0 <= degrees <= 180:
        raise ParameterError(f"crease angle is {degrees} deg, but 0 to 180 deg is accepted")
    return degrees


def draw(
    path: str | Path, output: str | Path, *, crease_angle_deg: float | None = None, azimuth_deg: float = 35.0,
    elevation_deg: float = 25.0,
) -> None:  # fmt: skip
    """Draw the faces of a mesh file with their edges, coloured by kind.

    Parameters
    ----------
    path : path-like
        An OBJ, PLY, glTF or GLB file of at most 60000 faces.
    output : path-like
        `.svg` or `.png`.
    crease_angle_deg : float, optional
        As for `report`.
    azimuth_deg, elevation_deg : float
        From where: the angle around the z axis from -y, and above the horizon, degrees.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.figure import Figure

    output = Path(output)
    if output.suffix.lower() not in (".svg", ".png"):
        raise ParameterError(f"`{output.name}` ends in `{output.suffix}`, but .svg and .png are accepted")
    mesh = edges(path, crease_angle_deg=crease_angle_deg)
    if len(mesh.sizes) > _MOST_FACES:
        raise ParameterError(f"`{path}` has {len(mesh.sizes)} faces, but up to {_MOST_FACES} can be drawn")
    points, towards = _project(mesh.positions, np.radians(azimuth_deg), np.radians(elevation_deg))
    figure = Figure(figsize=(7, 7), dpi=140)
    axes = figure.add_axes((0.02, 0.06, 0.96, 0.92))
    for order, (polygons, shades, lines, colors, widths) in enumerate(_layers(mesh, points, towards)):
        style: dict[str, Any] = {"facecolors": shades, "edgecolors": shades, "linewidths": 0.3}
        axes.add_collection(PolyCollection(polygons, zorder=2 * order, **style))
        axes.add_collection(
            LineCollection(lines, colors=colors, linewidths=widths, capstyle="round", zorder=2 * order + 1)
        )
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")
    counts = np.bincount(mesh.kinds, minlength=len(KINDS))
    handles = [
        axes.plot([], [], color=_COLORS[kind], linewidth=2, label=f"{kind.replace('_', '-')}: {count}")[0]
        for kind, count in zip(KINDS, counts, strict=True)
    ]
    figure.legend(handles=handles, loc="lower center", ncols=4, frameon=False, fontsize=9)
    canvas = FigureCanvasSVG(figure) if output.suffix.lower() == ".svg" else FigureCanvasAgg(figure)
    canvas.print_figure(str(output), facecolor="white")


def _project(
    positions: npt.NDArray[np.float32], azimuth: float, elevation: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Parallel projection: points on the picture, and how far each is towards the viewer."""
    sine, cosine = np.sin(azimuth), np.cos(azimuth)
    right = np.array([cosine, sine, 0.0])
    towards = np.array([sine * np.cos(elevation), -cosine * np.cos(elevation), np.sin(elevation)])
    up = np.cross(towards, right)
    return positions @ np.stack([right, up], axis=1), positions @ towards


def _layers(mesh: Edges, points: npt.NDArray[np.float64], depth: npt.NDArray[np.float64]) -> list[tuple[Any, ...]]:
    """Faces and edges in slices from back to front: a painter's algorithm, good enough to tell edges apart."""
    faces = np.split(mesh.corners, np.cumsum(mesh.sizes, dtype=np.int64)[:-1])
    face_depth = np.array([depth[f].mean() for f in faces])
    # an edge is drawn after the faces at both of its ends; equal positions count as one
    _, place = np.unique(mesh.positions, axis=0, return_inverse=True)
    place = place.reshape(-1)
    nearest = np.full(len(mesh.positions), -np.inf)
    np.maximum.at(nearest, place[mesh.corners], np.repeat(face_depth, mesh.sizes))
    edge_depth = nearest[place[mesh.edges]].min(axis=1)
    slices = min(400, max(1, len(faces)))
    borders = np.linspace(face_depth.min(), face_depth.max(), slices + 1)
    face_slice = np.clip(np.searchsorted(borders, face_depth, side="right") - 1, 0, slices - 1)
    edge_slice = np.clip(np.searchsorted(borders, edge_depth, side="right") - 1, 0, slices - 1)
    shades = _shades(faces, mesh.positions)
    face_order = np.argsort(face_slice, kind="stable")
    edge_order = np.argsort(edge_slice, kind="stable")
    out = []
    for k in range(slices):
        own = face_order[slice(*np.searchsorted(face_slice[face_order], [k, k + 1]))]
        lines = edge_order[slice(*np.searchsorted(edge_slice[edge_order], [k, k + 1]))]
        if len(own) == 0 and len(lines) == 0:
            continue
        names = [KINDS[i] for i in mesh.kinds[lines]]
        out.append(
            (
                [points[faces[i]] for i in own],
                [shades[i] for i in own],
                points[mesh.edges[lines]],
                [_COLORS[n] for n in names],
                [_WIDTHS[n] for n in names],
            )
        )
    return out


def _shades(faces: list[npt.NDArray[np.uint32]], positions: npt.NDArray[np.float32]) -> npt.NDArray[np.float64]:
    """Light greys by the direction of a face, shape (faces, 3)."""
    light = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
    out = np.empty((len(faces), 3))
    for i, face in enumerate(faces):
        p = positions[face].astype(float)
        normal = np.cross(p - p[0], np.roll(p, -1, axis=0) - p[0]).sum(axis=0)
        length = np.linalg.norm(normal)
        out[i] = 0.86 + 0.1 * abs(normal @ light) / length if length > 0 else 0.9
    return out
