"""An office in Lesk and in Radiance, point by point: `cargo xtask validate` where pyradiance is installed.

The room, its lamps and desks are written for both from the same numbers. Radiance runs without its ambient cache
(-aa 0), several times; the scatter of its runs is its error. Every point must agree within the combined error.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from tiles import sidak_limit

import lesk

SIZE = (6.0, 8.0, 2.8)
LAMPS = [(x, y) for y in (1.0, 3.0, 5.0, 7.0) for x in (1.0, 3.0, 5.0)]
LAMP_SIDE = 0.6
LUMINANCE = 3500.0
DESKS = [(x, y) for y in (2.1, 5.9) for x in (1.5, 4.5)]
DESK = (1.6, 1.6, 0.75)
REFLECTANCE = {"floor": 0.2, "wall": 0.6, "ceiling": 0.8, "desk": 0.4}
# Radiance's luminous efficacy
WHITE = 179.0
HEIGHT = 0.8
# of the whole comparison: one in a thousand runs fails by chance
ALPHA = 1e-3


def points() -> np.ndarray:
    """The points of both, shape (n, 3)."""
    x, y = np.arange(0.75, 6, 0.5), np.arange(0.75, 8, 0.5)
    return np.array([(a, b, HEIGHT) for b in y for a in x])


def lesk_scene() -> str:
    """The scene file."""
    w, d, h = SIZE
    text = "version = 1\ncamera = { eye = [1, 1, 1.5], target = [4, 6, 1] }\n"
    for name, rho in REFLECTANCE.items():
        text += f'[materials.{name}]\nmodel = "lambert"\nreflectance = {rho}\n'

    def rectangle(a: float, b: float, material: str, steps: str, light: str = "") -> str:
        look = f'material = "{material}"\n' if material else ""
        return f'[[objects]]\nshape = "rectangle"\nwidth = "{a} m"\nheight = "{b} m"\n{look}transform = [{steps}]\n{light}\n'

    down = '{ rotate = "180 deg", axis = [1, 0, 0] }'
    text += rectangle(w, d, "floor", f"{{ translate = [{w / 2}, {d / 2}, 0] }}")
    text += rectangle(w, d, "ceiling", f"{down}, {{ translate = [{w / 2}, {d / 2}, {h}] }}")
    for x in (0, w):
        turn = '{ rotate = "90 deg", axis = [0, 1, 0] }'
        text += rectangle(h, d, "wall", f"{turn}, {{ translate = [{x}, {d / 2}, {h / 2}] }}")
    for y in (0, d):
        turn = '{ rotate = "90 deg", axis = [1, 0, 0] }'
        text += rectangle(w, h, "wall", f"{turn}, {{ translate = [{w / 2}, {y}, {h / 2}] }}")
    for x, y in LAMPS:
        light = f'light = {{ luminance = "{LUMINANCE} cd/m2" }}'
        text += rectangle(LAMP_SIDE, LAMP_SIDE, "", f"{down}, {{ translate = [{x}, {y}, {h - 0.001}] }}", light)
    for x, y in DESKS:
        text += f'[[objects]]\nshape = "cube"\nsize = {list(DESK)}\nmaterial = "desk"\n'
        text += f"transform = {{ translate = [{x}, {y}, {DESK[2] / 2}] }}\n"
    p = points()
    text += f'[[sensors]]\ntype = "grid"\nname = "plane"\ncorner = [0.5, 0.5, {HEIGHT}]\n'
    return text + f'u = [{len(set(p[:, 0])) / 2}, 0, 0]\nv = [0, {len(set(p[:, 1])) / 2}, 0]\nspacing = "0.5 m"\n'


def radiance_scene() -> str:
    """The same in Radiance's format."""
    w, d, h = SIZE
    text = ""
    for name, rho in REFLECTANCE.items():
        text += f"void plastic {name} 0 0 5 {rho} {rho} {rho} 0 0\n"
    glow = LUMINANCE / WHITE
    text += f"void light lamp 0 0 3 {glow} {glow} {glow}\n"
    count = 0

    def polygon(material: str, corners: list[tuple[float, float, float]]) -> None:
        nonlocal text, count
        count += 1
        numbers = " ".join(f"{c:.9g}" for corner in corners for c in corner)
        text += f"{material} polygon p{count} 0 0 {3 * len(corners)} {numbers}\n"

    def box(material: str, low: tuple[float, float, float], high: tuple[float, float, float], faces: dict) -> None:
        (a, b, c), (p, q, r) = low, high
        polygon(faces.get("floor", material), [(a, b, c), (a, q, c), (p, q, c), (p, b, c)])
        polygon(faces.get("ceiling", material), [(a, b, r), (p, b, r), (p, q, r), (a, q, r)])
        polygon(material, [(a, b, c), (a, b, r), (a, q, r), (a, q, c)])
        polygon(material, [(p, b, c), (p, q, c), (p, q, r), (p, b, r)])
        polygon(material, [(a, b, c), (p, b, c), (p, b, r), (a, b, r)])
        polygon(material, [(a, q, c), (a, q, r), (p, q, r), (p, q, c)])

    box("wall", (0, 0, 0), (w, d, h), {"floor": "floor", "ceiling": "ceiling"})
    for x, y in DESKS:
        box("desk", (x - DESK[0] / 2, y - DESK[1] / 2, 0), (x + DESK[0] / 2, y + DESK[1] / 2, DESK[2]), {})
    for x, y in LAMPS:
        s, z = LAMP_SIDE / 2, h - 0.001
        # the order of the corners makes it face down
        polygon("lamp", [(x - s, y - s, z), (x - s, y + s, z), (x + s, y + s, z), (x + s, y - s, z)])
    return text


