"""What a user waits for once: the first call in a fresh process, the start of Python and of the command, shader source."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from models import PAIRS
from table import Row, Table
from timing import Timing, clock, interleaved

import lesk

HERE = Path(__file__).resolve().parent
LANGUAGES = ("glsl-es", "wgsl", "hlsl", "msl", "spirv")

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


def shaders(rounds: int) -> Table:
    """Eval, pdf and sample of a model in five languages, of every model."""
    table = Table("Shader source of one model in five languages, ms on one core", "limit")
    for name, model in lesk.models.ALL.items():
        made = model()
        seconds = []
        for _ in range(rounds + 1):
            start = clock()
            for language in LANGUAGES:
                made.shader(language)
            seconds.append(clock() - start)
        ms = 1e3 * Timing.of(seconds[1:]).median
        table.add(Row(name, f"{ms:.2f}", "5", 5 / ms, 1, 5))
    return table
