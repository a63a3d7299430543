"""Batches: eval, pdf and sample through NumPy, against Mitsuba 3, against what memory allows, and against each other."""

from __future__ import annotations

import resource
import subprocess
from collections.abc import Callable
from typing import Any

import numpy as np
import starts
from models import GOLD, PAIRS, directions, planar
from table import Row, Table
from timing import Timing, interleaved
from triad import Triad

import lesk

Calls = dict[str, Callable[[], object]]

# performance.md states targets for the conductor only
TARGETS = {"eval": (1.3, 1.8), "pdf": (0.9, 1.2), "sample": (1.0, 2.0)}
CHEAP = ("lambert", "oren_nayar", "phong", "blinn_phong", "modified_phong", "ward", "cook_torrance", "ggx")


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

    def calls(self, description: dict) -> Calls:
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


def lesk_calls(model: Any, wi: np.ndarray, wo: np.ndarray, u: np.ndarray) -> Calls:
    return {
        "eval": lambda: model.eval(wi, wo),
        "pdf": lambda: model.pdf(wi, wo),
        "sample": lambda: model.sample(wo, u),
    }


def calls_with_out(model: Any, wi: np.ndarray, wo: np.ndarray, u: np.ndarray) -> Calls:
    """The same into arrays of earlier results."""
    f, density, drawn = model.eval(wi, wo), model.pdf(wi, wo), model.sample(wo, u)
    return {
        "eval": lambda: model.eval(wi, wo, out=f),
        "pdf": lambda: model.pdf(wi, wo, out=density),
        "sample": lambda: model.sample(wo, u, out=drawn),
    }


def faults(call: Callable[[], object]) -> str:
    """How many pages the system has to make for one more call."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    call()
    return f"{resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before} page faults"


def rates(n: int, timings: dict[str, Timing]) -> dict[str, str]:
    return {name: f"{n / t.median * 1e-6:.0f}" for name, t in timings.items()}


def against_mitsuba(n: int, rounds: int) -> Table:
    """Throughput side by side, both on float32 arrays per component."""
    table = Table(
        f"Batches of {n:,} directions in arrays per component, M/s on one core", "Mitsuba llvm_ad_rgb, the same layout"
    )
    rng = np.random.default_rng(1)
    wi, wo, u = directions(n, rng), directions(n, rng), rng.random((n, 3), dtype=np.float32)
    peer = MitsubaSide(wi, wo, u)
    wi, wo, u = planar(wi), planar(wo), planar(u)
    for title, (name, params, description) in PAIRS.items():
        model = getattr(lesk.models, name)(**params)
        ours, theirs = lesk_calls(model, wi, wo, u), peer.calls(description)
        for what in TARGETS:
            t = interleaved({"lesk": ours[what], "mitsuba": theirs[what]}, rounds)
            rate = rates(n, t)
            must, aim = TARGETS[what] if title == "GGX conductor" else (None, None)
            ratio = t["mitsuba"].median / t["lesk"].median
            note = faults(ours[what])
            table.add(Row(f"{title}, {what}", rate["lesk"], rate["mitsuba"], ratio, must, aim, note))
    return table


def against_memory(n: int, rounds: int) -> Table:
    """Cheap models against a triad that moves as many bytes: 24 in and 12 out per evaluation."""
    table = Table(
        f"Batches of {n:,} directions in arrays per component against memory, M/s on one core",
        "STREAM triad past the caches, 36 B",
    )
    try:
        triad = Triad(n)
    except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
        print(f"skipped: batches against memory ({error})")
        return table
    rng = np.random.default_rng(1)
    wi, wo = planar(directions(n, rng)), planar(directions(n, rng))
    t = interleaved({"plain": triad.call(False), "past": triad.call(True)}, rounds)
    rate = rates(n, t)
    ratio = t["past"].median / t["plain"].median
    table.add(Row("the triad itself with plain stores", rate["plain"], rate["past"], ratio, note="not Lesk"))
    for name in CHEAP:
        model = getattr(lesk.models, name)()
        t = interleaved({"lesk": lambda m=model: m.eval(wi, wo), "triad": triad.call(True)}, rounds)
        rate = rates(n, t)
        table.add(Row(f"{name}, eval", rate["lesk"], rate["triad"], t["triad"].median / t["lesk"].median, 0.6, 0.9))
    return table


def against_itself(n: int, rounds: int) -> Table:
    """The usual layout of NumPy against arrays per component."""
    table = Table(f"Batches of {n:,} directions in (N, 3) arrays, M/s on one core", "the same in arrays per component")
    rng = np.random.default_rng(1)
    rows = directions(n, rng), directions(n, rng), rng.random((n, 3), dtype=np.float32)
    planes = tuple(map(planar, rows))
    models = {"GGX conductor": lesk.models.ggx_conductor_separable(**GOLD, alpha_x=0.1, alpha_y=0.4)}
    models |= {name: getattr(lesk.models, name)() for name in ("ggx", "oren_nayar")}
    for title, model in models.items():
        ours, given, by_plane = lesk_calls(model, *rows), calls_with_out(model, *rows), lesk_calls(model, *planes)
        for what in TARGETS:
            t = interleaved({"new": ours[what], "out": given[what], "planes": by_plane[what]}, rounds)
            rate = rates(n, t)
            for key, label in (("new", ""), ("out", " with `out`")):
                call = {"new": ours, "out": given}[key][what]
                ratio = t["planes"].median / t[key].median
                row = Row(f"{title}, {what}{label}", rate[key], rate["planes"], ratio, 0.7, 0.9, faults(call))
                table.add(row)
    return table


def run(quick: bool) -> list[Table]:
    """All tables of this section."""
    n, rounds = (1_000_000, 7) if quick else (4_000_000, 15)
    return [
        against_mitsuba(n, rounds),
        against_memory(n, rounds),
        against_itself(n, rounds),
        starts.first_calls(3 if quick else 7),
        starts.starts(5 if quick else 11),
        starts.shaders(5 if quick else 11),
    ]
