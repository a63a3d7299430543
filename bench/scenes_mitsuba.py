"""The scenes of `scenes.py` for Mitsuba 3."""

from __future__ import annotations

from typing import Any

import numpy as np
from mitsuba_side import mi, rgb
from scenes import Scene


def bsdf(m: tuple) -> dict:
    ggx: dict[str, Any] = {"distribution": "ggx"}
    if m[0] == "diffuse":
        inner = {"type": "diffuse", "reflectance": rgb(m[1])}
    elif m[0] == "conductor":
        # Schlick's Fresnel term with a coloured f0, as Lesk's `ggx` has it
        inner = {"type": "principled", "base_color": rgb(m[1]), "metallic": 1.0, "roughness": m[2] ** 0.5}
    elif m[0] == "plastic":
        inner = {"type": "roughplastic", "diffuse_reflectance": rgb(m[1]), "alpha": m[2]} | ggx
    elif m[0] == "dielectric":
        return {"type": "roughdielectric", "int_ior": m[1], "ext_ior": 1.0, "alpha": m[2]} | ggx
    else:
        inner = {"type": "diffuse", "reflectance": rgb((0, 0, 0))}
    return {"type": "twosided", "bsdf": inner}


def mesh(positions: np.ndarray, triangles: np.ndarray, normals: np.ndarray | None, m: tuple) -> Any:
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf(m))
    if m[0] == "emit":
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": rgb(m[1])})
    out = mi.Mesh("mesh", len(positions), len(triangles), has_vertex_normals=normals is not None, props=properties)
    data = mi.traverse(out)
    data["vertex_positions"] = np.ascontiguousarray(positions, np.float32).ravel()
    data["faces"] = np.ascontiguousarray(triangles, np.uint32).ravel()
    if normals is not None:
        data["vertex_normals"] = np.ascontiguousarray(normals, np.float32).ravel()
    data.update()
    return out


def load(scene: Scene, size: int) -> Any:
    """The scene, ready to render."""
    eye, target, fov = scene.camera
    d: dict[str, Any] = {"type": "scene", "integrator": {"type": "path", "max_depth": scene.depth, "rr_depth": 5}}
    film = {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}}
    d["sensor"] = {
        "type": "perspective",
        "fov": fov,
        "to_world": mi.ScalarTransform4f().look_at(eye, target, [0, 1, 0]),
        "film": film | {"pixel_format": "rgb", "component_format": "float32"},
        "sampler": {"type": "independent"},
    }
    for name, positions, triangles, normals, m in scene.objects:
        d[name] = mesh(positions, triangles, normals, m)
    if scene.environment is not None:
        d["environment"] = {"type": "envmap", "bitmap": mi.Bitmap(scene.environment)}
    return mi.load_dict(d)
