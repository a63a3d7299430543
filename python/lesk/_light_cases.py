"""The cases of `lesk validate lights`: scenes whose illuminances are known in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lesk import _closed_forms as exact

UP = (0.0, 0.0, 1.0)
DOWN = '{ rotate = "180 deg", axis = [1, 0, 0] }'


@dataclass(frozen=True)
class Row:
    """One number that is known."""

    what: str
    """In words."""
    sensor: str
    """The sensor that reads it."""
    expected: float
    """The closed form, in the unit of the sensor."""
    deterministic: bool = False
    """Whether there is no noise: within 1e-5, instead of a z-test."""
    part: str = "value"
    """`value`, or the mean of the grid's `indirect` light."""
    reference_error: float = 0.0
    """Relative error of the reference where it is numerical."""


@dataclass
class Case:
    """A scene with its rows."""

    group: str
    """The heading in the table."""
    error: float = 0.0018
    """Relative standard error of each reading."""
    rows: list[Row] = field(default_factory=list)
    _parts: list[str] = field(default_factory=list)
    _materials: dict[str, str] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The scene file."""
        head = "version = 1\ncamera = { eye = [0, -9, 9], target = [0, 0, 0] }\n"
        materials = "".join(f"[materials.{name}]\n{body}\n" for name, body in self._materials.items())
        return head + materials + "\n".join(self._parts)

    def light(self, kind: str, **keys: object) -> Case:
        """Add a light that is no surface."""
        self._parts.append(_table("lights", type=kind, **keys))
        return self

    def sky(self, **keys: object) -> Case:
        """Add an environment."""
        self._parts.append("[environment]\n" + _keys(keys))
        return self

    def thing(self, shape: str, *, light: str = "", steps: Sequence[str] = (), **keys: object) -> Case:
        """Add an object."""
        text = _table("objects", shape=shape, **keys)
        text += f"transform = [{', '.join(steps)}]\n" if steps else ""
        self._parts.append(text + (f"light = {light}\n" if light else ""))
        return self

    def diffuse(self, rho: float) -> str:
        """Give the name of a diffuse material."""
        name = f"diffuse{str(rho).replace('.', '_')}"
        self._materials[name] = f'model = "lambert"\nreflectance = {rho}'
        return name

    def material(self, name: str, body: str) -> str:
        """Give the name of a material."""
        self._materials[name] = body
        return name

    def point(
        self, what: str, expected: float, at: Sequence[float], normal: Sequence[float] = UP, *, exact: bool = False,
        reference_error: float = 0.0, part: str = "value", **keys: object,
    ) -> Case:  # fmt: skip
        """Add a point of illuminance with the value that is known there."""
        name = f"s{len(self.rows)}"
        self._parts.append(_table("sensors", type="point", name=name, position=list(at), normal=list(normal), **keys))
        self.rows.append(Row(what, name, expected, exact, part, reference_error))
        return self

    def grid(
        self, what: str, expected: float, *, part: str = "value", reference_error: float = 0.0, **keys: object
    ) -> Case:
        """Add a grid whose mean is known."""
        name = f"s{len(self.rows)}"
        self._parts.append(_table("sensors", type="grid", name=name, **keys))
        self.rows.append(Row(what, name, expected, False, part, reference_error))
        return self

    def look(self, what: str, expected: float, at: Sequence[float], target: Sequence[float]) -> Case:
        """Add a luminance along a ray."""
        name = f"s{len(self.rows)}"
        keys = {"position": list(at), "target": list(target), "opening": "0 deg"}
        self._parts.append(_table("sensors", type="luminance", name=name, **keys))
        self.rows.append(Row(what, name, expected))
        return self


def _table(section: str, **keys: object) -> str:
    return f"[[{section}]]\n" + _keys(keys)


def _keys(keys: dict[str, object]) -> str:
    def word(value: object) -> str:
        if isinstance(value, bool):
            return str(value).lower()
        return f'"{value}"' if isinstance(value, str) else str(value)

    return "".join(f"{name} = {word(value)}\n" for name, value in keys.items())


def cases() -> Iterator[Case]:
    """Give all cases, in the order of the table."""
    yield from _points()
    yield from _surfaces()
    yield from _skies()
    yield from _cie_skies()
    yield from _hosek_skies()
    yield from _glass()
    yield from _rooms()


def _points() -> Iterator[Case]:
    case = Case("point").light("point", position=[0, 0, 3], flux="10000 lm")
    for r in range(6):
        expected = exact.point(1e4, [0, 0, 3], [r, 0, 0], [0, 0, 1])
        case.point(f"10 klm, 3 m high, {r} m aside", expected, (r, 0, 0), exact=True)
    case.point("on a wall", exact.point(1e4, [0, 0, 3], [2, 0, 1], [-1, 0, 0]), (2, 0, 1), (-1, 0, 0), exact=True)
    yield case
    led = Case("point").light("point", position=[0, 0, 1.5], flux="1100 lm")
    yield led.point("LED of 1100 lm at 1.5 m", 1100 / (4 * math.pi * 2.25), (0, 0, 0), exact=True)
    # 2 m away at 60 degrees from +z
    s, c = math.sin(math.pi / 3), 0.5
    perpendicular = 1600 / (4 * math.pi * 4)
    forms = Case("receivers").light("point", position=[2 * s, 0, 2 * c], flux="1600 lm")
    forms.point("planar", perpendicular * c, (0, 0, 0), exact=True)
    forms.point("cylindrical: E sin / pi", perpendicular * s / math.pi, (0, 0, 0), exact=True, receiver="cylindrical")
    half: dict[str, Any] = {"exact": True, "receiver": "semicylindrical"}
    toward = perpendicular * 2 * s / math.pi
    forms.point("semicylindrical, facing it: 2 E sin / pi", toward, (0, 0, 0), facing=[1, 0, 0], **half)
    forms.point("semicylindrical, sideways", toward / 2, (0, 0, 0), facing=[0, 1, 0], **half)
    forms.point("spherical: E / 4", perpendicular / 4, (0, 0, 0), exact=True, receiver="spherical")
    hemisphere = perpendicular * (1 + c) / 4
    yield forms.point("hemispherical: E (1 + cos) / 4", hemisphere, (0, 0, 0), exact=True, receiver="hemispherical")
    watts = Case("receivers").light("point", position=[0, 0, 2], flux="100 W", spectrum="E")
    keys: dict[str, Any] = {"quantity": "radiometric", "spectrum": "E"}
    yield watts.point("100 W in W/m2, spectrum E", 100 / (16 * math.pi), (0, 0, 0), exact=True, **keys)
    for angle in (15, 30, 45, 60):
        spot = Case("spot").light(
            "spot", position=[0, 0, 1], direction=[0, 0, -1], inner=f"{angle} deg", outer=f"{angle} deg", flux="1000 lm"
        )
        yield spot.point(f"1 klm in {angle} deg, 1 m", exact.cone_intensity(1000, angle), (0, 0, 0), exact=True)
    smooth = Case("spot").light(
        "spot", position=[0, 0, 2], direction=[0, 0, -1], inner="20 deg", outer="40 deg", flux="1000 lm"
    )
    for angle in (0, 25, 35):
        c = math.cos(math.radians(angle))
        expected = exact.smooth_spot_intensity(1000, 20, 40, angle) * c**3 / 4
        aside = 2 * math.tan(math.radians(angle))
        smooth.point(f"smooth edge 20 to 40 deg, at {angle} deg", expected, (aside, 0, 0), exact=True)
    yield smooth
    sun = Case("parallel light").light("directional", direction=[0.6, 0, -0.8], illuminance="1000 lx")
    sun.point("1000 lx, horizontal", 800, (0, 0, 0), exact=True)
    yield sun.point("1000 lx, vertical", 600, (0, 0, 0), (-1, 0, 0), exact=True)


def _surfaces() -> Iterator[Case]:
    down = [DOWN, "{ translate = [0, 0, 3] }"]
    panel = exact.rectangle([0, 0, 3], [1, 0, 0], [0, 0.5, 0])
    lamp = '{ luminance = "1000 cd/m2" }'
    case = Case("rectangle").thing("rectangle", width="2 m", height="1 m", steps=down, light=lamp)
    for x, y in ((0, 0), (1, 0), (2, 0), (0, 1), (0, 2), (1, 1), (2, 2), (4, 0)):
        expected = exact.polygon(1000, panel, np.array([x, y, 0.0]), np.array(UP))
        case.point(f"2 x 1 m, parallel, ({x}, {y})", expected, (x, y, 0))
    turned: tuple[tuple[str, Sequence[float], Sequence[float]], ...] = (
        ("perpendicular", (2, 0, 1), (-1, 0, 0)),
        ("tilted", (0.5, 0.3, 0), (0.6, 0, 0.8)),
        ("cut by the horizon", (0, 0, 2), (1, 0, 0)),
    )
    for what, at, normal in turned:
        expected = exact.polygon(1000, panel, np.array(at, float), np.array(normal, float))
        case.point(f"2 x 1 m, {what}", expected, at, normal)
    yield case
    corner = Case("rectangle").thing(
        "rectangle", width="1 m", height="1 m", steps=[DOWN, "{ translate = [0.5, 0.5, 1] }"], light=lamp
    )
    yield corner.point("under a corner, F(1,1,1)", math.pi * 1000 * exact.parallel_factor(1, 1, 1), (0, 0, 0))
    upright = ['{ rotate = "-90 deg", axis = [0, 1, 0] }', "{ translate = [2, 0.5, 0.75] }"]
    wall = Case("rectangle").thing("rectangle", width="1.5 m", height="1 m", steps=upright, light=lamp)
    expected = math.pi * 1000 * exact.perpendicular_factor(1, 1.5, 2)
    yield wall.point("wall on the floor, 1 x 1.5 m at 2 m", expected, (0, 0, 0))
    disk = Case("disk").thing(
        "disk", radius="0.5 m", steps=[DOWN, "{ translate = [0, 0, 2] }"], light='{ luminance = "5000 cd/m2" }'
    )
    for aside in (0, 0.5, 1, 2):
        disk.point(f"radius 0.5 m, {aside} m aside", exact.disk(5000, 0.5, 2, aside), (aside, 0, 0))
    yield disk
    ball = Case("sphere").thing("sphere", radius="0.25 m", steps=["{ translate = [0, 0, 2] }"], light=lamp)
    for what, normal, cosine in (("below", UP, 1.0), ("tilted 60 deg", (math.sqrt(0.75), 0, 0.5), 0.5)):
        ball.point(f"radius 0.25 m at 2 m, {what}", exact.sphere(1000, 0.25, 2, cosine), (0, 0, 0), normal)
    yield ball
    tube = Case("line").thing(
        "cylinder", radius="5 mm", height="2 m", capped=False, light='{ luminance = "20 kcd/m2" }'
    )
    # the radius changes these by (r/d)²/2, 5e-5 at most
    for d in (0.5, 1, 2):
        tube.point(f"200 cd/m, 2 m long, end at {d} m", exact.line(200, 2, d), (d, 0, 0), (-1, 0, 0))
    yield tube
    # thin and far from where it is asked: no digit of the ray may hide it
    wire = Case("line").thing(
        "cylinder", radius="1 mm", height="2 m", capped=False, light='{ luminance = "100 kcd/m2" }'
    )
    side = math.sqrt(0.5)
    for what, east, north in (("along x", 1.0, 0.0), ("diagonally", side, side)):
        at, normal = (3 * east, 3 * north, 0), (-east, -north, 0)
        wire.point(f"radius 1 mm, 3 m off {what}", exact.line(200, 2, 3), at, normal)
    yield wire
    floor = Case("luminance").light("point", position=[0, 0, 3], flux="10000 lm")
    floor.thing("rectangle", width="20 m", height="20 m", material=floor.diffuse(0.5))
    e = exact.point(1e4, [0, 0, 3], [1, 0, 0], [0, 0, 1])
    yield floor.look("diffuse floor: rho E / pi", 0.5 * e / math.pi, (0, -1, 1), (1, 0, 0))


def _skies() -> Iterator[Case]:
    dome = Case("sky").sky(type="sky", luminance="1000 cd/m2", dome=True)
    dome.point("uniform, horizontal: pi L", 1000 * math.pi, (0, 0, 0))
    dome.point("uniform, vertical: pi L / 2", 500 * math.pi, (0, 0, 0), (1, 0, 0))
    dome.point("uniform, spherical: pi L / 2", 500 * math.pi, (0, 0, 0), receiver="spherical")
    yield dome.point("uniform, cylindrical: pi L / 2", 500 * math.pi, (0, 0, 0), receiver="cylindrical")
    for angle in (15, 30, 45, 60):
        tube = Case("sky").sky(type="sky", luminance="1000 cd/m2", dome=True)
        height = 1 / math.tan(math.radians(angle))
        tube.thing("cylinder", radius="1 m", height=f"{height!r} m", capped=False, material=tube.diffuse(0.0))
        expected = 1000 * math.pi * exact.cosine_cone(angle)
        yield tube.point(f"uniform, cone of {angle} deg: sin2", expected, (0, 0, 0))


def _cie_skies() -> Iterator[Case]:
    for number, elevation in (
        (1, 30),
        (3, 30),
        (5, 30),
        (6, 15),
        (6, 60),
        (9, 30),
        (12, 15),
        (12, 60),
        (15, 30),
        (15, 60),
    ):
        sky = Case("CIE sky").sky(type="cie_sky", number=number, elevation=f"{elevation} deg", luminance="1000 cd/m2")
        expected = 1000 * exact.cie_sky(number, elevation)
        yield sky.point(f"type {number}, sun at {elevation} deg, horizontal", expected, (0, 0, 0))
    overcast = Case("CIE sky").sky(type="cie_sky", number=16, elevation="30 deg", luminance="1000 cd/m2")
    overcast.point("traditional overcast, horizontal: 7 pi / 9", 7000 * math.pi / 9, (0, 0, 0))
    yield overcast.point("traditional overcast, vertical", 0.396177 * 7000 * math.pi / 9, (0, 0, 0), (1, 0, 0))


def _hosek_skies() -> Iterator[Case]:
    for (turbidity, elevation), expected in exact.HOSEK_SKIES.items():
        sky = Case("Hosek sky").sky(type="hosek_sky", turbidity=turbidity, elevation=f"{elevation} deg", ground=0.2)
        yield sky.point(f"turbidity {turbidity}, sun at {elevation} deg, horizontal", expected, (0, 0, 0))
    for (turbidity, elevation), expected in exact.HOSEK_SUNS.items():
        sun = Case("Hosek sun").light("sun", turbidity=turbidity, elevation=f"{elevation} deg")
        height = math.sin(math.radians(elevation))
        yield sun.point(f"turbidity {turbidity}, at {elevation} deg, horizontal", expected * height, (0, 0, 0))


def _glass() -> Iterator[Case]:
    lamp = '{ luminance = "1000 cd/m2" }'
    up = [DOWN, "{ translate = [0, 0, 2] }"]
    surface = Case("Fresnel").thing("rectangle", width="200 m", height="200 m", steps=up, light=lamp)
    glass = surface.material("glass", 'model = "dielectric"\nior = 1.52')
    surface.thing("rectangle", width="40 m", height="40 m", material=glass)
    for angle in (0, 30, 45, 60, 70, 75, 80, 85):
        tan = math.tan(math.radians(angle))
        expected = 1000 * exact.fresnel(1.52, angle)
        surface.look(f"n = 1.52, reflected at {angle} deg", expected, (-0.5 * tan, 0, 0.5), (0, 0, 0))
    yield surface
    pane = Case("slab").thing("rectangle", width="200 m", height="200 m", steps=up, light=lamp)
    glass = pane.material("glass", 'model = "dielectric"\nior = 1.52')
    pane.thing("cube", size=[40, 40, 0.01], material=glass)
    for angle in (0, 30, 60, 75):
        tan = math.tan(math.radians(angle))
        expected = 1000 * exact.slab(exact.fresnel(1.52, angle))
        pane.look(f"clear, n = 1.52, {angle} deg, unpolarised transport", expected, (-0.5 * tan, 0, -0.5), (0, 0, 0))
    yield pane


def _rooms() -> Iterator[Case]:
    for rho in (0.2, 0.5, 0.8, 0.9, 0.95):
        room = Case("cube of 4 m", error=0.03).light("point", position=[0, 0, 0], flux="10000 lm")
        room.thing("cube", edge="4 m", material=room.diffuse(rho))
        edges: dict[str, Any] = {"corner": [-2, -2, -2], "u": [4, 0, 0], "v": [0, 4, 0], "spacing": "0.2 m"}
        expected = exact.cube_grid_mean(1e4 / (4 * math.pi), 4, rho, 20)
        what = f"rho {rho}: mean indirect of 20 x 20 points"
        yield room.grid(what, expected, part="indirect", reference_error=3e-4, **edges)
    places = [(0.0, 0.0), (0.5, 0.5), (0.75, 0.75)]
    for rho in (0.2, 0.5, 0.8):
        room = Case("cube of 4 m").light("point", position=[0, 0, 0], flux="10000 lm")
        room.thing("cube", edge="4 m", material=room.diffuse(rho))
        for (x, y), e in zip(places, exact.cube(1e4 / (4 * math.pi), 4, rho, places), strict=True):
            room.point(f"rho {rho}: at ({x}, {y}) half widths", e, (2 * x, 2 * y, -2), reference_error=3e-4)
        yield room
    places = [(0, 0), (0.4, 0), (0.8, 0), (0.4, 0.4), (0.8, 0.4), (0.8, 0.8)]
    flux = 5e4 * 4 * math.pi
    room = Case("cube of 10 m").light("point", position=[0, 0, 0], flux=f"{flux!r} lm")
    room.thing("cube", edge="10 m", material=room.diffuse(2 / 3))
    for (x, y), e in zip(places, exact.cube(5e4, 10, 2 / 3, places), strict=True):
        room.point(f"rho 2/3: at ({x}, {y}) half widths", e, (5 * x, 5 * y, -5), reference_error=1e-4)
    yield room
    yield from _spheres()
    yield from _furnaces()
    yield from _factors()


def _spheres() -> Iterator[Case]:
    for rho in (0.5, 0.8, 0.9):
        wall = Case("integrating sphere").light("point", position=[0, 0, 0], flux="1000 lm")
        wall.thing("sphere", radius="1 m", material=wall.diffuse(rho))
        expected = 1000 / (4 * math.pi) + exact.integrating_sphere(1000, 1, rho)
        yield wall.point(f"rho {rho}: lamp in the middle", expected, (0, 0, -1))
    for port in (0.05, 0.2):
        # a disk across the sphere closes a cap of this share of its surface
        z = 1 - 2 * port
        wall = Case("integrating sphere")
        wall.light("spot", position=[0, 0, 0], direction=[1, 0, 0], inner="30 deg", outer="30 deg", flux="1000 lm")
        wall.thing("sphere", radius="1 m", material=wall.diffuse(0.9))
        wall.thing(
            "disk", radius=f"{math.sqrt(1 - z * z)!r} m", steps=[f"{{ translate = [0, 0, {z!r}] }}"],
            material=wall.diffuse(0.0),
        )  # fmt: skip
        expected = exact.integrating_sphere(1000, 1, 0.9, port)
        yield wall.point(f"rho 0.9, port of {100 * port:g} %", expected, (0, 0, -1))


def _furnaces() -> Iterator[Case]:
    for shape, rho in (("cube", 0.2), ("cube", 0.8), ("sphere", 0.5), ("cylinder", 0.9)):
        oven = Case("furnace")
        light = '{ luminance = "100 cd/m2", two_sided = true }'
        oven.thing(shape, material=oven.diffuse(rho), light=light)
        oven.look(f"{shape}, rho {rho}: Le / (1 - rho)", 100 / (1 - rho), (0.1, 0.2, 0.3), (0.3, 0.4, 0.31))
        expected = math.pi * 100 / (1 - rho)
        yield oven.point(f"{shape}, rho {rho}: pi Le / (1 - rho)", expected, (0.1, 0.2, 0.3), (0.6, 0, 0.8))
    bodies = {"diffuse": 'model = "lambert"\nreflectance = 1', "mirror": 'model = "mirror"\nreflectance = 1'}
    bodies["glass"] = 'model = "dielectric"'
    for name, body in bodies.items():
        white = Case("white sky").sky(type="sky", luminance="50 cd/m2")
        white.thing("sphere", radius="1 m", material=white.material(name, body))
        yield white.look(f"a {name} sphere cannot be seen", 50, (0, -5, 0), (0.3, 0, 0.4))


def _factors() -> Iterator[Case]:
    lamp = '{ luminance = "1000 cd/m2" }'
    n = 16
    middles = (np.arange(n) + 0.5) / n
    edges: dict[str, Any] = {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": f"{1 / n} m"}
    opposite = Case("unit cube", error=0.01).thing(
        "rectangle", width="1 m", height="1 m", steps=[DOWN, "{ translate = [0.5, 0.5, 1] }"], light=lamp
    )
    square = exact.rectangle([0.5, 0.5, 1], [0.5, 0, 0], [0, 0.5, 0])
    expected = _mean(square, middles)
    yield opposite.grid("opposite faces, mean of 16 x 16 points", expected, **edges)
    turned = ['{ rotate = "90 deg", axis = [0, 1, 0] }', "{ translate = [0, 0.5, 0.5] }"]
    adjacent = Case("unit cube", error=0.01).thing("rectangle", width="1 m", height="1 m", steps=turned, light=lamp)
    square = exact.rectangle([0, 0.5, 0.5], [0, 0.5, 0], [0, 0, 0.5])
    yield adjacent.grid("adjacent faces, mean of 16 x 16 points", _mean(square, middles), **edges)


def _mean(square: exact.Array, middles: exact.Array) -> float:
    points = ((x, y, 0.0) for y in middles for x in middles)
    return float(np.mean([exact.polygon(1000, square, np.array(p), np.array(UP)) for p in points]))
