"""Where the lecture's slides differ from their papers: both numbers, computed."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from lesk import models, terms
from lesk._registry import find


class Erratum(NamedTuple):
    """One difference; `slide` and `paper` compute the number that each gives for `case`."""

    id: str
    slide_title: str
    difference: str
    case: str
    unit: str
    """Unit of both numbers; empty for a number without."""
    slide: Callable[[], float]
    paper: Callable[[], float]
    command: str
    """What shows the paper's number in another way; empty where only `lesk lecture errata` does."""


def _direction(theta_deg: float, phi_deg: float) -> np.ndarray:
    theta, phi = np.radians((theta_deg, phi_deg))
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


# the pair of directions at which models are compared: (30, 0) and (50, 140) degrees
_WI, _WO = _direction(30, 0), _direction(50, 140)


def _ward_of_the_slide() -> float:
    alpha_x, alpha_y = 0.2, 0.4
    h = _WI + _WO
    h /= np.linalg.norm(h)
    cos2_phi, sin2_phi = h[0] ** 2 / (1 - h[2] ** 2), h[1] ** 2 / (1 - h[2] ** 2)
    tan2 = (1 - h[2] ** 2) / h[2] ** 2
    norm = 4 * np.pi * alpha_x * alpha_y * np.sqrt(_WI[2] * _WO[2])
    return float(np.exp(-tan2 * (cos2_phi / alpha_x + sin2_phi / alpha_y)) / norm)


def _ward() -> float:
    ward = models.ward(diffuse=0, specular=1, alpha_x=0.2, alpha_y=0.4)
    return float(ward.eval(_WI, _WO)[0])


def _blinn(normalised: bool) -> float:
    h = (_WI + _WO) / 2
    return float((h[2] / (np.linalg.norm(h) if normalised else 1)) ** 50)


def _energy(azimuth: bool) -> float:
    """Integral of f cos over the hemisphere for a matte surface of albedo 0.5, by Gauss's rule in both angles."""
    nodes, weights = np.polynomial.legendre.leggauss(32)
    theta, phi = (nodes + 1) * np.pi / 4, (nodes + 1) * np.pi
    cosine = np.cos(phi)[np.newaxis] if azimuth else np.cos(theta)[:, np.newaxis]
    inner = cosine * np.sin(theta)[:, np.newaxis] * np.outer(weights, weights)
    return float(np.round(0.5 / np.pi * inner.sum() * np.pi**2 / 4, 12)) + 0.0


def _across(blinn: bool) -> float:
    from lesk.figures._classic import highlights

    return float(highlights(60, [10], "across", 200 if blinn else 50)[int(blinn)][0])


def _burley() -> float:
    cosine = np.cos(np.radians(75))
    return float(np.pi * terms.diffuse.burley(cosine, cosine, 1.0, 0.0))


def _oren_nayar() -> float:
    w = _direction(75, 0)
    return float(np.pi * models.oren_nayar(reflectance=1.0, sigma=0.0).eval(w, w)[0])


_POINT = "--wi 30,0 --wo 50,140"

ERRATA = (
    Erratum(
        "ward",
        "Ward BRDF",
        "αx and αy are not squared in the exponent",
        "k_s = 1, α = 0.2 and 0.4, light (30°, 0°), viewer (50°, 140°)",
        "1/sr",
        _ward_of_the_slide,
        _ward,
        f"lesk eval ward --set diffuse=0 --set specular=1 --set alpha_x=0.2 --set alpha_y=0.4 {_POINT}",
    ),
    Erratum(
        "blinn_half",
        "Blinn-Phong illumination model",
        "H = (L + E)/2 is not normalised",
        "cos^50 γ, light (30°, 0°), viewer (50°, 140°)",
        "",
        lambda: _blinn(False),
        lambda: _blinn(True),
        "",
    ),
    Erratum(
        "cos_phi",
        "BRDF, BRDF properties, BSSRDF",
        "cos φi is printed where cos θi is meant",
        "∫ f cos dω of a matte surface of albedo 0.5",
        "",
        lambda: _energy(True),
        lambda: _energy(False),
        "lesk eval lambert --set reflectance=0.5",
    ),
    Erratum(
        "bssrdf_area",
        "BSSRDF",
        "the integral over the area lacks dA",
        "power of the metre in the unit of L_r, with S in 1/(m² sr)",
        "",
        lambda: -4.0,
        lambda: -2.0,
        "",
    ),
    Erratum(
        "radiance",
        "Radiometry: radiance",
        "L = dE/dω holds for E perpendicular to ω only",
        "L = 100 cd/m² seen at 60° to the normal of the receiver",
        "cd/m²",
        lambda: float(100 * np.cos(np.radians(60))),
        lambda: 100.0,
        "",
    ),
    Erratum(
        "point_light",
        "Light sources",
        "“intensity decreases”: the irradiance does, the intensity is constant",
        "a point light of 1100 lm, its intensity at 3 m over that at 1.5 m",
        "",
        lambda: (1.5 / 3) ** 2,
        lambda: 1.0,
        "lesk figure light_sources -o lights.png",
    ),
    Erratum(
        "disney_diffuse",
        "Current “PBR” BRDF models",
        "Disney's diffuse term is Burley's own, not Oren-Nayar",
        "π f/ρ of a smooth surface (roughness 0, σ = 0), light and viewer at 75°",
        "",
        _oren_nayar,
        _burley,
        "lesk plot diffuse.burley --set roughness=0,0.5,1 -o burley.png",
    ),
    Erratum(
        "beard_maxwell",
        "Scattering models: timeline",
        "Beard and Maxwell's model is older than its NEF form",
        "year",
        "",
        lambda: 2002.0,
        lambda: 1973.0,
        "lesk figure timeline -o timeline.svg",
    ),
    Erratum(
        "blinn_year",
        "Scattering models: timeline",
        "Blinn's model is of 1977; the slides print 1975 and 1994",
        "year",
        "",
        lambda: 1994.0,
        lambda: float(find("blinn_phong")["year"]),
        "lesk models blinn_phong",
    ),
    Erratum(
        "k_m",
        "Radiometry and photometry",
        "K_m = 680 lm/W and an upper limit of 770 nm",
        "luminous flux of 1 W at the peak of V(λ)",
        "lm",
        lambda: 680.0,
        lambda: 683.002,
        "lesk quantity '1 W @ 555 nm' --to lm --km '680 lm/W'",
    ),
    Erratum(
        "four_times_h",
        "Blinn-Phong illumination model",
        "“use 4x higher h” holds in the plane of incidence only",
        "highlight 10° across the mirror direction, light at 60°, h = 50 (Phong) and 200 (Blinn)",
        "",
        lambda: _across(True),
        lambda: _across(False),
        "lesk figure phong_blinn -o phong_blinn.svg",
    ),
)
"""In the order of the lecture's table. For `four_times_h` the slide's number is that of its rule, the other is Phong's."""
