"""Rays: Lesk's example `rays` against Embree 3 on the same meshes and rays, in alternating runs.

Each ray alone against Embree's single rays; 256 at once, as the path tracer casts them, against Embree's packets of 16.
"""

from __future__ import annotations

import re
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

from table import Row, Table

HERE = Path(__file__).resolve().parent
Rates = dict[tuple[str, str, str], float]
# the median of seven runs: both programs count processor time
KIND = re.compile(r"\s+(primary|bounce): ")
LINE = re.compile(r"\s+((?:nearest|any)(?: alone)?)\s+([\d.]+) \(best [\d.]+\)")


def build_embree(folder: Path) -> Path | None:
    """Compiles the small program with g++; None, and a line that says so, where that is impossible."""
    program = folder / "embree_rays"
    if not shutil.which("g++"):
        print("skipped: rays against Embree (g++ is missing)")
        return None
    command = ["g++", "-O3", "-march=native", str(HERE / "embree_rays.cpp"), "-lembree3", "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        print(f"skipped: rays against Embree ({done.stderr.strip().splitlines()[0]})")
        return None
    return program


def lesk_program() -> Path:
    """The example, built by cargo."""
    command = ["cargo", "build", "--release", "-p", "lesk-geometry", "--example", "rays", "--message-format=json"]
    out = subprocess.run(command, cwd=HERE.parent, capture_output=True, text=True, check=True).stdout
    return Path(re.findall(r'"executable":"([^"]+)"', out)[-1])


def parse_lesk(text: str) -> Rates:
    rates: Rates = {}
    meshes = iter(("70k", "1M"))
    mesh = kind = ""
    for line in text.splitlines():
        if "triangles: built" in line:
            mesh = next(meshes)
        elif found := KIND.match(line):
            kind = found[1]
        elif found := LINE.match(line):
            rates[mesh, kind, found[1]] = float(found[2])
    return rates


def parse_embree(text: str) -> tuple[Rates, int]:
    rates: Rates = {}
    disagree = 0
    for line in text.splitlines():
        match line.split():
            case [mesh, kind, "disagree", count]:
                disagree += int(count)
            case [mesh, kind, ("nearest" | "any") as query, median, _]:
                rates[mesh, kind, f"{query} alone"] = float(median)
            case [mesh, kind, ("nearest16" | "any16") as query, median, _]:
                rates[mesh, kind, query.removesuffix("16")] = float(median)
    return rates, disagree


def median_of(runs: list[Rates]) -> Rates:
    return {key: statistics.median(run[key] for run in runs) for key in runs[0]}


def run(quick: bool) -> list[Table]:
    """Two tables: Mrays/s of one thread."""
    alone = Table("Single rays, Mrays/s on one core", "Embree 3 intersect1, occluded1")
    together = Table("256 rays at once, Mrays/s on one core", "Embree 3 intersect16, occluded16")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        embree = build_embree(folder)
        if embree is None:
            return []
        lesk = lesk_program()
        ours, theirs, disagree = [], [], 0
        for _ in range(2 if quick else 5):
            ours.append(parse_lesk(output([str(lesk), name])))
            rates, disagree = parse_embree(output([str(embree), name]))
            theirs.append(rates)
    a, b = median_of(ours), median_of(theirs)
    for key, rate in a.items():
        mesh = {"70k": "82 k triangles", "1M": "1.3 M triangles"}[key[0]]
        row = Row(f"{mesh}, {key[1]}, {key[2].split()[0]}", f"{rate:.2f}", f"{b[key]:.2f}", rate / b[key])
        if key[2].endswith("alone"):
            row.must, row.aim = 0.8, 1.0
            alone.add(row)
        else:
            together.add(row)
    alone.rows[-1].note = f"{disagree} of 2 x 1.6 M distances differ by more than 1e-3"
    return [alone, together]


def output(command: list[str]) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout
