"""Docstrings of models, from the registry, for the classes and for their stubs."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any

_WIDTH = 100


def model_docstring(info: Mapping[str, Any]) -> str:
    """Write the numpydoc text of a model's class."""
    lines = [f"{info['title']} ({info['year']}).", "", *info["doc"].strip().splitlines(), ""]
    lines += ["Parameters", "----------"]
    for spec in info["parameters"]:
        lines += _parameter(spec)
    claims = [_claim(claim) for claim in info["claims"]]
    if claims:
        lines += ["", "Notes", "-----"]
        lines += textwrap.wrap(f"Claims, each with a test: {', '.join(claims)}.", _WIDTH)
    return "\n".join([*lines, "", "References", "----------", info["paper"]])


def _parameter(spec: Mapping[str, Any]) -> list[str]:
    shape = "float or array_like of shape (..., 3)" if spec["kind"] == "color" else "array_like of shape (...)"
    default = spec["default"]
    written = [f"{v:g}" for v in default] if isinstance(default, list) else [f"{default:g}"]
    text = f"[{', '.join(written)}]" if len(written) > 1 else written[0]
    low, high = spec["range"]
    unit = spec["unit"] or "dimensionless"
    doc = " ".join(spec["doc"].split())
    body = textwrap.wrap(f"{doc} {low:g} to {high:g}, {unit}.", _WIDTH - 4)
    return [f"{spec['name']} : {shape}, default {text}", *(f"    {line}" for line in body)]


def _claim(claim: Mapping[str, Any]) -> str:
    name = str(claim["property"]).replace("_", " ")
    return f"{name} where `{claim['when']}`" if claim["when"] else name
