"""What memory allows: STREAM's triad, compiled from `stream.c`."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
LINE = 64
"""Bytes of a cache line."""


class Triad:
    """c = a + 3 b over as much memory as evaluating `n` pairs of directions takes: 24 B in and 12 B out for each."""

    def __init__(self, n: int) -> None:
        compiler = next(filter(None, map(shutil.which, ("cc", "gcc", "g++", "clang"))), None)
        if compiler is None:
            raise RuntimeError("no C compiler")
        with tempfile.TemporaryDirectory() as folder:
            library = Path(folder) / "stream.so"
            command = [compiler, "-O3", "-shared", "-fPIC", "-x", "c", str(HERE / "stream.c"), "-o", str(library)]
            subprocess.run(command, check=True, capture_output=True)
            self.triad = ctypes.CDLL(str(library)).triad
        self.triad.argtypes = [ctypes.c_void_p] * 3 + [ctypes.c_size_t, ctypes.c_int]
        self.n = 3 * n // 16 * 16
        self.arrays = [aligned(self.n) for _ in range(3)]

    def call(self, past: bool) -> Callable[[], object]:
        """Run it, with results past the caches or not."""
        pointers = [a.ctypes.data for a in self.arrays]
        return lambda: self.triad(*pointers, self.n, past)


def aligned(n: int) -> np.ndarray:
    """Ones that start at a border of a cache line."""
    memory = np.ones(n + LINE, np.float32)
    start = -memory.ctypes.data % LINE // memory.itemsize
    return memory[start : start + n]
