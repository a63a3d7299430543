"""What flat, Gouraud and Phong shading miss, by Lesk's rasteriser."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk._raster import Classic, Shading, shade
from lesk.figures._animation import Animation, Frame, drawn
from lesk.figures._sheet import MARK, encoded, show
from lesk.image import develop
from lesk.plot._figure import CURVES, INK, Array, Plot, figure, style
from lesk.scene import Scene, parse

MODES = ("flat", "gouraud", "phong")
_TITLES = {"flat": "constant (flat)", "gouraud": "Gouraud", "phong": "Phong"}
_DASHES = {"flat": ":", "gouraud": "--", "phong": "-"}

_STAGE = """
version = 1
[camera]
eye = {eye}
target = {target}
fov = "{fov} deg"
[film]
size = [{width}, {height}]
[materials.subject]
model = "lambert"
[[objects]]
{shape}
material = "subject"
[[lights]]
type = "directional"
direction = [0, 1, 0]
illuminance = "1 lx"
"""
_BALL = 'shape = "sphere"\nradius = "1 m"'
_POT = 'shape = "teapot"\nlevel = {level}\ntransform = [{{ scale = 0.5 }}, {{ rotate = "-20 deg" }}]'


def _scene(
    shape: str, size: tuple[int, int], *, eye: Any = (0, -40, 0), target: Any = (0, 0, 0), fov: float = 3.1
) -> Scene:
    text = _STAGE.format(
        eye=[float(x) for x in eye],
        target=[float(x) for x in target],
        fov=fov,
        width=size[0],
        height=size[1],
        shape=shape,
    )
    return parse(text)


def _light(across_deg: float, up_deg: float = 0) -> Array:
    """Direction towards a light in front of the camera, which looks along +y."""
    a, u = np.radians((across_deg, up_deg))
    return np.array([np.cos(u) * np.sin(a), -np.cos(u) * np.cos(a), np.sin(u)])


def _shiny(direction: npt.ArrayLike, h: float = 50) -> Classic:
    """The classic model with k_A = 0.05, k_D = 0.45, k_S = 0.5 in one white light."""
    light = tuple(float(x) for x in np.asarray(direction))
    return Classic(ka=0.05, kd=0.45, ks=0.5, shininess=h, diffuse=(0.35, 0.6, 1.0), lights=[(light, (1.0, 1.0, 1.0))])


def shading_modes(*, size: int = 200, level: int = 4) -> Plot:
    """Shading: constant, Gouraud, Phong.

    One coarse teapot in the classic model, shaded once per face, at its vertices with colours interpolated, and at every
    pixel with normals interpolated. Below each the number of times that the model was evaluated: slower is more realistic.
    `lesk compare-shading` measures the times and the errors of a scene.

    Parameters
    ----------
    size : int
        Pixels per side of a picture.
    level : int
        Cells along each side of a patch of the teapot.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    scene = _scene(_POT.format(level=level), (size, 3 * size // 4), eye=(0, -7, 2.6), target=(0.16, 0, 0.74), fov=28)
    with style():
        fig = figure(7.6, 2.6)
        for axes, mode in zip(fig.subplots(1, 3), MODES, strict=True):
            picture = shade(scene, shading=mode, supersampling=2, classic=_shiny(_light(-35, 40)))
            where = {"flat": "faces", "gouraud": "vertices", "phong": "samples"}[mode]
            show(axes, encoded(picture.rgb), _TITLES[mode], f"{picture.counts['evaluations']:,} evaluations at {where}")
    return fig


@cache
def _ball(size: int) -> Scene:
    return _scene(_BALL, (size, size))


def ball(mode: str, light: npt.ArrayLike, *, size: int, tessellation: int) -> Shading:
    """Shade a coarse shiny ball in one light by a mode."""
    return shade(_ball(size), shading=mode, classic=_shiny(light), tessellation=tessellation)


def missed_highlights(*, size: int = 180, tessellation: int = 12) -> Plot:
    """Gouraud misses the maximum.

    A coarse ball with a highlight between vertices, and one with a highlight at a vertex. Gouraud's colours cannot exceed
    those at the vertices, so that the first highlight is nearly lost; Phong's normals find it in both. Below the largest
    value of each picture.

    Parameters
    ----------
    size : int
        Pixels per side of a picture.
    tessellation : int
        Faces around the ball.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    between, at = extremes(tessellation)
    with style():
        fig = figure(6.4, 4.9)
        grid = fig.subplots(2, 3)
        rows = (("between vertices", between), ("at a vertex", at))
        for row, (line, (name, across)) in enumerate(zip(grid, rows, strict=True)):
            for axes, mode in zip(line, MODES, strict=True):
                picture = ball(mode, _light(across), size=size, tessellation=tessellation).rgb
                title = _TITLES[mode] if row == 0 else ""
                show(axes, encoded(picture), title, f"max {picture.max():.3f}")
            line[0].set_ylabel(f"highlight {name}", fontsize=9)
    return fig


_LIT = """version = 1
[camera]
eye = [0, -5.2, 1.2]
target = [0, 0, 0]
fov = "26 deg"
ev100 = "4.4 EV"
[film]
size = [{size}, {size}]
[materials.clay]
model = "lambert"
reflectance = [0.55, 0.6, 0.7]
[[objects]]
material = "clay"
{shape}
[[lights]]
type = "point"
position = [4, -0.7, 1.6]
intensity = "1500 cd"
[[lights]]
type = "directional"
direction = [0.2, 1, -0.2]
illuminance = "3 lx"
"""


def shadow_terminator(*, size: int = 190, tessellation: int = 14, level: int = 3) -> Plot:
    """The border of a shadow on coarse faces.

    A coarse ball and a coarse teapot with interpolated normals, lit from the side, with shadows by rays. A face that turns
    from the light hides it, although its interpolated normals still see it: blocks. Rays that start above the face, on the
    planes through its corners that its normals state (hanika2021), meet the surface that the faces stand for. Right the
    true ball, and the teapot of finer faces.

    Parameters
    ----------
    size : int
        Pixels per side of a picture.
    tessellation : int
        Faces around the ball.
    level : int
        Cells along each side of a patch of the coarse teapot.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    ball = 'shape = "sphere"\nradius = "1 m"'
    turned = 'transform = [{{ scale = 0.33 }}, {{ rotate = "-20 deg" }}, {{ translate = [-0.1, 0, -0.5] }}]'
    pot = 'shape = "teapot"\nlevel = {level}\n' + turned
    fine = {"ball": (ball, 512), "teapot": (pot.format(level=24), 64)}
    coarse = {"ball": (ball, tessellation), "teapot": (pot.format(level=level), 64)}
    columns = (
        (coarse, "none", "rays from the faces"),
        (coarse, "hanika", "raised rays"),
        (fine, "hanika", "finer faces"),
    )
    with style():
        fig = figure(6.6, 4.8)
        grid = fig.subplots(2, 3)
        for line, name in zip(grid, ("ball", "teapot"), strict=True):
            for axes, (shapes, terminator, title) in zip(line, columns, strict=True):
                shape, around = shapes[name]
                scene = parse(_LIT.format(size=size, shape=shape))
                picture = shade(scene, tessellation=around, shadows=True, shadow_terminator=terminator, supersampling=3)
                show(
                    axes, np.clip(develop(picture.rgb, ev100=scene.ev100 or 0.0), 0, 1), title if name == "ball" else ""
                )
            line[0].set_ylabel(name, fontsize=10)
    return fig


def extremes(tessellation: int) -> tuple[float, float]:
    """Azimuths of the light, degrees, at which Gouraud's largest value is smallest and largest."""
    sweep = np.linspace(-60, 0, 21)
    peaks = [float(ball("gouraud", _light(a), size=60, tessellation=tessellation).rgb.max()) for a in sweep]
    return float(sweep[int(np.argmin(peaks))]), float(sweep[int(np.argmax(peaks))])


def highlight_crossing(*, frames: int = 24, size: int = 120, tessellation: int = 12) -> Animation:
    """A highlight crosses a coarse ball.

    The light moves from left to right. Gouraud's highlight appears at vertices and vanishes between them, Phong's moves
    evenly; constant shading misses it, because no face is turned that way. Below the largest value of each picture over the
    light's azimuth.

    Parameters
    ----------
    frames : int
        Number of frames.
    size : int
        Pixels per side of a picture.
    tessellation : int
        Faces around the ball.

    Returns
    -------
    Animation
    """
    sweep = np.linspace(-60, 60, frames)
    pictures = {m: [ball(m, _light(a), size=size, tessellation=tessellation).rgb for a in sweep] for m in MODES}
    peaks = {m: [float(p.max()) for p in pictures[m]] for m in MODES}
    drawings = []
    for index in range(frames):
        with style():
            fig = figure(5.4, 3.6)
            spots = fig.subplot_mosaic([list(MODES), ["peaks"] * 3], height_ratios=(1.5, 1))
            for mode in MODES:
                show(spots[mode], encoded(pictures[mode][index]), _TITLES[mode])
            axes = spots["peaks"]
            for color, mode in zip(CURVES, MODES, strict=False):
                axes.plot(sweep, peaks[mode], color=color, linestyle=_DASHES[mode], linewidth=1.6, label=_TITLES[mode])
            axes.axvline(sweep[index], color=INK, linewidth=1)
            axes.set(
                xlabel="azimuth of the light, degrees",
                ylabel="largest value",
                xlim=(sweep[0], sweep[-1]),
                ylim=(0, 1.05),
            )
            axes.legend(fontsize=7.5, ncols=3, loc="lower center")
        drawings.append(drawn(fig))
    return Animation(drawings, seconds=0.12)


QUAD_TILTS = (0.0, 75.0, 15.0, 80.0)
"""Angles between the quad and the normals at its corners, degrees: their cosines are the corners' brightness."""
_PROBE = (0.32, 0.18)


class Quad:
    """A square with four brightnesses, turned on the screen; light and camera look along its axis.

    Its file exists until the end of the `with` that it is used in.
    """

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="lesk-quad-")
        corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
        lines = [f"v {x} {y} 0" for x, y in corners]
        for (x, y), tilt in zip(corners, np.radians(QUAD_TILTS), strict=True):
            lines.append(
                f"vn {x * np.sin(tilt) / np.sqrt(2):.9f} {y * np.sin(tilt) / np.sqrt(2):.9f} {np.cos(tilt):.9f}"
            )
        path = Path(self._folder.name) / "quad.obj"
        path.write_text("\n".join([*lines, "f 1//1 2//2 3//3 4//4", ""]), encoding="utf-8")
        # the quad lies in the plane of x and z and faces the camera at -y
        self._shape = (
            f'shape = "mesh"\nfile = "{path.as_posix()}"\n'
            'transform = [{{ rotate = "{angle} deg" }}, {{ rotate = "90 deg", axis = [1, 0, 0] }}]'
        )

    def __enter__(self) -> Quad:
        return self

    def __exit__(self, *_: object) -> None:
        self._folder.cleanup()

    def picture(self, angle_deg: float, interpolation: str, size: int) -> Array:
        """The quad turned by an angle, shape (size, size, 3)."""
        return self._shaded(angle_deg, interpolation, (size, size), (0.0, 0.0), 4.2)

    def probe(self, angle_deg: float, interpolation: str) -> float:
        """Its brightness at one point that turns with it."""
        turn = np.radians(angle_deg)
        x = _PROBE[0] * np.cos(turn) - _PROBE[1] * np.sin(turn)
        z = _PROBE[0] * np.sin(turn) + _PROBE[1] * np.cos(turn)
        # one pixel whose middle is the point
        return float(self._shaded(angle_deg, interpolation, (1, 1), (x, z), 0.01)[0, 0, 0])

    def _shaded(
        self, angle: float, interpolation: str, size: tuple[int, int], at: tuple[float, float], fov: float
    ) -> Array:
        x, z = at
        scene = _scene(self._shape.format(angle=angle), size, eye=(x, -40, z), target=(x, 0, z), fov=fov)
        matte = Classic(ka=0, kd=1, ks=0, lights=[((0.0, -1.0, 0.0), (1.0, 1.0, 1.0))])
        shaded = shade(scene, shading="gouraud", interpolation=interpolation, classic=matte)
        return cast("Array", shaded.rgb.astype(float))


def rotating_quad(*, frames: int = 30, size: int = 150) -> Animation:
    """Gouraud is not invariant to rotation.

    A square with four brightnesses at its corners turns on the screen. With bilinear interpolation along edges and spans
    its inside changes, because the spans run along other lines of it: a temporal artefact. Barycentric
    interpolation within two triangles is the same at every angle. Below the brightness at the marked point, which turns
    with the square.

    Parameters
    ----------
    frames : int
        Number of frames.
    size : int
        Pixels per side of a picture.

    Returns
    -------
    Animation
    """
    with Quad() as quad:
        return Animation(_turning(quad, frames, size), seconds=0.12)


def _turning(quad: Quad, frames: int, size: int) -> list[Frame]:
    """The frames of `rotating_quad`."""
    angles = np.linspace(0, 180, frames, endpoint=False)
    fine = np.linspace(0, 180, 91)
    kinds = ("bilinear", "barycentric")
    curves = {kind: [quad.probe(a, kind) for a in fine] for kind in kinds}
    drawings = []
    for angle in angles:
        with style():
            fig = figure(4.6, 4.0)
            spots = fig.subplot_mosaic([list(kinds), ["curve", "curve"]], height_ratios=(1.7, 1))
            for color, kind in zip(CURVES, kinds, strict=False):
                show(spots[kind], encoded(quad.picture(angle, kind, size)), f"{kind} interpolation")
                spots[kind].plot(*_on_screen(angle, size), "o", color=MARK, markersize=5)
                spots["curve"].plot(
                    fine, curves[kind], color=color, linestyle="-" if kind == kinds[0] else "--", label=kind
                )
            spots["curve"].axvline(angle, color=INK, linewidth=1)
            spots["curve"].set(xlabel="angle of the square, degrees", ylabel="at the mark", xlim=(0, 180), ylim=(0, 1))
            spots["curve"].set_xticks(range(0, 181, 45))
            spots["curve"].legend(fontsize=8, ncols=2, loc="lower right")
        drawings.append(drawn(fig))
    return drawings


def _on_screen(angle_deg: float, size: int) -> tuple[float, float]:
    """Pixel of the probed point."""
    turn = np.radians(angle_deg)
    x = _PROBE[0] * np.cos(turn) - _PROBE[1] * np.sin(turn)
    z = _PROBE[0] * np.sin(turn) + _PROBE[1] * np.cos(turn)
    half = 40 * np.tan(np.radians(4.2 / 2))
    return size / 2 * (1 + x / half) - 0.5, size / 2 * (1 - z / half) - 0.5


_PIPE = 'shape = "cylinder"\nradius = "1 m"\nheight = "4 m"\ntransform = {{ translate = [0, 0, -2] }}'
PIPE_LIGHT_DEG = -30.0


def pipe(mode: str, sides: int, width: int, height: int = 3) -> Array:
    """The middle of a matte cylinder, seen from far, light from the left: rows of brightness, shape (height, width).

    Its rim is left out: colours of vertices behind it, which see the light from the back, would run into it.
    """
    scene = _scene(_PIPE.replace("{{", "{").replace("}}", "}"), (width, height), fov=2.05)
    light = _light(PIPE_LIGHT_DEG, 0)
    matte = Classic(ka=0, kd=0.9, ks=0, lights=[(tuple(float(v) for v in light), (1.0, 1.0, 1.0))])
    shaded = shade(scene, shading=mode, tessellation=sides, classic=matte, supersampling=2)
    return cast("Array", shaded.rgb[..., 0].astype(float))


def inhibited(profile: Array, narrow: float = 4.0, wide: float = 10.0) -> Array:
    """What an eye with lateral inhibition makes of a profile: it, sharpened by a difference of Gaussians (pixels)."""

    def blurred(width: float) -> Array:
        reach = int(4 * width)
        kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
        padded = np.pad(profile, reach, mode="edge")
        return np.convolve(padded, kernel / kernel.sum(), mode="valid")

    return profile + 2.0 * (blurred(narrow) - blurred(wide))


def mach_bands(*, width: int = 300) -> Animation:
    """Mach bands.

    The middle of a cylinder of 8 to 24 flat sides. Where brightness has a step (flat) or a kink (Gouraud), the eye sees bands
    that are not there: lateral inhibition sharpens every change. Solid: the brightness along a row; dotted: after a simple
    model of that inhibition (a difference of Gaussians), which overshoots at steps and kinks.

    Parameters
    ----------
    width : int
        Pixels per row.

    Returns
    -------
    Animation
    """
    drawings = []
    for sides in (8, 10, 12, 16, 20, 24):
        with style():
            fig = figure(5.8, 3.4)
            grid = fig.subplots(2, 2, height_ratios=(1, 1.6), sharex=True)
            for column, mode in enumerate(("flat", "gouraud")):
                row = pipe(mode, sides, width)[1]
                picture = np.repeat(np.repeat(row[np.newaxis, :, np.newaxis], 70, axis=0), 3, axis=2)
                show(grid[0, column], encoded(picture), f"{_TITLES[mode]}, {sides} sides")
                grid[0, column].set_aspect("auto")
                axes = grid[1, column]
                axes.plot(row, color=CURVES[0], linewidth=1.4, label="brightness")
                axes.plot(inhibited(row), color=CURVES[1], linestyle=":", linewidth=1.6, label="as seen")
                axes.set(ylim=(0, 1.25), xlim=(0, width - 1), xticks=[], xlabel="across the cylinder")
            # the curve of Gouraud shading is high there for every number of sides
            grid[1, 1].legend(fontsize=8, loc="lower left")
            grid[1, 0].set_ylabel("brightness")
        drawings.append(drawn(fig))
    return Animation(drawings, seconds=0.9)
