"""Spectra of light: illuminants, black bodies, lines, LEDs, tables from files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import FileError, ParameterError

ENDINGS = (".csv", ".spd", ".txt", ".dat")
"""Names that end like this are files."""
_MOST_BYTES = 4 << 20


@dataclass(frozen=True)
class ColorRendering:
    """Colour rendering indices of a light (CIE 13.3-1995)."""

    ra: float
    """The general index Ra, the mean of R1 to R8."""
    r: tuple[float, ...]
    """The special indices R1 to R14."""


class Spectrum:
    """A spectrum of light per nm; `lesk.spectrum` makes it."""

    def __init__(self, core: _lesk.Spectrum) -> None:
        self.core = core

    @property
    def name(self) -> str:
        """Its name: `D65`, `blackbody 2856 K`, a file's name."""
        return self.core.name

    @property
    def range(self) -> tuple[int, int] | None:
        """First and last nm that count as all of its light; None for the whole spectrum of a black body or a line."""
        return self.core.range

    def at(self, lambda_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Evaluate it.

        Parameters
        ----------
        lambda_nm : array_like
            Wavelengths in nm.

        Returns
        -------
        ndarray
            Of the same shape; per nm, on a scale of its own unless it was measured. A single line gives 0.
        """
        nm = np.asarray(lambda_nm, float)
        return np.array(self.core.at(nm.ravel().tolist())).reshape(nm.shape)

    def efficacy(self, range: str | None = None, *, scotopic: bool = False) -> float:
        """Luminous efficacy of radiation, lm per watt within a range.

        Parameters
        ----------
        range : str, optional
            First and last nm, `"380:780"`; without it `.range`.
        scotopic : bool
            For eyes adapted to the dark.

        Returns
        -------
        float
            lm/W.

        Examples
        --------
        >>> import lesk
        >>> round(lesk.spectrum("D65").efficacy("380:780"), 2)
        205.15
        """
        return self.core.efficacy(range, scotopic)

    def energy(self, range: str | None = None) -> float:
        """Integral over a range, `"400:700"` nm, in the unit of the spectrum times nm."""
        return self.core.energy(range)

    def photons_per_joule(self, range: str | None = None) -> float:
        """Photons of a joule within a range, `"400:700"` nm."""
        return self.core.photons_per_joule(range)

    def xyz(self, observer: str = "1931") -> npt.NDArray[np.float64]:
        """CIE XYZ as seen by the observer `1931`, `1964`, `2006-2` or `2006-10`; ndarray of shape (3,), without K_m."""
        return np.array(self.core.xyz(observer))

    def xy(self, observer: str = "1931") -> npt.NDArray[np.float64]:
        """Chromaticity x, y; ndarray of shape (2,). A light that the observer does not see is a `ParameterError`."""
        xyz = self._seen(observer)
        return cast("npt.NDArray[np.float64]", xyz[:2] / xyz.sum())

    @property
    def color_temperature(self) -> tuple[float, float] | None:
        """Correlated colour temperature in K and Duv; None where the CIE gives them no meaning (Duv beyond 0.05)."""
        return self.core.color_temperature()

    @property
    def color_rendering(self) -> ColorRendering | None:
        """Colour rendering indices; None where there is no colour temperature."""
        found = self.core.color_rendering()
        return None if found is None else ColorRendering(found[0], tuple(found[1]))

    def rgb(self, space: str = "srgb") -> npt.NDArray[np.float64]:
        """Linear RGB with luminance Y = 1, in `srgb`, `display-p3`, `rec2020` or `acescg`; negative outside the gamut."""
        xyz = self._seen("1931")
        return np.array(_lesk.xyz_to_rgb((xyz / xyz[1]).tolist(), space))

    def _seen(self, observer: str) -> npt.NDArray[np.float64]:
        xyz = self.xyz(observer)
        if not (xyz[1] > 0 and xyz.sum() > 0):
            raise ParameterError(f"`{self.name}` has no light that the observer `{observer}` sees, and so no colour")
        return xyz

    def __repr__(self) -> str:
        return f"<Spectrum {self.name}>"


def spectrum(source: str | Path) -> Spectrum:
    """Give a spectrum by its name, or read one from a file.

    Parameters
    ----------
    source : str or path-like
        `A`, `E`, `D65` (D40 to D250), `FL1` to `FL12`, `FL3.1` to `FL3.15`, `HP1` to `HP5`, `LED-B1` and its
        siblings, sunlight `AM0`, `AM1.5G`, `AM1.5D` (W/m2/nm), `blackbody 2856 K`, `555 nm`, `gaussian 450 nm, 20 nm`
        (peak, width at half maximum); or a file (.csv, .spd, .txt, .dat) with two columns, wavelengths in nm and values.

    Returns
    -------
    Spectrum
        With its colours, efficacies and indices.

    Raises
    ------
    ParameterError
        An unknown name, or a table that cannot be read: the text names the line.
    FileError
        A file that cannot be read.

    Examples
    --------
    >>> import lesk
    >>> kelvin, duv = lesk.spectrum("FL2").color_temperature
    >>> round(kelvin), round(lesk.spectrum("FL2").color_rendering.ra)
    (4225, 64)
    """
    text = str(source)
    if isinstance(source, Path) or Path(text).suffix.lower() in ENDINGS:
        return Spectrum(_lesk.Spectrum.from_text(Path(text).name, _read(Path(text))))
    return Spectrum(_lesk.Spectrum.parse(text))


def _read(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as error:
        raise FileError(f"cannot read `{path}`: {(error.strerror or str(error)).lower()}") from None
    if b"\0" in data:
        raise ParameterError(f"`{path}` is not text, a table of wavelengths in nm and values is accepted")
    # measuring programs write Latin-1 in their heads; digits are the same in both
    return data.decode("utf-8", errors="replace")
