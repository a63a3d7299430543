"""Runs a term over arrays."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk._arrays import Array, leading_shape, numbers, result_type, spread
from lesk.errors import ParameterError

TERMS: dict[tuple[str, str], dict[str, Any]] = {
    (term["role"], term["name"]): term for term in json.loads(_lesk.terms_json())["terms"]
}
"""All terms by role and name, with their arguments."""


def evaluate(role: str, name: str, *values: npt.ArrayLike) -> Array:
    """Evaluate a term; each argument has the shape (...) for numbers and (..., width) for the others."""
    term = TERMS[role, name]
    arguments = {spec["name"]: _argument(spec, value) for spec, value in zip(term["arguments"], values, strict=True)}
    shape = leading_shape({name: a.shape[:-1] for name, a in arguments.items()})
    width = term["returns"]["width"]
    # a bare number takes part in any type
    arrays = [arguments[spec["name"]] for spec in term["arguments"]]
    typed = [a for a, value in zip(arrays, values, strict=True) if isinstance(value, np.ndarray)]
    out = np.empty((*shape, width), result_type(*typed) if typed else np.float64)
    _lesk.term(role, name, [spread(a, shape) for a in arrays], out.reshape(-1))
    return out[..., 0] if width == 1 else out


def _argument(spec: dict[str, Any], value: npt.ArrayLike) -> Array:
    name, width = spec["name"], spec["width"]
    array = numbers(name, value)
    if width == 1:
        return array[..., np.newaxis]
    if spec["kind"] == "Color" and array.ndim == 0:
        return np.full(width, array)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ParameterError(f"`{name}` has shape {array.shape}, but (..., {width}) is accepted")
    return array
