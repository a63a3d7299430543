"""The exported GLSL, run by the driver that EGL offers (Mesa's llvmpipe where there is no graphics card)."""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
import pytest

import lesk

moderngl = pytest.importorskip("moderngl")
Context: TypeAlias = "moderngl.Context"

SIDE = 100
N = SIDE * SIDE
VERTEX = {
    "glsl": "#version 450 core\n",
    "glsl-es": "#version 300 es\n",
}
TRIANGLE = """
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
"""


@pytest.fixture(scope="module")
def context() -> Iterator[Context]:
    try:
        context = moderngl.create_context(standalone=True, backend="egl", require=450)
    except Exception as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(f"no OpenGL 4.5 through EGL: {error}")
    with context:
        yield context


def std140(model: lesk.Model) -> bytes:
    """The parameters as a uniform block: colours on 16 bytes, numbers on 4."""
    floats: list[float] = []
    for value in model.params.values():
        if value.ndim:
            floats += [0.0] * (-len(floats) % 4)
        floats += np.atleast_1d(value).tolist()
    floats += [0.0] * (-len(floats) % 4)
    return np.array(floats, np.float32).tobytes()


def run(context: Context, model: lesk.Model, language: str, math: str, **maps: np.ndarray) -> dict[str, np.ndarray]:
    """Run the complete shader over (N, 3) maps; returns an (N, 4) array per render target."""
    names = ["eval", "pdf", "draw_wi_pdf", "draw_weight_delta"]
    source = model.shader(language, parts=("eval", "pdf", "draw"), math=math, complete=True)
    program = context.program(vertex_shader=VERTEX[language] + TRIANGLE, fragment_shader=source)
    targets = [context.texture((SIDE, SIDE), 4, dtype="f4") for _ in names]
    frame = context.framebuffer(color_attachments=targets)
    resources = [program, *targets, frame]
    for unit, (name, values) in enumerate(maps.items(), start=1):
        texels = np.concatenate([values, np.zeros((N, 1))], axis=1).astype(np.float32)
        texture = context.texture((SIDE, SIDE), 4, texels.tobytes(), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        texture.use(unit)
        resources.append(texture)
        if f"{name}_map" in program:
            program[f"{name}_map"].value = unit
    if model.params:
        block = context.buffer(std140(model))
        block.bind_to_uniform_block(0)
        resources.append(block)
    frame.use()
    vertices = context.vertex_array(program, [])
    vertices.render(moderngl.TRIANGLES, vertices=3)
    out = [np.frombuffer(target.read(), np.float32).reshape(N, 4).copy() for target in targets]
    for resource in [vertices, *resources]:
        resource.release()
    return dict(zip(names, out, strict=True))


def directions(rng: np.random.Generator, both_sides: bool) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of unit vectors, float32: uniform on the hemisphere or the sphere, every other pair near the mirror's."""
    z, phi = rng.uniform(0.01, 1, (2, N)), rng.uniform(0, 2 * np.pi, (2, N))
    r = np.sqrt(1 - z * z)
    wi, wo = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    spread = 10 ** rng.uniform(-4, -0.5, (N // 2, 1))
    wi[::2] = wo[::2] * [-1, -1, 1] + spread * rng.standard_normal((N // 2, 3))
    wi[:, 2] = np.maximum(np.abs(wi[:, 2]), 0.01)
    if both_sides:
        wi[:, 2] *= rng.choice([-1, 1], N)
        wo[:, 2] *= rng.choice([-1, 1], N)
    wi /= np.linalg.norm(wi, axis=1, keepdims=True)
    return wi.astype(np.float32), wo.astype(np.float32)


def instances(name: str, rng: np.random.Generator) -> list[lesk.Model]:
    """The default parameters, the narrowest lobes of the sliders, and three sets between the sliders' ends."""
    make = getattr(lesk.models, name)
    specs = make.info["parameters"]
    narrow = {spec["name"]: spec["range"][0] for spec in specs if spec["scale"] == "log"}
    models = [make(), make(**narrow)]
    for _ in range(3):
        values = {}
        for spec in specs:
            low, high = spec["slider"]
            values[spec["name"]] = rng.uniform(low, high, 3 if spec["kind"] == "color" else None)
        models.append(make(**values))
    return models


def tolerance(model: lesk.Model, math: str) -> float:
    """2e-4; GLSL lets log2 be wrong by 2^-21 near 1 (4.50, section 4.7.1), which pow multiplies by its exponent."""
    exponent = float(model.params["shininess"]) if "shininess" in model.params and math == "builtin" else 0.0
    return 2e-4 + np.log(2) * 2.0**-21 * exponent


def near(ours: np.ndarray, core: np.ndarray, tolerance: float) -> np.ndarray:
    return np.abs(ours - core) <= tolerance * (1 + np.abs(core))


@pytest.mark.parametrize(("language", "math"), [("glsl", "builtin"), ("glsl", "exact"), ("glsl-es", "builtin")])
@pytest.mark.parametrize("name", lesk.models.__all__)
def test_the_gpu_computes_what_the_model_computes(context: Context, name: str, language: str, math: str) -> None:
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    for model in instances(name, rng):
        wi, wo = directions(rng, both_sides=model.info["domain"] != "upper")
        u = rng.random((N, 3), dtype=np.float32)
        targets = run(context, model, language, math, wi=wi, wo=wo, u=u)
        tol = tolerance(model, math)
        f, pdf = targets["eval"][:, :3], targets["pdf"][:, 0]
        assert near(f, model.eval(wi, wo), tol).all(), model
        assert near(pdf, model.pdf(wi, wo), tol).all(), model
        check_draws(model, wo, u, targets, tol)


def check_draws(model: lesk.Model, wo: np.ndarray, u: np.ndarray, targets: dict[str, np.ndarray], tol: float) -> None:
    wi, pdf = targets["draw_wi_pdf"][:, :3], targets["draw_wi_pdf"][:, 3]
    weight, delta = targets["draw_weight_delta"][:, :3], targets["draw_weight_delta"][:, 3] == 1
    core = model.sample(wo, u)
    drawn = pdf > 0
    # a number within a rounding of a threshold may choose the other lobe or the other side of the horizon
    same = (drawn == (core.pdf > 0)) & (delta == core.delta) & near(wi, core.wi, tol).all(axis=-1)
    assert np.count_nonzero(~same) <= N // 1000, model
    lobe = same & delta
    assert near(pdf, core.pdf, tol)[lobe].all(), model
    assert near(weight, core.weight, tol)[lobe].all(), model
    # the driver may compute on with an unrounded wi, and a rounding is a large part of a narrow lobe
    rest = drawn & ~delta
    exact, slack = at_drawn(model, wi[rest], wo[rest])
    ours = np.concatenate([pdf[rest, np.newaxis], weight[rest] * pdf[rest, np.newaxis]], axis=1)
    assert (np.abs(ours - exact) <= tol * (1 + np.abs(exact)) + 4 * slack).all(), model


def at_drawn(model: lesk.Model, wi: np.ndarray, wo: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Density and f |cos wi| for drawn directions, and how much a rounding of the directions changes them."""

    def values(wi: np.ndarray) -> np.ndarray:
        f_cos = model.eval(wi, wo) * np.abs(wi[:, 2:])
        return np.concatenate([model.pdf(wi, wo)[:, np.newaxis], f_cos], axis=1)

    exact = values(wi.astype(np.float64))
    rng = np.random.default_rng(1)
    shaken = [values(wi + rng.choice([-(2.0**-24), 2.0**-24], wi.shape)) for _ in range(8)]
    return exact, np.max(np.abs(np.array(shaken) - exact), axis=0)
