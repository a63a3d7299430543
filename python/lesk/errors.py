"""Errors of the package: what was given, what is accepted, and a hint on a line of its own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lesk._measure import Measurement
    from lesk._render import Render


class LeskError(Exception):
    """Base of all errors that Lesk raises on bad input."""


class ParameterError(LeskError, ValueError):
    """A parameter, direction or array that is not accepted."""


class SceneError(LeskError, ValueError):
    """A scene that cannot be rendered; the text lists all its faults with their places."""


class ImageError(LeskError, ValueError):
    """An image that is damaged, too large or of another kind than asked for."""


class LightError(LeskError, ValueError):
    """A luminaire file that cannot be understood, or a light that cannot shine; the text names line and field."""


class FileError(LeskError, OSError):
    """A file that cannot be read or written; a previous file of its name is unchanged."""


class CheckpointError(LeskError, ValueError):
    """A checkpoint that is damaged or belongs to another picture."""


class RenderInterrupted(KeyboardInterrupt):
    """Ctrl-C during `lesk.render`; `render` holds what was done until then."""

    def __init__(self, render: Render) -> None:
        super().__init__("the render was interrupted; `.render` holds what was done")
        self.render = render


class MeasureInterrupted(KeyboardInterrupt):
    """Ctrl-C during `lesk.measure` or `lesk.lux`; `measurement` holds what was done until then."""

    def __init__(self, measurement: Measurement) -> None:
        super().__init__("measuring was interrupted; `.measurement` holds what was done")
        self.measurement = measurement


def nearest(given: str, known: Iterable[str]) -> str:
    """Give a hint for a misspelt name, as a line to append; empty where nothing is near."""
    from difflib import get_close_matches

    close = get_close_matches(given, list(known), n=1)
    return f"\nhint: did you mean `{close[0]}`?" if close else ""


def quoted(names: Iterable[str]) -> str:
    """Join names for a message: `a`, `b`, `c`."""
    return ", ".join(f"`{name}`" for name in names)
