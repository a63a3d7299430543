"""Measuring: an office of 6 x 8 m with twelve IES luminaires on a grid of 0.5 m, each point to 1 % standard error."""

from __future__ import annotations

import statistics
from pathlib import Path

from table import Row, Table
from timing import clock

import lesk

OFFICE = Path(__file__).resolve().parent.parent / "examples" / "scenes" / "office_luminaires.toml"
# 20 s on two cores
WANTED = 40.0


def run(quick: bool) -> list[Table]:
    """One row: seconds on one core against those that are wanted."""
    text = OFFICE.read_text(encoding="utf-8").replace('spacing = "25 cm"', 'spacing = "50 cm"')
    scene = lesk.scene.parse(text, OFFICE.parent)
    seconds, points, worst = [], 0, 0.0
    for seed in range(1 if quick else 3):
        start = clock()
        plane = lesk.measure(scene, sensors=["working plane"], error=0.01, seed=seed, threads=1)["working plane"]
        seconds.append(clock() - start)
        points, worst = plane.value.size, max(worst, plane.relative_error)
    median = statistics.median(seconds)
    table = Table("Measuring", "wanted")
    what = f"office of 12 IES luminaires, {points} points to 1 %, s of one core"
    row = Row(what, f"{median:.2f}", f"{WANTED:g}", WANTED / median, 1.0, 10.0)
    row.note = f"greatest standard error {100 * worst:.2f} %, all reflections"
    table.add(row)
    return [table]
