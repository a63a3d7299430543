"""The table of ideas, the errata, F0, and their commands."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import lesk
from lesk import f0, figures
from lesk._errata import ERRATA
from lesk._lecture import IDEAS
from lesk.cli import COMMANDS, main

ROOT = Path(__file__).parents[2]
COMMAND_LINES = sorted({c for idea in IDEAS for c in idea.commands} | {row.command for row in ERRATA if row.command})


def test_every_figure_belongs_to_an_idea_and_exists():
    assert {name for idea in IDEAS for name in idea.figures} == set(figures.ALL)


def test_every_idea_has_a_figure_a_command_or_says_what_is_open():
    assert [idea.slide for idea in IDEAS if not (idea.figures or idea.commands or idea.open)] == []
    assert len({idea.slide for idea in IDEAS}) == len(IDEAS)


@pytest.mark.parametrize("line", COMMAND_LINES)
def test_every_command_of_the_lecture_runs(line, capsys, tmp_path, monkeypatch):
    words = shlex.split(line)
    assert words[0] == "lesk" and words[1] in COMMANDS
    if words[2:] and words[2].startswith("examples/"):
        if not (ROOT / words[2]).is_file():
            pytest.skip("the examples are not here")
        words[2] = str(ROOT / words[2])
        words += ["--spp", "1", *(["--quiet"] if words[1] == "render" else ["--frames", "1", "--no-curve"])]
    monkeypatch.chdir(tmp_path)
    if words[1] == "figure":
        assert words[2] in figures.ALL  # each is made by another test
    else:
        assert main(words[1:]) == 0, capsys.readouterr().err


# the numbers that the lecture's table of errata gives, and closed forms where it gives none
PUBLISHED = {
    "ward": (1.00479, 0.63075, 5e-6),
    "blinn_half": (7.6e-7, 0.0739, 5e-5),
    "cos_phi": (0.0, 0.5, 1e-12),
    "bssrdf_area": (-4, -2, 0),
    "radiance": (50, 100, 1e-12),
    "point_light": (0.25, 1, 0),
    # (1 + (F90 - 1)(1 - cos)^5)^2 with F90 = 1/2
    "disney_diffuse": (1, (1 - 0.5 * (1 - np.cos(np.radians(75))) ** 5) ** 2, 1e-12),
    "beard_maxwell": (2002, 1973, 0),
    "blinn_year": (1994, 1977, 0),
    "k_m": (680, 683.002, 0),
    "four_times_h": (0.0482, 0.4651, 5e-5),
}


@pytest.mark.parametrize("row", ERRATA, ids=lambda row: row.id)
def test_errata_have_the_published_numbers(row):
    slide, paper, tolerance = PUBLISHED[row.id]
    assert row.slide() == pytest.approx(slide, abs=tolerance, rel=0)
    assert row.paper() == pytest.approx(paper, abs=tolerance, rel=0)


def test_blinns_slide_is_the_seventh_power_that_the_lecture_says():
    row = next(row for row in ERRATA if row.id == "blinn_half")
    assert row.slide() == pytest.approx(7.6e-7, rel=0.01)


def test_k_m_is_683_over_v_at_540_terahertz():
    table = ROOT / "data" / "cie" / "cie1931_2deg_1nm.csv"
    if not table.is_file():
        pytest.skip("data/ is not here")
    rows = [line.split(",") for line in table.read_text().splitlines() if re.match(r"\d", line)]
    wavelength, v = np.array([(float(r[0]), float(r[2])) for r in rows]).T
    # 540e12 Hz in vacuum is 555.171 nm, in standard air (n = 1.00028) 555.016 nm
    at = np.interp(299792458 / 540e12 * 1e9 / 1.00028, wavelength, v)
    assert 683 / at == pytest.approx(683.002, abs=1e-3)


def test_texture_values_of_f0_are_srgb_codes_of_the_linear_ones():
    def code(linear):
        linear = np.asarray(linear)
        return 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)

    assert sum(s.metal for s in f0.substances()) == 13 and sum(not s.metal for s in f0.substances()) == 12
    for s in f0.substances():
        assert code(s.low) == pytest.approx(s.texture_low, abs=1), s.name
        assert code(s.high) == pytest.approx(s.texture_high, abs=1), s.name


def test_the_table_of_f0_is_the_one_of_data():
    source = ROOT / "data" / "f0" / "f0.csv"
    if not source.is_file():
        pytest.skip("data/ is not here")
    packaged = Path(lesk.__file__).parent / "data" / "f0.csv"
    assert packaged.read_bytes() == source.read_bytes()


def test_an_unknown_substance_is_explained():
    with pytest.raises(lesk.ParameterError, match="did you mean `gold`"):
        f0.find("golf")


def test_lecture_lists_every_idea(capsys):
    assert main(["lecture"]) == 0
    text = capsys.readouterr().out
    assert all(idea.slide in text for idea in IDEAS) and "open: " in text
    assert main(["lecture", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["version"] == 1 and len(data["ideas"]) == len(IDEAS)
    assert data["ideas"][0].keys() == {"slide", "says", "figures", "commands", "open"}


def test_errata_are_told_with_both_numbers(capsys):
    assert main(["lecture", "errata", "ward"]) == 0
    slide, paper = re.findall(r"(?:slide|paper) ([\d.]+) 1/sr", capsys.readouterr().out)
    assert (float(slide), float(paper)) == pytest.approx((1.00479, 0.63075), abs=5e-6)
    assert main(["lecture", "errata", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["errata"]
    assert [row["id"] for row in rows] == [row.id for row in ERRATA]
    assert all(row["command"].startswith("lesk ") for row in rows)


def test_figures_are_listed_and_written(capsys, tmp_path):
    assert main(["figure"]) == 0
    listed = capsys.readouterr().out
    assert all(name in listed for name in figures.ALL)
    assert main(["figure", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["version"] == 1 and [f["id"] for f in data["figures"]] == list(figures.ALL)
    path = tmp_path / "fresnel.svg"
    assert main(["figure", "fresnel", "-o", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out).keys() == {"version", "output", "id", "title", "caption", "animated"}
    assert "<svg" in path.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["figure", "shinines"], "did you mean `shininess`?"),
        (["figure", "fresnel", "-o", "a.bmp"], "`a.bmp` ends in `.bmp`"),
        (["figure", "-o", "a.png"], "without a figure"),
        (["figure", "timeline", "-o", "no/folder/a.png"], "cannot write `no/folder/a.png`"),
        (["lecture", "erata"], "did you mean `errata`?"),
        (["lecture", "errata", "wrd"], "did you mean `ward`?"),
        (["lecture", "ideas", "ward"], "listed as a whole"),
    ],
)
def test_wrong_use_exits_2_and_explains(words, text, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: ") and text in said.err and said.out == ""
