"""The scenes of `scenes.py` as files for Lesk: a TOML file, binary PLY meshes, an EXR map."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from agreement import emission
from scenes import Scene

import lesk


def write_ply(path: Path, positions: np.ndarray, triangles: np.ndarray, normals: np.ndarray | None) -> None:
    columns = [positions] if normals is None else [positions, normals]
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals is not None else [])
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}"]
    lines += [f"property float {name}" for name in names]
    lines += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    faces = np.empty(len(triangles), [("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    vertices = np.concatenate(columns, 1).astype("<f4")
    path.write_bytes("\n".join(lines).encode() + vertices.tobytes() + faces.tobytes())


def material(m: tuple) -> str | None:
    rgb = [float(v) for v in m[1]] if isinstance(m[1], tuple) else []
    alpha = float(m[2]) if len(m) > 2 else 0.0
    return {
        "diffuse": f'model = "lambert", reflectance = {rgb}',
        "conductor": f'model = "ggx", f0 = {rgb}, alpha_x = {alpha}, alpha_y = {alpha}',
        "dielectric": f'model = "rough_dielectric", ior = {m[1]}, alpha_x = {alpha}, alpha_y = {alpha}',
        "plastic": f'model = "metallic_roughness", base_color = {rgb}, metallic = 0, roughness = {alpha**0.5}',
        "emit": None,
    }[m[0]]


def write(scene: Scene, folder: Path, size: int) -> Path:
    """Writes the scene into an empty folder; gives the path of its TOML file."""
    eye, target, fov = scene.camera
    lines = ["version = 1", f'film = {{ size = [{size}, {size}], filter = "box" }}']
    lines.append(f'camera = {{ eye = {list(eye)}, target = {list(target)}, up = [0, 1, 0], fov = "{fov} deg" }}')
    # depth counts segments, Lesk counts scattering events
    lines.append(f"render = {{ max_depth = {scene.depth - 1} }}")
    objects = []
    for name, positions, triangles, normals, m in scene.objects:
        write_ply(folder / f"{name}.ply", positions, triangles, normals)
        if m[0] == "emit":
            tail = f"light = {{ {emission('luminance', list(m[1]), 'cd/m2')} }}"
        else:
            lines.append(f"materials.{name} = {{ {material(m)} }}")
            tail = f'material = "{name}"'
        objects.append(f'  {{ shape = "mesh", file = "{name}.ply", {tail} }},')
    lines += ["objects = [", *objects, "]"]
    if scene.environment is not None:
        lesk.image.write(folder / "environment.exr", scene.environment)
        # Mitsuba's picture begins at -z, Lesk's middle lies there
        lines.append(
            'environment = { type = "map", file = "environment.exr", scale = 1, up = "y", rotation = "180 deg" }'
        )
    path = folder / "scene.toml"
    path.write_text("\n".join(lines) + "\n")
    return path
