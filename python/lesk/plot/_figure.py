"""What all plots share: the look, labels, directions."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, cast

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from lesk._model import Model
from lesk.errors import ParameterError

Array = npt.NDArray[np.float64]

INK = "#24292f"
FAINT = "#d0d7de"
LIGHT = "#e69f00"
"""Colour of the light's direction."""
# Okabe & Ito, *Color Universal Design*, 2008: tells apart for colour-blind readers
CURVES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#8a6d00", "#5b5b5b")
CHANNELS = ("#c8322d", "#2f8a3c", "#2a62b8")

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Weights of Rec.709."""

_STYLE = {
    "axes.edgecolor": INK,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 12,
    "axes.titleweight": "normal",
    "figure.dpi": 110,
    "figure.facecolor": "white",
    "font.family": "sans-serif",
    "font.size": 10,
    "grid.color": FAINT,
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "lines.linewidth": 2.0,
    "lines.solid_capstyle": "round",
    "savefig.dpi": 160,
    "svg.fonttype": "none",
    "svg.hashsalt": "lesk",
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}


class Plot(Figure):
    """A matplotlib figure that shows itself in a notebook without any set-up."""

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        self.savefig(buffer, format="png")
        return buffer.getvalue()

    def savefig(self, fname: Any, **options: Any) -> None:
        """Write the figure with the look that it was made with, without date; see matplotlib."""
        name = str(options.get("format") or fname).lower()
        if name.endswith("svg"):
            options.setdefault("metadata", {"Date": None})
        with style():
            super().savefig(fname, **options)


@contextmanager
def style() -> Iterator[None]:
    """The look of Lesk's plots, for what is made inside."""
    with matplotlib.rc_context(cast("Any", _STYLE)):
        yield


def figure(width: float, height: float) -> Plot:
    """Make an empty figure of a size in inches."""
    return Plot(figsize=(width, height), layout="constrained")


def listed(models: Model | Sequence[Model]) -> list[Model]:
    """Take one model or several; their parameters must be single values."""
    found = [models] if isinstance(models, Model) else list(models)
    if not found:
        raise ParameterError("there is no model to plot")
    for model in found:
        for spec in model.info["parameters"]:
            value = model.params[spec["name"]]
            if value.ndim > (spec["kind"] == "color"):
                raise ParameterError(
                    f"`{spec['name']}` has shape {value.shape}, but a plot needs one value per parameter\n"
                    "hint: plot a list of models"
                )
    return found


def label(model: Model) -> str:
    """Name a model by its id and the parameters that differ from their defaults."""
    own = []
    for spec in model.info["parameters"]:
        value = model.params[spec["name"]]
        if not np.allclose(value, spec["default"], rtol=1e-6):
            shown = f"{value:g}" if value.ndim == 0 else _color(value)
            own.append(f"{spec['name']} {shown}")
    return f"{model.id} · {', '.join(own)}" if own else model.id


def _color(value: npt.NDArray[Any]) -> str:
    if (value == value[0]).all():
        return f"{value[0]:g}"
    return "(" + ", ".join(f"{v:.3g}" for v in value) + ")"


def direction(theta: npt.ArrayLike, phi: npt.ArrayLike = 0.0) -> Array:
    """Unit vectors from polar angle and azimuth in radians."""
    theta, phi = np.broadcast_arrays(np.asarray(theta, float), np.asarray(phi, float))
    x, y = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi)
    return cast("Array", np.stack([x, y, np.cos(theta)], axis=-1))


def polar_angle(name: str, degrees: float, most: float = 90.0) -> float:
    """Take an angle from the normal in degrees, give radians."""
    if not 0 <= degrees < most:
        raise ParameterError(f"`{name}` is {degrees:g}, but 0 to below {most:g} degrees is accepted")
    return float(np.radians(degrees))


def luminance(rgb: npt.NDArray[Any]) -> Array:
    """Weigh the channels of the last axis."""
    return cast("Array", rgb @ LUMINANCE)


def is_grey(rgb: npt.NDArray[Any]) -> bool:
    """Whether the channels are equal to the eye."""
    return bool(np.allclose(rgb, rgb[..., :1], rtol=2e-3, atol=1e-9))


def warped(center: float, low: float, high: float, count: int, sharpness: float = 5.0) -> Array:
    """Numbers from low to high that are dense around a center: narrow lobes keep their shape."""
    t = np.sinh(sharpness * np.linspace(-1, 1, count)) / np.sinh(sharpness)
    return cast("Array", np.where(t < 0, center + t * (center - low), center + t * (high - center)))
