"""Cycles (bpy) on one scene of `scenes.py`: python cycles_side.py SCENE SIZE SPP SEEDS OUT.npz.

A program of its own, because bpy exists for one version of Python and changes the process that loads it. The file holds
`pictures` (seeds, h, w, 3) and `seconds`, processor time of each, the fixed cost of a render included.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix, Vector
from scenes import SCENES, Scene
from timing import clock


def shader(nodes: Any, m: tuple) -> Any:
    """The node of a material."""

    def node(kind: str, **inputs: Any) -> Any:
        out = nodes.new(f"ShaderNode{kind}")
        for key, value in inputs.items():
            out.inputs[key.replace("_", " ")].default_value = value
        return out

    color = (*map(float, m[1]), 1.0) if isinstance(m[1], tuple) else None
    if m[0] == "diffuse":
        return node("BsdfDiffuse", Color=color)
    if m[0] == "emit":
        return node("Emission", Color=color)
    if m[0] == "plastic":
        return node("BsdfPrincipled", Base_Color=color, Roughness=m[2] ** 0.5, IOR=1.49)
    out = node("BsdfGlass", IOR=m[1]) if m[0] == "dielectric" else node("BsdfAnisotropic", Color=color)
    out.distribution = "GGX"
    out.inputs["Roughness"].default_value = m[2] ** 0.5
    return out


def material(name: str, m: tuple) -> Any:
    out = bpy.data.materials.new(name)
    out.use_nodes = True
    tree = out.node_tree
    tree.nodes.clear()
    surface = tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]
    node = shader(tree.nodes, m)
    if m[0] == "emit":
        # one side only, as the others have it
        geometry, front = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeMath")
        front.operation = "SUBTRACT"
        front.inputs[0].default_value = 1
        tree.links.new(geometry.outputs["Backfacing"], front.inputs[1])
        tree.links.new(front.outputs[0], node.inputs["Strength"])
        out.cycles.emission_sampling = "FRONT"
    tree.links.new(node.outputs[0], surface)
    return out


def environment(scene: Any, picture: np.ndarray) -> None:
    h, w, _ = picture.shape
    image = bpy.data.images.new("environment", w, h, float_buffer=True, is_data=True)
    image.pixels.foreach_set(np.concatenate([picture[::-1], np.ones((h, w, 1), np.float32)], -1).ravel())
    image.update()
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    texture, mapping = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeMapping")
    coordinates = nodes.new("ShaderNodeTexCoord")
    texture.image = image
    # +y is up here, +z in Cycles
    mapping.inputs["Rotation"].default_value = (math.pi / 2, 0, 0)
    links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs[0], nodes["Background"].inputs[0])


def camera(scene: Any, eye: Any, target: Any, fov: float) -> None:
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "HORIZONTAL", math.radians(fov)
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    z = (Vector(eye) - Vector(target)).normalized()
    x = Vector((0, 1, 0)).cross(z).normalized()
    matrix = Matrix((x, z.cross(x), z)).transposed().to_4x4()
    matrix.translation = Vector(eye)
    scene.camera.matrix_world = matrix


def settings(scene: Any, size: int, depth: int) -> None:
    """No clamping, no denoiser, no adaptive sampling, the same depth for all kinds of paths, one thread."""
    scene.render.engine = "CYCLES"
    cycles, render = scene.cycles, scene.render
    cycles.device, cycles.pixel_filter_type, cycles.use_light_tree = "CPU", "BOX", True
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = depth - 1
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    render.resolution_x = render.resolution_y = size
    render.resolution_percentage = 100
    render.threads_mode, render.threads, render.use_persistent_data = "FIXED", 1, True
    render.use_compositing = render.use_sequencer = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Standard"


def load(description: Scene, size: int) -> Any:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    settings(scene, size, description.depth)
    for name, positions, triangles, normals, m in description.objects:
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(positions.tolist(), [], triangles.tolist())
        mesh.materials.append(material(name, m))
        if normals is not None:
            mesh.polygons.foreach_set("use_smooth", [True] * len(triangles))
        mesh.update()
        scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    if description.environment is not None:
        environment(scene, description.environment)
    camera(scene, *description.camera)
    return scene


def render(scene: Any, spp: int, seed: int, folder: Path) -> tuple[np.ndarray, float]:
    path, size = folder / "picture.exr", scene.render.resolution_x
    scene.cycles.seed, scene.cycles.samples, scene.render.filepath = seed, spp, str(path)
    start = clock()
    bpy.ops.render.render(write_still=True)
    seconds = clock() - start
    image = bpy.data.images.load(str(path), check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.empty(size * size * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(size, size, 4)[::-1, :, :3].copy(), seconds


def main() -> None:
    name, size, spp, seeds, out = sys.argv[1], *map(int, sys.argv[2:5]), sys.argv[5]
    scene = load(SCENES[name](), size)
    with tempfile.TemporaryDirectory() as folder:
        render(scene, 1, 99, Path(folder))
        done = [render(scene, spp, seed, Path(folder)) for seed in range(seeds)]
    pictures, seconds = zip(*done, strict=True)
    np.savez(out, pictures=np.stack(pictures), seconds=np.array(seconds), version=bpy.app.version_string)


if __name__ == "__main__":
    main()
