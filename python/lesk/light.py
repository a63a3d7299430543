r"""Luminaires (IES LM-63 and EULUMDAT files, read, integrated, converted and written) and the cloudless sky.

>>> import lesk
>>> text = "IES:LM-63-2019\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1.00001 9\n0 180\n0\n100 100\n"
>>> lamp = lesk.light.parse(text)
>>> round(lamp.flux_lm, 3)  # 4 pi 100 cd
1256.637

Directions: `theta` is the angle from nadir, `phi` the azimuth from C0 toward C90; degrees, as in the files. Between its
angles a table is bilinear, and its flux is the exact integral of that.
"""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk._sky import HosekSky
from lesk.errors import FileError, ParameterError

Array = npt.NDArray[np.float64]

__all__ = ["REFLECTANCES", "ROOMS", "HosekSky", "Luminaire", "parse", "read"]

ROOMS: list[list[int]]
"""Rooms of UGR tables: sizes across and along the line of sight, in heights of the luminaires above the eye."""
REFLECTANCES: list[list[int]]
"""Reflectances of UGR tables: ceiling, walls and floor, percent."""
ROOMS, REFLECTANCES = _lesk.ugr_rooms()

EDITIONS = (1986, 1991, 1995, 2002, 2019)
"""Editions of LM-63 that can be written."""


def read(path: str | Path, *, strict: bool = False, lamp_set: int = 0) -> Luminaire:
    """Read an IES or EULUMDAT file; its content decides which it is.

    Parameters
    ----------
    path : path-like
        The file.
    strict : bool
        Refuse what would otherwise be repaired with a warning.
    lamp_set : int
        Which lamp set of an EULUMDAT file is taken, from 0.

    Returns
    -------
    Luminaire

    Raises
    ------
    LightError
        With line and field of what cannot be understood.
    FileError
        Where the file cannot be read.
    """
    path = Path(path)
    try:
        with path.open("rb"):
            pass
    except OSError as error:
        raise FileError(f"cannot read `{path}`: {(error.strerror or str(error)).lower()}") from None
    return Luminaire(_lesk.Photometry.read(path, strict, _lamp_set(lamp_set)))


def parse(text: str | bytes, *, strict: bool = False, lamp_set: int = 0) -> Luminaire:
    """Read the content of a file, as `read` does."""
    content = text.encode() if isinstance(text, str) else text
    return Luminaire(_lesk.Photometry.parse(content, strict, _lamp_set(lamp_set)))


def _lamp_set(number: int) -> int:
    if number < 0:
        raise ParameterError(f"`lamp_set` is {number}, but 0 or more is accepted")
    return number


