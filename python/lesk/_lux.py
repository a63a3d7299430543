"""Lighting of work places: measuring surfaces against their requirements."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lesk import _lesk
from lesk._measure import Measurement, MeasureProgress, Readings, measure, scene_of
from lesk.scene import Scene

SHOWN = ("point", "line", "grid", "glare")


@dataclass(frozen=True)
class Task:
    """A row of EN 12464-1."""

    id: str
    """The word for scene files."""
    name: str
    """In words."""
    illuminance: float
    """Least mean maintained illuminance, lx."""
    ugr: float | None
    """Greatest UGR."""
    uniformity: float | None
    """Least uniformity U0."""
    color_rendering: float | None
    """Least colour rendering index Ra; Lesk does not check it."""


def tasks() -> list[Task]:
    """Give the rows of EN 12464-1 that sensors may name. Check the edition in force."""
    return [Task(*row) for row in _lesk.measure_tasks()[0]]


EDITION: str = _lesk.measure_tasks()[1]
"""Where the rows come from."""


@dataclass(frozen=True)
class Check:
    """One requirement of one sensor."""

    sensor: str
    """Name of the sensor."""
    what: str
    """`mean`, `uniformity` or `UGR`."""
    value: float | None
    """What was found: maintained lx, U0 or UGR; None where it has no value."""
    limit: float
    """What is demanded: at least, of UGR at most."""
    error: float
    """Standard error of the value."""

    @property
    def met(self) -> bool:
        """Whether the requirement is met. No glaring surface in sight is no glare."""
        if self.what == "UGR":
            return self.value is None or self.value <= self.limit
        return self.value is not None and self.value >= self.limit

    @property
    def within_error(self) -> bool:
        """Whether the value is nearer to the limit than twice its standard error: measure longer to be sure."""
        return self.value is not None and abs(self.value - self.limit) < 2 * self.error


@dataclass(frozen=True)
class LuxReport:
    """Readings of a scene's surfaces with their requirements."""

    title: str
    """The title of the scene."""
    measurement: Measurement
    """The readings of a new installation."""

    @property
    def maintenance_factor(self) -> float:
        """Maintained over initial illuminance."""
        return self.measurement.maintenance_factor

    @property
    def checks(self) -> list[Check]:
        """All requirements."""
        return [check for sensor in self.measurement.sensors for check in _checks(sensor, self.maintenance_factor)]

    @property
    def passed(self) -> bool:
        """Whether every requirement is met."""
        return all(check.met for check in self.checks)

    def rows(self) -> list[dict[str, Any]]:
        """Give one row per surface: maintained values in the sensor's unit, requirements, verdict."""
        return [_row(s, self.maintenance_factor) for s in self.measurement.sensors if s.form != "camera"]

    def data(self) -> dict[str, Any]:
        """Give everything as plain data, as `lesk lux --json` prints it."""
        found = self.measurement
        return {
            "title": self.title,
            "passed": self.passed,
            "standard": EDITION,
            "maintenance_factor": self.maintenance_factor,
            "ended": found.ended,
            "seconds": found.seconds,
            "method": {"estimate": METHOD, **found.settings},
            "surfaces": self.rows(),
            "readings": [_plain(sensor) for sensor in found.sensors if sensor.form != "camera"],
        }

    def csv(self) -> str:
        """Write every reading as a line of CSV: sensor, row, column, position (m), initial and maintained values."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        head = "sensor,row,column,x_m,y_m,z_m,unit,initial,standard_error,maintained,direct,indirect,samples"
        writer.writerow(head.split(","))
        for s in (s for s in self.measurement.sensors if s.form != "camera"):
            for row, column in np.ndindex(s.value.shape):
                at = (row, column)
                place = [f"{x:.6g}" for x in s.positions[at]]
                values = (s.value[at], s.standard_error[at], s.value[at] * self.factor(s), s.direct[at], s.indirect[at])
                numbers = [f"{v:.6g}" for v in values]
                writer.writerow([s.name, row, column, *place, s.unit, *numbers, int(s.samples[at])])
        return out.getvalue()

    def html(self) -> str:
        """Write a page that needs no other file: tables, false-colour plans with isolux lines, how it was measured."""
        from lesk._lux_page import page

        return page(self)

    def factor(self, sensor: Readings) -> float:
        """Maintained over initial readings of a sensor: luminances and spectral units are not maintained values."""
        return self.maintenance_factor if sensor.unit == "lx" and sensor.form in SHOWN else 1.0

    def __str__(self) -> str:
        return "\n".join(_line(row) for row in self.rows())


METHOD = (
    "unbiased path tracing from every point, lights asked directly; standard errors from 32 independently scrambled "
    "Sobol sequences; no cache, no interpolation, no clamping"
)


def lux(
    scene: str | Path | Scene,
    *,
    sensors: Sequence[str] | None = None,
    error: float | None = None,
    time: float | None = None,
    seed: int | None = None,
    max_depth: int | None = None,
    threads: int | None = None,
    progress: Callable[[MeasureProgress], object] | None = None,
) -> LuxReport:
    """Measure the surfaces of a scene and check them against their requirements.

    Parameters
    ----------
    scene, sensors, error, time, seed, max_depth, threads, progress
        As of `lesk.measure`.

    Returns
    -------
    LuxReport
        `.passed`, `.rows()`, `.checks`; `.html()`, `.csv()` and `.data()` write it.

    Raises
    ------
    SceneError, ParameterError
        What was given and what is accepted.
    MeasureInterrupted
        On Ctrl-C; its `.measurement` holds what was done.
    """
    loaded = scene_of(scene)
    found = measure(
        loaded,
        sensors=sensors,
        error=error,
        time=time,
        seed=seed,
        max_depth=max_depth,
        threads=threads,
        progress=progress,
    )
    return LuxReport(loaded.title, found)


def _checks(s: Readings, factor: float) -> list[Check]:
    mean, uniformity, ugr = s.limits
    checks = []
    if s.glare is not None:
        return [] if ugr is None else [Check(s.name, "UGR", s.glare.ugr, ugr, s.glare.standard_error)]
    if mean is not None:
        checks.append(Check(s.name, "mean", factor * s.mean, mean, factor * s.mean_error))
    if uniformity is not None and s.value.size > 1:
        smallest = float(s.standard_error.flat[int(s.value.argmin())])
        spread = smallest / s.mean if s.mean > 0 else 0.0
        checks.append(Check(s.name, "uniformity", s.uniformity, uniformity, spread))
    return checks


def _row(s: Readings, maintenance_factor: float) -> dict[str, Any]:
    factor = maintenance_factor if s.unit == "lx" else 1.0
    checks = _checks(s, maintenance_factor)
    return {
        "name": s.name,
        "form": s.form,
        "unit": s.unit,
        "points": int(s.value.size),
        "mean": factor * s.mean,
        "mean_standard_error": factor * s.mean_error,
        "min": factor * s.min,
        "max": factor * s.max,
        "u0": s.uniformity,
        "ud": s.diversity,
        "ugr": s.glare.ugr if s.glare else None,
        "ugr_standard_error": s.glare.standard_error if s.glare else None,
        "task": s.task[0] if s.task else None,
        "task_name": s.task[1] if s.task else None,
        "checks": [
            {"what": c.what, "value": c.value, "limit": c.limit, "met": c.met, "within_error": c.within_error}
            for c in checks
        ],
        "met": all(c.met for c in checks) if checks else None,
        "worst_relative_error": s.relative_error,
    }


def _plain(s: Readings) -> dict[str, Any]:
    names = ("positions", "value", "standard_error", "half_interval", "direct", "indirect", "samples")
    data: dict[str, Any] = {"name": s.name, "unit": s.unit, "conversion": s.conversion}
    data |= {name: getattr(s, name).tolist() for name in names}
    if s.glare is not None:
        data["glare"] = {
            "ugr": s.glare.ugr,
            "standard_error": s.glare.standard_error,
            "background_cd_m2": s.glare.background,
            "left_out": s.glare.left_out,
            "sources": [{**vars(source), "term": source.term} for source in s.glare.sources],
        }
    return data


def _line(row: dict[str, Any]) -> str:
    verdict = {None: "", True: "met", False: "NOT MET"}[row["met"]]
    if row["form"] == "glare":
        ugr = "no glare" if row["ugr"] is None else f"UGR {row['ugr']:.1f}"
        return f"{row['name']}: {ugr} {verdict}".rstrip()
    u0 = "" if row["u0"] is None or row["points"] == 1 else f", U0 {row['u0']:.2f}"
    return f"{row['name']}: mean {row['mean']:.4g} {row['unit']}{u0} {verdict}".rstrip()
