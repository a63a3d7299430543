"""Pictures that move: APNG and GIF."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from lesk.errors import FileError, ParameterError
from lesk.plot._figure import Plot, style

Frame = npt.NDArray[np.uint8]

_DPI = 80
_COLORS = 256
"""Colours of a GIF, one palette for all frames: no flicker between palettes."""


class Animation:
    """Frames that repeat; it shows itself in a notebook.

    Parameters
    ----------
    frames : iterable of ndarray of shape (height, width, 3), uint8
        sRGB-encoded pictures of one size.
    seconds : float
        How long each frame is shown, s.
    """

    ENDINGS = (".png", ".apng", ".gif")

    def __init__(self, frames: Iterable[Frame], *, seconds: float = 0.08) -> None:
        self.frames: list[Frame] = list(frames)
        self.seconds = seconds
        if not self.frames:
            raise ParameterError("an animation has no frame")

    def savefig(self, path: str | Path) -> None:
        """Write the animation: `.png` and `.apng` are animated PNG, `.gif` is GIF.

        Parameters
        ----------
        path : path-like
            The file.
        """
        path = Path(path)
        if path.suffix.lower() not in self.ENDINGS:
            accepted = ", ".join(self.ENDINGS)
            raise ParameterError(f"`{path.name}` ends in `{path.suffix}`, but an animation accepts {accepted}")
        data = self._bytes("GIF" if path.suffix.lower() == ".gif" else "PNG")
        try:
            path.write_bytes(data)
        except OSError as error:
            raise FileError(f"cannot write `{path}`: {(error.strerror or str(error)).lower()}") from None

    def _bytes(self, kind: str) -> bytes:
        pictures = [Image.fromarray(frame) for frame in self.frames]
        if kind == "GIF":
            palette = self._palette()
            pictures = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
        buffer = io.BytesIO()
        options: dict[str, Any] = {"save_all": True, "append_images": pictures[1:], "duration": 1000 * self.seconds}
        pictures[0].save(buffer, format=kind, optimize=True, loop=0, **options)
        return buffer.getvalue()

    def _palette(self) -> Image.Image:
        """The colours of several frames; the ground stays white."""
        some = Image.fromarray(np.concatenate(self.frames[:: max(1, len(self.frames) // 6)]))
        palette = some.quantize(_COLORS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        entries = np.array(palette.getpalette()).reshape(-1, 3)
        entries[entries.sum(axis=1).argmax()] = 255
        palette.putpalette(entries.ravel().tolist())
        return palette

    def _repr_png_(self) -> bytes:
        return self._bytes("PNG")


def drawn(figure: Plot) -> Frame:
    """Draw a figure as a frame, shape (height, width, 3)."""
    buffer = io.BytesIO()
    with style():
        figure.savefig(buffer, format="png", dpi=_DPI)
    return np.asarray(Image.open(buffer).convert("RGB"))
