"""Colour: standard observers, RGB spaces, reflectance spectra of colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from lesk import _lesk

__all__ = ["Reflectance", "convert", "observer", "reflectance", "rgb", "spaces", "xyz"]


def spaces() -> list[str]:
    """Names of the linear RGB spaces: `srgb`, `display-p3`, `rec2020`, `acescg`."""
    return _lesk.rgb_spaces()


def convert(rgb: npt.ArrayLike, source: str, target: str) -> npt.NDArray[np.float64]:
    """Convert linear RGB between spaces; white stays white (Bradford adaptation where the whites differ).

    Parameters
    ----------
    rgb : array_like of shape (3,)
        Linear, not encoded.
    source, target : str
        Names of `spaces()`.

    Returns
    -------
    ndarray of shape (3,)
        Linear; negative where the target cannot show the colour.

    Examples
    --------
    >>> import lesk
    >>> lesk.color.convert([0, 1, 0], "display-p3", "srgb").round(4).tolist()
    [-0.2249, 1.0421, -0.0786]
    """
    return np.array(_lesk.rgb_convert(_three(rgb), source, target))


def xyz(rgb: npt.ArrayLike, space: str = "srgb") -> npt.NDArray[np.float64]:
    """CIE XYZ of linear RGB, ndarray of shape (3,); without adaptation, white has Y = 1."""
    return np.array(_lesk.rgb_to_xyz(_three(rgb), space))


def rgb(xyz: npt.ArrayLike, space: str = "srgb") -> npt.NDArray[np.float64]:
    """Linear RGB of CIE XYZ, ndarray of shape (3,); without adaptation, negative outside the gamut."""
    return np.array(_lesk.xyz_to_rgb(_three(xyz), space))


def observer(name: str, lambda_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Colour matching functions of a standard observer.

    Parameters
    ----------
    name : str
        `1931`, `1964`, `2006-2`, `2006-10`; `V` and `V'` for the luminous efficiencies by day and in the dark.
    lambda_nm : array_like of shape (N,)
        Wavelengths in nm.

    Returns
    -------
    ndarray of shape (N, 3), or (N, 1) for `V` and `V'`
        Zero outside the tables.
    """
    return np.array(_lesk.observer(name, np.atleast_1d(np.asarray(lambda_nm, float)).tolist()))


@dataclass(frozen=True)
class Reflectance:
    """A smooth reflectance spectrum (Jakob and Hanika 2019)."""

    rgb: tuple[float, float, float]
    """The linear sRGB colour that it was made for."""
    error: float
    """Largest difference of a channel between `.rgb` and the colour of the spectrum under D65."""

    def at(self, lambda_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Evaluate it at wavelengths in nm; values between 0 and 1."""
        nm = np.asarray(lambda_nm, float)
        return np.array(_lesk.reflectance(list(self.rgb), nm.ravel().tolist())[0]).reshape(nm.shape)


def reflectance(rgb: npt.ArrayLike) -> Reflectance:
    """Find a smooth reflectance spectrum that has a colour under D65.

    Parameters
    ----------
    rgb : array_like of shape (3,)
        Linear sRGB, 0 to 1.

    Returns
    -------
    Reflectance
        With its error; channels below 0.001 or above 0.999 are not reached exactly.

    Raises
    ------
    ParameterError
        A channel outside 0 to 1.

    Examples
    --------
    >>> import lesk
    >>> lesk.color.reflectance([0.5, 0.5, 0.5]).at([400, 700]).round(6).tolist()
    [0.5, 0.5]
    """
    three = _three(rgb)
    return Reflectance((three[0], three[1], three[2]), _lesk.reflectance(three, [])[2])


def _three(values: npt.ArrayLike) -> list[float]:
    array = np.asarray(values, float)
    if array.shape != (3,):
        from lesk.errors import ParameterError

        raise ParameterError(f"a colour has shape {array.shape}, but (3,) is accepted")
    return [float(value) for value in array]
