"""Illuminances in closed form, computed without the renderer: what `lesk validate lights` compares with.

Lengths in metres, angles in radians unless a name says degrees; luminances in cd/m², fluxes in lm, illuminances in lx.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def point(flux: float, source: list[float], at: list[float], normal: list[float]) -> float:
    """E = Φ/4π cos θ / d² of a point that shines alike in all directions."""
    toward = np.subtract(source, at)
    distance = float(np.linalg.norm(toward))
    return flux / (4 * math.pi) * max(0.0, float(np.dot(toward, normal))) / distance**3


def cone_intensity(flux: float, half_angle_deg: float) -> float:
    """I = Φ / 2π (1 - cos a) of a hard cone, cd."""
    return flux / (2 * math.pi * (1 - math.cos(math.radians(half_angle_deg))))


def smooth_spot_intensity(flux: float, inner_deg: float, outer_deg: float, angle_deg: float) -> float:
    """Intensity of a cone whose edge is a smooth step of the cosine, cd."""
    ci, co, c = (math.cos(math.radians(a)) for a in (inner_deg, outer_deg, angle_deg))
    peak = flux / (2 * math.pi * ((1 - ci) + (ci - co) / 2))
    s = min(1.0, max(0.0, (c - co) / (ci - co)))
    return peak * s * s * (3 - 2 * s)


def polygon(luminance: float, corners: Array, at: Array, normal: Array) -> float:
    """E of a Lambertian polygon by Lambert's formula, clipped at the horizon of the receiver.

    E = (L/2) |Σ θ_i (n . g_i)| with the angle θ_i that edge i subtends and the unit normal g_i of the plane through the
    edge and the receiver.
    """
    vectors = _clipped(np.asarray(corners, float) - at, np.asarray(normal, float))
    if len(vectors) < 3:
        return 0.0
    units = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    nexts = np.roll(units, -1, axis=0)
    planes = np.cross(units, nexts)
    sines = np.linalg.norm(planes, axis=1)
    angles = np.arctan2(sines, np.einsum("ij,ij->i", units, nexts))
    used = sines > 1e-14
    projected = (planes[used] / sines[used, None]) @ np.asarray(normal, float)
    return 0.5 * luminance * abs(float(np.dot(angles[used], projected)))


def _clipped(vectors: Array, normal: Array) -> Array:
    """The part of a polygon above the horizon (Sutherland & Hodgman)."""
    heights = vectors @ normal
    kept = []
    for i in range(len(vectors)):
        j = (i + 1) % len(vectors)
        if heights[i] >= 0:
            kept.append(vectors[i])
        if (heights[i] >= 0) != (heights[j] >= 0):
            kept.append(vectors[i] + (vectors[j] - vectors[i]) * heights[i] / (heights[i] - heights[j]))
    return np.array(kept)


def rectangle(center: list[float], half_u: list[float], half_v: list[float]) -> Array:
    """The corners of a rectangle."""
    c, u, v = (np.array(x, float) for x in (center, half_u, half_v))
    return np.array([c - u - v, c + u - v, c + u + v, c - u + v])


def parallel_factor(a: float, b: float, c: float) -> float:
    """Form factor of an element under the corner of a parallel rectangle a x b at distance c (Howell B-3)."""
    x, y = a / c, b / c
    first = x / math.sqrt(1 + x * x) * math.atan(y / math.sqrt(1 + x * x))
    second = y / math.sqrt(1 + y * y) * math.atan(x / math.sqrt(1 + y * y))
    return (first + second) / (2 * math.pi)


def perpendicular_factor(a: float, b: float, c: float) -> float:
    """Form factor of an element to a perpendicular rectangle of width a and height b at distance c (Howell B-4)."""
    x, y = b / a, c / a
    r = math.sqrt(x * x + y * y)
    return (math.atan(1 / y) - y / r * math.atan(1 / r)) / (2 * math.pi)


def disk(luminance: float, radius: float, height: float, aside: float) -> float:
    """E of a parallel disk at a distance `aside` from its axis."""
    if aside == 0:
        return math.pi * luminance * radius**2 / (radius**2 + height**2)
    h, r = height / aside, radius / aside
    z = 1 + h * h + r * r
    return math.pi * luminance * 0.5 * (1 - (z - 2 * r * r) / math.sqrt(z * z - 4 * r * r))


def sphere(luminance: float, radius: float, distance: float, cosine: float) -> float:
    """E of a sphere that is wholly above the horizon: π L (R/d)² cos θ, exactly that of a point."""
    return math.pi * luminance * (radius / distance) ** 2 * cosine


def line(intensity_per_metre: float, length: float, distance: float) -> float:
    """E opposite to the end of a diffuse line, on a plane that faces it: I'/2d (atan(l/d) + (l/d)/(1 + (l/d)²))."""
    x = length / distance
    return intensity_per_metre / (2 * distance) * (math.atan(x) + x / (1 + x * x))


