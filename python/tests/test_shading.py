"""Rasterising and meshes from Python and from the command line."""

import json

import numpy as np
import pytest

import lesk
from lesk.cli import main

SCENE = """
version = 1
[camera]
eye = [0, -4, 0]
target = [0, 0, 0]
fov = "40 deg"
[film]
size = [64, 48]
[materials.clay]
model = "lambert"
reflectance = 0.6
[[objects]]
shape = "sphere"
material = "clay"
[[lights]]
type = "point"
position = [0, -4, 0]
intensity = "100 cd"
"""

CUBE = "\n".join(
    ["v {} {} {}".format(*(2 * ((k >> b) & 1) - 1 for b in range(3))) for k in range(8)]
    + ["f 1 5 7 3", "f 2 4 8 6", "f 1 2 6 5", "f 3 7 8 4", "f 1 3 4 2", "f 5 6 8 7", ""]
)


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "ball.toml"
    path.write_text(SCENE)
    return path


def test_phong_at_the_middle_of_a_sphere_is_the_closed_form():
    picture = lesk.shade(SCENE, tessellation=256, supersampling=2)
    # the lamp is at the camera, 3 m from the nearest point: L = rho/pi I/d^2
    assert picture.rgb[23:25, 31:33].mean() == pytest.approx(0.6 / np.pi * 100 / 9, rel=2e-3)
    assert picture.counts["evaluations"] == picture.counts["samples"]


def test_evaluations_are_faces_vertices_or_samples():
    counts = {mode: lesk.shade(SCENE, shading=mode, tessellation=16).counts for mode in ("flat", "gouraud", "phong")}
    assert counts["flat"]["evaluations"] <= counts["flat"]["faces"] == 16 * 8
    # a vertex of a front and a back is lit on both
    assert counts["gouraud"]["evaluations"] <= 2 * counts["gouraud"]["vertices"]
    culled = lesk.shade(SCENE, shading="gouraud", tessellation=16, cull=True).counts
    assert culled["evaluations"] < culled["vertices"]
    assert counts["phong"]["evaluations"] == counts["phong"]["samples"] > 500


def test_layers_are_those_of_the_path_tracer():
    shaded = lesk.shade(SCENE, aovs=True)
    traced = lesk.render(SCENE, spp=1, aovs=True)
    assert set(shaded.layers) == set(traced.layers)
    assert shaded.faces.shape == (48, 64)


def test_the_classic_model_needs_no_units_and_warns_above_one():
    classic = {"ka": 0.5, "kd": 0.5, "ks": 0.5, "shininess": 10, "lights": [((0, -1, 0), (1, 1, 1))]}
    picture = lesk.shade(SCENE, classic=classic)
    assert picture.rgb[24, 32, 0] == pytest.approx(1.5, rel=1e-2)
    assert "1.5" in picture.warnings[0]
    assert lesk.shade(SCENE, classic=lesk.Classic()).warnings == []


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"shading": "toon"}, "phong, gouraud, flat are accepted"),
        ({"normals": "smooth"}, "max1999"),
        ({"tessellation": 2}, "3 to 4096"),
        ({"supersampling": -1}, "`supersampling` is -1"),
        ({"crease_angle_deg": 200}, "0 to 180 deg"),
        ({"threads": 0}, "`threads` is 0"),
        ({"classic": {"kx": 1}}, "no `kx`"),
        ({"classic": {"diffuse": (1, 2)}}, "2 numbers"),
        ({"classic": {"kd": -1}}, "`kd` is -1"),
    ],
)
def test_wrong_settings_are_named(wrong, message):
    with pytest.raises(lesk.ParameterError, match=message):
        lesk.shade(SCENE, **wrong)


def test_render_has_a_raster_engine(scene, tmp_path, capsys):
    out = tmp_path / "ball.png"
    words = ["render", str(scene), "-o", str(out), "--engine", "raster", "--shading", "gouraud", "--json"]
    assert main(words) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["version"] == 1
    assert facts["counts"]["evaluations"] <= facts["counts"]["vertices"]
    assert out.read_bytes().startswith(b"\x89PNG")
    assert main(["render", str(scene), "-o", str(out), "--engine", "fast"]) == 2
    assert "path, raster are accepted" in capsys.readouterr().err
    assert main([*words[:6], "--classic", "kd=x"]) == 2
    assert main([*words[:6], "--classic", "kd=0.5,ks=0.6,h=20,highlight=blinn"]) == 0


