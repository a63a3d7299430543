"""`lesk.light` and `lesk light`: flux of closed forms, conversion, comparison, refusal."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import lesk
from lesk.cli import main


def isotropic(candela: float = 100.0, ballast: str = "1") -> str:
    """An IES file whose intensity is the same everywhere: 4 pi times the candela."""
    return f"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0.3 1.2 0\n{ballast} 1 9\n0 180\n0\n{candela} {candela}\n"


def lambert(step: float = 1.0) -> str:
    """An IES file of 100 cd times the cosine: 100 pi lm."""
    theta = np.arange(0, 90 + step / 2, step)
    values = " ".join(f"{100 * math.cos(math.radians(t)):.9f}" for t in theta)
    angles = " ".join(f"{t:g}" for t in theta)
    return f"IES:LM-63-2019\nTILT=NONE\n1 -1 1 {len(theta)} 1 1 2 0.6 0.6 0\n1 1.00001 9\n{angles}\n0\n{values}\n"


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "iso.ies").write_text(isotropic())
    (tmp_path / "lambert.ies").write_text(lambert())
    return tmp_path


LOUVRE = Path(__file__).parents[2] / "examples" / "scenes" / "louvre.ies"


def test_the_louvre_of_the_examples_is_its_formula():
    lamp = lesk.light.read(LOUVRE)
    # I = I0 cos^2 within the lower half: 4000 lm = 2 pi I0 / 3
    peak = 3 * 4000 / (2 * math.pi)
    angles = np.arange(0, 91, 5)
    assert lamp.candela(angles, 0) == pytest.approx(peak * np.cos(np.radians(angles)) ** 2, abs=0.0051)
    assert lamp.candela([95, 180], 0) == pytest.approx([0, 0], abs=1e-9)
    # linear between its rows: -h^2/12 of the mean curvature, 0.13 %, and no more
    assert lamp.flux_lm == pytest.approx(4000, rel=2e-3)
    assert lamp.declared_flux_lm == 4000


def test_the_web_states_the_largest_intensity_of_the_file(tmp_path: Path) -> None:
    # linear from 100 cd at nadir to a peak of 250 cd at 33 degrees, which no point of the drawn surface meets
    text = "IES:LM-63-2019\nTILT=NONE\n1 -1 1 3 1 1 2 0.6 0.6 0\n1 1.00001 9\n0 33 90\n0\n100 250 0\n"
    (tmp_path / "ring.ies").write_text(text)
    assert "250 cd" in lesk.plot.web(lesk.light.read(tmp_path / "ring.ies")).get_suptitle()


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, str, str]:
    status = main(["light", *map(str, words)])
    out, err = capsys.readouterr()
    return status, out, err


def test_fluxes_are_the_closed_forms(files: Path) -> None:
    lamp = lesk.light.read(files / "iso.ies")
    assert lamp.flux_lm == pytest.approx(400 * math.pi, rel=1e-12)
    # chords of one degree: h^2/12 = 2.5e-5
    assert lesk.light.read(files / "lambert.ies").flux_lm == pytest.approx(100 * math.pi, rel=3e-5)


def test_candela_broadcasts(files: Path) -> None:
    lamp = lesk.light.read(files / "lambert.ies")
    assert lamp.candela(60) == pytest.approx(50, rel=1e-6)
    values = lamp.candela([[0.0], [60.0], [120.0]], [0.0, 77.0])
    assert np.shape(values) == (3, 2)
    np.testing.assert_allclose(values, [[100, 100], [50, 50], [0, 0]], rtol=1e-6)
    with pytest.raises(lesk.ParameterError):
        lamp.candela(math.nan)


def test_beam_angle_of_a_cosine_is_120_degrees(files: Path) -> None:
    lamp = lesk.light.read(files / "lambert.ies")
    assert lamp.beam_angle_deg == pytest.approx((120, 120), abs=0.02)
    assert lamp.field_angle_deg[0] == pytest.approx(2 * math.degrees(math.acos(0.1)), abs=0.02)


def test_conversion_keeps_the_flux(files: Path, tmp_path: Path) -> None:
    lamp = lesk.light.read(files / "lambert.ies")
    for name in ("a.ldt", "a.ies"):
        lamp.write(tmp_path / name)
        again = lesk.light.read(tmp_path / name, strict=True)
        assert again.flux_lm == pytest.approx(lamp.flux_lm, rel=1e-7)
        assert again.opening["shape"] == "rectangle"
    assert lamp.resample(5, 15).flux_lm == pytest.approx(100 * math.pi, rel=7e-4)


def test_command_prints_json(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, files / "lambert.ies", "--json")
    data = json.loads(out)
    assert status == 0
    assert data["version"] == 1
    assert data["flux_lm"] == pytest.approx(100 * math.pi, rel=3e-5)
    assert (data["type"], data["symmetry"], data["declared_flux_lm"]) == ("C", "rotational", None)
    assert data["warnings"] == []
    assert np.shape(data["ugr"]["crosswise"]) == (19, 5)


def test_command_writes_pictures_data_and_files(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("p.png", "p.svg", "d.json", "c.ies", "c.ldt"):
        status, _, _ = run(capsys, files / "lambert.ies", "-o", files / name)
        assert status == 0
        assert (files / name).stat().st_size > 300
    assert run(capsys, files / "lambert.ies", "--kind", "web", "-o", files / "w.png")[0] == 0
    assert json.loads((files / "d.json").read_text())["version"] == 1


def test_command_compares_two_files(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, files / "iso.ies", files / "lambert.ies", "--json")
    assert status == 0
    assert json.loads(out)["difference"]["flux_ratio"] == pytest.approx(0.25, rel=3e-5)
    status, out, _ = run(capsys, files / "iso.ies", files / "iso.ies", "--json")
    assert json.loads(out)["difference"]["largest_of_peak"] == 0


def test_warnings_name_the_line_and_strict_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "zero.ies"
    file.write_text(isotropic(ballast="0"))
    status, out, err = run(capsys, file, "--json")
    assert status == 0
    assert json.loads(out)["warnings"][0]["line"] == 4
    assert "line 4" in err
    status, out, err = run(capsys, file, "--strict")
    assert (status, out) == (2, "")
    assert "line 4: `ballast factor`" in err


@pytest.mark.parametrize("content", ["", "hello\n", isotropic().replace("100.0", "nan"), isotropic()[:-12]])
def test_bad_files_end_with_one_message(content: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bad.ies"
    file.write_text(content)
    status, out, err = run(capsys, file, "--json")
    assert (status, out) == (2, "")
    assert err.startswith("error: ")


def test_absent_files_and_wrong_options_are_told(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words in (
        [files / "none.ies"],
        [files / "iso.ies", "-o", files / "x.pdf"],
        [files / "iso.ies", "--resample", "7"],
        [files / "iso.ies", "--resample", "a"],
        [files / "iso.ies", "--kind", "cube"],
        [files / "iso.ies", "--edition", "2000", "-o", files / "x.ies"],
    ):
        status, _, err = run(capsys, *words)
        assert status == 2
        assert err.startswith("error: ")
