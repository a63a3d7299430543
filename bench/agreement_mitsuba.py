"""The scenes of `agreement.py` for Mitsuba 3."""

from __future__ import annotations

from typing import Any

import numpy as np
from agreement import MAP_SIZE, MATERIALS, SCENES, SIZE, radiance_of_map
from mitsuba_side import mi, rgb


def bsdf(material: str | None) -> dict:
    if material is None:
        return {"type": "diffuse", "reflectance": rgb([0, 0, 0])}
    model, p = MATERIALS[material]
    alpha = {"alpha_u": p.get("alpha_x"), "alpha_v": p.get("alpha_y"), "distribution": "ggx"}
    ior = {"int_ior": p.get("ior"), "ext_ior": 1.0}
    index = {"eta": rgb(p["eta"]), "k": rgb(p["k"])} if "eta" in p else {}
    plugins: dict[str, Any] = {
        "lambert": lambda: {"type": "diffuse", "reflectance": rgb(p["reflectance"])},
        "conductor": lambda: {"type": "conductor", **index},
        "dielectric": lambda: {"type": "dielectric", **ior},
        "ggx_conductor_separable": lambda: {"type": "roughconductor", **alpha, **index},
        "rough_dielectric": lambda: {"type": "roughdielectric", **alpha, **ior},
    }
    plugin = plugins[model]()
    return plugin if "dielectric" in model else {"type": "twosided", "bsdf": plugin}


def place(steps: tuple) -> np.ndarray:
    t = mi.ScalarTransform4f()
    for step in steps:
        if step[0] == "rotate":
            t = mi.ScalarTransform4f().rotate(step[2], step[1]) @ t
        else:
            t = mi.ScalarTransform4f().translate(step[1]) @ t
    return np.array(t.matrix, np.float64)


def shape(o: dict, world: np.ndarray) -> dict:
    """Mitsuba's rectangle and cube are 2 wide, its cylinder stands on the origin."""
    size = o["size"]
    scale, plugin = {
        "sphere": lambda: ([size] * 3, {"type": "sphere"}),
        "disk": lambda: ([size, size, 1], {"type": "disk"}),
        "rectangle": lambda: ([size[0] / 2, size[1] / 2, 1], {"type": "rectangle"}),
        "cube": lambda: ([s / 2 for s in size], {"type": "cube"}),
        "cylinder": lambda: ([size[0], size[0], size[1]], {"type": "cylinder"}),
    }[o["shape"]]()
    matrix = world @ np.diag([*scale, 1.0])
    out = plugin | {"to_world": mi.ScalarTransform4f(matrix.tolist()), "bsdf": bsdf(o["material"])}
    if o["radiance"]:
        out["emitter"] = {"type": "area", "radiance": rgb(o["radiance"])}
    return out


def shapes(objects: list[dict], groups: dict, world: np.ndarray) -> list[dict]:
    out = []
    for o in objects:
        matrix = world @ place(o["steps"])
        out += shapes(groups[o["size"]], groups, matrix) if o["shape"] == "group" else [shape(o, matrix)]
    return out


def environment(what: Any) -> dict:
    if what != "map":
        return {"type": "constant", "radiance": rgb(what)}
    # texels lie at (i + 1/2) / w and j / (h - 1); the left edge of the picture is local -z, +y is up
    w, h = MAP_SIZE
    x, y = np.meshgrid((np.arange(w) + 0.5) / w, np.arange(h) / (h - 1))
    world_from_local = [[-1, 0, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1]]
    picture = mi.Bitmap(radiance_of_map(x, y).astype(np.float32))
    return {"type": "envmap", "bitmap": picture, "to_world": mi.ScalarTransform4f(world_from_local)}


def load(name: str) -> Any:
    """The scene, ready to render."""
    s = SCENES[name]
    eye, target, fov = s["camera"]
    d: dict[str, Any] = {"type": "scene", "integrator": {"type": "path", "max_depth": s["depth"] + 1}}
    d["sensor"] = {
        "type": "perspective",
        "fov": fov,
        "to_world": mi.ScalarTransform4f().look_at(eye, target, [0, 0, 1]),
        "film": {
            "type": "hdrfilm",
            "width": SIZE,
            "height": SIZE,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }
    for i, one in enumerate(shapes(s["objects"], s.get("groups", {}), np.eye(4))):
        d[f"object{i}"] = one
    for i, (position, intensity) in enumerate(s["lights"]):
        d[f"light{i}"] = {"type": "point", "position": position, "intensity": rgb(intensity)}
    if s["environment"]:
        d["environment"] = environment(s["environment"])
    return mi.load_dict(d)
