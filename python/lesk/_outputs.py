"""Arrays for results: their layout, memory that is used again, and arrays that the caller gives."""

from __future__ import annotations

import math
from collections import deque
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from lesk.errors import ParameterError

Bytes = npt.NDArray[np.uint8]

_POOLED = 1 << 20
"""Bytes from which memory comes from the pool: smaller pieces the C library has at hand."""

_POOL_LIMIT = 1 << 27
"""Bytes that the pool keeps for later at most."""

_CACHE_LINE = 64


class Output(NamedTuple):
    """An array to be filled."""

    array: npt.NDArray[Any]
    """What the caller gets: leading shape, then the components."""
    flat: npt.NDArray[Any]
    """The memory to fill: rows one after the other or, in planes, one component after the other."""
    given: npt.NDArray[Any] | None
    """The caller's array, if `array` has to be copied to it."""

    def deliver(self) -> npt.NDArray[Any]:
        """Give the result in the array that the caller wants it in."""
        if self.given is None:
            return self.array
        np.copyto(self.given, self.array)
        return self.given


def is_planar(arrays: tuple[npt.NDArray[Any], ...]) -> bool:
    """Whether vectors of shape (..., 3) hold each component in an array of its own; single ones have no say."""
    many = [a for a in arrays if a.size > a.shape[-1]]
    return bool(many) and all(_is_planar(a) for a in many)


def _is_planar(array: npt.NDArray[Any]) -> bool:
    return not array.flags.c_contiguous and np.moveaxis(array, -1, 0).flags.c_contiguous


def output(
    name: str,
    leading: tuple[int, ...],
    tail: tuple[int, ...],
    dtype: npt.DTypeLike,
    planar: bool,
    out: npt.NDArray[Any] | None,
    inputs: tuple[npt.NDArray[Any], ...],
) -> Output:
    """Make an output, in the memory of `out` where that is possible."""
    dtype, planar = np.dtype(dtype), planar and bool(tail)
    if out is not None:
        _check(name, out, (*leading, *tail), dtype)
        fits = _is_planar(out) if planar else out.flags.c_contiguous
        # a result may be written only where no input is read
        if fits and out.flags.aligned and not any(np.may_share_memory(out, a) for a in inputs):
            return Output(out, (np.moveaxis(out, -1, 0) if planar else out).reshape(-1), None)
    flat = _empty(math.prod(leading) * math.prod(tail), dtype)
    array = np.moveaxis(flat.reshape((*tail, *leading)), 0, -1) if planar else flat.reshape((*leading, *tail))
    return Output(array, flat, out)


def _check(name: str, out: object, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    if not isinstance(out, np.ndarray):
        raise ParameterError(f"`{name}` is a {type(out).__name__}, but an array of NumPy is accepted")
    if out.shape != shape:
        raise ParameterError(f"`{name}` has shape {out.shape}, but the result has shape {shape}")
    if out.dtype != dtype:
        hint = "\nhint: float32 directions give float32, all others float64" if dtype.kind == "f" else ""
        raise ParameterError(f"`{name}` is an array of {out.dtype}, but the result is {dtype}{hint}")
    if not out.flags.writeable:
        raise ParameterError(f"`{name}` cannot be written: it is read-only")


def _empty(n: int, dtype: np.dtype[Any]) -> npt.NDArray[Any]:
    size = n * dtype.itemsize
    if size < _POOLED:
        return np.empty(n, dtype)
    return np.asarray(_Loan(_POOL.take(size)))[:size].view(dtype)


class _Pool:
    """Memory of results that nobody holds any more.

    New memory costs about as much as computing what is written to it: the system clears each page at its first use.
    The pool gives the memory of earlier results again, if it is not much larger than what is asked for, and keeps
    `_POOL_LIMIT` bytes at most.
    """

    def __init__(self) -> None:
        # a deque, since its methods are atomic: memory comes back whenever and wherever an array dies
        self._free: deque[Bytes] = deque()

    def take(self, size: int) -> Bytes:
        for _ in range(len(self._free)):
            try:
                # the last one that came back may still lie in the caches
                memory = self._free.pop()
            except IndexError:
                break
            if size <= memory.size <= 2 * size:
                return memory
            self._free.appendleft(memory)
        memory = np.empty(size + _CACHE_LINE, np.uint8)
        start = -memory.ctypes.data % _CACHE_LINE
        return memory[start : start + size]

    def give(self, memory: Bytes) -> None:
        self._free.append(memory)
        while sum(m.size for m in list(self._free)) > _POOL_LIMIT:
            try:
                self._free.popleft()
            except IndexError:
                break


_POOL = _Pool()


class _Loan:
    """The owner of an array's memory while the array or a view of it lives; then the memory goes back to the pool."""

    def __init__(self, memory: Bytes) -> None:
        self._memory = memory
        self.__array_interface__ = memory.__array_interface__

    def __del__(self, give: Any = _POOL.give) -> None:
        give(self._memory)
