"""Spectra of lights, and the eyes that see them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lesk import _lesk
from lesk._spectrum import Spectrum
from lesk._spectrum import spectrum as _spectrum
from lesk.errors import ParameterError
from lesk.plot._figure import CHANNELS, CURVES, INK, Plot, figure, style

_NM = np.arange(360.0, 831.0)


def spectrum(lights: str | Path | Spectrum | Sequence[str | Path | Spectrum]) -> Plot:
    """Plot spectra over the wavelength, each scaled to its maximum, with the colours of the rainbow below.

    Parameters
    ----------
    lights : Spectrum, str, path-like, or a sequence of them
        Names, files or what `lesk.spectrum` gives.

    Returns
    -------
    Plot
        A matplotlib figure.

    Examples
    --------
    >>> import lesk
    >>> figure = lesk.plot.spectrum(["A", "D65", "LED-B3"])
    """
    given = [lights] if isinstance(lights, str | Path | Spectrum) else list(lights)
    if not given:
        raise ParameterError("there is no spectrum to plot")
    found = [light if isinstance(light, Spectrum) else _spectrum(light) for light in given]
    with style():
        fig = figure(7.0, 3.6)
        axes = fig.add_subplot()
        for i, light in enumerate(found):
            _curve(axes, light, CURVES[i % len(CURVES)], single=len(found) == 1)
        _rainbow(axes)
        axes.set(xlabel="wavelength, nm", ylabel="per nm, relative to the maximum", xlim=(360, 830), ylim=(-0.06, 1.06))
        fig.legend(loc="outside right upper")
    return fig


def observers() -> Plot:
    """Plot the eye's efficiencies V and V', and the colour matching functions of the standard observers.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    with style():
        fig = figure(7.0, 6.4)
        above, below = fig.subplots(2, 1, sharex=True)
        for name, label, color in (
            ("V", "V(λ), by day (1924)", CURVES[0]),
            ("V'", "V'(λ), in the dark (1951)", CURVES[1]),
        ):
            above.plot(_NM, _columns(name)[:, 0], color=color, label=label)
        _rainbow(above)
        above.set(ylabel="luminous efficiency", ylim=(-0.06, 1.06))
        above.legend()
        lines = (("1931", "-"), ("1964", "--"), ("2006-2", ":"))
        for name, dashes in lines:
            table = _columns(name)
            for channel in range(3):
                below.plot(_NM, table[:, channel], dashes, color=CHANNELS[channel], linewidth=1.6)
        for (_, dashes), label in zip(lines, ("CIE 1931, 2°", "CIE 1964, 10°", "CIE 2006, 2°"), strict=True):
            below.plot([], [], dashes, color=INK, linewidth=1.6, label=label)
        for (x, y), letter, channel in zip(((612, 1.13), (556, 1.08), (462, 1.9)), "xyz", range(3), strict=True):
            below.text(x, y, f"{letter}̄", color=CHANNELS[channel], ha="center", fontsize=12)
        below.set(xlabel="wavelength, nm", ylabel="colour matching functions", xlim=(360, 830), ylim=(0, 2.3))
        below.legend()
    return fig


def _columns(name: str) -> Any:
    return np.array(_lesk.observer(name, _NM.tolist()))


def _curve(axes: Any, light: Spectrum, color: str, *, single: bool) -> None:
    line = light.core.single_wavelength
    if line is not None:
        axes.plot([line, line], [0, 1], color=color, label=light.name)
        return
    values = light.at(_NM)
    top = values.max()
    if top <= 0:
        raise ParameterError(f"`{light.name}` has no light between 360 and 830 nm to plot")
    inside = values > 0 if light.range is None else (light.range[0] <= _NM) & (light.range[1] >= _NM)
    shown = np.where(inside | (values > 0), values / top, np.nan)
    axes.plot(_NM, shown, color=INK if single else color, linewidth=1.6, label=light.name)


def _rainbow(axes: Any) -> None:
    """Draw the colours of single wavelengths as a strip below the axis."""
    xyz = _columns("1931")
    rgb = np.array([_lesk.xyz_to_rgb(row.tolist(), "srgb") for row in xyz])
    # towards grey until no channel is negative, then as bright as V, so that both ends are dark
    rgb = rgb - np.minimum(rgb.min(axis=1, keepdims=True), 0)
    rgb = rgb / rgb.max(axis=1, keepdims=True).clip(1e-9) * (xyz.sum(axis=1, keepdims=True) / 0.6).clip(0, 1)
    encoded = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb.clip(0.0031308) ** (1 / 2.4) - 0.055)
    axes.imshow(encoded[None].clip(0, 1), extent=(360, 830, -0.06, -0.015), aspect="auto", zorder=1)
