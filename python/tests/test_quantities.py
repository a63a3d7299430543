"""Quantities with units: exercises, explanations, the command line, the page of the book."""

from __future__ import annotations

import inspect
import json
import re
import shlex
from pathlib import Path

import pytest

import lesk
from lesk import _lesk
from lesk.cli import main, quantity

PAGE = Path(__file__).parents[2] / "docs" / "quantities.md"


def output(capsys: pytest.CaptureFixture[str], *words: str, status: int = 0) -> str:
    """Run a command; give its standard output."""
    assert main(list(words)) == status, capsys.readouterr().err
    return capsys.readouterr().out


@pytest.mark.parametrize(
    ("given", "to", "options", "expected"),
    [
        # lecture.md and lights.md, section 5: the digits that they print
        ("3.86e26 W", "W/m2", {"distance": "1.5e11 m"}, 1365.196),
        ("3.828e26 W", "W/m2", {"distance": "1 au"}, 1361.166),
        ("1100 lm", "lx", {"distance": "1.5 m"}, 38.9045),
        ("1600 lm", "lx", {"distance": "2 m"}, 31.831),
        ("1 W @ 600 nm", "photons/s", {}, 3.020470e18),
        ("1 W @ 600 nm", "lm", {}, 430.974),
        ("1 W @ 555 nm", "lm", {}, 683.002),
        ("600 nm", "eV", {}, 2.06640),
    ],
)
def test_exercises_have_their_values(given, to, options, expected):
    assert lesk.quantity(given).to(to, **options).value == pytest.approx(expected, rel=2e-6)


def test_every_step_tells_its_formula_and_assumption():
    found = lesk.quantity("1100 lm").to("lx", distance="1.5 m")
    assert [step.unit for step in found.steps] == ["cd", "lx"]
    assert "alike in all directions" in found.explain() and "E = I cos θ / d²" in found.explain()
    assert found.dimension == "illuminance"
    assert float(found) == found.value


def test_a_result_can_be_converted_on_with_its_spectrum():
    lux = lesk.quantity("500 lx @ D65")
    watts = lux.to("W/m2")
    assert watts.value == pytest.approx(500 / 205.15, rel=1e-4)  # lights.md 3.1
    assert watts.to("lx").value == pytest.approx(500, rel=1e-12)


def test_what_is_missing_is_named():
    with pytest.raises(lesk.ParameterError, match="a distance is needed") as error:
        lesk.quantity("300 lx").to("cd")
    assert "distance" in str(error.value)
    with pytest.raises(lesk.ParameterError, match="by a spectrum only"):
        lesk.quantity("60 W").to("lm")
    for bad in ("", "5", "lm", "5 furlong", "1 W @ blue", "nan lm"):
        with pytest.raises(lesk.ParameterError):
            lesk.quantity(bad)


def test_python_and_the_command_have_the_options_of_the_core():
    names = {name for name, _ in _lesk.quantity_options()}
    python = set(inspect.signature(lesk.Quantity.to).parameters)
    command = {name.rstrip("_") for name in inspect.signature(quantity.main).parameters}
    assert names <= python
    assert names - {"distance"} <= command
    assert "at" in command


def test_json_has_value_unit_and_steps(capsys):
    data = json.loads(output(capsys, "quantity", "1100 lm", "--to", "lx", "--at", "1.5m", "--json"))
    assert data["version"] == 1
    assert data["value"] == pytest.approx(38.9045, rel=1e-5)
    assert data["unit"] == "lx"
    assert [set(step) for step in data["steps"]] == [{"formula", "assumption", "value", "unit"}] * 2


def test_bands_show_the_lecture_beside_a_black_body(capsys):
    words = ["quantity", "3.86e26 W", "--to", "W/m2", "--at", "1.5e11m", "--bands", "--json"]
    visible = json.loads(output(capsys, *words))["bands"][1]
    # lecture.md: 40 % are 546 W/m2; a black body of 5778 K has 46.5 % in 380 to 780 nm
    assert visible["lecture_value"] == pytest.approx(546, abs=0.5)
    assert visible["share"] == pytest.approx(0.465, abs=5e-4)
    assert main(["quantity", "1100 lm", "--bands"]) == 2


