"""Curve of one term over the angle."""

from __future__ import annotations

import itertools
from importlib import import_module
from typing import Any

import numpy as np
import numpy.typing as npt

from lesk._term import TERMS
from lesk.errors import ParameterError, nearest
from lesk.plot._figure import CHANNELS, CURVES, Plot, direction, figure, is_grey, style

_DEFAULTS = {
    "alpha": 0.3,
    "alpha_x": 0.3,
    "alpha_y": 0.3,
    "cos_d": 0.9,
    "cos_i": 0.8,
    "eta": 1.5,
    "f0": 0.04,
    "k": 3.0,
    "n": 20.0,
    "roughness": 0.5,
}
_SWEPT = {"cos": "θ", "cos_theta": "θ", "cos_o": "θo", "h": "θh", "w": "θ", "wo": "θo"}
_LIGHT_DEG = 45.0


def term(name: str, **arguments: npt.ArrayLike) -> Plot:
    """Plot a term over the angle that it depends on.

    Parameters
    ----------
    name : str
        Role and name, like `ndf.ggx`, `masking.v_groove` or `fresnel.conductor`.
    **arguments : float or sequence of float
        Values of the other arguments; a sequence gives one curve each. Directions are swept; `wi`, where it is not, is
        45 degrees from the normal.

    Returns
    -------
    Plot
        A matplotlib figure.

    Examples
    --------
    >>> import lesk
    >>> figure = lesk.plot.term("fresnel.dielectric", eta=[1.33, 1.5, 2.4])
    """
    role, _, short = name.partition(".")
    names = [f"{r}.{n}" for r, n in TERMS if not n.startswith("sample_")]
    if name not in names:
        raise ParameterError(f"there is no term `{name}` to plot{nearest(name, names) or f'{chr(10)}hint: {names}'}")
    specs = [a["name"] for a in TERMS[role, short]["arguments"]]
    for given in arguments:
        if given not in specs or given in ("h", "w", "wi", "wo"):
            raise ParameterError(f"term `{name}` has no argument `{given}` to set{nearest(given, specs)}")
    function = getattr(import_module(f"lesk.terms.{role}"), short)
    swept = next((a for a in ("cos_theta", "cos_o", "cos", "wo", "w", "h") if a in specs and a not in arguments), "")
    if not swept:
        raise ParameterError(f"term `{name}` has no angle to plot over")
    most = 90.0 if swept in ("cos_theta", "h", "cos") else 89.9
    degrees = np.linspace(0.0 if swept != "wo" else -most, most, 721)
    free = [s for s in specs if s not in ("h", "w", "wi", "wo", swept)]
    choices = [np.atleast_1d(np.asarray(arguments.get(s, _DEFAULTS[s]), float)) for s in free]
    with style():
        fig = figure(6.0, 3.9)
        axes = fig.add_subplot()
        for index, values in enumerate(itertools.product(*choices)):
            fixed = dict(zip(free, values, strict=True))
            curve = function(*(_value(s, swept, np.radians(degrees), fixed) for s in specs))
            text = ", ".join(f"{s} {v:g}" for s, v in fixed.items())
            if curve.ndim > 1 and not is_grey(curve):
                for channel in range(3):
                    axes.plot(degrees, curve[:, channel], color=CHANNELS[channel])
            else:
                curve = curve if curve.ndim == 1 else curve[:, 0]
                axes.plot(degrees, curve, color=CURVES[index % len(CURVES)], label=text or None)
        axes.set(xlabel=f"{_SWEPT[swept]}, degrees", ylabel=f"{name}{', 1/sr' if role == 'ndf' else ''}")
        axes.set(xlim=(degrees[0], 90), xticks=range(0 if degrees[0] == 0 else -90, 91, 15))
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
        axes.set_title(name + (f", light from {_LIGHT_DEG:g}°" if "wi" in specs else ""))
        if axes.get_legend_handles_labels()[0]:
            axes.legend()
    return fig


def _value(argument: str, swept: str, theta: Any, fixed: dict[str, float]) -> Any:
    if argument in fixed:
        return fixed[argument]
    light = direction(np.radians(-_LIGHT_DEG))
    if argument == "wi":
        return light
    if argument == "h" and swept == "wo":
        return light + direction(theta)
    if argument == swept:
        return np.cos(theta) if argument.startswith("cos") else direction(theta)
    # masking of one direction, at the facet that mirrors the light to it
    return light + direction(theta)
