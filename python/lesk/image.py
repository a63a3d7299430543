"""Pictures: EXR, HDR, PNG and JPEG in, EXR, HDR and PNG out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import ImageError

Pixels = npt.NDArray[np.float32]

__all__ = ["TONE_MAPPERS", "develop", "meter", "read", "read_layers", "write"]

TONE_MAPPERS: list[str] = _lesk.tone_mappers()
"""Names of the tone mappers; the first is the default: exposure and the sRGB curve, clipped."""


def read(path: str | Path) -> Pixels:
    """Read a picture.

    Parameters
    ----------
    path : path-like
        An EXR, HDR, PNG or JPEG file.

    Returns
    -------
    ndarray of shape (height, width, channels), float32
        Linear values; those of PNG and JPEG are decoded from sRGB to 0..1. Row 0 is the top row.
    """
    pixels, _ = _lesk.read_image(Path(path), True)
    return pixels


def read_layers(path: str | Path) -> tuple[dict[str, npt.NDArray[Any]], dict[str, str]]:
    """Read all channels of an EXR file by name, shape (height, width), and its text attributes."""
    channels, attributes, _ = _lesk.read_planes(Path(path))
    return dict(channels), dict(attributes)


def write(path: str | Path, pixels: npt.ArrayLike, *, depth: int = 8) -> None:
    """Write a picture; the ending of the name decides on the format.

    Parameters
    ----------
    path : path-like
        Ends in `.exr`, `.hdr` or `.png`. A previous file stays as it was if writing fails.
    pixels : array_like of shape (height, width, channels) or (height, width)
        Linear values; PNG takes 0..1 and encodes them as sRGB.
    depth : int
        Bits per channel of a PNG: 8 or 16.
    """
    array = np.asarray(pixels, np.float32)
    if array.ndim == 2:
        array = array[..., np.newaxis]
    if array.ndim != 3:
        raise ImageError(f"the picture has shape {array.shape}, but (height, width, channels) is accepted")
    _lesk.write_image(Path(path), np.ascontiguousarray(array), False, depth)


def meter(pixels: npt.ArrayLike) -> float | None:
    """Give the EV100 at which a linear picture in cd/m² has its log-average luminance at middle grey."""
    return _lesk.meter(np.ascontiguousarray(pixels, np.float32))


def develop(pixels: npt.ArrayLike, *, ev100: float, mapper: str = TONE_MAPPERS[0]) -> Pixels:
    """Expose, tone map and encode a linear picture in cd/m².

    Parameters
    ----------
    pixels : array_like of shape (height, width, 3)
        Linear Rec.709 whose luminance Y is cd/m².
    ev100 : float
        Exposure value at ISO 100.
    mapper : str
        One of `TONE_MAPPERS`.

    Returns
    -------
    ndarray of shape (height, width, 3), float32
        sRGB-encoded, 0..1.
    """
    return _lesk.develop(np.ascontiguousarray(pixels, np.float32), ev100, mapper)
