"""Batches: eval, pdf and sample through NumPy, against Mitsuba 3 and against what memory allows."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from table import Row, Table
from timing import interleaved

import lesk

HERE = Path(__file__).resolve().parent
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
# performance.md states targets for the conductor only
TARGETS = {"eval": (1.3, 1.8), "pdf": (0.9, 1.2), "sample": (1.0, 2.0)}
CHEAP = ("lambert", "oren_nayar", "phong", "blinn_phong", "modified_phong", "ward", "cook_torrance", "ggx")


def directions(n: int, rng: np.random.Generator) -> np.ndarray:
    """Cosine-distributed, (n, 3)."""
    u = rng.random((2, n), dtype=np.float32)
    r, phi = np.sqrt(u[0]), 2 * np.pi * u[1]
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u[0])], -1).astype(np.float32)


class MitsubaSide:
    """Calls of Mitsuba on arrays that Dr.Jit already holds; every call ends when its output is in memory."""

    def __init__(self, wi: np.ndarray, wo: np.ndarray, u: np.ndarray) -> None:
        import drjit as dr
        from mitsuba_side import VARIANT, mi

        if not VARIANT.startswith("llvm"):
            raise RuntimeError("batches need the variant llvm_ad_rgb")
        dr.set_thread_count(1)
        self.dr, self.mi, self.n = dr, mi, len(wi)
        # Mitsuba's wi is the direction that sampling is given: Lesk's wo
        self.given, self.other = mi.Vector3f(wo.T.copy()), mi.Vector3f(wi.T.copy())
        self.u = mi.Float(u[:, 0].copy()), mi.Point2f(u[:, 1:].T.copy())
        dr.eval(self.given, self.other, self.u)
        dr.sync_thread()

    def calls(self, description: dict) -> dict[str, Callable[[], object]]:
        """Functions that evaluate, give the density, and draw."""
        from mitsuba_side import rgb

        wrapped = {k: rgb(v) if isinstance(v, list) else v for k, v in description.items()}
        bsdf, context = self.mi.load_dict(wrapped), self.mi.BSDFContext()

        def finish(result: Any) -> Any:
            self.dr.eval(result)
            self.dr.sync_thread()
            return result

        def interaction() -> Any:
            si = self.dr.zeros(self.mi.SurfaceInteraction3f, self.n)
            si.wi = self.given
            return si

        def sample() -> Any:
            drawn, weight = bsdf.sample(context, interaction(), *self.u)
            return finish((drawn.wo, drawn.pdf, weight))

        return {
            "eval": lambda: finish(bsdf.eval(context, interaction(), self.other)),
            "pdf": lambda: finish(bsdf.pdf(context, interaction(), self.other)),
            "sample": sample,
        }


def lesk_calls(model: Any, wi: np.ndarray, wo: np.ndarray, u: np.ndarray) -> dict[str, Callable[[], object]]:
    return {
        "eval": lambda: model.eval(wi, wo),
        "pdf": lambda: model.pdf(wi, wo),
        "sample": lambda: model.sample(wo, u),
    }


def against_mitsuba(n: int, rounds: int) -> Table:
    """Throughput side by side: (N, 3) float32 arrays in Lesk, Dr.Jit's own arrays in Mitsuba."""
    table = Table(f"Batches of {n:,} directions, M/s on one core", "Mitsuba llvm_ad_rgb")
    rng = np.random.default_rng(1)
    wi, wo, u = directions(n, rng), directions(n, rng), rng.random((n, 3), dtype=np.float32)
    peer = MitsubaSide(wi, wo, u)
    for title, (name, params, description) in PAIRS.items():
        model = getattr(lesk.models, name)(**params)
        ours, theirs = lesk_calls(model, wi, wo, u), peer.calls(description)
        for what in ("eval", "pdf", "sample"):
            t = interleaved({"lesk": ours[what], "mitsuba": theirs[what]}, rounds)
            rate = {k: n / v.median * 1e-6 for k, v in t.items()}
            must, aim = TARGETS[what] if title == "GGX conductor" else (None, None)
            row = Row(f"{title}, {what}", f"{rate['lesk']:.0f}", f"{rate['mitsuba']:.0f}", must=must, aim=aim)
            row.ratio = t["mitsuba"].median / t["lesk"].median
            table.add(row)
    return table