def fresnel(n: float, angle_deg: float) -> float:
    """Reflectance of a boundary from air to index n, the mean of both polarisations."""
    theta = math.radians(angle_deg)
    inner = math.asin(math.sin(theta) / n)
    ci, ct = math.cos(theta), math.cos(inner)
    s, p = (ci - n * ct) / (ci + n * ct), (n * ci - ct) / (n * ci + ct)
    return (s * s + p * p) / 2


def slab(reflectance: float) -> float:
    """Transmittance of two boundaries with all reflections between them: (1 - R)/(1 + R), per polarisation."""
    return (1 - reflectance) / (1 + reflectance)


def slab_polarised(n: float, angle_deg: float) -> float:
    """The same for each polarisation of its own, then the mean."""
    theta = math.radians(angle_deg)
    inner = math.asin(math.sin(theta) / n)
    ci, ct = math.cos(theta), math.cos(inner)
    s, p = (ci - n * ct) / (ci + n * ct), (n * ci - ct) / (n * ci + ct)
    return (slab(s * s) + slab(p * p)) / 2


def enclosure_mean(flux: float, area: float, rho: float) -> float:
    """Mean indirect illuminance of a closed room of uniform diffuse reflectance: Φ ρ / (S (1 - ρ))."""
    return flux * rho / (area * (1 - rho))


def integrating_sphere(flux: float, radius: float, rho: float, port: float = 0.0) -> float:
    """Indirect illuminance in a sphere with the share `port` of its wall open: Φ ρ / (S (1 - ρ (1 - f)))."""
    return flux * rho / (4 * math.pi * radius**2 * (1 - rho * (1 - port)))


def cube(intensity: float, edge: float, rho: float, places: list[tuple[float, float]]) -> list[float]:
    """The limit of `cube_radiosity` for many cells, from 12 and 24: its error falls with the square of their size."""
    coarse, fine = (cube_radiosity(intensity, edge, rho, places, cells) for cells in (12, 24))
    return [f + (f - c) / 3 for c, f in zip(coarse, fine, strict=True)]


def cube_grid_mean(intensity: float, edge: float, rho: float, count: int) -> float:
    """Mean indirect illuminance at `count` x `count` midpoints of a face; the mean of the whole is `enclosure_mean`.

    The midpoint rule does not see the dark edges well: it gives 0.1 % too much for 20 x 20 points, and nearly a
    quarter of that for twice as many.
    """
    # a quarter of the face stands for all
    places = [(x, y) for x in _middles(count) for y in _middles(count) if x > 0 and y > 0]
    total = np.array(cube(intensity, edge, rho, places))
    return float(np.mean(total - _cube_direct(np.array(places), intensity, edge / 2)))


def _middles(count: int) -> list[float]:
    return [(2 * i + 1) / count - 1 for i in range(count)]


def cube_radiosity(
    intensity: float, edge: float, rho: float, places: list[tuple[float, float]], cells: int
) -> list[float]:
    """Total illuminance at places of a face, in half widths from its centre, of a point in the middle of a diffuse cube.

    Radiosity by collocation: the radiosity is constant on each of `cells` x `cells` squares of a face, and all faces are
    alike; form factors from points to squares are exact.
    """
    half = edge / 2
    centers = (np.arange(cells) + 0.5) / cells * 2 - 1
    grid = np.stack(np.meshgrid(centers, centers, indexing="ij"), axis=-1).reshape(-1, 2)
    # the mean over each square, so that no flux is lost: the midpoint rule on 16 x 16 parts
    fine = (np.arange(16 * cells) + 0.5) / (16 * cells) * 2 - 1
    fine_grid = np.stack(np.meshgrid(fine, fine, indexing="ij"), axis=-1)
    direct: Array = _cube_direct(fine_grid, intensity, half).reshape(cells, 16, cells, 16).mean((1, 3)).reshape(-1)
    matrix = np.array([_cube_factors(x, y, cells) for x, y in grid])
    total = np.linalg.solve(np.eye(len(grid)) - rho * matrix, direct)
    wanted = np.array(places, float)
    at = np.array([_cube_factors(x, y, cells) for x, y in wanted])
    return [float(v) for v in _cube_direct(wanted, intensity, half) + rho * (at @ total)]


def _cube_direct(places: Array, intensity: float, half: float) -> Array:
    square = 1 + (places**2).sum(-1)
    return np.asarray(intensity / half**2 / square**1.5, np.float64)


def _cube_factors(x: float, y: float, cells: int) -> Array:
    """Form factors from the point (x, y) of the face z = -1 to the squares of the other faces, by square of a face."""
    edges = np.linspace(-1, 1, cells + 1)
    top = _parallel(edges - x, edges - y, 2.0)
    sum_ = top
    # the walls x = +-1 (coordinates y, z) and y = +-1 (coordinates x, z); by symmetry a wall's square (a, z) is the face's
    # square (a, z), and z = -1 is the edge at the point's own face
    for distance, along in ((1 - x, y), (1 + x, y), (1 - y, x), (1 + y, x)):
        sum_ = sum_ + _perpendicular(edges - along, edges + 1, distance)
    return sum_.reshape(-1)


