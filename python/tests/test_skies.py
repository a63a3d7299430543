"""`lesk.light.HosekSky`, `lesk sky` and the plot of skies."""

import json
from pathlib import Path

import numpy as np
import pytest

import lesk
from lesk.cli import main

# the authors' code: see crates/lesk-light/tests/hosek_sky.rs
SKY = lesk.light.HosekSky(2, elevation_deg=40, ground=0.2)


def test_numbers_are_those_of_the_authors_code() -> None:
    assert SKY.luminance(0, 0) == pytest.approx(2322.4, rel=5e-5)
    assert SKY.illuminance_lx == pytest.approx(14034.7, rel=6e-4)
    assert SKY.sun_illuminance_lx == pytest.approx(76792.7, rel=3e-6)
    assert SKY.spectral_radiance(30, 60, 450) == pytest.approx(8.791535026e-02, rel=1e-8)
    assert SKY.sun_spectral_irradiance(450) == pytest.approx(8.2343918e-01, rel=1e-6)


def test_the_sky_integrates_to_its_illuminance() -> None:
    # midpoint rule over zenith distance and azimuth; 1e-3: its steps in the aureole
    z, a = np.meshgrid((np.arange(180) + 0.5) / 2, np.arange(0, 360, 2) + 1)
    radians = np.radians(z)
    weights = np.cos(radians) * np.sin(radians) * np.radians(0.5) * np.radians(2)
    assert np.sum(SKY.luminance(z, a) * weights) == pytest.approx(SKY.illuminance_lx, rel=1e-3)


def test_shapes_broadcast_and_the_azimuth_is_that_of_the_sun() -> None:
    assert SKY.rgb(np.zeros((4, 1)), np.zeros(3)).shape == (4, 3, 3)
    assert isinstance(SKY.luminance(10, 20), float)
    east = lesk.light.HosekSky(2, elevation_deg=40, azimuth_deg=90, ground=[0.2, 0.2, 0.2])
    assert east.luminance(30, 150) == pytest.approx(SKY.luminance(30, 60), rel=1e-12)


def test_wrong_states_and_directions_are_refused() -> None:
    with pytest.raises(lesk.errors.LightError, match="turbidity is 11, 1 to 10 is accepted"):
        lesk.light.HosekSky(11, elevation_deg=40)
    with pytest.raises(lesk.errors.LightError, match="elevation -1 deg"):
        lesk.light.HosekSky(2, elevation_deg=-1)
    with pytest.raises(lesk.errors.ParameterError, match="one or three"):
        lesk.light.HosekSky(2, elevation_deg=1, ground=[0.1, 0.2])
    for bad in (91, -1, float("nan")):
        with pytest.raises(lesk.errors.ParameterError, match="0 to 90 degrees"):
            SKY.luminance(bad, 0)


def test_the_command_says_what_sky_and_sun_give(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    picture = tmp_path / "sky.png"
    assert main(["sky", "--turbidity", "2", "--elevation", "20,40", "-o", str(picture), "--json"]) == 0
    first, second = json.loads(capsys.readouterr().out)["skies"]
    assert first["illuminance_lx"] == pytest.approx(11218.3, rel=6e-4)
    both = second["illuminance_lx"] + second["sun_illuminance_lx"] * np.sin(np.radians(40))
    assert second["global_illuminance_lx"] == pytest.approx(both)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main(["sky", "--turbidity", "2", "--elevation", "20,40"]) == 0
    assert "zenith" in capsys.readouterr().out
    assert main(["sky", "--turbidity", "0"]) == 2
    assert main(["sky", "-o", "sky.txt"]) == 2
