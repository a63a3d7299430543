"""The lecture's exercises: the Sun and an LED bulb."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from lesk._lecture import ILLUMINANCES
from lesk.plot._figure import CURVES, FAINT, INK, Array, Plot, figure, style

PLANCK, LIGHT_SPEED, BOLTZMANN = 6.62607015e-34, 299792458.0, 1.380649e-23
"""SI, exact by definition (BIPM 2019)."""
_BULB_LM = 1100.0


def irradiance(flux: float, distance: npt.ArrayLike) -> Array:
    """Irradiance of a sphere around a source that sends its flux evenly: W/m² from W, lx from lm; distance in m."""
    return np.asarray(flux / (4 * np.pi * np.asarray(distance, float) ** 2))


def band_share(temperature: float, low_nm: float, high_nm: float) -> float:
    """Share of a black body's power in a band of wavelengths, by its series (sum of exponentials).

    Parameters
    ----------
    temperature : float
        K.
    low_nm, high_nm : float
        The band, nm; to 20 µm or infinite.

    Returns
    -------
    float
    """

    def below(nm: float) -> float:
        if np.isinf(nm):
            return 1.0
        x = PLANCK * LIGHT_SPEED / (nm * 1e-9 * BOLTZMANN * temperature)
        n = np.arange(1, 300)
        terms = np.exp(-n * x) / n * (x**3 + 3 * x**2 / n + 6 * x / n**2 + 6 / n**3)
        return float(15 / np.pi**4 * terms.sum())

    return below(high_nm) - below(low_nm)


def spectral_radiance(temperature: float, wavelength_nm: npt.ArrayLike) -> Array:
    """Planck's law, W/(m² sr nm)."""
    w = np.asarray(wavelength_nm, float) * 1e-9
    per_metre = 2 * PLANCK * LIGHT_SPEED**2 / w**5 / np.expm1(PLANCK * LIGHT_SPEED / (w * BOLTZMANN * temperature))
    return np.asarray(per_metre * 1e-9)


def sun(*, flux: float = 3.86e26, distance: float = 1.5e11, temperature: float = 5778) -> Plot:
    """The Sun.

    3.86e26 W spread over a sphere of 1.5e11 m give 1365 W/m² above the atmosphere (solar constant: 1362), and with the
    lecture's 40 % of visible light 546 W/m². Which share is visible depends on the band: of a black body of 5778 K,
    46.5 % lie in 380 to 780 nm, 36.7 % in 400 to 700 nm.

    Parameters
    ----------
    flux : float
        Radiant flux of the Sun, W.
    distance : float
        Distance from the Sun, m.
    temperature : float
        Temperature of the black body, K.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    wavelength = np.linspace(100, 2500, 1201)
    curve = spectral_radiance(temperature, wavelength)
    with style():
        fig = figure(6.8, 3.9)
        axes = fig.add_subplot()
        axes.plot(wavelength, curve, color=INK, linewidth=1.6)
        bands = (((380, 780), CURVES[0], 0.25, None), ((400, 700), CURVES[4], 0.45, "//"))
        for (low, high), color, alpha, hatch in bands:
            inside = (wavelength >= low) & (wavelength <= high)
            share = 100 * band_share(temperature, low, high)
            label = f"{low} to {high} nm: {share:.1f} %"
            axes.fill_between(
                wavelength[inside], curve[inside], color=color, alpha=alpha, hatch=hatch, linewidth=0, label=label
            )
        infrared, ultraviolet = 100 * band_share(temperature, 780, np.inf), 100 * band_share(temperature, 10, 380)
        axes.text(1250, 0.42 * curve.max(), f"infrared {infrared:.1f} %", fontsize=9)
        axes.annotate(
            f"ultraviolet\n{ultraviolet:.1f} %",
            (345, 0.42 * curve.max()),
            (112, 0.88 * curve.max()),
            fontsize=9,
            arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.8},
        )
        e = float(irradiance(flux, distance))
        axes.set_title(f"{flux:.3g} W at {distance:.3g} m: {e:.0f} W/m², 40 % of it {0.4 * e:.0f} W/m²", fontsize=11)
        axes.set(xlabel="wavelength, nm", ylabel=f"black body of {temperature:g} K, W/(m² sr nm)", xlim=(100, 2500))
        axes.set_ylim(bottom=0)
        axes.legend()
    return fig


def led_bulb(*, flux: float = _BULB_LM, distance: float = 1.5) -> Plot:
    """An LED bulb.

    1100 lm sent evenly in all directions give 38.9 lx at 1.5 m: too little even for a temporary working place (50 lx),
    for work with an important role of sight (100 lx) or with high demands (300 lx). Dots: how near the bulb would have to
    hang.

    Parameters
    ----------
    flux : float
        Luminous flux of the bulb, lm.
    distance : float
        Distance to the table, m.

    Returns
    -------
    Plot
        A matplotlib figure.
    """
    d = np.geomspace(0.3, 3, 200)
    with style():
        fig = figure(6.4, 3.9)
        axes = fig.add_subplot()
        axes.loglog(d, irradiance(flux, d), color=CURVES[0])
        for name, wanted in ILLUMINANCES:
            near = float(np.sqrt(flux / (4 * np.pi * wanted)))
            axes.axhline(wanted, color=FAINT, linewidth=1)
            axes.plot(near, wanted, "o", color=CURVES[1], markersize=5)
            axes.text(2.95, 1.06 * wanted, f"{wanted:g} lx, {name}: {near:.2f} m", fontsize=8.5, ha="right")
        e = float(irradiance(flux, distance))
        axes.plot(distance, e, "s", color=INK, markersize=6)
        axes.annotate(
            f"{e:.1f} lx at {distance:g} m", (distance, e), (-10, -12), textcoords="offset points", ha="right"
        )
        axes.set(xlabel="distance, m", ylabel="illuminance, lx", xlim=(0.3, 3), ylim=(8, 1100))
        axes.set_xticks([0.3, 0.5, 1, 1.5, 2, 3], ["0.3", "0.5", "1", "1.5", "2", "3"])
        axes.set_xticks([], minor=True)
        axes.set_yticks([10, 50, 100, 300, 1000], ["10", "50", "100", "300", "1000"])
        axes.set_title(f"E = Φ/(4π d²), Φ = {flux:g} lm", fontsize=11)
    return fig
