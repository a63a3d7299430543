"""Timing A against B so that a shared machine disturbs both alike.

The clock is the processor time of this process: with everything on one pinned core that is the time on a quiet machine,
and other programs that wait for the same core do not count.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

clock = time.process_time


@dataclass(frozen=True)
class Timing:
    """Seconds of one call: median, and the best decile."""

    median: float
    best: float

    @staticmethod
    def of(seconds: list[float]) -> Timing:
        """Summary of repeated calls."""
        ordered = sorted(seconds)
        return Timing(statistics.median(ordered), ordered[len(ordered) // 10])


def interleaved(
    calls: dict[str, Callable[[], object]], rounds: int, now: Callable[[], float] = clock
) -> dict[str, Timing]:
    """Times all calls in turn, A B A B, after two calls of each that do not count."""
    seconds: dict[str, list[float]] = {name: [] for name in calls}
    for k in range(rounds + 2):
        for name, call in calls.items():
            start = now()
            call()
            if k >= 2:
                seconds[name].append(now() - start)
    return {name: Timing.of(values) for name, values in seconds.items()}


def pin() -> int | None:
    """Keeps this process on one core, its highest; None where the system cannot."""
    if not hasattr(os, "sched_setaffinity"):
        return None
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return core


def load_average() -> float:
    """How many programs want to run: above the number of cores, absolute numbers are low."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
