"""Every plot can be made and saved for every model, and shows what the model says."""

from __future__ import annotations

import numpy as np
import pytest

import lesk
from lesk import plot
from lesk._term import TERMS
from lesk.plot._slice import half_difference

NAMES = list(lesk.models.ALL)


@pytest.mark.parametrize("name", NAMES)
def test_every_model_has_a_polar_cut(name, tmp_path):
    path = tmp_path / "plot.svg"
    plot.polar(lesk.models.ALL[name]()).savefig(path)
    assert name in path.read_text(encoding="utf-8")


def test_a_plot_has_no_date(tmp_path):
    for name in ("a", "b"):
        plot.polar(lesk.models.lambert()).savefig(tmp_path / f"{name}.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_a_polar_cut_of_lambert_is_a_half_circle_of_rho_over_pi():
    axes = plot.polar(lesk.models.lambert(reflectance=0.5)).axes[0]
    (curve,) = (line for line in axes.lines if len(line.get_xdata()) > 100)
    inside = np.abs(curve.get_xdata()) < np.radians(89)
    assert curve.get_ydata()[inside] == pytest.approx(0.5 / np.pi)


def test_half_and_difference_angles_are_those_of_the_directions():
    theta_h, theta_d = np.radians([10, 40, 70]), np.radians([20, 30, 15])
    wi, wo = half_difference(theta_h, theta_d, np.radians(90))
    h = (wi + wo) / np.linalg.norm(wi + wo, axis=-1, keepdims=True)
    assert np.arccos(h[:, 2]) == pytest.approx(theta_h)
    assert np.arccos(np.sum(h * wi, axis=-1)) == pytest.approx(theta_d)


@pytest.mark.parametrize("draw", [plot.lobe3d, plot.slice, plot.albedo])
@pytest.mark.parametrize("name", ["ggx", "mirror", "rough_dielectric"])
def test_rough_smooth_and_transmitting_models_have_all_plots(draw, name, tmp_path):
    draw(lesk.models.ALL[name]()).savefig(tmp_path / "plot.png")
    assert lesk.image.read(tmp_path / "plot.png").std() > 0.01


@pytest.mark.parametrize("name", ["lambert", "conductor", "dielectric"])
def test_a_sphere_shows_light(name):
    figure = plot.sphere(lesk.models.ALL[name](), resolution=24, samples=4)
    picture = figure.axes[0].images[0].get_array()
    assert picture.shape == (24, 24, 3) and 0 <= picture.min() < picture.max() <= 1


@pytest.mark.parametrize("term", [f"{role}.{name}" for role, name in TERMS if not name.startswith("sample_")])
def test_every_term_has_a_curve(term, tmp_path):
    figure = plot.term(term)
    assert all(np.isfinite(line.get_ydata()).all() for line in figure.axes[0].lines)
    figure.savefig(tmp_path / "plot.png")


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: plot.polar([]), "no model to plot"),
        (lambda: plot.polar(lesk.models.ggx(alpha_x=[0.1, 0.2])), "a plot needs one value per parameter"),
        (lambda: plot.polar(lesk.models.ggx(), theta_i_deg=95), "`theta_i_deg` is 95"),
        (lambda: plot.polar(lesk.models.ggx(), plane="sideways"), "`plane` is `sideways`"),
        (lambda: plot.term("ndf.gxg"), "did you mean `ndf.ggx`?"),
        (lambda: plot.term("ndf.ggx", alhpa_x=1), "did you mean `alpha_x`?"),
    ],
)
def test_wrong_use_is_explained(make, text):
    with pytest.raises(lesk.ParameterError) as error:
        make()
    assert text in str(error.value)


def test_a_plot_shows_itself_in_a_notebook():
    assert plot.polar(lesk.models.lambert())._repr_png_().startswith(b"\x89PNG")
