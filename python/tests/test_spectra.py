"""Spectra: names, files, colours, against colour-science and luox."""

from __future__ import annotations

import csv
import json
import os
import warnings
from pathlib import Path

import numpy as np
import pytest

import lesk
from lesk import _lesk
from lesk.cli import main

SHARED = Path(os.environ.get("LESK_SHARED", Path(__file__).parents[3] / "shared"))
SPECTRAN = SHARED / "data" / "lights" / "spectra" / "spectran"

TABLES = [name for name in _lesk.spectrum_names() if name[:2] in ("FL", "HP", "LE")]
OBSERVERS = {
    "1931": "CIE 1931 2 Degree Standard Observer",
    "1964": "CIE 1964 10 Degree Standard Observer",
    "2006-2": "CIE 2015 2 Degree Standard Observer",
    "2006-10": "CIE 2015 10 Degree Standard Observer",
}


@pytest.fixture(scope="module")
def colour():
    """The oracle, colour-science."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip("colour", reason="colour-science is not installed")


def table(colour, name):
    """A light of colour-science on our wavelengths: linear between its rows, zero outside."""
    nm = np.arange(360.0, 831.0)
    source = colour.SDS_ILLUMINANTS[name]
    return nm, np.interp(nm, source.wavelengths, source.values, left=0, right=0)


@pytest.mark.parametrize("name", ["A", "E", "D50", "D55", "D65", "D75", *TABLES])
def test_colors_of_all_illuminants_are_those_of_colour_science(name, colour):
    light = lesk.spectrum(name)
    nm, values = table(colour, name)
    # the tables of A and D stop at 780 nm and round to six digits
    inside = nm <= 780
    scale = light.at(560.0) / values[nm == 560]
    assert light.at(nm)[inside & (nm >= 380)] == pytest.approx(scale * values[inside & (nm >= 380)], rel=2e-3, abs=1e-2)
    for ours, theirs in OBSERVERS.items():
        source = colour.MSDS_CMFS[theirs]
        cmfs = np.zeros((nm.size, 3))
        cmfs[int(source.domain[0]) - 360 :] = source.values
        xyz = np.trapezoid(cmfs * values[:, None], axis=0)
        assert light.xy(ours) == pytest.approx(xyz[:2] / xyz.sum(), abs=2e-5)


@pytest.mark.parametrize("name", ["A", "D50", "D65", *TABLES])
def test_color_temperature_and_duv_are_those_of_colour_science(name, colour):
    light = lesk.spectrum(name)
    kelvin, duv = light.color_temperature
    uv = colour.xy_to_UCS_uv(light.xy())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = colour.temperature.uv_to_CCT_Ohno2013(uv)
    # Ohno 2013 states an error of 1 K below 20 000 K and 1e-5 of Duv for its table
    assert kelvin == pytest.approx(theirs[0], rel=5e-4)
    assert duv == pytest.approx(theirs[1], abs=2e-5)


@pytest.mark.parametrize("name", ["FL1", "FL2", "FL4", "FL7", "FL11", "FL3.12", "HP1", "LED-B1", "LED-B3", "LED-RGB1"])
def test_color_rendering_is_that_of_colour_science(name, colour):
    ours = lesk.spectrum(name).color_rendering
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = colour.colour_rendering_index(colour.SDS_ILLUMINANTS[name], additional_data=True)
    # its colour temperature is Robertson's, up to 4 K from the minimum: a tenth of an index
    assert ours.ra == pytest.approx(theirs.Q_a, abs=0.15)
    assert ours.r[:8] == pytest.approx([theirs.Q_as[i + 1].Q_a for i in range(8)], abs=0.4)


@pytest.mark.parametrize("space", ["srgb", "display-p3", "rec2020", "acescg"])
def test_color_spaces_are_those_of_colour_science(space, colour):
    theirs = {"srgb": "sRGB", "display-p3": "Display P3", "rec2020": "ITU-R BT.2020", "acescg": "ACEScg"}
    spaces = colour.RGB_COLOURSPACES
    rgb = [0.2, 0.7, 0.4]
    expected = colour.RGB_to_RGB(rgb, spaces["sRGB"], spaces[theirs[space]], chromatic_adaptation_transform="Bradford")
    # its matrices of sRGB and BT.2020 are rounded to four digits, as in the standards
    assert lesk.color.convert(rgb, "srgb", space) == pytest.approx(expected, abs=5e-4)


def lamps() -> list[Path]:
    """The ten lamps that were measured with a Spectran and evaluated by luox."""
    return sorted(path for path in SPECTRAN.glob("*.csv") if not path.stem.endswith("_results"))


@pytest.mark.parametrize("name", [path.stem for path in lamps()] or ["absent"])
def test_measured_lamps_are_as_luox_says(name):
    if not SPECTRAN.is_dir():
        pytest.skip("the measured lamps are not here")
    light = lesk.spectrum(SPECTRAN / f"{name}.csv")
    with (SPECTRAN / f"{name}_luox_results.csv").open(encoding="utf-8-sig") as file:
        luox = {row[0]: float(row[1]) for row in list(csv.reader(file))[1:] if len(row) > 1 and row[1]}
    # luox uses 683 lm/W: its 100.0003 lx are 683.002/683
    lux = light.energy() * light.efficacy()
    assert lux == pytest.approx(luox["Illuminance (lx)"], rel=2e-5)
    assert light.xy() == pytest.approx(
        [luox["CIE 1931 xy chromaticity [x]"], luox["CIE 1931 xy chromaticity [y]"]], abs=2e-5
    )
    kelvin, duv = light.color_temperature
    assert kelvin == pytest.approx(luox["CCT (K) - Ohno, 2013"], rel=5e-4)
    assert duv == pytest.approx(luox["Duv"], abs=2e-5)
    # luox rounds each R to a whole number first
    assert light.color_rendering.ra == pytest.approx(luox["Colour Rendering Index [Ra]"], abs=0.6)


def test_measured_lamps_are_ten():
    if not SPECTRAN.is_dir():
        pytest.skip("the measured lamps are not here")
    assert len(lamps()) == 10


def test_a_file_is_read_and_its_faults_are_named(tmp_path):
    path = tmp_path / "lamp.csv"
    path.write_text("nm,W\n400,1\n500,3\n")
    light = lesk.spectrum(path)
    assert light.name == "lamp.csv"
    assert light.at([400, 450, 600]).tolist() == [1, 2, 0]
    assert light.energy() == pytest.approx(200)
    path.write_text("400,1\n390,2\n")
    with pytest.raises(lesk.ParameterError, match="line 2"):
        lesk.spectrum(path)
    path.write_bytes(b"\x00\x01\x02")
    with pytest.raises(lesk.ParameterError, match="not text"):
        lesk.spectrum(path)
    with pytest.raises(lesk.FileError, match="cannot read"):
        lesk.spectrum(tmp_path / "absent.csv")


def test_a_file_serves_a_conversion(tmp_path):
    path = tmp_path / "line.csv"
    # a triangle of 2 nm around 555 nm, where V is flat: 683 lm/W
    path.write_text("554,0\n555,1\n556,0\n")
    assert lesk.quantity("1 W").to("lm", spectrum=path).value == pytest.approx(683.002, rel=1e-4)


def test_the_command_says_what_a_light_is(capsys, tmp_path):
    picture = tmp_path / "lamp.png"
    assert main(["spectrum", "FL2", "--json", "-o", str(picture)]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["efficacy_lm_per_w"] == pytest.approx(336.73, abs=0.01)  # lights.md 3.1
    assert data["ra"] == pytest.approx(64, abs=0.75)  # CIE 15
    assert data["cct_k"] == pytest.approx(4230, abs=10)  # CIE 15
    assert picture.stat().st_size > 10_000
    assert main(["spectrum", "532 nm"]) == 0
    assert "CCT          none" in capsys.readouterr().out
    # what nobody sees has no colour, and no NaN
    assert main(["spectrum", "2000 nm", "--json"]) == 0
    unseen = json.loads(capsys.readouterr().out.replace("NaN", "broken"))
    assert unseen["xy"] == {} and unseen["rgb"] == {} and unseen["efficacy_lm_per_w"] == 0
    assert main(["spectrum", "FL2", "--range", "900:1000"]) == 2
    assert main(["spectrum"]) == 2
    assert main(["spectrum", "blue"]) == 2
    assert main(["spectrum", "--names"]) == 0


def test_reflectances_of_colors_have_their_colors():
    nm = np.arange(360.0, 831.0, 5.0)
    fitted = lesk.color.reflectance([0.8, 0.3, 0.1])
    values, error = fitted.at(nm), fitted.error
    assert error < 1e-6
    assert 0 < values.min() <= values.max() < 1
    with pytest.raises(lesk.ParameterError):
        lesk.color.reflectance([1.2, 0.0, 0.0])
