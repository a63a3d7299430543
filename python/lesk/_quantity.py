"""Quantities of light with units, and conversions that say what they assume."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from lesk import _lesk
from lesk._spectrum import Spectrum, spectrum


@dataclass(frozen=True)
class Step:
    """One step of a conversion."""

    formula: str
    """The formula: `E = I cos θ / d²`."""
    assumption: str
    """What it assumes, with its numbers."""
    value: float
    """The value after the step."""
    unit: str
    """Its unit."""

    def __str__(self) -> str:
        return f"= {self.value:.6g} {self.unit}    {self.formula}: {self.assumption}"


@dataclass(frozen=True)
class Quantity:
    """A number with a unit, and how it was found."""

    value: float
    """The number."""
    unit: str
    """The unit, like `lx`."""
    dimension: str
    """What it is: `illuminance`, `radiant flux`, ..."""
    spectrum: str | None = None
    """The spectrum that was given with it: `D65` of `500 lx @ D65`."""
    steps: tuple[Step, ...] = ()
    """From the quantity that was converted to this one; empty where only the unit changed."""
    unused: tuple[str, ...] = ()
    """Options of the conversion that were not needed."""

    def to(
        self,
        unit: str,
        *,
        distance: str | None = None,
        cone: str | None = None,
        solid_angle: str | None = None,
        area: str | None = None,
        reflectance: float | str | None = None,
        incidence: str | None = None,
        time: str | None = None,
        width: str | None = None,
        efficacy: str | None = None,
        spectrum: str | Path | Spectrum | None = None,
        range: str | None = None,
        km: float | str | None = None,
        lambertian: bool = False,
        dome: bool = False,
        scotopic: bool = False,
    ) -> Quantity:
        """Convert to another unit; each step names what it assumes.

        Parameters
        ----------
        unit : str
            A unit (`lx`, `cd/m2`, `umol/s/m2`) or the name of a quantity (`illuminance`, `PPFD`).
        distance : str, optional
            From the source to the lit point, with its unit: `"1.5 m"`.
        cone : str, optional
            Half-angle of a cone that holds all the light, evenly: `"30 deg"`.
        solid_angle : str, optional
            Solid angle of the light or of a source: `"0.1 sr"`.
        area : str, optional
            Area that is lit evenly, or that shines: `"2 m2"`.
        reflectance : float or str, optional
            Reflectance of a Lambertian surface, 0 to 1.
        incidence : str, optional
            Angle between the light and the normal of the lit surface: `"60 deg"`.
        time : str, optional
            How long a constant light shines: `"8 h"`.
        width : str, optional
            Width of a band, between W/nm and W: `"10 nm"`.
        efficacy : str, optional
            Lumens of a watt, where no spectrum is known: `"100 lm/W"`.
        spectrum : str, path-like or Spectrum, optional
            The light's spectrum: a name, a file, or what `lesk.spectrum` gives.
        range : str, optional
            Wavelengths that count as the light's energy: `"380:780"`, nm.
        km : float or str, optional
            Another maximum luminous efficacy than 683.002, lm/W.
        lambertian : bool
            The source is a Lambertian surface.
        dome : bool
            The light comes from an even hemisphere.
        scotopic : bool
            Count lumens for eyes adapted to the dark: V'(λ), 1700.06 lm/W.

        Returns
        -------
        Quantity
            With `.value`, `.unit`, `.steps`.

        Raises
        ------
        ParameterError
            Where something is missing or not accepted; the text names the option that helps.

        Examples
        --------
        >>> import lesk
        >>> lux = lesk.quantity("1100 lm").to("lx", distance="1.5 m")
        >>> print(lux)
        38.9045 lx
        >>> lux.steps[0].assumption
        'shines alike in all directions'
        """
        texts = {
            "distance": distance,
            "cone": cone,
            "solid_angle": solid_angle,
            "area": area,
            "reflectance": reflectance,
            "incidence": incidence,
            "time": time,
            "width": width,
            "efficacy": efficacy,
            "range": range,
            "km": km,
            "lambertian": lambertian or None,
            "dome": dome or None,
            "scotopic": scotopic or None,
        }
        options = [(name, str(text)) for name, text in texts.items() if text is not None]
        light = None if spectrum is None else _spectrum(spectrum)
        value, shown, steps, unused = _lesk.quantity_convert(self._given(), unit, options, light)
        dimension = _lesk.quantity_parse(f"{value!r} {shown}")[2]
        kept = self.spectrum if light is None else self.spectrum or light.name
        return Quantity(value, shown, dimension, kept, tuple(Step(*step) for step in steps), tuple(unused))

    def explain(self) -> str:
        """Tell the chain of steps, one a line."""
        return "\n".join([str(self), *(f"  {step}" for step in self.steps)])

    def _given(self) -> str:
        at = f" @ {self.spectrum}" if self.spectrum else ""
        return f"{self.value!r} {self.unit}{at}"

    def __str__(self) -> str:
        return f"{self.value:.6g} {self.unit}"

    def __float__(self) -> float:
        return self.value


def _spectrum(given: str | Path | Spectrum) -> _lesk.Spectrum:
    return (given if isinstance(given, Spectrum) else spectrum(given)).core


def quantity(text: str) -> Quantity:
    """Read a quantity of light.

    Parameters
    ----------
    text : str
        A number with a unit, and behind `@` the spectrum of the light where it is known: `"1100 lm"`, `"3e3 cd/m^2"`,
        `"20 mW/cm2"`, `"1 W @ 600 nm"`, `"500 lx @ D65"`.

    Returns
    -------
    Quantity
        `.value`, `.unit`, and `.to(...)` for another unit.

    Raises
    ------
    ParameterError
        A text that is not a number with a unit.

    Examples
    --------
    >>> import lesk
    >>> print(lesk.quantity("1 W @ 600 nm").to("lm"))
    430.974 lm
    >>> print(lesk.quantity("1 fc").to("lx"))
    10.7639 lx
    """
    value, unit, dimension, light = _lesk.quantity_parse(text)
    return Quantity(value, unit, dimension, light)
