"""Rasterising: Phong shading at 1920 x 1080 against Mesa's llvmpipe, one core each, in turns.

llvmpipe runs in the calling thread (LP_NUM_THREADS=0) through moderngl over EGL. Both draw the same triangles with the
same vertex normals from memory that was filled before, transform all vertices, cull back faces, test depth, clear the
picture and compute Blinn-Phong's model for one directional light per pixel; both cover the same number of pixels. Both
write light as it is, Lesk 3 x f32 and llvmpipe 4 x 8 bit, which is less.
"""

from __future__ import annotations

import math
import os
import tempfile
from pathlib import Path

import numpy as np
from table import Row, Table
from timing import clock, interleaved

WIDTH, HEIGHT = 1920, 1080
ZOOM = 2.4
LIGHT = (0.5, 0.8, 0.6)

VERTEX = """#version 330
in vec3 p; in vec3 n; out vec3 P; out vec3 N; uniform float zoom;
void main() { P = p; N = n; float z = 3.2 - p.z; gl_Position = vec4(p.x * zoom * 9. / 16., p.y * zoom, z * 1.002 - .2, z); }
"""
FRAGMENT = """#version 330
in vec3 P; in vec3 N; out vec4 o;
void main() {
  vec3 n = normalize(N), v = normalize(vec3(0, 0, 3.2) - P), l = normalize(vec3(.5, .8, .6)), h = normalize(l + v);
  float norm = (80. + 8.) / 25.132741;
  vec3 f = vec3(.4) / 3.14159265 + vec3(.4) * norm * pow(max(dot(n, h), 0.), 80.);
  o = vec4(3. * f * max(dot(n, l), 0.), 1);
}
"""


def mesh(level: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A sphere displaced by seven octaves of sine noise: positions, normals, triangles (20 * 4^level)."""
    positions, triangles = icosphere(level)
    displacement, frequency, amplitude = np.zeros(len(positions)), 2.0, 0.25
    random = np.random.default_rng(3)
    for _ in range(7):
        k = random.normal(size=(6, 3))
        k /= np.linalg.norm(k, axis=1, keepdims=True)
        phase = random.random(6) * 6.28
        displacement += amplitude * np.mean(np.sin(frequency * positions @ k.T + phase), axis=1)
        frequency, amplitude = frequency * 2.1, amplitude * 0.55
    positions = positions * (1 + displacement)[:, None]
    a, b, c = (positions[triangles[:, i]] for i in range(3))
    faces = np.cross(b - a, c - a)
    normals = np.zeros_like(positions)
    for i in range(3):
        np.add.at(normals, triangles[:, i], faces)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return positions.astype("f4"), normals.astype("f4"), triangles.astype("i4")


def icosphere(level: int) -> tuple[np.ndarray, np.ndarray]:
    g = (1 + math.sqrt(5)) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    points += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = "0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8 3 9 4 3 4 2 3 2 6 3 6 8 3 8 9"
    faces += " 4 9 5 2 4 11 6 2 10 8 6 7 9 8 1"
    p = np.array(points, float) / math.hypot(1, g)
    t = np.array(faces.split(), int).reshape(-1, 3)
    for _ in range(level):
        edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
        unique, inverse = np.unique(edges, axis=0, return_inverse=True)
        middle = p[unique].sum(axis=1)
        ab, bc, ca = (inverse.reshape(-1) + len(p)).reshape(3, -1)
        p = np.concatenate([p, middle / np.linalg.norm(middle, axis=1, keepdims=True)])
        a, b, c = t.T
        t = np.concatenate([np.stack(x, 1) for x in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    return p, t


def write_ply(path: Path, positions: np.ndarray, normals: np.ndarray, triangles: np.ndarray) -> None:
    names = "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz"))
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n{names}"
    head += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = np.empty(len(triangles), dtype=[("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    path.write_bytes(head.encode() + np.concatenate([positions, normals], 1).tobytes() + faces.tobytes())


def scene(ply: Path) -> str:
    fov = math.degrees(2 * math.atan(16 / 9 / ZOOM))
    x, y, z = (-v for v in LIGHT)
    return f"""
version = 1
[camera]
eye = [0, 0, 3.2]
target = [0, 0, 0]
up = [0, 1, 0]
fov = "{fov} deg"
[film]
size = [{WIDTH}, {HEIGHT}]
[materials.m]
model = "blinn_phong"
[[objects]]
shape = "mesh"
file = "{ply.name}"
material = "m"
[[lights]]
type = "directional"
direction = [{x}, {y}, {z}]
illuminance = "3 lx"
"""


def lesk_raster(folder: Path, arrays: tuple[np.ndarray, ...]):
    from lesk import _lesk
    from lesk._raster import wishes

    ply = folder / "mesh.ply"
    write_ply(ply, *arrays)
    return _lesk.Raster(_lesk.Scene.parse(scene(ply), folder), wishes(cull=True, threads=1))


class Llvmpipe:
    """One context; its threads are this one."""

    def __init__(self) -> None:
        os.environ["LP_NUM_THREADS"] = "0"
        os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
        import moderngl

        self.gl = moderngl
        self.context = moderngl.create_standalone_context(backend="egl")
        color = self.context.texture((WIDTH, HEIGHT), 4)
        self.target = self.context.framebuffer([color], self.context.depth_renderbuffer((WIDTH, HEIGHT)))
        self.target.use()
        self.context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self.program = self.context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self.program["zoom"].value = ZOOM

    @property
    def name(self) -> str:
        """What draws."""
        return f"{self.context.info['GL_RENDERER']}, {self.context.info['GL_VERSION']}"

    def load(self, positions: np.ndarray, normals: np.ndarray, triangles: np.ndarray) -> None:
        """Hands a mesh to the peer."""
        vertices = self.context.buffer(np.concatenate([positions, normals], 1).tobytes())
        indices = self.context.buffer(triangles.tobytes())
        self.array = self.context.vertex_array(self.program, [(vertices, "3f 3f", "p", "n")], indices)

    def draw(self) -> None:
        """One frame, to its end."""
        self.target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        self.array.render(self.gl.TRIANGLES)
        self.context.finish()

    def covered(self) -> int:
        """Pixels that a triangle covers: its alpha is 1."""
        pixels = np.frombuffer(self.target.read(components=4), np.uint8).reshape(HEIGHT, WIDTH, 4)
        return int((pixels[..., 3] > 0).sum())


def run(quick: bool) -> list[Table]:
    """One table: ms per frame of one thread."""
    try:
        peer = Llvmpipe()
    except Exception as error:  # no EGL, no Mesa, no moderngl: each says so in its own way
        print(f"skipped: rasterising against llvmpipe ({error})")
        return []
    table = Table("Phong shading at 1920 x 1080, ms per frame on one core", peer.name)
    for level, what in ((6, "82 k triangles"), (8, "1.3 M triangles")):
        arrays = mesh(level)
        with tempfile.TemporaryDirectory() as name:
            ours = lesk_raster(Path(name), arrays)
        peer.load(*arrays)
        times = interleaved({"lesk": ours.draw, "peer": peer.draw}, 9 if quick else 25, clock)
        a, b = times["lesk"].median, times["peer"].median
        table.add(Row(f"{what}, blinn_phong", f"{1e3 * a:.1f}", f"{1e3 * b:.1f}", b / a, 1.0, 3.0))
        own, other = ours.draw(), peer.covered()
        if abs(own - other) > 1e-3 * other:
            raise AssertionError(f"lesk covers {own} pixels, the peer {other}: they do not draw the same")
        table.rows[-1].note = f"pixels covered: {own}, by the peer {other}"
    return [table]
