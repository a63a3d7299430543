"""Lesk: a light-and-shading workbench.

Every reflectance model is written once, as its paper states it; numbers, gradients, shader source, plots, checks and
pictures come from that one definition.

>>> import lesk
>>> satin = lesk.models.ggx(alpha_x=0.2, alpha_y=0.4)
>>> satin.eval([0.0, 0.6, 0.8], [0.0, 0.0, 1.0]).round(4).tolist()
[0.5231, 0.5231, 0.5231]

- `lesk.models`: every model as a class: values, draws, densities, gradients, shader source.
- `lesk.terms`: the parts of models, alone: distributions of facets, masking, Fresnel.
- `lesk.plot`: polar cuts, lobes, slices, albedo, a lit sphere.
- `lesk.figures`: the figures of a lecture on light and shading.
- `lesk.f0`: reflectance of common substances at normal incidence.
- `lesk.check`: runs the claims of a model.
- `lesk.light`: luminaires from IES and EULUMDAT files.
- `lesk.measure`, `lesk.lux`: illuminance, luminance and glare at the sensors of a scene, with standard errors.
- `lesk.validate`: measured light against closed forms.
- `lesk.shade`, `lesk.mesh`: flat, Gouraud and Phong shading by a rasteriser; what a mesh file holds.
- `lesk.quantity`, `lesk.spectrum`, `lesk.color`: light in units, with every assumption of a conversion named.
- `lesk.render`, `lesk.scene`, `lesk.image`: pictures in cd/m², from a scene file to EXR, HDR and PNG.

Nothing is loaded before it is used: `import lesk` takes a few milliseconds.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from lesk.errors import (
    CheckpointError,
    FileError,
    ImageError,
    LeskError,
    LightError,
    MeasureInterrupted,
    ParameterError,
    RenderInterrupted,
    SceneError,
)

if TYPE_CHECKING:
    from lesk import color, f0, figures, image, light, mesh, models, plot, scene, terms, validate
    from lesk._check import CheckReport, check
    from lesk._compare_shading import Comparison, compare_shading
    from lesk._lesk import __version__
    from lesk._lux import LuxReport, lux
    from lesk._measure import Measurement, MeasureProgress, Readings, measure
    from lesk._model import Delta, Model, Sample
    from lesk._quantity import Quantity, quantity
    from lesk._raster import Classic, Shading, shade
    from lesk._render import Progress, Render, render
    from lesk._spectrum import ColorRendering, Spectrum, spectrum

_MODULES = ("color", "f0", "figures", "image", "light", "mesh", "models", "plot", "scene", "terms", "validate")
_NAMES = {
    "CheckReport": "_check",
    "Classic": "_raster",
    "ColorRendering": "_spectrum",
    "Comparison": "_compare_shading",
    "Delta": "_model",
    "LuxReport": "_lux",
    "MeasureProgress": "_measure",
    "Measurement": "_measure",
    "Model": "_model",
    "Progress": "_render",
    "Quantity": "_quantity",
    "Readings": "_measure",
    "Render": "_render",
    "Sample": "_model",
    "Shading": "_raster",
    "Spectrum": "_spectrum",
    "__version__": "_lesk",
    "check": "_check",
    "compare_shading": "_compare_shading",
    "lux": "_lux",
    "measure": "_measure",
    "quantity": "_quantity",
    "render": "_render",
    "shade": "_raster",
    "spectrum": "_spectrum",
}

__all__ = [
    "CheckReport",
    "CheckpointError",
    "Classic",
    "ColorRendering",
    "Comparison",
    "Delta",
    "FileError",
    "ImageError",
    "LeskError",
    "LightError",
    "LuxReport",
    "MeasureInterrupted",
    "MeasureProgress",
    "Measurement",
    "Model",
    "ParameterError",
    "Progress",
    "Quantity",
    "Readings",
    "Render",
    "RenderInterrupted",
    "Sample",
    "SceneError",
    "Shading",
    "Spectrum",
    "__version__",
    "check",
    "color",
    "compare_shading",
    "f0",
    "figures",
    "image",
    "light",
    "lux",
    "measure",
    "mesh",
    "models",
    "plot",
    "quantity",
    "render",
    "scene",
    "shade",
    "spectrum",
    "terms",
    "validate",
]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f"lesk.{name}")
    if name in _NAMES:
        value = getattr(import_module(f"lesk.{_NAMES[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module `lesk` has no attribute `{name}`")


def __dir__() -> list[str]:
    return sorted(__all__)
