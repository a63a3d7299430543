"""The cloudless sky of Hosek and Wilkie in numbers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from lesk import _lesk
from lesk.errors import ParameterError

Array = npt.NDArray[np.float64]

_LUMINANCE = np.array([_lesk.rgb_to_xyz(unit, "srgb")[1] for unit in np.eye(3).tolist()])


class HosekSky:
    """The cloudless sky of Hosek and Wilkie (2012) and its sun (2013), in physical units.

    Directions are given by the distance from the zenith and the azimuth from north over east, degrees.

    Parameters
    ----------
    turbidity : float
        1 to 10: 2 is a very clear sky, 3 a clear one, 6 a hazy one.
    elevation_deg : float
        Of the sun, 0 to 90.
    azimuth_deg : float
        Of the sun.
    ground : float or sequence of 3 floats
        Reflectance of the ground, 0 to 1, grey or linear Rec.709; it brightens the sky.

    Raises
    ------
    LightError
        For a state that the model does not have.
    """

    def __init__(
        self, turbidity: float, *, elevation_deg: float, azimuth_deg: float = 0.0, ground: float | Sequence[float] = 0.0
    ) -> None:
        channels = [float(ground)] * 3 if isinstance(ground, (int, float)) else [float(v) for v in ground]
        if len(channels) != 3:
            raise ParameterError(f"`ground` has {len(channels)} numbers, but one or three are accepted")
        self.turbidity, self.elevation_deg, self.azimuth_deg = turbidity, elevation_deg, azimuth_deg
        self._core = _lesk.HosekSky(turbidity, channels, elevation_deg, azimuth_deg)

    def __repr__(self) -> str:
        return f"<HosekSky of turbidity {self.turbidity:g}, sun at {self.elevation_deg:g}°>"

    def rgb(self, zenith_deg: npt.ArrayLike, azimuth_deg: npt.ArrayLike) -> Array:
        """Give linear Rec.709 whose luminance is cd/m², of shape (..., 3); without the sun's disk."""
        z, a = _directions(zenith_deg, azimuth_deg)
        return self._core.rgb(z.ravel(), a.ravel()).reshape((*z.shape, 3))

    def luminance(self, zenith_deg: npt.ArrayLike, azimuth_deg: npt.ArrayLike) -> Array | float:
        """Give luminances in cd/m², without the sun's disk."""
        values = self.rgb(zenith_deg, azimuth_deg) @ _LUMINANCE
        return values if values.ndim else float(values)

    def spectral_radiance(
        self, zenith_deg: npt.ArrayLike, azimuth_deg: npt.ArrayLike, lambda_nm: npt.ArrayLike
    ) -> Array | float:
        """Give radiances in W/(m² sr nm), without the sun's disk; 0 outside 320 to 720 nm."""
        z, a, nm = np.broadcast_arrays(
            *_directions(zenith_deg, azimuth_deg, lambda_nm), np.asarray(lambda_nm, np.float64)
        )
        values = self._core.spectral_radiance(*(np.ascontiguousarray(v.ravel()) for v in (z, a, nm))).reshape(z.shape)
        return values if values.ndim else float(values)

    @cached_property
    def illuminance_lx(self) -> float:
        """Illuminance of a horizontal plane by the sky without the sun, lx, as scenes have it."""
        return self._core.illuminance()

    @property
    def sun_rgb(self) -> Array:
        """Illuminance of a plane perpendicular to the sun, by its disk alone: linear Rec.709 whose luminance is lx."""
        return np.array(self._core.sun_rgb())

    @property
    def sun_illuminance_lx(self) -> float:
        """Illuminance of a plane perpendicular to the sun, by its disk alone, lx."""
        return float(self.sun_rgb @ _LUMINANCE)

    def sun_spectral_irradiance(self, lambda_nm: npt.ArrayLike) -> Array | float:
        """Give irradiances of a plane perpendicular to the sun, by its disk alone, W/(m² nm)."""
        nm = np.asarray(lambda_nm, np.float64)
        values = self._core.sun_spectral_irradiance(np.ascontiguousarray(nm.ravel())).reshape(nm.shape)
        return values if values.ndim else float(values)


def _directions(zenith_deg: npt.ArrayLike, azimuth_deg: npt.ArrayLike, *others: npt.ArrayLike) -> tuple[Array, Array]:
    z, a, *_ = np.broadcast_arrays(*(np.asarray(v, np.float64) for v in (zenith_deg, azimuth_deg, *others)))
    if not (np.isfinite(a).all() and ((z >= 0) & (z <= 90)).all()):
        raise ParameterError(
            "a direction is below the horizon or not finite, but zenith distances of 0 to 90 degrees are accepted"
        )
    # copies: broadcast arrays are not contiguous
    return np.array(z), np.array(a)
