"""Path tracing: samples per second, and time to equal error, each renderer against its own converged mean."""

from __future__ import annotations

import itertools
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scenes import SCENES, Scene, many_lights
from table import Row, Table
from timing import clock

HERE = Path(__file__).resolve().parent
TARGET = 1e-2
Render = Callable[[int], tuple[np.ndarray, float]]


def rel_mse_99(pictures: list[np.ndarray]) -> float:
    """The relMSE of one picture without its worst 1 % of pixels, from pairs of independent seeds.

    The square of the difference of two pictures is twice the error of one. It is divided by the square of the mean of
    all pictures, blurred over 7 x 7 pixels so that no firefly divides by itself, plus 1e-2.
    """
    mean = np.mean(pictures, 0).mean(-1)
    h, w = mean.shape
    padded = np.pad(mean, 3, mode="edge")
    blurred = sum(padded[i : i + h, j : j + w] for i in range(7) for j in range(7)) / 49
    pairs = [((a - b) ** 2).mean(-1) / 2 for a, b in itertools.combinations(pictures, 2)]
    relative = np.sort((np.mean(pairs, 0) / (blurred**2 + 1e-2)).ravel())
    return float(relative[: int(0.99 * relative.size)].mean())


def lesk_render(scene: Scene, folder: Path, size: int, spp: int) -> Render:
    import lesk_side
    import scenes_lesk

    path = scenes_lesk.write(scene, folder, size)
    return lambda seed: lesk_side.render(path, spp, seed, threads=1)


def mitsuba_render(scene: Scene, size: int, spp: int) -> Render:
    import drjit as dr
    import scenes_mitsuba
    from mitsuba_side import VARIANT, mi

    if VARIANT.startswith("llvm"):
        dr.set_thread_count(1)
    loaded = scenes_mitsuba.load(scene, size)

    def render(seed: int) -> tuple[np.ndarray, float]:
        start = clock()
        picture = np.array(mi.render(loaded, spp=spp, seed=seed))
        return picture, clock() - start

    return render


@dataclass(frozen=True)
class Measured:
    """One renderer on one scene: Msamples/s, seconds to the target error, mean of the pictures, relMSE99 times spp."""

    rate: float
    to_target: float
    mean: float
    cost: float

    @staticmethod
    def of(pictures: list[np.ndarray], seconds: list[float], spp: int) -> Measured:
        """From pictures of independent seeds; the variance falls as 1 / samples."""
        median, error = statistics.median(seconds), rel_mse_99(pictures)
        samples = pictures[0].shape[0] * pictures[0].shape[1] * spp
        return Measured(samples / median * 1e-6, median * error / TARGET, float(np.mean(pictures)), error * spp)


def side_by_side(scene: Scene, size: int, spp: int, seeds: int) -> tuple[Measured, Measured]:
    """Lesk and Mitsuba in turns."""
    with tempfile.TemporaryDirectory() as folder:
        renders = (lesk_render(scene, Path(folder), size, spp), mitsuba_render(scene, size, spp))
        renders[1](99)  # compiles
        done: tuple[list, list] = ([], [])
        for seed in range(seeds):
            for runs, render in zip(done, renders, strict=True):
                runs.append(render(seed))
    ours, theirs = (Measured.of(*map(list, zip(*runs, strict=True)), spp) for runs in done)
    return ours, theirs


def cycles(name: str, size: int, spp: int, seeds: int) -> Measured | None:
    """Cycles in a process of its own; None, and a line that says so, where bpy is not installed.

    The environment variable LESK_CYCLES_PYTHON may name a Python that has bpy.
    """
    python = os.environ.get("LESK_CYCLES_PYTHON", sys.executable)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "cycles.npz"
        program = [python, str(HERE / "cycles_side.py"), name, *map(str, (size, spp, seeds)), str(out)]
        done = subprocess.run(program, capture_output=True, text=True)
        if done.returncode or not out.exists():
            lines = done.stderr.strip().splitlines() or ["it ended without a picture"]
            print(f"skipped: Cycles on {name} ({lines[-1]})")
            return None
        data = np.load(out)
        return Measured.of(list(data["pictures"]), list(data["seconds"]), spp)


def add_rows(table: Table, name: str, scene: Scene, ours: Measured, theirs: Measured) -> None:
    must, aim = scene.rate_targets if "Mitsuba" in table.peer else (None, None)
    ratio = ours.rate / theirs.rate
    row = Row(f"{name}, Msamples/s", f"{ours.rate:.2f}", f"{theirs.rate:.2f}", ratio, must, aim)
    row.note = f"mean of the pictures {ours.mean / theirs.mean - 1:+.1%}"
    table.add(row)
    must, aim = scene.error_targets
    ratio = theirs.to_target / ours.to_target
    row = Row(f"{name}, s to relMSE99 1e-2", f"{ours.to_target:.2f}", f"{theirs.to_target:.2f}", ratio, must, aim)
    row.note = f"relMSE99 x spp {ours.cost:.2f} and {theirs.cost:.2f}"
    table.add(row)


def ten_times_the_lights(size: int, spp: int, seeds: int) -> Table:
    """Lesk alone: what ten times as many lights cost at equal error."""
    table = Table("Ten times as many lights, Lesk alone", "1,000 lights")
    names = (1000, 10_000)
    with tempfile.TemporaryDirectory() as folder:
        renders = []
        for count in names:
            inner = Path(folder) / str(count)
            inner.mkdir()
            renders.append(lesk_render(many_lights(count), inner, size, spp))
        done: tuple[list, list] = ([], [])
        for seed in range(max(seeds, 3)):
            for runs, render in zip(done, renders, strict=True):
                runs.append(render(seed))
    few, many = (Measured.of(*map(list, zip(*runs, strict=True)), spp) for runs in done)
    ratio = few.to_target / many.to_target
    row = Row("10,000 lights, s to relMSE99 1e-2", f"{many.to_target:.2f}", f"{few.to_target:.2f}", ratio)
    row.must, row.aim = 1 / 1.6, 1 / 1.2
    row.note = f"relMSE99 x spp {many.cost:.2f} and {few.cost:.2f}"
    table.add(row)
    return table


def run(quick: bool) -> list[Table]:
    """A table against Mitsuba, one against Cycles where bpy is installed, and one of many lights."""
    from mitsuba_side import VARIANT

    size, spp, seeds = (256, 16, 2) if quick else (512, 32, 3)
    about = f"{size} x {size} pixels, {spp} samples, one thread"
    first = Table(f"Path tracing, {about}", f"Mitsuba {VARIANT}")
    second = Table(f"Path tracing against Cycles, {about}", "Cycles")
    for name, make in SCENES.items():
        scene = make()
        ours, mitsuba = side_by_side(scene, size, spp, seeds)
        add_rows(first, name, scene, ours, mitsuba)
        if blender := cycles(name, size, spp, seeds):
            add_rows(second, name, scene, ours, blender)
    third = ten_times_the_lights(size, spp, seeds)
    return [first, second, third] if second.rows else [first, third]
