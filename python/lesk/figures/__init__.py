"""The figures of a lecture on light and shading, each made by one function.

Every function gives a matplotlib figure, or an `Animation`; `lesk figure` lists them, `lesk lecture` says which idea of the
lecture each belongs to.

>>> import lesk
>>> figure = lesk.figures.fresnel(etas=[1.33, 1.5])
>>> figure.savefig("fresnel.svg")  # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from lesk.figures._animation import Animation
from lesk.figures._classic import phong_blinn, phong_table, shininess
from lesk.figures._diagrams import bilinear, vertex_normals
from lesk.figures._edges import auxiliary_edges, crease_angle
from lesk.figures._exercises import led_bulb, sun
from lesk.figures._microfacets import cook_torrance, fresnel, microfacet_terms, microfacets
from lesk.figures._shading import (
    highlight_crossing,
    mach_bands,
    missed_highlights,
    rotating_quad,
    shading_modes,
    shadow_terminator,
)
from lesk.figures._surfaces import oren_nayar, reflection_types, ward_satin
from lesk.figures._tables import f0_table, metallic_dial, timeline
from lesk.figures._traced import appearance, light_paths, light_sources

_MAKERS = (
    light_paths,
    appearance,
    sun,
    led_bulb,
    light_sources,
    reflection_types,
    phong_table,
    shininess,
    phong_blinn,
    ward_satin,
    microfacets,
    microfacet_terms,
    cook_torrance,
    fresnel,
    f0_table,
    oren_nayar,
    metallic_dial,
    timeline,
    shading_modes,
    mach_bands,
    bilinear,
    vertex_normals,
    auxiliary_edges,
    crease_angle,
    missed_highlights,
    highlight_crossing,
    rotating_quad,
    shadow_terminator,
)


class Maker(NamedTuple):
    """A figure: how it is made, and what it says."""

    make: Callable[[], Any]
    title: str
    caption: str
    animated: bool
    """Whether it gives an `Animation`."""


def _described(make: Callable[..., Any]) -> Maker:
    """Take title and caption from the docstring: what stands before its first section."""
    import inspect

    title, body, *_ = (inspect.getdoc(make) or "").split("\n\n")
    animated = inspect.signature(make).return_annotation == "Animation"
    return Maker(make, title.rstrip("."), " ".join(body.split()), animated)


ALL: dict[str, Maker] = {make.__name__: _described(make) for make in _MAKERS}
"""All figures by name, in the order of the lecture."""

__all__ = ["ALL", "Animation", "Maker", *sorted(make.__name__ for make in _MAKERS)]