STATED = (
    SCENE
    + """
[raster]
shading = "flat"
tessellation = 12
normals = "max1999"
crease_angle = "40 deg"
supersampling = 2
cull = true
flat_point = "first"
interpolation = "barycentric"
correction = "screen"
renormalize = false
quadrature = 4
shadows = true
subdivide = 0
space = "gamma"
[raster.classic]
kd = 0.9
ka = 0.0
ks = 0.0
"""
)

ASKED = {
    "shading": "flat",
    "tessellation": 12,
    "normals": "max1999",
    "crease_angle_deg": 40,
    "supersampling": 2,
    "cull": True,
    "flat_point": "first",
    "interpolation": "barycentric",
    "correction": "screen",
    "renormalize": False,
    "quadrature": 4,
    "shadows": True,
    "subdivide": 0,
    "space": "gamma",
    "classic": {"kd": 0.9, "ka": 0.0, "ks": 0.0},
}


def test_a_scene_says_how_it_is_shaded_and_arguments_override_it(tmp_path, capsys):
    asked = lesk.shade(SCENE, **ASKED)
    stated = lesk.shade(STATED)
    assert stated.counts == asked.counts
    np.testing.assert_array_equal(stated.rgb, asked.rgb)
    usual = lesk.shade(SCENE)
    back = {
        "shading": "phong",
        "tessellation": 64,
        "normals": "given",
        "crease_angle_deg": "stored",
        "supersampling": 1,
        "cull": False,
        "flat_point": "centroid",
        "interpolation": "bilinear",
        "correction": "perspective",
        "renormalize": True,
        "quadrature": 16,
        "shadows": False,
        "space": "linear",
        "classic": False,
    }
    over = lesk.shade(STATED, **back)
    assert over.counts == usual.counts
    np.testing.assert_array_equal(over.rgb, usual.rgb)
    # the same from the command line
    path = tmp_path / "stated.toml"
    path.write_text(STATED)
    words = ["render", str(path), "-o", str(tmp_path / "a.exr"), "--engine", "raster", "--json"]
    opposite = (
        "--shading phong --tessellation 64 --normals given --crease-angle stored --supersampling 1 --no-cull "
        "--flat-point centroid --interpolation bilinear --correction perspective --renormalize --quadrature 16 "
        "--no-shadows --space linear --classic none"
    )
    for options, expected in (("", stated), (opposite, usual)):
        assert main([*words, *options.split()]) == 0
        assert json.loads(capsys.readouterr().out)["counts"] == expected.counts
        np.testing.assert_array_equal(lesk.image.read(tmp_path / "a.exr"), expected.rgb)


def test_options_of_the_rasteriser_are_refused_for_paths(scene, tmp_path, capsys):
    assert main(["render", str(scene), "-o", str(tmp_path / "a.png"), "--crease-angle", "30"]) == 2
    assert "`--crease-angle` is for the rasteriser\nhint: add `--engine raster`" in capsys.readouterr().err


def test_compare_shading_orders_the_modes_by_their_errors(scene, tmp_path, capsys):
    out = tmp_path / "compare.png"
    words = ["compare-shading", str(scene), "-o", str(out), "--spp", "16", "--frames", "2", "--json"]
    assert main(words) == 0
    facts = json.loads(capsys.readouterr().out)
    errors = {mode: one["error"] for mode, one in facts["modes"].items()}
    assert errors["phong"] < errors["gouraud"] < errors["flat"]
    assert [p["tessellation"] for p in facts["curve"]] == sorted(p["tessellation"] for p in facts["curve"])
    assert out.read_bytes().startswith(b"\x89PNG")


