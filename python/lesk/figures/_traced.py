"""Figures that are path traced: kinds of light paths, appearance, light sources."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
import numpy.typing as npt

from lesk._render import Render, render
from lesk.figures._sheet import show
from lesk.image import develop
from lesk.plot._figure import LUMINANCE, Array, Plot, figure, style
from lesk.scene import parse

SPLITS = ("direct", "indirect", "specular", "caustic")
_PATHS = {
    "direct": "light, one rough surface, eye",
    "indirect": "two or more rough surfaces",
    "specular": "seen in a mirror or through glass",
    "caustic": "focused on a rough surface",
}
_SEED = 1


def light_paths(*, spp: int = 96) -> Plot:
    """Kinds of light paths.

    One room, its light split by the path that it took (after Ritschel et al. 2012): direct, indirect, specular and caustic
    light add up to the picture. Percentages are shares of the mean luminance.

    Parameters
    ----------
    spp : int
        Samples per pixel.

    Returns
    -------
    Plot
        A matplotlib figure; all pictures have the same exposure.
    """
    text = files("lesk").joinpath("data", "light_paths.toml").read_text(encoding="utf-8")
    picture = render(parse(text), spp=spp, split=SPLITS, seed=_SEED)
    layers = picture.layers
    total = float((picture.rgb @ LUMINANCE).mean())
    with style():
        fig = figure(8.6, 5.1)
        fig.set_layout_engine("constrained", h_pad=0.12)
        spots = fig.subplot_mosaic(
            [["all", "direct", "indirect"], ["all", "specular", "caustic"]], width_ratios=(1.35, 1, 1)
        )
        show(spots["all"], exposed(picture.rgb, picture), "all paths")
        for name in SPLITS:
            layer = np.stack([layers[f"{name}.{c}"] for c in "RGB"], axis=-1)
            share = 100 * float((layer @ LUMINANCE).mean()) / total
            show(spots[name], exposed(layer, picture), f"{name}, {share:.1f} %", _PATHS[name])
    return fig


def exposed(linear: npt.NDArray[Any], like: Render) -> Array:
    """Develop linear pixels in cd/m² as another picture is developed."""
    ev100 = like.ev100 if like.ev100 is not None else 0.0
    return np.clip(develop(linear, ev100=ev100, mapper="srgb"), 0, 1).astype(np.float64)


_STAGE = """
version = 1
[camera]
eye = [0, -5.2, 1.7]
target = [0, 0, 0.62]
fov = "24 deg"
ev100 = "{ev}"
[film]
size = [{size}, {size}]
[render]
max_depth = 3
[materials.ground]
model = "lambert"
reflectance = 0.4
[materials.subject]
{material}
[[objects]]
shape = "disk"
radius = "8 m"
material = "ground"
[[objects]]
{shape}
material = "subject"
{light}
"""
_SHAPES = {
    "sphere": 'shape = "sphere"\nradius = "65 cm"\ntransform = { translate = [0, 0, 0.65] }',
    "cube": 'shape = "cube"\nedge = "1 m"\ntransform = [{ rotate = "30 deg" }, { translate = [0, 0, 0.5] }]',
    "teapot": 'shape = "teapot"\nlevel = 16\ntransform = [{ scale = 0.29 }, { rotate = "-20 deg" }]',
}
_FAINT = '[environment]\ntype = "sky"\nluminance = "1.5 cd/m2"'
"""A sky that keeps shadows from being black."""
_LIGHTS = {
    "point": '[[lights]]\ntype = "point"\nposition = [-1.6, -1.8, 2.6]\nintensity = "{power} cd"\n' + _FAINT,
    "spot": '[[lights]]\ntype = "spot"\nposition = [-1.6, -1.8, 2.6]\ntarget = [0, 0, 0.5]\ninner = "9 deg"\n'
    'outer = "13 deg"\nintensity = "{power} cd"\n' + _FAINT,
    "directional": '[[lights]]\ntype = "directional"\ndirection = [1.6, 1.8, -2.3]\nilluminance = "75 lx"\n' + _FAINT,
    "area": '[[objects]]\nshape = "rectangle"\nwidth = "1.4 m"\nheight = "1.4 m"\n'
    'transform = {{ look_at = {{ from = [-1.6, -1.8, 2.6], to = [0, 0, 0.5] }} }}\nlight = {{ flux = "1900 lm" }}\n'
    + _FAINT,
    "environment": '[environment]\ntype = "sky"\nluminance = "17 cd/m2"\ncolor = [0.75, 0.88, 1.0]',
}
_MATERIALS = {
    "matte": 'model = "lambert"\nreflectance = [0.55, 0.2, 0.1]',
    "plastic": 'model = "disney_2012"\nbase_color = [0.55, 0.2, 0.1]\nroughness = 0.25\nspecular = 0.5',
    "metal": 'model = "ggx"\nf0 = [0.955, 0.638, 0.538]\nalpha_x = 0.15\nalpha_y = 0.15',
}


@cache
def stage(shape: str, light: str, material: str, *, size: int = 150, spp: int = 48) -> Array:
    """Render the demo scene of one subject with a shape, a light and a material, by their names."""
    text = _STAGE.format(
        size=size,
        ev="4.2 EV",
        shape=_SHAPES[shape],
        material=_MATERIALS[material],
        light=_LIGHTS[light].format(power=600),
    )
    picture = render(text, spp=spp, seed=_SEED)
    return exposed(picture.rgb, picture)


def appearance(*, size: int = 150, spp: int = 48) -> Plot:
    """Surface appearance is geometry, light and reflectance.

    One demo scene, varied in one of the three at a time: each row changes its part only, the middle picture of
    each is the same. What we see is the product of all three.

    Parameters
    ----------
    size : int
        Pixels per side of a picture.
    spp : int
        Samples per pixel.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    base = ("sphere", "area", "plastic")
    rows = (
        ("geometry", 0, ("cube", "sphere", "teapot")),
        ("light", 1, ("point", "area", "environment")),
        ("reflectance", 2, ("matte", "plastic", "metal")),
    )
    with style():
        fig = figure(6.2, 6.6)
        grid = fig.subplots(3, 3)
        for line, (name, part, choices) in zip(grid, rows, strict=True):
            for axes, choice in zip(line, choices, strict=True):
                words = [*base]
                words[part] = choice
                shape, light, material = words
                show(axes, stage(shape, light, material, size=size, spp=spp), choice)
            line[0].set_ylabel(name, fontsize=11)
    return fig


def light_sources(*, size: int = 170, spp: int = 48) -> Plot:
    """Light sources.

    One scene under five lights: point, spot, directional, area with its penumbra, and an environment. A faint sky keeps
    shadows from being black. The point light has 600 cd, the directional light 75 lx, the area light 1900 lm, the
    environment 17 cd/m².

    Parameters
    ----------
    size : int
        Pixels per side of a picture.
    spp : int
        Samples per pixel.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    with style():
        fig = figure(1.9 * len(_LIGHTS), 2.3)
        for axes, name in zip(fig.subplots(1, len(_LIGHTS)), _LIGHTS, strict=True):
            show(axes, stage("teapot", name, "matte", size=size, spp=spp), name)
    return fig
