"""Every model of the registry as a class: `lesk.models.ggx(alpha_x=0.2)`."""

from __future__ import annotations

from typing import Any

from lesk._model import REGISTRY, Model, Sample

__all__ = ["Model", "Sample"]


def _docstring(info: dict[str, Any]) -> str:
    lines = [f"{info['title']} ({info['year']}).", "", info["doc"], "", "Parameters", "----------"]
    for spec in info["parameters"]:
        shape = "array_like of shape (..., 3) or float" if spec["kind"] == "color" else "array_like of shape (...)"
        unit = f", {spec['unit']}" if spec["unit"] else ", dimensionless"
        low, high = spec["range"]
        lines += [f"{spec['name']} : {shape}, default {spec['default']}", f"    {spec['doc']} [{low:g}, {high:g}]{unit}"]
    return "\n".join([*lines, "", "References", "----------", info["paper"]])


for _info in REGISTRY:
    _members = {"id": _info["id"], "info": _info, "__doc__": _docstring(_info), "__module__": __name__}
    globals()[_info["id"]] = type(_info["id"], (Model,), _members)
    __all__.append(_info["id"])
