"""Lesk, as a user of the Python package sees it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from timing import clock

import lesk


def render(scene: Path, spp: int, seed: int, threads: int | None = None) -> tuple[np.ndarray, float]:
    """The picture (h, w, 3) in cd/m2 and the processor seconds that rendering took, reading the scene not included."""
    loaded = lesk.scene.load(scene)
    start = clock()
    done = lesk.render(loaded, spp=spp, seed=seed, threads=threads)
    return np.asarray(done.rgb, np.float32), clock() - start
