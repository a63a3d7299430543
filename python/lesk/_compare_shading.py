"""Flat, Gouraud and Phong shading side by side with the direct light that they approximate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from lesk import _lesk, image
from lesk._raster import NAMES, Shading, shade, wishes
from lesk._render import Render, render
from lesk.errors import ParameterError
from lesk.scene import Scene, load, parse

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = npt.NDArray[np.float64]
MODES = ("flat", "gouraud", "phong")
CURVES = {"flat": "#0072b2", "gouraud": "#d55e00", "phong": "#009e73"}
TITLES = {"flat": "flat", "gouraud": "Gouraud", "phong": "Phong"}
TESSELLATIONS = (6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
SUBDIVISIONS = (0, 1, 2, 3, 4)
COARSE = 8
"""Faces around curved shapes beside meshes that are not subdivided yet."""
MOST_FACES = 2_000_000
"""Of the finest mesh, which is the truth of a curve."""


@dataclass(frozen=True)
class Comparison:
    """What `compare_shading` found."""

    shaded: dict[str, Shading]
    """One picture per mode."""
    reference: Render
    """Direct light of the exact surfaces, path traced."""
    errors: dict[str, float]
    """Root of the mean squared difference to the reference over its mean luminance, per mode."""
    curve: list[dict[str, Any]]
    """`faces`, `errors` per mode, and `tessellation` of curved shapes, `subdivide` of meshes and rectangles, or both."""

    def facts(self) -> dict[str, Any]:
        """Give the numbers."""
        modes = {
            mode: {
                **one.counts,
                "milliseconds": float(np.median(one.milliseconds)),
                "error": self.errors[mode],
                "warnings": one.warnings,
            }
            for mode, one in self.shaded.items()
        }
        return {"modes": modes, "reference_seconds": self.reference.seconds, "curve": self.curve}

    def figure(self) -> Figure:
        """Draw pictures, differences, faces, normals and the curve of errors."""
        return _figure(self)


def compare_shading(
    scene: str | Path | Scene,
    *,
    tessellation: int = 24,
    spp: int = 64,
    frames: int = 5,
    normals: str | None = None,
    crease_angle_deg: float | str | None = None,
    curve: bool = True,
) -> Comparison:
    """Compare the three modes of shading with the direct light of the exact surfaces.

    Interpolation and normals are as the scene says under `[raster]`; its `classic` model, `space` and `supersampling`
    have no counterpart in the reference and are left out.

    Parameters
    ----------
    scene : path-like, str or Scene
        As for `lesk.shade`.
    tessellation : int
        Faces around a sphere, disk or cylinder, 3 to 4096.
    spp : int
        Samples per pixel of the reference, which is path traced to depth 1 with hard shadows like those of the modes.
    frames : int
        How often to draw, for the median of their times.
    normals : str
        Vertex normals, as for `lesk.shade`.
    crease_angle_deg : float or str
        As for `lesk.shade`.
    curve : bool
        Whether to measure errors against the number of faces. Curved shapes alone: 6 to 128 faces around them, against
        the true shapes. With meshes or rectangles, these are subdivided up to four times on the surface that their normals state, as
        far as 2 million faces, while curved shapes get 8, 16, ... faces around; there the direct light of the finest
        faces, path traced, is the truth. The first point is a mesh with its own normals, finer ones have those of their
        faces.

    Returns
    -------
    Comparison
    """
    if normals is not None and normals not in NAMES["normals"]:
        raise ParameterError(
            f"there is no rule `{normals}` for normals, but {', '.join(NAMES['normals'])} are accepted"
        )
    if not isinstance(scene, Scene):
        scene = parse(scene) if isinstance(scene, str) and "\n" in scene else load(scene)
    options: dict[str, Any] = {
        "normals": normals,
        "crease_angle_deg": crease_angle_deg,
        "shadows": True,
        "classic": False,
        "space": "linear",
        "supersampling": 1,
    }

    def picture(mode: str, tessellation: int, *, times: int = 1, subdivide: int = 0, aovs: bool = False) -> Shading:
        return shade(
            scene,
            shading=mode,
            tessellation=tessellation,
            subdivide=subdivide,
            aovs=aovs,
            frames=times,
            **options,
        )

    reference = render(scene, spp=spp, max_depth=1)
    truth = reference.rgb.astype(float)
    shaded = {mode: picture(mode, tessellation, aovs=True) for mode in MODES}
    for mode, one in shaded.items():
        # layers cost more than flat light
        one.milliseconds = picture(mode, tessellation, times=max(frames, 2)).milliseconds
    errors = {mode: _error(one.rgb, truth) for mode, one in shaded.items()}

    def measure(steps: Sequence[dict[str, int]], limit: Array) -> list[dict[str, Any]]:
        points = []
        for step in steps:
            around, level = step.get("tessellation", tessellation), step.get("subdivide", 0)
            several = {mode: picture(mode, around, subdivide=level) for mode in MODES}
            own = {mode: _error(one.rgb, limit) for mode, one in several.items()}
            points.append({**step, "faces": several["flat"].counts["faces"], "errors": own})
        return points

    def faces(around: int, level: int = 0) -> int:
        return picture("flat", around, subdivide=level).counts["faces"]

    # a picture without light has no relative error
    if not (curve and truth.any()):
        return Comparison(shaded, reference, errors, [])
    coarse = faces(COARSE)
    curved = faces(2 * COARSE) > coarse
    levels = [n for n in SUBDIVISIONS if coarse * 4**n <= MOST_FACES]
    if len(levels) < 2 or faces(COARSE, 1) == coarse:
        steps = [{"tessellation": n} for n in TESSELLATIONS] if curved else []
        return Comparison(shaded, reference, errors, measure(steps, truth))
    # each step halves the size of all faces
    steps = [{"subdivide": n, **({"tessellation": COARSE << n} if curved else {})} for n in levels]
    surfaces = _lesk.shaded_surfaces(scene, wishes(**{"tessellation": tessellation, **steps[-1]}, **options))
    points = measure(steps[:-1], render(surfaces, spp=spp, max_depth=1).rgb.astype(float))
    return Comparison(shaded, reference, errors, points)


def _error(picture: npt.NDArray[np.float32], truth: Array) -> float:
    weights = np.array([0.2126, 0.7152, 0.0722])
    mean = float((truth @ weights).mean())
    return float(np.sqrt((((picture - truth) @ weights) ** 2).mean()) / mean) if mean > 0 else 0.0


def _figure(found: Comparison) -> Figure:
    from matplotlib.figure import Figure

    ev100 = found.reference.ev100 or 0.0
    columns = [*MODES, "reference"]
    height, width = found.reference.rgb.shape[:2]
    figure = Figure(figsize=(13, 2.0 + 3 * 3.1 * min(1.2, height / width)), dpi=110, layout="constrained")
    axes = figure.subplots(3, 4)
    shown = {mode: image.develop(one.rgb, ev100=ev100) for mode, one in found.shaded.items()}
    shown["reference"] = image.develop(found.reference.rgb, ev100=ev100)
    truth = found.reference.rgb.astype(float)
    white = float(np.quantile(truth.max(axis=2), 0.99)) or 1.0
    for place, name in zip(axes[0], columns, strict=True):
        place.imshow(np.clip(shown[name], 0, 1))
        place.set_title(_title(found, name), fontsize=10)
    mapped = None
    for place, mode in zip(axes[1], MODES, strict=False):
        difference = (found.shaded[mode].rgb - truth).mean(axis=2) / white
        mapped = place.imshow(difference, cmap="RdBu_r", vmin=-0.25, vmax=0.25)
        place.set_title(f"{TITLES[mode]} - reference, error {100 * found.errors[mode]:.3g} %", fontsize=10)
    if mapped is not None:
        scale = axes[1, 0].inset_axes((0.06, 0.13, 0.42, 0.045))
        figure.colorbar(mapped, cax=scale, orientation="horizontal", ticks=(-0.25, 0, 0.25))
        scale.tick_params(labelsize=7, length=2, pad=1)
        scale.set_title("share of white", fontsize=7, pad=2)
    _normals(axes[1, 3], found.shaded["phong"], "normals of pixels (Phong)")
    _faces(axes[2, 0], found.shaded["flat"], np.clip(shown["flat"], 0, 1))
    _normals(axes[2, 1], found.shaded["flat"], "normals of faces (flat)")
    for place in (*axes[0], *axes[1], *axes[2, :2]):
        place.set_xticks([])
        place.set_yticks([])
    _curve(figure, axes, found.curve)
    return figure


def _title(found: Comparison, name: str) -> str:
    if name == "reference":
        return f"reference: path traced, depth 1\n{found.reference.seconds:.1f} s"
    one = found.shaded[name]
    where = {"flat": "faces", "gouraud": "vertices", "phong": "pixels"}[name]
    milliseconds = float(np.median(one.milliseconds))
    return f"{TITLES[name]}: {milliseconds:.1f} ms\nmodel evaluated at {one.counts['evaluations']} {where}"


def _normals(place: Axes, one: Shading, title: str) -> None:
    layers = one.layers
    normals = np.stack([layers[f"normal.{c}"] for c in "XYZ"], axis=-1)
    length = np.linalg.norm(normals, axis=2, keepdims=True)
    place.imshow(np.where(length > 0, 0.5 + 0.5 * normals / np.maximum(length, 1e-9), 1.0))
    place.set_title(title, fontsize=10)


def _faces(place: Axes, one: Shading, picture: npt.NDArray[Any]) -> None:
    """Lines where neighbouring pixels show different faces."""
    faces = one.faces
    assert faces is not None
    edge = np.zeros(faces.shape, dtype=bool)
    edge[:, 1:] |= faces[:, 1:] != faces[:, :-1]
    edge[1:, :] |= faces[1:, :] != faces[:-1, :]
    overlay = 0.55 * picture + 0.45
    overlay[edge] = (0.1, 0.1, 0.12)
    place.imshow(overlay)
    place.set_title(f"{one.counts['faces']} faces", fontsize=10)


def _curve(figure: Figure, axes: npt.NDArray[Any], curve: Sequence[dict[str, Any]]) -> None:
    grid = axes[2, 2].get_gridspec()
    axes[2, 2].remove()
    axes[2, 3].remove()
    place = figure.add_subplot(grid[2, 2:])
    if not curve:
        place.axis("off")
        place.text(0.5, 0.5, "no curve: not asked for, no light, or too many faces", ha="center", va="center")
        return
    faces = [p["faces"] for p in curve]
    for mode in MODES:
        own = [100 * p["errors"][mode] for p in curve]
        place.loglog(faces, own, "o-", color=CURVES[mode], markersize=3.5, label=TITLES[mode])
    place.set_xlabel("faces of the scene")
    place.set_ylabel("error, % of the mean luminance")
    place.grid(visible=True, which="major", color="#d0d7de", linewidth=0.6)
    place.legend(frameon=False)
    place.set_title("error against number of faces", fontsize=10)