def _parallel(a: Array, b: Array, c: float) -> Array:
    x, y = np.meshgrid(a / c, b / c, indexing="ij")
    rx, ry = np.sqrt(1 + x * x), np.sqrt(1 + y * y)
    corner = (x / rx * np.arctan(y / rx) + y / ry * np.arctan(x / ry)) / (2 * math.pi)
    return np.asarray(np.diff(np.diff(corner, axis=0), axis=1))


def _perpendicular(a: Array, b: Array, c: float) -> Array:
    """Rectangles with corners at offset a along the wall and height b above the element, at distance c."""
    c = max(c, 1e-12)
    offset, height = np.meshgrid(a, b, indexing="ij")
    r = np.sqrt(height**2 + c**2)
    corner = (np.arctan(offset / c) - c / r * np.arctan(offset / r)) / (2 * math.pi)
    return np.asarray(np.diff(np.diff(corner, axis=0), axis=1))


def cosine_cone(half_angle_deg: float) -> float:
    """Share of a uniform sky's illuminance that comes from a cone around the zenith: sin² a."""
    return math.sin(math.radians(half_angle_deg)) ** 2


def overcast_cone(half_angle_deg: float) -> float:
    """The same of the traditional overcast sky: (3/7) sin² a + (4/7)(1 - cos³ a)."""
    a = math.radians(half_angle_deg)
    return 3 / 7 * math.sin(a) ** 2 + 4 / 7 * (1 - math.cos(a) ** 3)


# a, b, c, d, e of CIE S 011 for types 1 to 15
CIE_SKIES = (
    (4, -0.7, 0, -1, 0), (4, -0.7, 2, -1.5, 0.15), (1.1, -0.8, 0, -1, 0), (1.1, -0.8, 2, -1.5, 0.15), (0, -1, 0, -1, 0),
    (0, -1, 2, -1.5, 0.15), (0, -1, 5, -2.5, 0.3), (0, -1, 10, -3, 0.45), (-1, -0.55, 2, -1.5, 0.15),
    (-1, -0.55, 5, -2.5, 0.3), (-1, -0.55, 10, -3, 0.45), (-1, -0.32, 10, -3, 0.45), (-1, -0.32, 16, -3, 0.3),
    (-1, -0.15, 16, -3, 0.3), (-1, -0.15, 24, -2.8, 0.15),
)  # fmt: skip


HOSEK_SKIES = {
    (2, 20): 11218.3,
    (2, 60): 15206.3,
    (3, 40): 16227.2,
    (5, 20): 16725.1,
    (5, 60): 25499.1,
}
"""Illuminance of a horizontal plane by the skies of Hosek and Wilkie over a ground of 0.2, without the sun: turbidity,
elevation of the sun in degrees. The authors' code (version 1.4a) was run for these, 360 to 719 nm, K_m 683.002 lm/W."""

HOSEK_SUNS = {(2, 40): 76792.7, (3, 20): 60910.7, (6, 60): 72777.6}
"""Illuminance of a plane perpendicular to the sun by its disk of 0.51 degrees, likewise."""


def cie_sky(number: int, elevation_deg: float) -> float:
    """Horizontal illuminance over zenith luminance of a CIE general sky: the midpoint rule on 1000 x 1000 cells."""
    a, b, c, d, e = CIE_SKIES[number - 1]
    sun = math.pi / 2 - math.radians(elevation_deg)
    n = 1000
    square = (np.arange(n) + 0.5) / n
    # cells of equal sin² Z: cos Z sin Z dZ is half their width
    z = np.arcsin(np.sqrt(square))[:, None]
    azimuth = 2 * math.pi * square[None, :]
    chi = np.arccos(np.clip(math.cos(sun) * np.cos(z) + math.sin(sun) * np.sin(z) * np.cos(azimuth), -1, 1))

    def indicatrix(x: Array) -> Array:
        return np.asarray(1 + c * (np.exp(d * x) - math.exp(d * math.pi / 2)) + e * np.cos(x) ** 2)

    gradation = (1 + a * np.exp(b / np.cos(z))) / (1 + a * math.exp(b))
    relative = indicatrix(chi) * gradation / indicatrix(np.array(sun))
    return float(math.pi * relative.mean())


def ugr(background: float, sources: list[tuple[float, float, float]]) -> float:
    """UGR = 8 log10[(0.25/Lb) Σ L² ω / p²] from luminance, solid angle and position index of each source."""
    return 8 * math.log10(0.25 / background * sum(lum**2 * omega / p**2 for lum, omega, p in sources))
