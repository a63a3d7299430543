"""Measuring at the sensors of a scene: arrays with standard errors."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import MeasureInterrupted, ParameterError, nearest
from lesk.scene import Scene, load, parse

Array = npt.NDArray[np.float64]


class MeasureProgress(NamedTuple):
    """How far measuring is."""

    done: float
    """Estimated share of the work, 0 to 1."""
    finished: int
    """Readings that have reached their error."""
    total: int
    """All readings."""
    elapsed: float
    """Seconds so far."""


@dataclass(frozen=True)
class GlareSource:
    """A luminous surface as an observer sees it."""

    light: str
    """The object that shines."""
    luminance: float
    """Mean luminance L, cd/m²."""
    solid_angle: float
    """Solid angle ω that nothing hides, sr."""
    position_index: float
    """Guth's position index p."""

    @property
    def term(self) -> float:
        """L² ω / p², the part of the sum of the UGR formula."""
        return (self.luminance / self.position_index) ** 2 * self.solid_angle


@dataclass(frozen=True)
class Glare:
    """The glare at the eye of an observer (CIE 117): UGR = 8 log10[(0.25/Lb) Σ L² ω / p²]."""

    ugr: float | None
    """The unified glare rating; None where no luminous surface is in sight."""
    standard_error: float
    """Standard error of the rating, from that of the background."""
    background: float
    """Background luminance Lb, cd/m²."""
    sources: list[GlareSource]
    """The luminous surfaces in sight."""
    left_out: int
    """Lights in sight without a luminous area, which UGR does not know."""


@dataclass(frozen=True)
class Readings:
    """What one sensor reads; the arrays have the shape (rows, columns), of points (1, 1)."""

    name: str
    """The name of the sensor."""
    form: str
    """`point`, `line`, `grid`, `luminance`, `camera` or `glare`."""
    unit: str
    """Unit of the values: lx, cd/m2, W/m2 or W/m2/sr."""
    conversion: str
    """How lumens became that unit; empty where they did not."""
    positions: Array
    """Where it was read, metres, shape (rows, columns, 3)."""
    value: Array
    """The readings of a new installation, in `unit`."""
    standard_error: Array
    """Their standard errors, in `unit`."""
    half_interval: Array
    """Half the width of the 95 % interval around each value, in `unit`."""
    direct: Array
    """The part that came straight from a light."""
    indirect: Array
    """The part that was reflected or refracted on its way."""
    samples: npt.NDArray[np.uint64]
    """Samples behind each reading; 0 where there was no time."""
    limits: tuple[float | None, float | None, float | None]
    """Least mean (lx), least uniformity, greatest UGR that are demanded."""
    task: tuple[str, str] | None
    """Row of EN 12464-1: id and name."""
    glare: Glare | None
    """The rating of a glare sensor, whose reading is the vertical illuminance at the eye."""

    @property
    def mean(self) -> float:
        """Mean of the readings, in `unit`."""
        return float(self.value.mean())

    @property
    def mean_error(self) -> float:
        """Standard error of the mean; the readings are independent of each other."""
        return float(np.sqrt(np.square(self.standard_error).sum()) / self.value.size)

    @property
    def min(self) -> float:
        """Smallest reading, in `unit`."""
        return float(self.value.min())

    @property
    def max(self) -> float:
        """Greatest reading, in `unit`."""
        return float(self.value.max())

    @property
    def uniformity(self) -> float | None:
        """U0 = min / mean; None in the dark."""
        return self.min / self.mean if self.mean > 0 else None

    @property
    def diversity(self) -> float | None:
        """Ud = min / max; None in the dark."""
        return self.min / self.max if self.max > 0 else None

    @property
    def relative_error(self) -> float:
        """The greatest relative standard error of a reading; nan where one was not taken."""
        if not self.samples.all():
            return float("nan")
        lit = self.value > 0
        return float((self.standard_error[lit] / self.value[lit]).max()) if lit.any() else 0.0