class Luminaire:
    """A luminaire: its distribution of intensities and what its file says about it."""

    def __init__(self, core: _lesk.Photometry) -> None:
        self._core = core

    def __repr__(self) -> str:
        flux = f"{self.flux_lm:.5g} lm" if self.flux_lm is not None else f"{self.facts['flux_mw']:.5g} mW"
        return f"<Luminaire {self.facts['format']}, type {self.type}, {flux}>"

    @cached_property
    def facts(self) -> dict[str, Any]:
        """All scalar facts, as `lesk light --json` prints them; names end in their units."""
        return cast("dict[str, Any]", json.loads(self._core.facts_json()))

    @property
    def flux_lm(self) -> float | None:
        """Luminous flux, lm: the exact integral of the bilinear table; None where the file counts watts."""
        return cast("float | None", self.facts["flux_lm"])

    @property
    def declared_flux_lm(self) -> float | None:
        """Flux that the header states, lm: of the luminaire, else of its lamps."""
        return cast("float | None", self.facts["declared_flux_lm"])

    @property
    def symmetry(self) -> str:
        """`rotational`, `quadrant`, `c0_c180`, `c90_c270` or `none`, as the file states it."""
        return str(self.facts["symmetry"])

    @property
    def type(self) -> str:
        """`A`, `B` or `C`: how the angles of the table are meant."""
        return str(self.facts["type"])

    @property
    def opening(self) -> dict[str, Any]:
        """The luminous opening: `shape`, and extents `c0_m`, `c90_m`, `height_m`."""
        return dict(self.facts["opening"])

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """What was repaired or is doubtful: `line`, `field`, `text`."""
        return list(self.facts["warnings"])

    @property
    def beam_angle_deg(self) -> tuple[float, float]:
        """Full angles at half of the maximum, degrees, in the planes C0-C180 and C90-C270."""
        return self._core.opening_angles(0.5)

    @property
    def field_angle_deg(self) -> tuple[float, float]:
        """Full angles at a tenth of the maximum, degrees, in the planes C0-C180 and C90-C270."""
        return self._core.opening_angles(0.1)

    def candela(self, theta_deg: npt.ArrayLike, phi_deg: npt.ArrayLike = 0.0) -> Array | float:
        """Look up intensities.

        Parameters
        ----------
        theta_deg : array_like
            Angles from nadir, degrees.
        phi_deg : array_like
            Azimuths from C0 toward C90, degrees; broadcast with `theta_deg`.

        Returns
        -------
        ndarray or float
            cd; W/sr where the file counts watts. 0 outside of the table.
        """
        theta, phi = np.broadcast_arrays(np.asarray(theta_deg, np.float64), np.asarray(phi_deg, np.float64))
        if not (np.isfinite(theta).all() and np.isfinite(phi).all()):
            raise ParameterError("an angle is not finite, but finite degrees are accepted")
        values = self._core.candela(np.ascontiguousarray(theta.ravel()), np.ascontiguousarray(phi.ravel()))
        return values.reshape(theta.shape) if theta.ndim else float(values[0])

    def table(self) -> tuple[Array, Array, Array]:
        """Give vertical and horizontal angles in degrees, and intensities of shape (horizontal, vertical)."""
        return self._core.table()

    def ugr(self, *, spacing: float = 0.25) -> Array | None:
        """Give the UGR table (CIE 117:1995, CIE 190:2010).

        Parameters
        ----------
        spacing : float
            Spacing of the luminaires over their height above the eye: 0.25 in catalogues, 1 in CIE 190.

        Returns
        -------
        ndarray of shape (19, 10) or None
            One row per room of `ROOMS`; crosswise with each of `REFLECTANCES`, then endwise. None where the luminaire
            has no luminous area. For the flux of the luminaire as it is.
        """
        if not 0.05 <= spacing <= 2:
            raise ParameterError(f"`spacing` is {spacing:g}, but 0.05 to 2 is accepted")
        found = self._core.ugr(spacing)
        return None if found is None else found[0]

    def ugr_uncorrected(self, *, spacing: float = 0.25) -> Array | None:
        """Give the UGR table for 1000 lm in the lamps, as CIE 190 prints it; see `ugr`."""
        self.ugr(spacing=spacing)
        found = self._core.ugr(spacing)
        return None if found is None else found[0] + found[1]

    def resample(self, v_step_deg: float = 1.0, h_step_deg: float = 5.0) -> Luminaire:
        """Make the same distribution as a table of type C in equal steps of degrees, by the bilinear rule."""
        return Luminaire(self._core.resampled(v_step_deg, h_step_deg))

    def to_ies(self, *, edition: int = 2019) -> str:
        """Give the text of an IES file of an edition: 1986, 1991, 1995, 2002 or 2019."""
        return self._core.to_ies(edition)

    def to_eulumdat(self) -> str:
        """Give the text of an EULUMDAT file."""
        return self._core.to_eulumdat()

    def write(self, path: str | Path, *, edition: int = 2019) -> None:
        """Write the luminaire: `.ies` in an edition of LM-63, `.ldt` as EULUMDAT."""
        path = Path(path)
        ending = path.suffix.lower()
        if ending not in (".ies", ".ldt"):
            raise ParameterError(f"`{path.name}` ends in `{path.suffix}`, but .ies and .ldt are accepted")
        text = self.to_ies(edition=edition) if ending == ".ies" else self.to_eulumdat()
        try:
            path.write_bytes(text.encode("latin-1", "replace"))
        except OSError as error:
            raise FileError(f"cannot write `{path}`: {(error.strerror or str(error)).lower()}") from None