def radiance(divisions: int, runs: int) -> np.ndarray:
    """Illuminances of several runs, lx, shape (runs, n)."""
    import pyradiance

    binaries = Path(pyradiance.__file__).parent / "bin"
    environment = {**os.environ, "RAYPATH": str(Path(pyradiance.__file__).parent / "lib")}
    rays = "".join(f"{x} {y} {z} 0 0 1\n" for x, y, z in points())
    options = [
        "-I",
        "-h",
        "-u+",
        "-ab",
        "14",
        "-aa",
        "0",
        "-ad",
        str(divisions),
        "-as",
        "0",
        "-lr",
        "-14",
        "-lw",
        "1e-5",
    ]
    options += ["-ds", "0.05", "-dj", "0.7", "-dt", "0", "-dc", "1"]
    with tempfile.TemporaryDirectory() as folder:
        scene, tree = Path(folder) / "office.rad", Path(folder) / "office.oct"
        scene.write_text(radiance_scene())
        with tree.open("wb") as out:
            subprocess.run([binaries / "oconv", scene], check=True, stdout=out, env=environment)
        found = []
        for k in range(runs):
            # its random numbers begin with the second in which it starts
            time.sleep(1.1 if k else 0)
            command = [binaries / "rtrace", *options, tree]
            done = subprocess.run(command, input=rays, check=True, capture_output=True, text=True, env=environment)
            rgb = np.array([line.split() for line in done.stdout.splitlines() if line.strip()], float)
            found.append(WHITE * rgb @ [0.265, 0.670, 0.065])
    return np.array(found)


def main() -> int:
    """Prints the comparison; 0 if every point agrees."""
    try:
        import pyradiance
    except ImportError:
        print("skipped: comparing with Radiance (pyradiance is not installed)")
        return 0
    quick = "--quick" in sys.argv[1:]
    divisions, count = (64, 4) if quick else (128, 8)
    runs = radiance(divisions, count)
    theirs, their_error = runs.mean(0), runs.std(0, ddof=1) / math.sqrt(len(runs))
    plane = lesk.measure(lesk_scene(), error=0.004 if quick else 0.002)["plane"]
    ours, our_error = plane.value.ravel(), plane.standard_error.ravel()
    np.testing.assert_allclose(plane.positions.reshape(-1, 3), points(), atol=1e-9)
    # few runs tell an error badly: use the mean relative one of all points, at least
    their_error = np.maximum(their_error, (their_error / theirs).mean() * theirs)
    z = (ours - theirs) / np.hypot(our_error, their_error)
    limit = sidak_limit(len(z), ALPHA)
    print(
        f"Radiance of pyradiance {getattr(pyradiance, '__version__', '?')}, -ab 14 -aa 0 -ad {divisions}, {count} runs"
    )
    print(f"{len(z)} points, mean {ours.mean():.2f} lx (Lesk), {theirs.mean():.2f} lx (Radiance)")
    print(
        f"relative difference: mean {(ours / theirs - 1).mean():+.5f}, greatest {np.abs(ours / theirs - 1).max():.5f}"
    )
    print(f"errors: Lesk {(our_error / ours).mean():.5f}, Radiance {(their_error / theirs).mean():.5f}")
    print(f"largest |z| {np.abs(z).max():.2f}, chance is below {limit:.2f}; mean z² {np.square(z).mean():.2f}")
    return 0 if np.abs(z).max() < limit else 1


if __name__ == "__main__":
    sys.exit(main())
