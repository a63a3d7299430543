"""Memory of a scene of ten million triangles from a binary PLY, in a process of its own (Linux)."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from table import Row, Table

# the mesh's own numbers: positions 12 B per vertex, half as many vertices as triangles, indices 12 B per triangle
SIDE = 2237
LIMIT_RESIDENT_GB, LIMIT_PEAK_GB = 1.6, 3.0
PROGRAM = """
import re, sys
import lesk
scene = lesk.scene.load(sys.argv[1])
status = open("/proc/self/status").read()
print(*(re.search(key + r":\\s+(\\d+) kB", status)[1] for key in ("VmRSS", "VmHWM")))
"""


def write(folder: Path, side: int) -> tuple[Path, int]:
    """A height field of 2 (side - 1)^2 triangles as a scene; gives its file and the number of triangles."""
    x, y = np.meshgrid(np.linspace(-1, 1, side, dtype="<f4"), np.linspace(-1, 1, side, dtype="<f4"), indexing="ij")
    z = 0.1 * np.sin(7 * x) * np.cos(5 * y) + 0.01 * np.sin(90 * x * y)
    a = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)[None, :]).ravel().astype("<i4")
    triangles = np.concatenate([np.stack([a, a + side, a + 1], -1), np.stack([a + 1, a + side, a + side + 1], -1)])
    faces = np.empty(len(triangles), [("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {side * side}"]
    lines += [f"property float {name}" for name in "xyz"]
    lines += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    with (folder / "field.ply").open("wb") as file:
        file.write("\n".join(lines).encode())
        file.write(np.stack([x, y, z], -1).astype("<f4").tobytes())
        file.write(faces.tobytes())
    scene = folder / "scene.toml"
    scene.write_text(
        "version = 1\n"
        "film = { size = [64, 64] }\n"
        'camera = { eye = [0, -3, 2], target = [0, 0, 0], up = [0, 0, 1], fov = "40 deg" }\n'
        'materials.grey = { model = "lambert" }\n'
        'objects = [{ shape = "mesh", file = "field.ply", material = "grey" }]\n'
        'environment = { type = "sky", luminance = "100 cd/m2" }\n'
    )
    return scene, len(triangles)


def run(quick: bool) -> list[Table]:
    """One table: gigabytes of the process with the scene loaded, and at the peak of building."""
    if not Path("/proc/self/status").exists():
        print("skipped: memory (no /proc/self/status)")
        return []
    side = SIDE // 3 if quick else SIDE
    with tempfile.TemporaryDirectory() as name:
        scene, count = write(Path(name), side)
        command = [sys.executable, "-c", PROGRAM, str(scene)]
        out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    resident, peak = (int(v) * 1024e-9 for v in out.split())
    table = Table(f"Memory of {count:,} triangles from a binary PLY, GB", "limit")
    for what, value, limit in (
        ("resident", resident, LIMIT_RESIDENT_GB * count / 1e7),
        ("peak while building", peak, LIMIT_PEAK_GB * count / 1e7),
    ):
        table.add(Row(what, f"{value:.2f}", f"{limit:.2f}", limit / value, 1.0))
    return [table]
