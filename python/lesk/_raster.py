"""Shading by a scanline rasteriser."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk._render import Render
from lesk.errors import ParameterError
from lesk.scene import Scene, load, parse

NAMES: Mapping[str, Sequence[str]] = dict(_lesk.shading_names())
"""The names that `shade` accepts for `shading`, `interpolation`, `correction`, `normals`, `flat_point`, `space` and
`shadow_terminator`, and `Classic` for `highlight`; the default first."""

_COLORS, _NUMBERS, _HIGHLIGHT = _lesk.classic_defaults()


@dataclass(frozen=True, kw_only=True)
class Classic:
    """The classic local model: I = I_A + sum of I_D + I_S over the lights, without units.

    I_A = C_A C_D k_A, I_D = C_L C_D k_D cos(alpha), I_S = C_L C_S k_S cos(beta)^h. A light of illuminance E
    (perpendicular to its direction) counts as C_L = E/pi: then k_D C_D is the albedo of a Lambert surface.
    """

    ambient: Sequence[float] = tuple(_COLORS[0])
    """C_A, colour of the ambient light."""
    diffuse: Sequence[float] = tuple(_COLORS[1])
    """C_D, colour of the surface."""
    specular: Sequence[float] = tuple(_COLORS[2])
    """C_S, colour of the highlight."""
    ka: float = _NUMBERS[0]
    kd: float = _NUMBERS[1]
    ks: float = _NUMBERS[2]
    shininess: float = _NUMBERS[3]
    """h, the exponent of the highlight."""
    highlight: str = _HIGHLIGHT
    """`phong`: beta lies between viewer and mirrored light; `blinn`: between normal and half vector."""
    lights: Sequence[tuple[Sequence[float], Sequence[float]]] = field(default_factory=tuple)
    """Directions towards lights, and their colours C_L; without any, the lights of the scene count."""


class Shading(Render):
    """A rasterised picture, and what it took."""

    def __init__(self, picture: _lesk.Picture, facts: tuple[Any, ...]) -> None:
        super().__init__(picture)
        counts, times, warnings, faces = facts
        self.counts: dict[str, int] = dict(counts)
        """`faces` of the scene; `drawn`: faces put into bands of 32 rows; `vertices`; `samples` that show a face;
        `evaluations`: points at which light was computed, vertices once for each side that their faces show."""
        self.milliseconds: list[float] = times
        """Time of each frame, ms, without reading and preparing the scene."""
        self.warnings: list[str] = warnings
        """What to know about the picture, one sentence each."""
        self.faces: npt.NDArray[np.uint32] | None = faces
        """With `aovs`, the face that each sample shows, from 1, 0 for none; shape (height, width) times
        `supersampling`."""


def shade(
    scene: str | Path | Scene,
    *,
    shading: str | None = None,
    interpolation: str | None = None,
    correction: str | None = None,
    normals: str | None = None,
    crease_angle_deg: float | str | None = None,
    tessellation: int | None = None,
    subdivide: int | None = None,
    renormalize: bool | None = None,
    supersampling: int | None = None,
    quadrature: int | None = None,
    shadows: bool | None = None,
    shadow_terminator: str | None = None,
    cull: bool | None = None,
    flat_point: str | None = None,
    space: str | None = None,
    classic: Classic | Mapping[str, Any] | bool | None = None,
    aovs: bool | None = None,
    threads: int | None = None,
    frames: int = 1,
) -> Shading:
    """Shade a scene with a scanline rasteriser: direct light of every material, face by face.

    What is not given is as the scene says under `[raster]`, and `aovs` and `shadow_terminator` under `[render]`.

    Parameters
    ----------
    scene : path-like, str or Scene
        A scene file; text of one, if it has line breaks; or a scene that was read before.
    shading : str
        `flat`: once per face; `gouraud`: at vertices, light is interpolated; `phong`: at pixels, normals are.
    interpolation : str
        `bilinear`: along edges, then along the span of a scanline; `barycentric`: within triangles.
    correction : str
        `perspective`: linear on the surface; `screen`: linear on the screen.
    normals : str
        Vertex normals: `given` by the surface or file, else angle-weighted; `analytic`, of surfaces that know their
        own; `mean`, `area`, `angle`, `max1999`: of the faces around.
    crease_angle_deg : float or str
        Edges with a larger angle between their faces are real, 0 to 180 degrees; `stored`: as the mesh stores them.
    tessellation : int
        Faces around a sphere, disk or cylinder, 3 to 4096.
    subdivide : int
        How often the faces of meshes are cut into four, 0 to 8. New points move to the curved surface that the normals of
        the mesh state (Phong tessellation); sharp edges stay as they are.
    renormalize : bool
        Whether interpolated normals are brought to unit length.
    supersampling : int
        Samples along each side of a pixel, 1 to 16.
    quadrature : int
        Points per light that has an area or fills the sky, 1 to 4096.
    shadows : bool
        Whether rays look for obstacles between a point and its lights.
    shadow_terminator : str
        On faces with interpolated normals, `hanika`: the normal says which lights are seen, and rays start from points
        raised to the surface that the faces stand for; `none`: the face says, in blocks.
    cull : bool
        Whether faces that show their back are left out.
    flat_point : str
        The point of a face in flat shading: `centroid` or `first` corner. Its normal is that of the face.
    space : str
        `linear`: sums of light are light; `gamma`: they are codes of a screen, wrong on purpose.
    classic : Classic, dict or bool
        The classic local model for all objects, instead of their materials and of what the scene says; True: with its
        defaults; False: the materials.
    aovs : bool
        Whether to keep albedo, normal, depth and ids.
    threads : int, optional
        Threads; without it, one per core. The picture is the same for any number.
    frames : int
        How often to draw, for their times.

    Returns
    -------
    Shading
        The picture, with the layers of `lesk.render`; `counts`, `milliseconds` and `warnings`.

    Raises
    ------
    SceneError, ParameterError
        What was given and what is accepted.

    References
    ----------
    gouraud1971, phong1975, boubekeur2008, hanika2021
    """
    chosen = wishes(
        shading=shading,
        interpolation=interpolation,
        correction=correction,
        normals=normals,
        crease_angle_deg=crease_angle_deg,
        tessellation=tessellation,
        subdivide=subdivide,
        renormalize=renormalize,
        supersampling=supersampling,
        quadrature=quadrature,
        shadows=shadows,
        shadow_terminator=shadow_terminator,
        cull=cull,
        flat_point=flat_point,
        space=space,
        classic=_classic(classic),
        aovs=aovs,
        threads=threads,
        frames=frames,
    )
    if not isinstance(scene, Scene):
        scene = parse(scene) if isinstance(scene, str) and "\n" in scene else load(scene)
    return Shading(*_lesk.shade(scene, chosen))


_WISHES = [name for name in shade.__annotations__ if name not in ("scene", "return")]


def wishes(**chosen: Any) -> dict[str, Any]:
    """All settings for the core; what is not chosen is as the scene says."""
    out = {**dict.fromkeys(_WISHES), "frames": 1, **chosen}
    for name in ("threads", "frames"):
        if out[name] is not None and out[name] < 1:
            raise ParameterError(f"`{name}` is {out[name]}, but 1 or more is accepted")
    for name in ("tessellation", "subdivide", "supersampling", "quadrature"):
        if out[name] is not None and not 0 <= out[name] < 2**31:
            raise ParameterError(f"`{name}` is {out[name]}, but a whole number from 0 to {2**31 - 1} is accepted")
    return out


def _classic(model: Classic | Mapping[str, Any] | bool | None) -> dict[str, Any] | bool | None:
    if model is None or isinstance(model, bool):
        return model
    if not isinstance(model, Classic):
        known = Classic.__dataclass_fields__
        for name in model:
            if name not in known:
                raise ParameterError(f"the classic model has no `{name}`, but {', '.join(known)} are accepted")
        model = Classic(**model)
    return {
        "ambient": _three("ambient", model.ambient),
        "diffuse": _three("diffuse", model.diffuse),
        "specular": _three("specular", model.specular),
        "ka": float(model.ka),
        "kd": float(model.kd),
        "ks": float(model.ks),
        "shininess": float(model.shininess),
        "highlight": model.highlight,
        "lights": [(_three("direction", d), _three("light", c)) for d, c in model.lights],
    }


def _three(name: str, values: Sequence[float] | float) -> list[float]:
    numbers = [float(values)] * 3 if isinstance(values, int | float) else [float(v) for v in values]
    if len(numbers) != 3:
        raise ParameterError(f"`{name}` has {len(numbers)} numbers, but 3 are accepted")
    return numbers
