"""Small scenes made only of what Lesk and Mitsuba 3 define alike, and their spelling for both.

Metres, +z up; radiances and intensities are the numbers of the film: linear Rec.709 whose luminance is cd/m2 or cd.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

SIZE = 64
# Y of linear Rec.709
LUMINANCE = (0.212639, 0.715169, 0.072192)

GOLD = {"eta": [0.16, 0.42, 1.38], "k": [3.6, 2.47, 1.92]}
MATERIALS = {
    "white": ("lambert", {"reflectance": [0.75, 0.7, 0.6]}),
    "red": ("lambert", {"reflectance": [0.6, 0.05, 0.04]}),
    "blue": ("lambert", {"reflectance": [0.08, 0.2, 0.6]}),
    "gold": ("conductor", GOLD),
    "glass": ("dielectric", {"ior": 1.5}),
    "satin": ("ggx_conductor_separable", GOLD | {"alpha_x": 0.15, "alpha_y": 0.15}),
    "rough": ("ggx_conductor_separable", GOLD | {"alpha_x": 0.5, "alpha_y": 0.5}),
    "brushed": ("ggx_conductor_separable", GOLD | {"alpha_x": 0.1, "alpha_y": 0.4}),
    "frosted": ("rough_dielectric", {"ior": 1.5, "alpha_x": 0.2, "alpha_y": 0.2}),
}


def turn(degrees: float, axis: list[float]) -> tuple:
    return ("rotate", degrees, axis)


def move(x: float, y: float, z: float) -> tuple:
    return ("translate", [x, y, z])


def thing(shape: str, size: Any, material: str | None, *steps: tuple, radiance: list[float] | None = None) -> dict:
    return {"shape": shape, "size": size, "material": material, "steps": steps, "radiance": radiance}


FLOOR = thing("rectangle", [6, 6], "white")
WALL = thing("rectangle", [6, 3], "blue", turn(90, [1, 0, 0]), move(0, 2, 1.5))
DOWN = turn(180, [1, 0, 0])


def scene(depth: int, objects: list[dict], lights: tuple = (), environment: Any = None, **more: Any) -> dict:
    camera = more.pop("camera", ([0.3, -5.0, 2.4], [0, 0, 0.6], 40.0))
    return {"camera": camera, "depth": depth, "objects": objects, "lights": lights, "environment": environment} | more


def rows_of(name: str, step: list[float], count: int = 10) -> list[dict]:
    return [thing("group", name, None, move(*(round(k * s, 9) for s in step))) for k in range(count)]


def lamps() -> dict:
    """Ten by ten by ten squares of 2 cm that shine downward, as groups of groups."""
    lamp = [
        thing("rectangle", [0.02, 0.02], None, DOWN, move(round(0.4 * k, 9), 0, 0), radiance=[9e3, 7e3 + 500 * k, 4e3])
        for k in range(10)
    ]
    groups = {"row": lamp, "layer": rows_of("row", [0, 0.35, 0]), "cloud": rows_of("layer", [0, 0, 0.12])}
    ball = thing("sphere", 0.4, "red", move(0.5, -0.6, 0.4))
    cloud = thing("group", "cloud", None, move(-1.8, -1.6, 1.0))
    return scene(3, [FLOOR, WALL, ball, cloud], groups=groups)


LAMP = thing("rectangle", [1.6, 1.6], None, DOWN, move(-0.5, -0.5, 2.9), radiance=[900, 700, 500])

CLOSE = ([0.3, -2.5, 0.6], [0, 0, 0], 44.0)

SCENES = {
    "diffuse_point": scene(
        4,
        [
            FLOOR,
            WALL,
            thing("cube", [0.8, 0.8, 1.2], "red", turn(25, [0, 0, 1]), move(-0.9, 0.3, 0.6)),
            thing("sphere", 0.5, "white", move(0.8, -0.4, 0.5)),
        ],
        (([1.2, -1.5, 2.5], [3000, 2500, 2000]), ([-2.0, -1.0, 1.5], [200, 500, 900])),
    ),
    "diffuse_area": scene(
        6,
        [
            FLOOR,
            WALL,
            thing("cylinder", [0.4, 1.1], "red", move(-0.9, 0.2, 0)),
            thing("sphere", 0.5, "white", move(0.8, -0.4, 0.5)),
            thing("disk", 0.5, "blue", turn(60, [0, 1, 0]), move(0.0, -1.2, 0.5)),
            thing("sphere", 0.15, None, move(0.1, 0.3, 1.6), radiance=[3000, 2000, 1500]),
            LAMP,
        ],
    ),
    "smooth_area": scene(
        8,
        [
            FLOOR,
            WALL,
            thing("sphere", 0.55, "gold", move(-0.8, 0.2, 0.55)),
            thing("sphere", 0.5, "glass", move(0.7, -0.5, 0.55)),
            thing("sphere", 0.8, None, move(-0.3, -0.5, 2.6), radiance=[300, 280, 240]),
        ],
    ),
    "rough_conductor_area": scene(
        5,
        [
            FLOOR,
            WALL,
            thing("sphere", 0.55, "satin", move(-0.8, 0.2, 0.55)),
            thing("sphere", 0.5, "rough", move(0.7, -0.3, 0.5)),
            thing("rectangle", [1.2, 0.9], "brushed", turn(20, [0, 0, 1]), turn(15, [1, 0, 0]), move(0.2, -1.3, 0.3)),
            LAMP,
        ],
    ),
    "conductors_environment": scene(
        5,
        [
            FLOOR,
            thing("sphere", 0.55, "satin", move(-0.8, 0.2, 0.55)),
            thing("sphere", 0.5, "gold", move(0.7, -0.3, 0.5)),
            thing("rectangle", [1.2, 0.9], "brushed", turn(30, [1, 0, 0]), move(0.2, -1.3, 0.4)),
        ],
        environment="map",
    ),
    "rough_dielectric_environment": scene(
        8,
        [
            FLOOR,
            thing("sphere", 0.55, "frosted", move(-0.8, 0.2, 0.6)),
            thing("cube", [0.9, 0.3, 0.8], "frosted", turn(30, [0, 0, 1]), move(0.7, -0.5, 0.45)),
            thing("sphere", 0.3, "red", move(0.9, 0.6, 0.3)),
        ],
        environment="map",
    ),
    "sky": scene(
        5,
        [
            FLOOR,
            thing("sphere", 0.5, "rough", move(-0.7, 0.2, 0.5)),
            thing("sphere", 0.5, "glass", move(0.7, -0.5, 0.55)),
        ],
        environment=[200, 260, 340],
    ),
    "thousand_lights": lamps(),
    # nothing but one body under a sky, close up: a refractive index off by 0.01 or an extinction by 0.1 is seen
    "glass_close": scene(12, [thing("sphere", 1.0, "glass")], environment="map", camera=CLOSE),
    "gold_close": scene(4, [thing("sphere", 1.0, "gold")], environment=[200, 260, 340], camera=CLOSE),
}


def radiance_of_map(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The environment at places (x, y) of its picture, each 0 to 1 from the upper left: a sky, a ground, a soft sun."""
    theta, phi = math.pi * y, 2 * math.pi * (x - 0.5)
    # right, forward, up
    d = np.stack([np.sin(theta) * np.sin(phi), np.sin(theta) * np.cos(phi), np.cos(theta)], -1)
    sun = np.array([-0.48, -0.6, 0.64])
    glow = np.exp(12 * (d @ sun - 1))[..., None] * np.array([2500.0, 2000.0, 1400.0])
    blend = 1 / (1 + np.exp(-8 * d[..., 2:]))
    return blend * np.array([150.0, 220.0, 380.0]) + (1 - blend) * np.array([90.0, 70.0, 50.0]) + glow


