"""Measured light against closed forms, as one table: `lesk validate lights`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from lesk._light_cases import Case, Row, cases
from lesk._measure import measure

DETERMINISTIC = 1e-5
"""Greatest relative deviation of a row without noise: single precision, some roundings of 6e-8 each."""
NOISE = 2e-3
"""Greatest relative standard error of a row with noise."""
Z = 4.0
"""Greatest |z| of a row with noise."""


@dataclass(frozen=True)
class Compared:
    """One row of the table."""

    group: str
    """What kind of case."""
    what: str
    """The case."""
    expected: float
    """The closed form."""
    value: float
    """What Lesk reads."""
    standard_error: float
    """Its standard error; of a numerical reference, with its error."""
    unit: str
    """lx, cd/m2 or W/m2."""
    deterministic: bool
    """Whether there is no noise."""

    @property
    def z(self) -> float | None:
        """Deviation in standard errors; None of a deterministic row."""
        if self.deterministic:
            return None
        # where stratification leaves no noise, rounding counts
        rounding = DETERMINISTIC / Z * self.expected
        return (self.value - self.expected) / math.hypot(self.standard_error, rounding)

    @property
    def deviation(self) -> float:
        """Relative deviation."""
        return self.value / self.expected - 1

    @property
    def met(self) -> bool:
        """Whether the row agrees."""
        if self.deterministic:
            return abs(self.deviation) <= DETERMINISTIC
        z = self.z
        return z is not None and abs(z) < Z and self.standard_error <= NOISE * self.expected


def lights(*, seed: int = 0, say: Callable[[str], object] | None = None) -> list[Compared]:
    """Compare readings with closed forms.

    Parameters
    ----------
    seed : int
        Of the random numbers.
    say : callable, optional
        Called with the name of each group when it begins.

    Returns
    -------
    list of Compared
        One per case; all of them agree where `all(row.met for row in rows)`.
    """
    table: list[Compared] = []
    for case in cases():
        if say is not None:
            say(f"{case.group}: {case.rows[0].what}")
        table += compare(case, seed)
    return table


def compare(case: Case, seed: int) -> list[Compared]:
    """Compare the readings of one case."""
    found = measure(case.text, error=case.error, seed=seed)
    return [_row(case, row, found[row.sensor]) for row in case.rows]


def _row(case: Case, row: Row, readings: object) -> Compared:
    from lesk._measure import Readings

    assert isinstance(readings, Readings)
    # the lights of rooms are points, whose direct part has no noise
    value = float(readings.indirect.mean()) if row.part == "indirect" else readings.mean
    error = math.hypot(readings.mean_error, row.reference_error * row.expected)
    return Compared(case.group, row.what, row.expected, value, error, readings.unit, row.deterministic)


_HEAD = """# Light against closed forms

Written by `lesk validate lights --markdown docs/light_validation.md`, which exits with 1 if a row differs.

{exact} of {rows} rows have no noise and lie within 1e-5 of the closed form, which is what single precision allows; {noisy} rows are Monte Carlo estimates with a standard error of at most 0.2 % of the value and |z| < 4.
All cases begin with the same random numbers, so that the z of similar cases are alike.
The closed forms are computed by `python/lesk/_closed_forms.py`, which knows nothing of the renderer; tests compare it with values printed elsewhere.
The mean indirect illuminance of a closed room is Φρ / (S (1 - ρ)) over all of its surface. The midpoint rule of a grid sees more: 20 x 20 points of a face of the cube have 0.07 to 0.11 % more, which the reference has, too; 80 x 80 points have 0.02 % more.
The totals at single points of the cubes, and so the means over points, come from a radiosity solution with exact form factors, whose own error (1e-4 and 3e-4) is in the standard error.
The geometry is that of CIE 171:2006 where it has the case (point, area source, glass, cube of 4 m); its printed tables were not available, so this is a comparison with the formulas, not a certificate.

Lesk traces no polarisation: light that has passed one boundary of a pane meets the next one unpolarised. At 60 degrees a pane of n = 1.52 transmits 0.8307 that way and 0.8435 in nature (0.5915 and 0.6148 at 75 degrees, equal at 0).
"""


def markdown(rows: list[Compared]) -> str:
    """Write the table as a page of the book."""
    noisy = sum(not r.deterministic for r in rows)
    lines = [
        _HEAD.format(rows=len(rows), exact=len(rows) - noisy, noisy=noisy),
        "| case | | closed form | Lesk | standard error | z | |",
        "|---|---|--:|--:|--:|--:|---|",
    ]
    for r in rows:
        lines.append("| " + " | ".join([r.group, r.what, *columns(r)]) + " |")
    return "\n".join(lines) + "\n"


def columns(r: Compared) -> list[str]:
    """Write the numbers of a row: closed form, Lesk, standard error, z, verdict."""
    unit = r.unit.replace("m2", "m²")
    z = "" if r.z is None else f"{r.z:+.2f}"
    error = f"{100 * r.deviation:+.4f} % off" if r.deterministic else f"{100 * r.standard_error / r.expected:.3f} %"
    return [f"{r.expected:.7g} {unit}", f"{r.value:.7g}", error, z, "agrees" if r.met else "DIFFERS"]
