"""Three test scenes as plain numbers, the same for every renderer (performance.md section 5). Metres, +y up.

An object is (name, positions, triangles, normals or None, material); a material is ("diffuse", rgb), ("conductor", rgb,
alpha), ("dielectric", ior, alpha), ("plastic", rgb, alpha) or ("emit", rgb).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Object = tuple[str, np.ndarray, np.ndarray, np.ndarray | None, tuple]


@dataclass
class Scene:
    """`camera` is eye, target, horizontal field of view in degrees; `depth` counts segments of a path."""

    camera: tuple[Any, Any, float]
    objects: list[Object]
    environment: np.ndarray | None = None
    depth: int = 8
    # performance.md: least and hoped-for factor in Msamples/s and in time to equal error
    rate_targets: tuple = (None, None)
    error_targets: tuple = (1.2, 2.5)


def quad(center: Any, u: Any, v: Any) -> tuple[np.ndarray, np.ndarray]:
    c, u, v = (np.asarray(a, float) for a in (center, u, v))
    return np.array([c - u - v, c + u - v, c + u + v, c - u + v]), np.array([[0, 1, 2], [0, 2, 3]])


def icosphere(level: int) -> tuple[np.ndarray, np.ndarray]:
    """Unit sphere: the icosahedron, each triangle cut into four `level` times."""
    g = (1 + 5**0.5) / 2
    v = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g]]
    v += [[0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]]
    f = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
    ]
    f += [
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ]
    vertices, faces = np.array(v, float), np.array(f)
    for _ in range(level):
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, which = np.unique(edges, axis=0, return_inverse=True)
        middle = len(vertices) + which.reshape(-1, 3)
        vertices = np.concatenate([vertices, vertices[unique].mean(1)])
        a, b, c = faces.T
        ab, bc, ca = middle.T
        corners = [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        faces = np.concatenate([np.stack(t, -1) for t in corners])
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), faces


def ball(name: str, center: Any, radius: float, material: tuple, level: int = 4) -> Object:
    v, f = icosphere(level)
    return name, v * radius + np.asarray(center), f, v, material


def cornell() -> Scene:
    white, red, green = (("diffuse", c) for c in ((0.885, 0.699, 0.667), (0.57, 0.043, 0.044), (0.105, 0.378, 0.076)))
    light = ("emit", (18.387, 13.9873, 6.75357))
    walls = [
        ("floor", (0, -1, 0), (1, 0, 0), (0, 0, -1), white),
        ("ceiling", (0, 1, 0), (1, 0, 0), (0, 0, 1), white),
        ("back", (0, 0, -1), (1, 0, 0), (0, 1, 0), white),
        ("left", (-1, 0, 0), (0, 0, -1), (0, 1, 0), red),
        ("right", (1, 0, 0), (0, 0, 1), (0, 1, 0), green),
        ("light", (0, 0.99, 0), (0.23, 0, 0), (0, 0, 0.19), light),
    ]
    objects: list[Object] = [(name, *quad(c, u, v), None, material) for name, c, u, v, material in walls]
    objects.append(ball("metal", (-0.4, -0.6, -0.3), 0.4, ("conductor", (0.95, 0.79, 0.45), 0.15), 5))
    objects.append(ball("glass", (0.4, -0.65, 0.3), 0.35, ("dielectric", 1.5, 0.1), 5))
    return Scene(((0, 0, 3.9), (0, 0, 0), 39.3), objects, rate_targets=(0.8, 1.3))


GROUND = quad((0, -0.35, 0), (6, 0, 0), (0, 0, -6))
ABOVE = ((0, 3.2, 4.6), (0, -0.1, 0), 45.0)


def glossy() -> Scene:
    """Twenty balls of rising roughness under a sky with a sun."""
    objects: list[Object] = [("ground", *GROUND, None, ("diffuse", (0.5, 0.5, 0.5)))]
    rng = np.random.default_rng(1)
    for i in range(5):
        for j, a in enumerate((0.05, 0.1, 0.2, 0.35)):
            c = tuple(rng.uniform(0.2, 0.9, 3))
            kinds = [("conductor", c, a), ("plastic", c, a), ("dielectric", 1.5, a)]
            kinds += [("conductor", c, a * 1.3), ("plastic", c, a * 1.3)]
            objects.append(ball(f"ball{i}{j}", ((i - 2) * 0.8, 0, (j - 1.5) * 0.8), 0.35, kinds[i]))
    h, w = 256, 512
    y, x = np.meshgrid(np.linspace(0, np.pi, h), np.linspace(0, 2 * np.pi, w), indexing="ij")
    d = np.stack([np.sin(y) * np.cos(x), np.cos(y), np.sin(y) * np.sin(x)], -1)
    sky = np.array([0.4, 0.6, 1.0]) * (0.3 + 0.7 * d[..., 1:2])
    sun = np.array([0.5, 0.7, 0.5]) / np.linalg.norm([0.5, 0.7, 0.5])
    glow = 400 * np.exp((d @ sun - 1) * 1500)[..., None] * np.array([1, 0.9, 0.7])
    picture = np.where(d[..., 1:2] > 0, sky, np.array([0.15, 0.12, 0.1])) + glow
    return Scene(ABOVE, objects, picture.astype(np.float32))


def many_lights(count: int = 1000) -> Scene:
    """Squares of 2 cm that shine downward, as bright together as a thousand, and twelve balls."""
    # the balls stay where they are, whatever the number of lights
    rng, balls = np.random.default_rng(2), np.random.default_rng(2)
    balls.uniform(size=3 * 1000)
    strength = 1000 / count
    quads = [
        quad((rng.uniform(-4, 4), rng.uniform(0.02, 0.5), rng.uniform(-4, 4)), (0.01, 0, 0), (0, 0, 0.01))
        for _ in range(count)
    ]
    positions = np.concatenate([v for v, _ in quads])
    triangles = np.concatenate([f + 4 * k for k, (_, f) in enumerate(quads)])
    objects: list[Object] = [
        ("ground", *GROUND, None, ("diffuse", (0.6, 0.6, 0.6))),
        ("lights", positions, triangles, None, ("emit", (60.0 * strength, 50.0 * strength, 40.0 * strength))),
    ]
    for k in range(12):
        place = (balls.uniform(-2.5, 2.5), 0, balls.uniform(-2.5, 2.5))
        c = tuple(balls.uniform(0.3, 0.8, 3))
        objects.append(ball(f"ball{k}", place, 0.3, ("diffuse", c) if k % 2 else ("plastic", c, 0.15)))
    return Scene(ABOVE, objects, depth=4, error_targets=(2.0, 7.0))


SCENES = {"cornell": cornell, "glossy": glossy, "many lights": many_lights}
