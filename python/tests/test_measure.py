"""Measuring: arrays, reports, the commands `lux`, `falsecolor` and `validate`, and the closed forms themselves."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import lesk
from lesk import _closed_forms as exact
from lesk import validate
from lesk._light_cases import cases
from lesk.cli import main
from lesk.plot import _measured

OFFICE = Path(__file__).parents[2] / "examples" / "scenes" / "office.toml"

ROOM = """
version = 1
title = "A desk"
camera = { eye = [0, -4, 2], target = [0, 0, 1] }
measure = { maintenance_factor = 0.8 }
film = { size = [32, 20] }
[materials.floor]
model = "lambert"
reflectance = 0.5
[[objects]]
shape = "rectangle"
width = "8 m"
height = "8 m"
material = "floor"
[[lights]]
type = "point"
position = [0, 0, 2]
flux = "1600 lm"
[[sensors]]
type = "grid"
name = "desk"
corner = [-0.5, -0.5, 0]
u = [1, 0, 0]
v = [0, 1, 0]
spacing = "25 cm"
min_mean = "20 lx"
min_uniformity = 0.5
[[sensors]]
type = "line"
name = "across"
from = [-2, 0, 0]
to = [2, 0, 0]
spacing = "50 cm"
[[sensors]]
type = "glare"
name = "eye"
position = [0, -2, 1.2]
direction = [0, 1, 0]
"""


@pytest.fixture
def room(tmp_path: Path) -> Path:
    """A scene file."""
    path = tmp_path / "room.toml"
    path.write_text(ROOM)
    return path


def test_readings_are_arrays_with_errors_and_places():
    found = lesk.measure(ROOM)
    desk = found["desk"]
    assert desk.value.shape == desk.standard_error.shape == desk.samples.shape == (4, 4)
    assert desk.positions.shape == (4, 4, 3)
    np.testing.assert_allclose(desk.positions[0, 0], [-0.375, -0.375, 0])
    d2 = (desk.positions[..., :2] ** 2).sum(-1) + 4
    np.testing.assert_allclose(desk.value, 1600 / (4 * math.pi) * 2 / d2**1.5, rtol=1e-5)
    np.testing.assert_allclose(desk.direct + desk.indirect, desk.value, rtol=1e-12)
    assert desk.uniformity == desk.min / desk.mean and desk.diversity == desk.min / desk.max
    assert found.maintenance_factor == 0.8 and list(found) == ["desk", "across", "eye"]
    assert found["eye"].glare is not None and found["eye"].glare.left_out == 1
    with pytest.raises(KeyError, match="did you mean `desk`"):
        found["desc"]


def test_report_counts_maintained_values(room: Path):
    report = lesk.lux(room)
    row = report.rows()[0]
    assert row["mean"] == pytest.approx(0.8 * report.measurement["desk"].mean)
    assert [(c.what, c.met) for c in report.checks] == [("mean", True), ("uniformity", True)]
    assert report.passed
    lines = list(csv.DictReader(io.StringIO(report.csv())))
    assert len(lines) == 16 + 8 + 1
    assert float(lines[0]["maintained"]) == pytest.approx(0.8 * float(lines[0]["initial"]), rel=1e-5)
    page = report.html()
    assert "data:image/png;base64," in page and "maintenance factor 0.8" in page and "EN 12464-1" in page


def test_lux_exits_with_1_where_a_requirement_is_not_met(room: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["lux", str(room), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["version"] == 1 and data["passed"] and data["surfaces"][0]["met"]
    room.write_text(ROOM.replace("20 lx", "200 lx"))
    assert main(["lux", str(room), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert not data["passed"] and data["surfaces"][0]["checks"][0]["met"] is False
    assert main(["lux", str(room)]) == 1
    assert "NOT MET" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--error", "0%"], "`--error` is `0%`"),
        (["--error", "one"], "`--error` is `one`"),
        (["--sensor", "dsk"], "there is no sensor `dsk`"),
        (["--threads", "0"], "`threads` is 0"),
        (["--csv", "/nonexistent/folder/x.csv"], "cannot write"),
        (["--plan", "x.doc"], "cannot write"),
    ],
)
def test_wrong_wishes_are_refused(words: list[str], text: str, room: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["lux", str(room), *words]) == 2
    assert text in capsys.readouterr().err


def test_a_scene_without_sensors_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    path = tmp_path / "empty.toml"
    path.write_text("version = 1\ncamera = { eye = [0, -4, 2], target = [0, 0, 1] }\n")
    assert main(["lux", str(path)]) == 2
    assert "has no sensor" in capsys.readouterr().err


def test_tasks_are_listed(capsys: pytest.CaptureFixture[str]):
    assert main(["lux", "--tasks", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    tasks = {task["id"]: task for task in data["tasks"]}
    assert tasks["office.writing"]["illuminance"] == 500 and "check the edition in force" in data["standard"]


def test_plans_leave_out_specks_and_number_long_lines_only():
    # a slope from 0 to 100 lx over 2 m, one noisy cell at 95 lx, and a dip of 4 x 4 cells
    x, y = np.meshgrid(np.linspace(0, 2, 41), np.linspace(0, 1, 21))
    value = 50 * x
    value[10, 8], value[4:8, 30:34] = 95, 5
    axes = Figure().add_subplot()
    contours = axes.contour(x, y, value, levels=[60, 90])
    pieces = [len(path.to_polygons(closed_only=False)) for path in contours.get_paths()]
    middles = _measured._prune(contours, smallest=0.15, long=0.5)
    # at 60 lx the slope, the noise and the dip; at 90 lx the slope and the noise
    assert pieces == [3, 2]
    assert [len(path.to_polygons(closed_only=False)) for path in contours.get_paths()] == [2, 1]
    assert sorted(round(float(at[0]), 1) for at in middles) == [1.2, 1.8]


def test_files_and_false_colours_are_written(room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    written = [tmp_path / name for name in ("plan.png", "page.html", "table.csv")]
    options = ["--plan", str(written[0]), "--html", str(written[1]), "--csv", str(written[2])]
    assert main(["lux", str(room), *options]) == 0
    for unit, width in (("lx", ["--width", "16"]), ("cd/m2", ["--spp", "4"])):
        path = tmp_path / f"{unit[:2]}.png"
        written.append(path)
        assert main(["falsecolor", str(room), "-o", str(path), "--unit", unit, *width]) == 0
    picture = tmp_path / "picture.exr"
    lesk.image.write(picture, np.full((4, 6, 3), 80.0, np.float32))
    written.append(tmp_path / "exr.png")
    capsys.readouterr()
    assert main(["falsecolor", str(picture), "-o", str(written[-1]), "--range", "0,100", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["mean"] == pytest.approx(80, rel=1e-3)
    assert all(path.stat().st_size > 500 for path in written)
    assert main(["falsecolor", str(picture), "-o", "x.png", "--unit", "lx"]) == 2
    assert main(["falsecolor", str(picture), "-o", "x.png", "--range", "5,1"]) == 2


def test_office_meets_its_tasks():
    report = lesk.lux(OFFICE, sensors=["working plane", "desk 1"], error=0.02)
    assert report.passed and report.measurement["working plane"].value.shape == (28, 20)


def test_closed_forms_give_the_printed_values():
    # lights.md 6.2, computed there by other code
    point = [exact.point(1e4, [0, 0, 3], [r, 0, 0], [0, 0, 1]) for r in range(6)]
    np.testing.assert_allclose(point, [88.4194, 75.4938, 50.9327, 31.2610, 19.0986, 12.0418], atol=5e-5)
    panel = exact.rectangle([0, 0, 3], [1, 0, 0], [0, 0.5, 0])
    places = [(0, 0), (1, 0), (2, 0), (0, 1), (0, 2), (1, 1), (2, 2), (4, 0)]
    floor = [exact.polygon(1000, panel, np.array([*p, 0.0]), np.array([0, 0, 1.0])) for p in places]
    expected = [203.6260, 172.0659, 109.1303, 167.8287, 102.3892, 143.5404, 63.4235, 30.8028]
    np.testing.assert_allclose(floor, expected, atol=6e-5)
    wall = exact.polygon(1000, panel, np.array([2, 0, 1.0]), np.array([-1.0, 0, 0]))
    assert wall == pytest.approx(120.3276, abs=6e-5)
    disk = [exact.disk(5000, 0.5, 2, a) for a in (0, 0.5, 1, 2)]
    np.testing.assert_allclose(disk, [923.9978, 829.1669, 615.4743, 249.1493], atol=6e-5)
    assert exact.sphere(1000, 0.25, 2, 1) == pytest.approx(49.0874, abs=5e-5)
    assert exact.parallel_factor(1, 1, 1) == pytest.approx(0.138531606, abs=1e-9)
    cones = [exact.cone_intensity(1000, a) for a in (15, 30, 45, 60)]
    np.testing.assert_allclose(cones, [4670.84, 1187.95, 543.39, 318.31], atol=6e-3)
    angles = (0, 30, 45, 60, 70, 75, 80, 85)
    reflected = [0.04258, 0.04414, 0.05305, 0.09248, 0.17471, 0.25672, 0.39095, 0.61492]
    np.testing.assert_allclose([exact.fresnel(1.52, a) for a in angles], reflected, atol=6e-6)
    passed = [0.91832, 0.91596, 0.90253, 0.84347, 0.72471, 0.61481, 0.45604, 0.24565]
    np.testing.assert_allclose([exact.slab_polarised(1.52, a) for a in angles], passed, atol=6e-6)
    overcast = [exact.overcast_cone(a) for a in (15, 30, 45, 60)]
    np.testing.assert_allclose(overcast, [0.085154, 0.307418, 0.583684, 0.821429], atol=6e-7)


def test_cie_skies_have_the_printed_ratios():
    # lights.md 6.2, to its digits
    for number, ratios in {6: (3.4558, 3.2778, 2.9775, 2.5842), 12: (7.2048, 6.3941, 4.8485, 3.1906)}.items():
        found = [exact.cie_sky(number, elevation) for elevation in (15, 30, 45, 60)]
        np.testing.assert_allclose(found, ratios, rtol=3e-4)
    np.testing.assert_allclose([exact.cie_sky(n, 30) for n in (1, 3, 5)], [2.4495, 2.770, 3.14159], rtol=2e-4)
    np.testing.assert_allclose([exact.cie_sky(15, e) for e in (15, 30, 60)], [10.338, 8.116, 3.016], rtol=1e-3)


def test_form_factors_of_the_unit_cube_are_the_published_ones():
    # 0.199824896 and 0.200043776; the midpoint rule at 24 x 24 points keeps within 3e-4 (the shared edge is the worst)
    for square, expected in (
        (exact.rectangle([0.5, 0.5, 1], [0.5, 0, 0], [0, 0.5, 0]), 0.199824896),
        (exact.rectangle([0, 0.5, 0.5], [0, 0.5, 0], [0, 0, 0.5]), 0.200043776),
    ):
        middles = (np.arange(24) + 0.5) / 24
        points = [np.array([x, y, 0.0]) for x in middles for y in middles]
        mean = np.mean([exact.polygon(1 / math.pi, square, p, np.array([0, 0, 1.0])) for p in points])
        assert mean == pytest.approx(expected, rel=3e-4)


def test_radiosity_of_the_cube_is_that_of_keldysh():
    # keldysh.ru, test CUBE: 10 m, 50 000 cd, rho 2/3, given to 0.3 lx; ours to 1e-4
    places = [(0, 0), (0.4, 0), (0.8, 0), (0.4, 0.4), (0.8, 0.4), (0.8, 0.8)]
    found = exact.cube(5e4, 10, 2 / 3, places)
    np.testing.assert_allclose(found, [4207.4, 3798.6, 3095.7, 3494.9, 2920.5, 2515.0], atol=0.3 + 0.42)
    assert exact.enclosure_mean(1e4, 96, 0.5) + 1e4 / 96 == pytest.approx(208.33, abs=5e-3)


def test_means_over_the_cubes_grid_tend_to_the_mean_of_the_enclosure():
    few, many = (exact.cube_grid_mean(1e4 / (4 * math.pi), 4, 0.5, count) for count in (8, 16))
    whole = exact.enclosure_mean(1e4, 96, 0.5)
    # the midpoint rule: nearly a quarter of the error for twice as many points: the edges are not smooth
    assert 3 < (few - whole) / (many - whole) < 4
    # 4e-4: that, and the radiosity of 12 and 24 cells
    assert (4 * many - few) / 3 == pytest.approx(whole, rel=4e-4)


def test_validation_has_enough_rows_and_its_quick_ones_agree():
    table = list(cases())
    assert sum(len(case.rows) for case in table) >= 60
    for case in table:
        if case.group in ("point", "spot", "rectangle", "disk", "Fresnel"):
            for row in validate.compare(case, seed=0):
                assert row.met, (row, row.z)


def test_a_wrong_row_differs():
    row = validate.Compared("x", "y", 100.0, 100.9, 0.15, "lx", False)
    assert not row.met and row.z == pytest.approx(6, rel=1e-3)
    assert not validate.Compared("x", "y", 100.0, 100.1, 0.3, "lx", False).met  # too noisy
    assert not validate.Compared("x", "y", 100.0, 100.01, 0.0, "lx", True).met
    assert validate.Compared("x", "y", 100.0, 100.0005, 0.0, "lx", True).met