@dataclass(frozen=True)
class Measurement(Mapping[str, Readings]):
    """Readings by the name of their sensor, with how they came about."""

    sensors: list[Readings]
    """The readings, in the order of the scene."""
    settings: dict[str, Any]
    """`error` (wished), `max_depth`, `roulette_depth`, `seed`, `replicates`."""
    maintenance_factor: float
    """Maintained over initial illuminance, as the scene states it; the readings are initial ones."""
    ended: str
    """`done`, `out of time` or `stopped`."""
    seconds: float
    """How long it took, s."""
    _names: dict[str, Readings] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        self._names.update({sensor.name: sensor for sensor in self.sensors})

    def __getitem__(self, name: str) -> Readings:
        if name not in self._names:
            raise KeyError(f"there is no sensor `{name}`{nearest(name, self._names)}")
        return self._names[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def measure(
    scene: str | Path | Scene,
    *,
    sensors: Sequence[str] | None = None,
    error: float | None = None,
    time: float | None = None,
    seed: int | None = None,
    max_depth: int | None = None,
    max_samples: int | None = None,
    threads: int | None = None,
    progress: Callable[[MeasureProgress], object] | None = None,
) -> Measurement:
    """Measure at the sensors of a scene.

    Every reading is an unbiased Monte Carlo estimate from independent paths; its standard error comes from the scatter of
    32 independently scrambled sequences of samples. Sampling goes on until each reading has the wished error.

    Parameters
    ----------
    scene : path-like, str or Scene
        A scene file; text of one, if it has line breaks; or a scene that was read before.
    sensors : sequence of str, optional
        Names of the sensors to read; all where absent.
    error : float, optional
        Relative standard error that each reading shall reach, 0.01 is 1 %. What is not given here is taken from the
        scene.
    time : float, optional
        Seconds after which sampling stops; readings that are not finished have larger errors.
    seed : int, optional
        Seed; the same seed, build and instruction set give the same bits for any number of threads.
    max_depth : int, optional
        Reflections of a path at most; 0 counts direct light only.
    max_samples : int, optional
        Samples of a reading at most.
    threads : int, optional
        Threads; without it, one per core.
    progress : callable, optional
        Called with a `MeasureProgress` about twenty times per second.

    Returns
    -------
    Measurement
        Readings by the name of their sensor.

    Raises
    ------
    SceneError, ParameterError
        What was given and what is accepted.
    MeasureInterrupted
        On Ctrl-C; its `.measurement` holds what was done.

    Examples
    --------
    >>> import lesk
    >>> scene = '''
    ... version = 1
    ... camera = { eye = [0, -4, 2], target = [0, 0, 1] }
    ... [[lights]]
    ... type = "point"
    ... position = [0, 0, 2]
    ... flux = "1600 lm"
    ... [[sensors]]
    ... type = "point"
    ... name = "desk"
    ... position = [0, 0, 0]
    ... '''
    >>> round(lesk.measure(scene)["desk"].mean, 3)  # 1600 lm / (4 pi 2² m²), lx
    31.831
    """
    wishes = {
        "error": error,
        "time": time,
        "seed": seed,
        "max_depth": max_depth,
        "max_samples": max_samples,
        "threads": threads,
        "sensors": None if sensors is None else list(sensors),
        "camera": None,
    }
    return run(scene, wishes, progress)


def run(
    scene: str | Path | Scene, wishes: dict[str, Any], progress: Callable[[MeasureProgress], object] | None
) -> Measurement:
    """Measure as wished."""
    for name in ("threads", "max_samples"):
        if wishes[name] is not None and wishes[name] < 1:
            raise ParameterError(f"`{name}` is {wishes[name]}, but 1 or more is accepted")
    scene = scene_of(scene)
    observe = None if progress is None else (lambda *now: progress(MeasureProgress(*now)))
    found = _lesk.measure_scene(scene, wishes, observe)
    measurement = Measurement(
        [_readings(data) for data in found.sensors()],
        found.settings(),
        found.maintenance_factor,
        found.ended,
        found.seconds,
    )
    if isinstance(found.raised, KeyboardInterrupt):
        raise MeasureInterrupted(measurement) from None
    if found.raised is not None:
        raise found.raised
    return measurement


def scene_of(scene: str | Path | Scene) -> Scene:
    """Read a scene where it is none yet."""
    if isinstance(scene, Scene):
        return scene
    return parse(scene) if isinstance(scene, str) and "\n" in scene else load(scene)


def _readings(data: dict[str, Any]) -> Readings:
    glare = data.pop("glare")
    if glare is not None:
        glare = Glare(**{**glare, "sources": [GlareSource(**source) for source in glare["sources"]]})
    return Readings(**data, glare=glare)
