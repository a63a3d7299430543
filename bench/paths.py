"""Path tracing: samples per second, and time to equal error, each renderer against its own converged mean."""

from __future__ import annotations

import itertools
import statistics
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scenes import SCENES, Scene
from table import Row, Table
from timing import clock

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


def compare(name: str, scene: Scene, size: int, spp: int, seeds: int, table: Table) -> None:
    """Two rows: Msamples/s, and seconds to the error."""
    with tempfile.TemporaryDirectory() as folder:
        renders = {"lesk": lesk_render(scene, Path(folder), size, spp), "mitsuba": mitsuba_render(scene, size, spp)}
        renders["mitsuba"](99)  # compiles
        done: dict[str, list] = {who: [] for who in renders}
        for seed in range(seeds):
            for who, render in renders.items():
                done[who].append(render(seed))
    seconds = {who: statistics.median(t for _, t in runs) for who, runs in done.items()}
    pictures = {who: [p for p, _ in runs] for who, runs in done.items()}
    rate = {who: size * size * spp / t * 1e-6 for who, t in seconds.items()}
    error = {who: rel_mse_99(p) for who, p in pictures.items()}
    # variance falls as 1 / samples
    to_target = {who: seconds[who] * error[who] / TARGET for who in renders}
    means = {who: np.mean(p) for who, p in pictures.items()}
    row = Row(f"{name}, Msamples/s", f"{rate['lesk']:.2f}", f"{rate['mitsuba']:.2f}", rate["lesk"] / rate["mitsuba"])
    row.must, row.aim = scene.rate_targets
    row.note = f"mean of the pictures {means['lesk'] / means['mitsuba'] - 1:+.1%}"
    table.add(row)
    ratio = to_target["mitsuba"] / to_target["lesk"]
    must, aim = scene.error_targets
    row = Row(
        f"{name}, s to relMSE99 1e-2", f"{to_target['lesk']:.2f}", f"{to_target['mitsuba']:.2f}", ratio, must, aim
    )
    row.note = f"relMSE99 x spp {error['lesk'] * spp:.2f} and {error['mitsuba'] * spp:.2f}"
    table.add(row)


def run(quick: bool) -> list[Table]:
    """One table; Cycles has its own where it is installed."""
    from mitsuba_side import VARIANT

    size, spp, seeds = (256, 16, 2) if quick else (512, 32, 3)
    table = Table(f"Path tracing, {size} x {size} pixels, {spp} samples, one thread", f"Mitsuba {VARIANT}")
    for name, make in SCENES.items():
        compare(name, make(), size, spp, seeds, table)
    return [table]