def against_memory(n: int, rounds: int) -> Table:
    """Cheap models against a copy that moves as many bytes: 24 in and 12 out per evaluation."""
    table = Table(f"Batches of {n:,} directions against memory, M/s on one core", "copy of 36 B")
    rng = np.random.default_rng(1)
    wi, wo = directions(n, rng), directions(n, rng)
    # NumPy's copy uses plain stores, whose lines are read first: its 12 B are 16 or 24 moved
    source, target = np.ones(n * 9 // 2, np.float32), np.zeros(n * 9 // 2, np.float32)
    for name in CHEAP:
        model = getattr(lesk.models, name)()
        t = interleaved({"lesk": lambda m=model: m.eval(wi, wo), "copy": lambda: np.copyto(target, source)}, rounds)
        rate = {k: n / v.median * 1e-6 for k, v in t.items()}
        row = Row(f"{name}, eval", f"{rate['lesk']:.0f}", f"{rate['copy']:.0f}", rate["lesk"] / rate["copy"], 0.6, 0.9)
        table.add(row)
    return table


FIRST_CALL = """
import json, sys, time
import numpy as np
rng = np.random.default_rng(1)
v = rng.normal(size=(2, 10_000, 3)).astype(np.float32); v[..., 2] = abs(v[..., 2])
wi, wo = v / np.linalg.norm(v, axis=-1, keepdims=True)
u = rng.random((10_000, 3), dtype=np.float32)
start = time.process_time()
"""
FIRST_LESK = (
    FIRST_CALL
    + """
import lesk
lesk.models
model = lesk.models.{name}(**{params})
loaded = time.process_time()
{call}
print(json.dumps([loaded - start, time.process_time() - loaded]))
"""
)
FIRST_MITSUBA = (
    FIRST_CALL
    + """
sys.path.insert(0, {here!r})
import batch
sides = batch.MitsubaSide(wi, wo, u)
call = sides.calls({description})[{what!r}]
import drjit as dr
dr.flush_kernel_cache()
dr.set_flag(dr.JitFlag.KernelHistory, False)
loaded = time.process_time()
call()
print(json.dumps([loaded - start, time.process_time() - loaded]))
"""
)


def fresh(code: str) -> list[float]:
    """Runs a program in a process of its own, without Dr.Jit's kernels of earlier runs; seconds to load and to call."""
    with tempfile.TemporaryDirectory() as home:
        environment = os.environ | {"HOME": home}
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    return json.loads(done.stdout.strip().splitlines()[-1])


def first_calls(rounds: int) -> Table:
    """The first call in a fresh process, 10,000 directions, after imports."""
    table = Table(
        "First call in a fresh process, 10,000 directions, ms of processor time after imports", "Mitsuba llvm_ad_rgb"
    )
    calls = {"eval": "model.eval(wi, wo)", "sample": "model.sample(wo, u)"}
    for title, (name, params, description) in PAIRS.items():
        for what, call in calls.items():
            ours = FIRST_LESK.format(name=name, params=params, call=call)
            theirs = FIRST_MITSUBA.format(here=str(HERE), description=description, what=what)
            seconds = [(fresh(ours)[1], fresh(theirs)[1]) for _ in range(rounds)]
            a, b = (float(np.median(v)) for v in zip(*seconds, strict=True))
            table.add(Row(f"{title}, {what}", f"{a * 1e3:.2f}", f"{b * 1e3:.1f}", b / a, 20, 100))
    return table


def starts(rounds: int) -> Table:
    """Seconds until a program is usable, a bare Python not included."""
    table = Table("Start, ms (a bare Python's start subtracted)", "limit")
    commands = {
        "bare": [sys.executable, "-c", "pass"],
        "`import lesk`": [sys.executable, "-c", "import lesk"],
        "`lesk --help`": [sys.executable, "-m", "lesk", "--help"],
    }
    script = Path(sys.executable).parent / "lesk"
    if script.exists():
        commands["`lesk --help`"] = [str(script), "--help"]

    def call(command: list[str]) -> Callable[[], object]:
        return lambda: subprocess.run(command, capture_output=True, check=True)

    try:
        t = interleaved({k: call(v) for k, v in commands.items()}, rounds, time.perf_counter)
    except subprocess.CalledProcessError as error:
        print(f"skipped: start of `lesk --help` ({error})")
        del commands["`lesk --help`"]
        t = interleaved({k: call(v) for k, v in commands.items()}, rounds, time.perf_counter)
    for what, limit in (("`import lesk`", 150), ("`lesk --help`", 250)):
        if what in t:
            ms = 1e3 * max(t[what].median - (t["bare"].median if "import" in what else 0.0), 1e-4)
            table.add(Row(what, f"{ms:.0f}", f"{limit}", limit / ms, 1, 2))
    return table


def run(quick: bool) -> list[Table]:
    """All tables of this section."""
    n, rounds = (1_000_000, 7) if quick else (4_000_000, 15)
    return [
        against_mitsuba(n, rounds),
        against_memory(n, rounds),
        first_calls(3 if quick else 7),
        starts(5 if quick else 11),
    ]