def test_the_bulb_misses_all_that_the_lecture_demands(capsys):
    words = ["quantity", "1100 lm", "--to", "lx", "--at", "1.5m", "--demands"]
    rows = json.loads(output(capsys, *words, "--json"))["demands"]
    # lecture.md: the bulb's 38.9 lx against 50, 100 and 300 lx
    assert [row["lux"] for row in rows] == [50, 100, 300]
    assert [row["share"] for row in rows] == pytest.approx([38.9045 / 50, 38.9045 / 100, 38.9045 / 300], rel=1e-5)
    assert not any(row["met"] for row in rows)
    assert output(capsys, *words).count("missed") == 3
    words[words.index("1.5m")] = "1m"
    assert output(capsys, *words).count("met") == 1
    assert main(["quantity", "1100 lm", "--to", "cd", "--demands"]) == 2


def test_sunlight_on_a_tilted_plane_in_lux(capsys):
    # lights.md, section 5: ASTM G173 global tilt, 1000.37 W/m2 and 109.50 klx
    words = ["quantity", "1000.37 W/m2 @ AM1.5G", "--to", "klx", "--json"]
    assert json.loads(output(capsys, *words))["value"] == pytest.approx(109.50, abs=0.006)
    assert lesk.spectrum("AM1.5G").energy() == pytest.approx(1000.37, abs=0.006)


def test_constants_of_the_lecture_stand_beside_ours(capsys):
    words = ["quantity", "1 W @ 555 nm", "--to", "lm", "--km", "680", "--range", "380:770", "--json"]
    data = json.loads(output(capsys, *words))
    assert data["value"] == pytest.approx(680)
    assert data["standard"]["value"] == pytest.approx(683.002)


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["5"],
        ["5 lm", "--to", "lx"],
        ["5 lm", "--to", "furlong"],
        ["5 lm", "--to", "lx", "--at", "0m"],
        ["5 lm", "--to", "lx", "--at", "1"],
        ["5 W", "--to", "lm", "--spectrum", "no.csv"],
        ["5 W", "--to", "lm", "--spectrum", "D65", "--range", "5"],
        ["5 lm", "--to", "cd", "--cone", "200deg"],
    ],
)
def test_bad_words_are_one_message_and_status_2(words, capsys):
    assert main(["quantity", *words]) == 2
    captured = capsys.readouterr()
    assert captured.out == "" and captured.err.startswith("error: ")


def test_what_was_not_needed_is_said(capsys):
    assert main(["quantity", "5 lm", "--to", "cd", "--at", "1m"]) == 0
    assert "`--at` was not needed" in capsys.readouterr().err


def test_all_units_of_the_list_are_read(capsys):
    data = json.loads(output(capsys, "quantity", "--units", "--json"))
    for row in data["quantities"]:
        for unit in row["units"]:
            assert lesk.quantity(f"1 {unit}").dimension == row["name"]
    for row in data["units"]:
        assert lesk.quantity(f"1 {row['symbol']}").dimension == row["measures"]


def test_scenes_take_the_same_units_and_spectra():
    text = """
version = 1
[camera]
eye = [0, -4, 1]
target = [0, 0, 0]
fov = "40 deg"
[materials.grey]
model = "lambert"
[[objects]]
shape = "rectangle"
width = "1 ft"
height = "30 cm"
material = "grey"
light = { luminance = "100 fL" }
[[lights]]
type = "directional"
direction = [0, 0, -1]
illuminance = "20 uW/cm2"
spectrum = "LED-B3"
"""
    scene = lesk.scene.parse(text)
    # 0.2 W/m2 at 316.88 lm/W (lights.md 3.1)
    assert any("63.37" in note and "LED-B3" in note for note in scene.notes), scene.notes


def blocks() -> list[tuple[str, str]]:
    """Commands of the page with what it says that they print."""
    if not PAGE.is_file():
        return []
    found = []
    for block in re.findall(r"```console\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL):
        for command, text in re.findall(r"^\$ (lesk .*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE):
            found.append((command, text))
    return found


@pytest.mark.parametrize(("command", "printed"), blocks())
def test_commands_of_the_book_print_what_it_says(command, printed, capsys, monkeypatch):
    monkeypatch.chdir(PAGE.parent)
    main(shlex.split(command)[1:])
    captured = capsys.readouterr()
    assert (captured.out + captured.err).rstrip() == printed.rstrip()


def test_the_table_of_the_book_is_that_of_the_core():
    if not PAGE.is_file():
        pytest.skip("the book is not here")
    text = PAGE.read_text(encoding="utf-8")
    assert len(blocks()) > 10
    for name, czech, symbol, units in _lesk.quantity_dimensions():
        assert f"| {name} | {czech} | {symbol} | {', '.join(f'`{unit}`' for unit in units)} |" in text, name
    for symbol, name, _, factor in _lesk.quantity_units():
        assert f"| `{symbol}` | {name} | {factor:.9g} |" in text, symbol
