"""The numbers in the figures, against closed forms and the lecture."""

from __future__ import annotations

import inspect
from fractions import Fraction

import numpy as np
import pytest

import lesk
from lesk import figures
from lesk.figures import _classic, _diagrams, _edges, _microfacets, _sheet, _surfaces, _tables, _traced
from lesk.plot._figure import direction

QUICK = {"resolution": 24, "samples": 1, "spp": 1, "size": 12, "frames": 2, "width": 60}


def quick(name):
    """Make a figure with few pixels."""
    make = figures.ALL[name].make
    return make(**{key: QUICK[key] for key in inspect.signature(make).parameters if key in QUICK})


@pytest.mark.parametrize("name", figures.ALL)
def test_every_figure_is_made_and_says_what_it_shows(name, tmp_path):
    path = tmp_path / "figure.png"
    quick(name).savefig(path)
    assert lesk.image.read(path).std() > 0.01
    maker = figures.ALL[name]
    assert len(maker.title) > 5 and len(maker.caption) > 100 and "Parameters" not in maker.caption
    assert getattr(figures, name) is maker.make


def shown(figure):
    """All words of a figure."""
    import matplotlib.text

    return " ".join(text.get_text() for text in figure.findobj(matplotlib.text.Text))


@pytest.mark.parametrize(("k_d", "k_s", "h"), [(0.5, 1.0, 50), (1.0, 0.5, 50), (0.5, 1.0, 1), (0.5, 1.0, 100)])
def test_a_ball_shows_the_classic_model(k_d, k_s, h):
    ball = _sheet.Ball(40)
    n, light = ball.normals, _sheet.LIGHT_ABOVE
    cos_alpha = n @ light
    # R.E with E = +z
    cos_beta = 2 * cos_alpha * n[:, 2] - light[2]
    expected = k_d * np.outer(np.maximum(cos_alpha, 0), _classic.COLOR)
    expected += np.where((cos_alpha > 0) & (cos_beta > 0), k_s * np.abs(cos_beta) ** h, 0)[:, np.newaxis]
    # the frame of a pixel is good to 1e-15, cos^100 to 100 times that; below cos 1e-6 the model scatters nothing
    assert ball.lit(_classic.classic(k_d, k_s, h)) == pytest.approx(expected, abs=1e-5)


def test_clipped_balls_are_those_of_the_formula():
    text = shown(figures.phong_table(resolution=60))
    # at the highlight cos(alpha) = cos of half the angle between light and viewer, C_D = 0.8 in blue
    cos_half = np.sqrt((1 + _sheet.LIGHT_ABOVE[2]) / 2)
    for k_d, k_s in ((0.5, 1.0), (1.0, 0.5), (1.0, 1.0)):
        assert k_d * 0.8 * cos_half + k_s > 1
        assert f"max {k_d * 0.8 * cos_half + k_s:.2f}, clipped" in text
    assert text.count("clipped ") == 3


def test_four_times_h_holds_in_the_plane_of_incidence_only():
    # the numbers of the lecture's errata
    assert _classic.highlights(60, [10], "incidence", 50)[0] == pytest.approx(0.4651, abs=5e-5)
    assert _classic.highlights(60, [10], "incidence", 200)[1] == pytest.approx(0.4665, abs=5e-5)
    assert _classic.highlights(60, [10], "across", 50)[0] == pytest.approx(0.4651, abs=5e-5)
    assert _classic.highlights(60, [10], "across", 200)[1] == pytest.approx(0.0482, abs=5e-5)
    text = shown(figures.phong_blinn(resolution=20))
    assert all(number in text for number in (".4651", ".4665", ".0482"))


def test_in_the_plane_the_angles_are_the_viewers_and_half_of_it():
    off = np.array([-20.0, 3.0, 15.0])
    phong, _ = _classic.highlights(50, off, "incidence", 50)
    _, blinn = _classic.highlights(50, off, "incidence", 200)
    assert phong == pytest.approx(np.cos(np.radians(off)) ** 50, rel=1e-12)
    assert blinn == pytest.approx(np.cos(np.radians(off / 2)) ** 200, rel=1e-12)


