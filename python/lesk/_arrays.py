"""Arrays as inputs: types, shapes, broadcasting without copies."""

from __future__ import annotations

import math
import warnings
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk.errors import ParameterError

Array = npt.NDArray[np.floating[Any]]


def numbers(name: str, value: npt.ArrayLike) -> Array:
    """Take numbers as they are if they are float32 or float64, else as float64.

    Arrays that NumPy itself would have to copy before computing (not aligned, other byte order) are copied.
    """
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise ParameterError(f"`{name}` is not an array: its rows differ in length") from None
    if array.dtype not in (np.float32, np.float64):
        if array.dtype.kind not in "biuf":
            given = f"{value!r}" if array.ndim == 0 else f"an array of {array.dtype}"
            raise ParameterError(f"`{name}` is {given:.60}, but numbers are accepted")
        array = array.astype(np.float64)
    native = array.dtype.newbyteorder("=")
    return cast(Array, np.require(array, dtype=native, requirements=["ALIGNED"]))


def vectors(name: str, value: npt.ArrayLike) -> Array:
    """Take an array of shape (..., 3)."""
    array = numbers(name, value)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ParameterError(f"`{name}` has shape {array.shape}, but (..., 3) is accepted")
    return array


def result_type(*arrays: Array) -> np.dtype[Any]:
    """Give float32 if all directions are float32, else float64."""
    single = all(a.dtype == np.float32 for a in arrays)
    return np.dtype(np.float32 if single else np.float64)


def leading_shape(named: dict[str, tuple[int, ...]]) -> tuple[int, ...]:
    """Broadcast leading shapes."""
    try:
        return np.broadcast_shapes(*named.values())
    except ValueError:
        shapes = ", ".join(f"`{name}` {shape}" for name, shape in named.items() if shape)
        raise ParameterError(f"leading shapes do not broadcast: {shapes}") from None


def spread(array: Array, leading: tuple[int, ...]) -> Array:
    """Repeat rows over a leading shape without copying; a single row stays one."""
    width = array.shape[-1]
    return array if array.size == width else np.broadcast_to(array, (*leading, width))


def require_directions(**named: Array) -> None:
    """Raise for vectors of another length than 1, and warn of those that are not finite."""
    for name, array in named.items():
        finite = np.isfinite(array).all(axis=-1)
        with np.errstate(over="ignore", invalid="ignore"):
            length2 = np.einsum("...i,...i", array, array, dtype=np.float64)
            # the square of a long vector overflows: infinite, and too long
            odd = finite & (np.abs(length2 - 1) > 1e-4)
        count = int(np.count_nonzero(odd))
        if count:
            first = np.unravel_index(int(np.argmax(odd)), odd.shape)
            place = f", the first at index {tuple(map(int, first))}" if odd.ndim else ""
            raise ParameterError(
                f"`{name}` is not of unit length: {count} of {odd.size} vectors{place} with length "
                f"{math.hypot(*array[first]):.6g}, but 1 within 5e-5 is accepted\n"
                f"hint: divide by numpy.linalg.norm({name}, axis=-1, keepdims=True)"
            )
        if not finite.all():
            lost = int(np.count_nonzero(~finite))
            text = f"{lost} of {finite.size} vectors `{name}` are not finite; results there are 0"
            warnings.warn(text, RuntimeWarning, stacklevel=4)