MAP_SIZE = (512, 256)


def toml(name: str, environment_file: str) -> str:
    """The scene as a Lesk scene file."""
    s = SCENES[name]
    eye, target, fov = s["camera"]
    lines = [
        "version = 1",
        f'title = "{name}"',
        f'camera = {{ eye = {eye}, target = {target}, fov = "{fov} deg" }}',
        f'film = {{ size = [{SIZE}, {SIZE}], filter = "box" }}',
        f"render = {{ max_depth = {s['depth']} }}",
        "",
    ]
    used = {o["material"] for o in s["objects"]} - {None}
    for material in sorted(used):
        model, params = MATERIALS[material]
        body = "".join(f", {key} = {value}" for key, value in params.items())
        lines.append(f'materials.{material} = {{ model = "{model}"{body} }}')
    for group, objects in s.get("groups", {}).items():
        lines.append(f"groups.{group}.objects = [")
        lines += [f"  {toml_object(o)}," for o in objects] + ["]"]
    lines += ["objects = ["] + [f"  {toml_object(o)}," for o in s["objects"]] + ["]"]
    if s["lights"]:
        lines += ["lights = ["] + [f"  {toml_light(*light)}," for light in s["lights"]] + ["]"]
    if s["environment"] == "map":
        lines.append(f'environment = {{ type = "map", file = "{environment_file}", scale = 1 }}')
    elif s["environment"]:
        lines.append(f'environment = {{ type = "sky", {emission("luminance", s["environment"], "cd/m2")} }}')
    return "\n".join(lines) + "\n"


def emission(what: str, rgb: list[float], unit: str) -> str:
    amount = sum(weight * c for weight, c in zip(LUMINANCE, rgb, strict=True))
    return f'{what} = "{amount:.10g} {unit}", color = {rgb}'


def toml_light(position: list[float], intensity: list[float]) -> str:
    return f'{{ type = "point", position = {position}, {emission("intensity", intensity, "cd")} }}'


def toml_object(o: dict) -> str:
    size = o["size"]
    words = {
        "sphere": lambda: f'radius = "{size} m"',
        "disk": lambda: f'radius = "{size} m"',
        "rectangle": lambda: f'width = "{size[0]} m", height = "{size[1]} m"',
        "cube": lambda: f"size = {size}",
        "cylinder": lambda: f'radius = "{size[0]} m", height = "{size[1]} m", capped = false',
        "group": lambda: f'group = "{size}"',
    }[o["shape"]]()
    parts = [f'shape = "{o["shape"]}"', words]
    if o["material"]:
        parts.append(f'material = "{o["material"]}"')
    steps = [
        f'{{ rotate = "{s[1]} deg", axis = {s[2]} }}' if s[0] == "rotate" else f"{{ translate = {s[1]} }}"
        for s in o["steps"]
    ]
    if steps:
        parts.append(f"transform = [{', '.join(steps)}]")
    if o["radiance"]:
        parts.append(f"light = {{ {emission('luminance', o['radiance'], 'cd/m2')} }}")
    return f"{{ {', '.join(parts)} }}"