def test_schlick_is_worst_at_85_degrees_for_glass():
    theta = np.linspace(0, 90, 9001)
    exact, schlick = _microfacets.boundary(1.5, theta)
    c = np.cos(np.radians(theta))
    t = np.sqrt(1 - (1 - c * c) / 2.25)
    s_polarised, p_polarised = (c - 1.5 * t) / (c + 1.5 * t), (1.5 * c - t) / (1.5 * c + t)
    assert exact == pytest.approx((s_polarised**2 + p_polarised**2) / 2, abs=1e-12)
    error = np.abs(schlick - exact)
    # the lecture: .036 at 85 degrees
    assert error.max() == pytest.approx(0.036, abs=5e-4)
    assert theta[error.argmax()] == pytest.approx(85, abs=0.5)
    assert "+0.036 at 85°" in shown(figures.fresnel())


def test_facets_have_the_slopes_of_beckmanns_distribution():
    # a Gaussian of rms slope alpha over the plane has alpha/sqrt(2) along a line; 5 standard errors
    slope = _microfacets.slopes(0.3, 20000, seed=1)
    assert slope.std() == pytest.approx(0.3 / np.sqrt(2), rel=5 / np.sqrt(2 * 20000))


def test_the_three_factors_make_the_picture():
    ball, light = _sheet.Ball(30), direction(np.radians(60), 0.5)
    alpha = 0.3
    d, f, g = (ball.lit(_microfacets._Factor(name, alpha), light) for name in "DFG")
    # D(0) of Beckmann's distribution is 1/(pi alpha^2)
    product = np.pi * d / (np.pi * alpha**2) * f * g / (4 * ball.normals[:, 2:])
    whole = ball.lit(lesk.models.cook_torrance(f0=_microfacets.COPPER, alpha=alpha), light)
    up = ball.normals @ light > 1e-3
    assert whole[up] == pytest.approx(product[up], rel=1e-9, abs=1e-12)


def test_shadowing_of_a_groove_that_is_looked_at_from_the_light():
    # h = wi: G = min(1, 2 cos^2 theta)
    for theta, expected in ((30, 1.0), (60, 0.5), (75, 2 * np.cos(np.radians(75)) ** 2)):
        assert _microfacets.shadowing(theta, [-theta]) == pytest.approx(expected, rel=1e-12)


def test_a_flat_moon():
    theta = np.array([0.0, 30.0, 60.0, 80.0])
    cosine = np.cos(np.radians(theta))
    assert _surfaces.moon(0.0, theta) == pytest.approx(0.7 * cosine, rel=1e-12)
    sigma2 = 0.3**2
    a, b = 1 - 0.5 * sigma2 / (sigma2 + 0.33), 0.45 * sigma2 / (sigma2 + 0.09)
    sine = np.sin(np.radians(theta))
    # alpha = beta = theta: sin tan cos = sin^2
    assert _surfaces.moon(0.3, theta) == pytest.approx(0.7 * (a * cosine + b * sine**2), rel=1e-12)


def test_shallow_grooves_are_lambertian_and_deep_ones_what_the_model_was_fitted_to():
    theta = np.array([0.0, 20.0, 45.0, 65.0])
    assert _surfaces.grooves(0.02, theta) == pytest.approx(0.7 * np.cos(np.radians(theta)), abs=2e-3)
    sigma = np.radians(40)
    # looked at along the normal nothing is masked, and the facets' mean cosine is left
    t = np.linspace(0, np.pi / 2, 200001)
    weight = np.exp(-0.5 * (t / sigma) ** 2) * np.sin(t)
    assert _surfaces.grooves(sigma, [0.0])[0] == pytest.approx(
        0.7 * np.sum(weight * np.cos(t)) / np.sum(weight), rel=1e-6
    )
    # the qualitative model drops a term of a few percent (oren1994)
    assert _surfaces.grooves(sigma, theta) == pytest.approx(_surfaces.moon(sigma, theta), rel=0.07)


