"""Plots of models, terms, luminaires, skies and measured light.

Every function gives a matplotlib figure that shows itself in a notebook and is saved with `savefig`; nothing touches
matplotlib's global state. Light comes from the left; angles are degrees from the normal.

>>> import lesk
>>> figure = lesk.plot.polar(lesk.models.ggx(alpha_x=0.3, alpha_y=0.3), theta_i_deg=40)
>>> figure.savefig("ggx.svg")  # doctest: +SKIP
"""

from lesk.plot._albedo import albedo
from lesk.plot._figure import Plot
from lesk.plot._lobe3d import lobe3d
from lesk.plot._luminaire import intensity, web
from lesk.plot._measured import false_color, plan
from lesk.plot._polar import polar
from lesk.plot._sky import sky
from lesk.plot._slice import slice
from lesk.plot._spectrum import observers, spectrum
from lesk.plot._sphere import sphere
from lesk.plot._term import term

__all__ = [
    "Plot",
    "albedo",
    "false_color",
    "intensity",
    "lobe3d",
    "observers",
    "plan",
    "polar",
    "sky",
    "slice",
    "spectrum",
    "sphere",
    "term",
    "web",
]