def test_mesh_reports_a_cube_and_draws_its_edges(tmp_path, capsys):
    path = tmp_path / "cube.obj"
    path.write_text(CUBE)
    (one,) = lesk.mesh.report(path)["meshes"]
    assert one["edges"] == {"real": 12, "auxiliary": 0, "boundary": 0, "non_manifold": 0}
    assert (one["closed"], one["faces_by_corners"], one["area_m2"]) == (True, {"4": 6}, 24.0)
    assert lesk.mesh.report(path, crease_angle_deg=100)["meshes"][0]["edges"]["auxiliary"] == 12
    for ending in ("svg", "png"):
        assert main(["mesh", str(path), "-o", str(tmp_path / f"cube.{ending}")]) == 0
    assert "6 (6 with 4 corners), 12 triangles" in capsys.readouterr().out
    assert main(["mesh", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["version"] == 1


def test_mesh_names_what_is_wrong(tmp_path, capsys):
    assert main(["mesh", str(tmp_path / "none.obj")]) == 2
    assert "cannot be read" in capsys.readouterr().err
    path = tmp_path / "cube.obj"
    path.write_text(CUBE)
    assert main(["mesh", str(path), "--crease-angle", "270"]) == 2
    assert "0 to 180 deg" in capsys.readouterr().err
    assert main(["mesh", str(path), "-o", "edges.gif"]) == 2


POT = """
version = 1
[camera]
eye = [0.4, -5.2, 2.2]
target = [0, 0, 0.7]
fov = "36 deg"
[film]
size = [120, 80]
[materials.red]
model = "blinn_phong"
shininess = 20
[[objects]]
shape = "teapot"
level = 3
material = "red"
transform = { scale = 0.5 }
[[lights]]
type = "point"
position = [-2.0, -4.0, 4.5]
intensity = "2000 cd"
"""


def test_a_scene_of_meshes_is_subdivided_and_all_modes_approach_one_limit():
    found = lesk.compare_shading(POT, spp=4, frames=1)
    assert [p["subdivide"] for p in found.curve] == [0, 1, 2, 3]
    faces = [p["faces"] for p in found.curve]
    assert faces == [faces[0] * 4**n for n in range(4)]
    for mode in ("flat", "gouraud", "phong"):
        errors = [p["errors"][mode] for p in found.curve]
        # first order in the size of faces, 1/8 of the first; edges of the picture and of shadows decide on single pixels
        assert errors[3] < 0.5 * errors[0] and errors[3] < errors[2], (mode, errors)
    assert lesk.compare_shading(POT, spp=1, frames=1, curve=False).curve == []


def test_a_curve_under_a_lamp_with_an_area_ends_near_its_limit():
    start = POT.index("[[lights]]")
    lamp = '[[objects]]\nshape = "rectangle"\nwidth = "0.4 m"\nheight = "0.4 m"\nlight = { flux = "9000 lm", two_sided = true }\n'
    place = "transform = { translate = [-2.0, -4.0, 4.5] }\n"
    found = lesk.compare_shading(POT[:start] + lamp + place, spp=64, frames=1)
    errors = [p["errors"]["phong"] for p in found.curve]
    # what is left: noise of 64 samples, hard edges against filtered ones
    assert errors[-1] < 0.3 and errors[-1] <= errors[0], errors


def test_shapes_and_meshes_together_become_finer_together():
    ball = '[[objects]]\nshape = "sphere"\nradius = "0.4 m"\nmaterial = "red"\ntransform = { translate = [-1.2, 0, 0.4] }\n'
    found = lesk.compare_shading(POT.replace("[[lights]]", f"{ball}[[lights]]"), spp=4, frames=1)
    assert [(p["subdivide"], p["tessellation"]) for p in found.curve] == [(0, 8), (1, 16), (2, 32), (3, 64)]
    pot = lesk.shade(POT).counts["faces"]
    # a sphere of n faces around has n/2 rows of them
    assert [p["faces"] for p in found.curve] == [(pot + 8 * 4) * 4**n for n in range(4)]
    for mode in ("flat", "gouraud", "phong"):
        errors = [p["errors"][mode] for p in found.curve]
        assert errors[3] < 0.5 * errors[0] and errors[3] < errors[2], (mode, errors)


def test_a_picture_without_light_has_no_curve():
    away = POT.replace("target = [0, 0, 0.7]", "target = [0, -9, 0.7]")
    found = lesk.compare_shading(away, spp=1, frames=1)
    assert found.curve == [] and found.errors["flat"] == 0
