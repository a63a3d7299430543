"""What the figures of the rasteriser show, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

import lesk
from lesk import figures
from lesk.figures import _animation, _diagrams, _shading

CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
VALUES = np.cos(np.radians(_shading.QUAD_TILTS))


def scan_line(angle_deg):
    """Bilinear interpolation at the probe, from the definition: along the edges, then along the span."""
    turn = np.radians(angle_deg)
    spin = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    corners, (px, py) = CORNERS @ spin.T, spin @ _shading._PROBE
    crossings = []
    for i in range(4):
        (x0, y0), (x1, y1) = corners[i], corners[(i + 1) % 4]
        if (y0 - py) * (y1 - py) < 0:
            t = (py - y0) / (y1 - y0)
            crossings.append((x0 + t * (x1 - x0), VALUES[i] + t * (VALUES[(i + 1) % 4] - VALUES[i])))
    (left, low), (right, high) = sorted(crossings)
    return low + (px - left) / (right - left) * (high - low)


@pytest.fixture(scope="module")
def quad():
    """The turning square."""
    with _shading.Quad() as square:
        yield square


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0, 100.0, 170.0])
def test_bilinear_spans_change_as_the_square_turns(quad, angle):
    # float32 positions of a pixel at a distance of 40: 40 * 6e-8 / 0.007 of a pixel
    assert quad.probe(angle, "bilinear") == pytest.approx(scan_line(angle), abs=1e-3)


def test_at_angle_zero_it_is_the_lectures_formula(quad):
    d, c, b, a = VALUES[[1, 0, 2, 3]]
    x, y = _shading._PROBE
    expected = _diagrams.interpolated([a, b, c, d], (1 - y) / 2, (1 - y) / 2, (1 + x) / 2)
    assert quad.probe(0.0, "bilinear") == pytest.approx(expected, abs=1e-3)


def test_barycentric_interpolation_does_not_turn(quad):
    angles = np.arange(0.0, 180.0, 15.0)
    fixed = np.array([quad.probe(a, "barycentric") for a in angles])
    turning = np.array([quad.probe(a, "bilinear") for a in angles])
    assert np.ptp(fixed) < 1e-3 and np.ptp(turning) > 0.05
    # the triangle of the corners 0, 1, 2, in which x > y
    x, y = _shading._PROBE
    weights = np.array([(1 - x) / 2, (x - y) / 2, (1 + y) / 2])
    assert fixed[0] == pytest.approx(weights @ VALUES[:3], abs=1e-3)


def test_gouraud_misses_the_highlight_and_phong_finds_it():
    between, at = _shading.extremes(12)
    peaks = {
        (mode, light): float(_shading.ball(mode, _shading._light(light), size=120, tessellation=12).rgb.max())
        for mode in ("gouraud", "phong")
        for light in (between, at)
    }
    for light in (between, at):
        # in blue, C_D = 1: k_A + k_D cos(half the angle between light and viewer) + k_S
        half = np.arccos(-_shading._light(light)[1]) / 2
        expected = 0.05 + 0.45 * np.cos(half) + 0.5
        # the nearest pixel centre lies within 1 degree of the peak: 1 - cos^50(1 deg) = 0.8 % of k_S
        assert peaks["phong", light] == pytest.approx(expected, rel=0.02)
    assert peaks["gouraud", between] < 0.8 * peaks["phong", between]
    assert peaks["gouraud", at] > peaks["gouraud", between] + 0.1


def test_flat_sides_are_constant_and_gouraud_is_linear_between_edges():
    flat, gouraud = (_shading.pipe(mode, 8, 301)[1] for mode in ("flat", "gouraud"))
    lit = flat[flat > 1e-3]
    assert len(np.unique(lit.round(4))) <= 8
    kinks = np.abs(np.diff(gouraud, 2)) > 1e-3
    # eight edges, of which half show; a kink takes up to three second differences
    assert 0 < kinks.sum() <= 3 * 8


def test_inhibition_overshoots_at_a_step_and_leaves_even_light_alone():
    assert _shading.inhibited(np.full(200, 0.4)) == pytest.approx(np.full(200, 0.4), abs=1e-12)
    step = np.repeat([0.2, 0.8], 100)
    seen = _shading.inhibited(step)
    assert seen.max() > 0.85 and seen.min() < 0.15


def test_phong_evaluates_more_than_gouraud_and_flat_least():
    import matplotlib.text

    words = [t.get_text() for t in figures.shading_modes(size=60).findobj(matplotlib.text.Text)]
    counts = [int(w.split(" evaluations")[0].replace(",", "")) for w in words if " evaluations" in w]
    assert len(counts) == 3 and counts[2] > counts[1] > 0 and counts[2] > counts[0] > 0


FRAMES = [np.full((12, 20, 3), level, np.uint8) for level in (0, 100, 255)]


@pytest.mark.parametrize("ending", ["png", "apng", "gif"])
def test_an_animation_keeps_its_frames_and_its_white(ending, tmp_path):
    path = tmp_path / f"moves.{ending}"
    _animation.Animation(FRAMES, seconds=0.2).savefig(path)
    with Image.open(path) as picture:
        assert picture.n_frames == 3
        picture.seek(2)
        assert picture.info["duration"] == 200 and picture.convert("RGB").getpixel((5, 5)) == (255, 255, 255)


def test_an_animation_shows_itself_in_a_notebook():
    assert _animation.Animation(FRAMES)._repr_png_().startswith(b"\x89PNG")


def test_wrong_endings_and_no_frames_are_explained(tmp_path):
    with pytest.raises(lesk.ParameterError, match=r"ends in `\.svg`, but an animation accepts \.png, \.apng, \.gif"):
        _animation.Animation(FRAMES).savefig(tmp_path / "a.svg")
    with pytest.raises(lesk.ParameterError, match="no frame"):
        _animation.Animation([])
    with pytest.raises(lesk.FileError, match="cannot write"):
        _animation.Animation(FRAMES).savefig(tmp_path / "no" / "a.gif")
