"""The models that Lesk and Mitsuba 3 define alike, and directions for them."""

from __future__ import annotations

import numpy as np

COLOR = [0.8, 0.3, 0.2]
GOLD = {"eta": [0.16, 0.42, 1.38], "k": [3.6, 2.47, 1.92]}

# the channels of a colour differ: Dr.Jit merges equal ones, and then does a third of the work
PAIRS: dict[str, tuple[str, dict, dict]] = {
    "diffuse": ("lambert", {"reflectance": COLOR}, {"type": "diffuse", "reflectance": COLOR}),
    "GGX conductor": (
        "ggx_conductor_separable",
        GOLD | {"alpha_x": 0.1, "alpha_y": 0.4},
        {"type": "roughconductor", "distribution": "ggx", "alpha_u": 0.1, "alpha_v": 0.4} | GOLD,
    ),
    "rough dielectric": (
        "rough_dielectric",
        {"ior": 1.5, "alpha_x": 0.2, "alpha_y": 0.2},
        {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.2, "int_ior": 1.5, "ext_ior": 1.0},
    ),
}


def directions(n: int, rng: np.random.Generator) -> np.ndarray:
    """Cosine-distributed, (n, 3)."""
    u = rng.random((2, n), dtype=np.float32)
    r, phi = np.sqrt(u[0]), 2 * np.pi * u[1]
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u[0])], -1).astype(np.float32)


def planar(vectors: np.ndarray) -> np.ndarray:
    """The same (n, 3) array with each component in an array of its own, as Dr.Jit holds it."""
    return np.ascontiguousarray(vectors.T).T
