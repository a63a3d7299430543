"""`lesk validate lights`: closed forms against readings, as one table."""

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
        table += _compare(case, seed)
    return table


def _compare(case: Case, seed: int) -> list[Compared]:
    found = measure(case.text, error=case.error, seed=seed)
    return [_row(case, row, found[row.sensor]) for row in case.rows]


def _row(case: Case, row: Row, readings: object) -> Compared:
    from lesk._measure import Readings

    assert isinstance(readings, Readings)
    # the lights of rooms are points, whose direct part has no noise
    value = float(readings.indirect.mean()) if row.part == "indirect" else readings.mean
    error = math.hypot(readings.mean_error, row.reference_error * row.expected)
    return Compared(case.group, row.what, row.expected, value, error, readings.unit, row.deterministic)


def markdown(rows: list[Compared]) -> str:
    """Write the table as Markdown."""
    lines = ["| case | | closed form | Lesk | standard error | z | |", "|---|---|--:|--:|--:|--:|---|"]
    for r in rows:
        lines.append("| " + " | ".join([r.group, r.what, *columns(r)]) + " |")
    return "\n".join(lines) + "\n"


def columns(r: Compared) -> list[str]:
    """Write the numbers of a row: closed form, Lesk, standard error, z, verdict."""
    unit = r.unit.replace("m2", "m²")
    z = "" if r.z is None else f"{r.z:+.2f}"
    error = f"{100 * r.deviation:+.4f} % off" if r.deterministic else f"{100 * r.standard_error / r.expected:.3f} %"
    return [f"{r.expected:.7g} {unit}", f"{r.value:.7g}", error, z, "agrees" if r.met else "DIFFERS"]
