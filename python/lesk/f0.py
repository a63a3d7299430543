"""Reflectance at normal incidence of common substances.

>>> import lesk
>>> lesk.f0.find("gold").low
(1.0, 0.782, 0.344)
"""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from lesk.errors import ParameterError, nearest

__all__ = ["Substance", "find", "substances"]

Color = tuple[float, float, float]


class Substance(NamedTuple):
    """One row of the table; `low` and `high` are equal where it gives one value."""

    name: str
    metal: bool
    low: Color
    """F0, linear Rec.709, dimensionless."""
    high: Color
    """F0 of the upper end, linear Rec.709, dimensionless."""
    texture_low: Color
    """The same as the table prints it for textures: sRGB codes, 0 to 255."""
    texture_high: Color
    """The upper end as sRGB codes, 0 to 255."""


@cache
def substances() -> tuple[Substance, ...]:
    """Give the table: 12 dielectrics and 13 metals, in the order of its source (see data/f0/PROVENANCE.md).

    Returns
    -------
    tuple of Substance
    """
    text = files("lesk").joinpath("data", "f0.csv").read_text(encoding="utf-8")
    return tuple(
        Substance(row["name"], row["kind"] == "metal", *_ends(row["linear"]), *_ends(row["texture"]))
        for row in csv.DictReader(text.splitlines())
    )


def find(name: str) -> Substance:
    """Look a substance up.

    Parameters
    ----------
    name : str
        Its name in the table, like `gold`.

    Returns
    -------
    Substance

    Raises
    ------
    ParameterError
        If there is none of this name.
    """
    known = {substance.name: substance for substance in substances()}
    if name not in known:
        hint = nearest(name, known) or f"\nhint: {', '.join(known)}"
        raise ParameterError(f"there is no substance `{name}` in the table of F0{hint}")
    return known[name]


def _ends(text: str) -> tuple[Color, Color]:
    """Read `0.02`, `0.02-0.04` or three channels."""
    low, _, high = text.partition("-")
    return _color(low), _color(high or low)


def _color(text: str) -> Color:
    numbers = [float(word) for word in text.split()]
    r, g, b = numbers * 3 if len(numbers) == 1 else numbers
    return r, g, b