def test_satin_is_narrow_along_its_threads():
    threads = lesk.models.ward(diffuse=0, specular=1, alpha_x=0.1, alpha_y=0.4)
    light = np.array([0.0, 0.0, 1.0])
    tilt = np.radians(15)
    along = np.array([[np.sin(tilt), 0.0, np.cos(tilt)]])
    across = np.array([[0.0, np.sin(tilt), np.cos(tilt)]])
    x = np.array([[1.0, 0.0, 0.0]])
    both = [_sheet.lit(threads, n, light, x)[0, 0] for n in (along, across)]
    # viewer and light along +z: tan(theta_h) = tan(tilt), cos = cos(tilt)
    expected = [np.exp(-((np.tan(tilt) / a) ** 2)) / (4 * 0.1 * 0.4) for a in (0.1, 0.4)]
    assert both == pytest.approx(expected, rel=1e-9)


def test_retro_reflection_goes_back_to_the_light():
    wi = direction(np.radians(-45))
    theta = np.radians(np.linspace(-80, 80, 161))
    f = _surfaces.Retro().eval(wi, direction(theta))[:, 0]
    assert np.degrees(theta[f.argmax()]) == pytest.approx(-45)


def test_metalness_in_unity_and_gltf():
    # the lecture's numbers
    at = _tables.metalness(0.5, 0.3)
    assert float(at.diffuse_unity) == pytest.approx(0.336, rel=1e-12)
    assert float(at.diffuse_gltf) == pytest.approx(0.35, rel=1e-12)
    assert float(at.f0) == pytest.approx(0.7 * 0.04 + 0.3 * 0.5, rel=1e-12)
    text = shown(figures.metallic_dial())
    assert "0.336" in text and "0.350" in text


def test_gltf_in_the_figure_is_the_model():
    wi, wo = direction(0.4), direction(0.9, 2.0)
    model = lesk.models.metallic_roughness(base_color=0.5, metallic=0.3, roughness=0.6)
    at = _tables.metalness(0.5, 0.3)
    cos_d = np.sqrt((1 + wi @ wo) / 2)
    f = lesk.terms.fresnel.schlick(float(at.f0), cos_d)[0]
    alpha = 0.36
    d = lesk.terms.ndf.ggx(wi + wo, alpha, alpha)
    v = lesk.terms.masking.smith_ggx_visibility(wi, wo, alpha, alpha)
    assert model.eval(wi, wo)[0] == pytest.approx((1 - f) * float(at.diffuse_gltf) / np.pi + f * d * v, rel=1e-9)


def test_the_timeline_has_the_years_of_the_registry():
    known = {info["id"]: info["year"] for info in lesk._registry.MODELS}
    wrong = [(name, year) for name, _, year, model in _tables.TIMELINE if model and known[model] != year]
    assert wrong == []
    assert len(_tables.TIMELINE) == 21


def test_bilinear_interpolation_of_one_quad_by_hand():
    # A 0.9, B 0.5, C 0.1, D 0.7; the scan line y = 2.6 cuts AC (4.2 to 0.8) and BD (5.2 to 0.3), X at 0.6 of the span
    alpha, beta, gamma = Fraction(16, 34), Fraction(26, 49), Fraction(6, 10)
    left = (1 - alpha) * Fraction(9, 10) + alpha * Fraction(1, 10)
    right = (1 - beta) * Fraction(5, 10) + beta * Fraction(7, 10)
    expected = float((1 - gamma) * left + gamma * right)
    assert _diagrams.interpolated([0.9, 0.5, 0.1, 0.7], float(alpha), float(beta), 0.6) == pytest.approx(expected)
    assert f"$f_X$ = {expected:.4f}" in shown(figures.bilinear())


def test_a_crease_is_the_angle_between_faces():
    roof = np.array([(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 0.0)])
    assert _edges.folds_of(roof) == pytest.approx([90, 45])
    text = shown(figures.crease_angle(limit_deg=40))
    assert "auxiliary: up to 40°" in text


def test_vertex_normals_are_means_of_faces():
    normals = [_diagrams._face_normal(face) for face in _diagrams.tent(0.45)]
    # symmetric in x and y: the mean points up
    mean = np.mean(normals, axis=0)
    assert mean[:2] == pytest.approx([0, 0], abs=1e-12) and mean[2] > 0.8
    assert all(np.linalg.norm(n) == pytest.approx(1) and n[2] > 0 for n in normals)


def test_the_kinds_of_light_paths_add_up():
    text = (_traced.files("lesk") / "data" / "light_paths.toml").read_text(encoding="utf-8")
    picture = lesk.render(lesk.scene.parse(text.replace("[216, 180]", "[24, 20]")), spp=8, split=_traced.SPLITS)
    layers = picture.layers
    total = sum(layers[f"{name}.G"].astype(float) for name in _traced.SPLITS)
    # float32 sums of four layers
    assert total == pytest.approx(picture.rgb[..., 1].astype(float), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: figures.bilinear(y=9), "`y` is 9, but 0.8 to 4.2"),
        (lambda: figures.crease_angle(limit_deg=-1), "`limit_deg` is -1"),
        (lambda: figures.auxiliary_edges(sides=2), "`sides` is 2"),
    ],
)
def test_wrong_use_is_explained(make, text):
    with pytest.raises(lesk.ParameterError) as error:
        make()
    assert text in str(error.value)


def test_the_exercises_have_the_numbers_of_the_lecture():
    from lesk.figures import _exercises

    assert float(_exercises.irradiance(3.86e26, 1.5e11)) == pytest.approx(1365, abs=0.5)
    assert 0.4 * float(_exercises.irradiance(3.86e26, 1.5e11)) == pytest.approx(546, abs=0.5)
    assert float(_exercises.irradiance(1100, 1.5)) == pytest.approx(38.9, abs=0.05)
    # shares of a black body of 5778 K, as the lecture's notes state them
    assert _exercises.band_share(5778, 380, 780) == pytest.approx(0.465, abs=5e-4)
    assert _exercises.band_share(5778, 400, 700) == pytest.approx(0.367, abs=5e-4)
    assert _exercises.band_share(5778, 10, 20_000) == pytest.approx(1, abs=1e-3)
    text = shown(figures.sun()) + shown(figures.led_bulb())
    assert "1365 W/m², 40 % of it 546 W/m²" in text and "38.9 lx at 1.5 m" in text


def test_the_series_of_a_band_is_the_integral_of_plancks_law():
    from lesk.figures import _exercises

    nm = np.linspace(400, 700, 20001)
    power = np.pi * np.trapezoid(_exercises.spectral_radiance(5778, nm), nm)
    # Stefan and Boltzmann, CODATA 2018
    assert power / (5.670374419e-8 * 5778**4) == pytest.approx(_exercises.band_share(5778, 400, 700), rel=1e-6)


@pytest.mark.parametrize(("limit", "real"), [(0, 36), (75, 24), (180, 0)])
def test_the_figures_of_edges_shade_meshes_whose_edges_are_real_above_the_crease_angle(limit, real):
    light, up = np.array((-0.5, -0.75, 0.55)), np.array((0.0, 0.0, 1.0))
    # from straight above: the cap alone
    values, mesh = _edges.shaded(_edges.prism(12), limit, tuple(light), up, np.array((0, 1.0, 0)), up, 1.1, (40, 40))
    kinds = [lesk.mesh.KINDS[kind] for kind in mesh.kinds]
    assert (kinds.count("real"), kinds.count("auxiliary")) == (real, 36 - real)
    cap = values[12:28, 12:28]
    flat = 0.06 + 0.9 * 0.55 / np.linalg.norm(light)
    if limit < 90:
        assert cap == pytest.approx(flat, abs=1e-5)
    else:
        assert np.ptp(cap) > 0.3
