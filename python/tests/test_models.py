"""Models over arrays: values, shapes, types, errors. Point values: double precision, computed from the papers' equations
independently of this program, at geometry A (wi 30, 0; wo 50, 140 degrees) and B (wi 60, 20; wo 70, 215 degrees)."""

from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import lesk

EPSILON = float(np.finfo(np.float32).eps)
NAMES = list(lesk.models.ALL)


def direction(theta_deg, phi_deg=0.0):
    theta, phi = np.radians(theta_deg), np.radians(phi_deg)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi], axis=-1)


A = direction(30, 0), direction(50, 140)
B = direction(60, 20), direction(70, 215)

POINTS = [
    (lesk.models.lambert(reflectance=0.5), 0.15915494, 0.15915494),
    (lesk.models.modified_phong(diffuse=0, specular=1, shininess=20), 0.13597647, 1.4561024),
    (lesk.models.phong(diffuse=0, specular=1, shininess=20), 0.044842551, 0.83172376),
    (lesk.models.blinn_phong(diffuse=0, specular=1, shininess=20), 0.39301113, 0.48878321),
    (lesk.models.ward(diffuse=0, specular=1, alpha_x=0.2, alpha_y=0.4), 0.63074811, 1.3360121),
    (lesk.models.oren_nayar(reflectance=0.8, sigma=np.radians(30)), 0.19687044, 0.19687044),
    (lesk.models.ggx(f0=1, alpha_x=0.2, alpha_y=0.4), 0.69615512, 2.3216433),
    (lesk.models.ggx_conductor(eta=0.2, k=3.9, alpha_x=0.3, alpha_y=0.3), 0.36349607, 1.2444544),
    (lesk.models.metallic_roughness(base_color=0.5, metallic=0.3, roughness=0.4), 0.13488836, 0.32399168),
]


def directions(n, seed=0):
    rng = np.random.default_rng(seed)
    z, phi = rng.uniform(0.05, 1, n), rng.uniform(0, 2 * np.pi, n)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)


@pytest.mark.parametrize(("model", "at_a", "at_b"), POINTS, ids=[m.id for m, _, _ in POINTS])
def test_values_are_those_of_the_papers_to_the_printed_digits(model, at_a, at_b):
    assert model.eval(*A) == pytest.approx([at_a] * 3, rel=1e-7)
    assert model.eval(*B) == pytest.approx([at_b] * 3, rel=1e-7)


def test_glass_at_normal_incidence_reflects_as_fresnel_says():
    lobes = lesk.models.dielectric(ior=1.5).delta([0.0, 0.0, 1.0])
    reflected = lobes.wi[:, 2] > 0
    assert lobes.weight[reflected] == pytest.approx(np.full((1, 3), 0.04), rel=1e-12)  # ((n - 1)/(n + 1))^2
    assert lobes.probability.sum() == pytest.approx(1, rel=1e-12)


def test_albedo_of_lambert_is_its_reflectance():
    assert lesk.models.lambert(reflectance=[0.1, 0.5, 0.9]).albedo(direction(40)) == pytest.approx([0.1, 0.5, 0.9])


def test_albedo_of_ggx_at_normal_incidence_is_one_minus_ln_2():
    # closed form at alpha = 1; 4096 points of a Sobol sequence: error of the order of 1/4096
    assert lesk.models.ggx(alpha_x=1, alpha_y=1).albedo([0.0, 0.0, 1.0]) == pytest.approx(1 - np.log(2), abs=1e-3)


@pytest.mark.parametrize("name", NAMES)
def test_leading_shapes_broadcast_parameters_too(name):
    model = lesk.models.ALL[name]
    wi, wo = directions(5), directions(4, 1)[:, np.newaxis]
    first = model.info["parameters"][0]
    low, high = first["slider"]
    values = np.linspace(low, high, 3)[:, np.newaxis, np.newaxis]
    full = values if first["kind"] == "scalar" else values[..., np.newaxis] * np.ones(3)
    f = model(**{first["name"]: full}).eval(wi, wo)
    assert f.shape == (3, 4, 5, 3)
    one = model(**{first["name"]: values[1, 0, 0]}).eval(wi[2], wo[3, 0])
    assert np.array_equal(f[1, 3, 2], one)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_results_have_the_type_and_shape_of_the_directions(name, dtype):
    model = lesk.models.ALL[name]()
    wi, wo = directions(7).astype(dtype), directions(7, 1).astype(dtype)
    drawn = model.sample(wo)
    results = [model.eval(wi, wo), model.pdf(wi, wo), model.gradient(wi, wo), model.albedo(wo, samples=8)]
    assert {a.dtype for a in [*results, drawn.wi, drawn.weight, drawn.pdf, *model.delta(wo)]} == {np.dtype(dtype)}
    assert [a.shape for a in results] == [(7, 3), (7,), (7, 3, len(model.entries)), (7, 3)]
    assert [a.shape for a in drawn] == [(7, 3), (7, 3), (7,), (7,)]
    assert drawn.delta.dtype == np.bool_


@pytest.mark.parametrize("view", [lambda a: a[::-1], lambda a: a[::2], lambda a: np.asfortranarray(a), lambda a: a[:0]])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_strides_do_not_matter(view, dtype):
    model = lesk.models.ggx(alpha_x=0.3, alpha_y=0.5)
    wi, wo = (view(directions(20_000, seed).astype(dtype)) for seed in (0, 1))
    expected = model.eval(np.ascontiguousarray(wi), np.ascontiguousarray(wo))
    # the same loop over other blocks: equal to the bit
    assert np.array_equal(model.eval(wi, wo), expected)


def test_lists_and_integers_are_directions():
    lambert = lesk.models.lambert(reflectance=1)
    assert lambert.eval([0, 0, 1], [0, 0, 1]) == pytest.approx([1 / np.pi] * 3, rel=1e-12)


def test_arrays_of_another_byte_order_or_alignment_are_read():
    model, w = lesk.models.ggx(), directions(3)
    packed = np.zeros(3, dtype=[("pad", "u1"), ("w", "f8", 3)])
    packed["w"] = w
    expected = model.eval(w, w)
    assert np.array_equal(model.eval(w.astype(">f8"), w), expected)
    assert np.array_equal(model.eval(packed["w"], w), expected)


def test_a_draw_depends_on_seed_and_index_only():
    model, wo = lesk.models.ggx(), direction(50)
    many = model.sample(np.broadcast_to(wo, (5000, 3)), seed=3)
    few = model.sample(np.broadcast_to(wo, (10, 3)), seed=3)
    other = model.sample(np.broadcast_to(wo, (10, 3)), seed=4)
    assert np.array_equal(many.wi[:10], few.wi)
    assert not np.array_equal(other.wi, few.wi)


@pytest.mark.parametrize("name", NAMES)
def test_the_weight_of_a_draw_is_f_cos_over_pdf(name):
    model = lesk.models.ALL[name]()
    wo = directions(500)
    drawn = model.sample(wo)
    rough = ~drawn.delta & (drawn.pdf > 0)
    wi, wo = drawn.wi[rough], wo[rough]
    expected = model.eval(wi, wo) * (np.abs(wi[:, 2]) / drawn.pdf[rough])[:, np.newaxis]
    assert drawn.weight[rough] == pytest.approx(expected, rel=1e-9)
    assert model.pdf(wi, wo) == pytest.approx(drawn.pdf[rough], rel=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_gradients_are_differences_of_values(name):
    model = lesk.models.ALL[name]
    middle = {p["name"]: np.mean(p["slider"]) for p in model.info["parameters"]}
    wi, wo = directions(50), directions(50, 1)
    gradient = model(**middle).gradient(wi, wo)
    at = 0
    for spec in model.info["parameters"]:
        # central differences: error h^2 f''', h = 1e-5 of the value
        h = 1e-5 * middle[spec["name"]]
        above, below = (model(**{**middle, spec["name"]: middle[spec["name"]] + s * h}).eval(wi, wo) for s in (1, -1))
        entries = gradient[..., at : at + spec["length"]].sum(axis=-1)
        scale = np.abs(above).max(axis=-1, keepdims=True) / middle[spec["name"]]
        assert np.all(np.abs((above - below) / (2 * h) - entries) <= 1e-5 * (scale + np.abs(entries)) + 1e-9)
        at += spec["length"]


@settings(max_examples=50, deadline=None)
@given(hnp.arrays(np.float64, (4, 3), elements=st.floats(allow_nan=True, allow_infinity=True)))
def test_any_vectors_give_finite_values_or_an_error_that_explains(vectors):
    model = lesk.models.ggx()
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            assert np.isfinite(model.eval(vectors, [0, 0, 1])).all()
    except lesk.ParameterError as error:
        assert "not of unit length" in str(error) and "hint:" in str(error)


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: lesk.models.ggx(alpha_x=1.7), "`alpha_x` is 1.7, but model `ggx` accepts 0.001 to 1"),
        (lambda: lesk.models.ggx(alpha_x=np.nan), "`alpha_x` is nan, but model `ggx` accepts 0.001 to 1"),
        (lambda: lesk.models.ggx(alhpa_x=1), "did you mean `alpha_x`?"),
        (lambda: lesk.models.create("gxg"), "did you mean `ggx`?"),
        (lambda: lesk.models.ggx(alpha_x="soft"), "`alpha_x` is 'soft', but numbers are accepted"),
        (lambda: lesk.models.lambert(reflectance=[0.1, 0.2]), "a colour of model `lambert` is one number"),
        (lambda: lesk.models.ggx().eval([0, 0, 2], [0, 0, 1]), "`wi` is not of unit length"),
        (lambda: lesk.models.ggx().pdf([0, 1], [0, 0, 1]), "`wi` has shape (2,), but (..., 3) is accepted"),
        (lambda: lesk.models.ggx().eval([[0, 0], [1]], [0, 0, 1]), "its rows differ in length"),
        (lambda: lesk.models.ggx().eval(directions(2), directions(3)), "`wi` (2,), `wo` (3,)"),
        (lambda: lesk.models.ggx().sample([0, 0, 1], [0, 0, 1.0]), "numbers from 0 to below 1"),
        (lambda: lesk.models.ggx().sample([0, 0, 1], seed=-1), "`seed` is -1"),
        (lambda: lesk.models.ggx().albedo([0, 0, 1], samples=0), "`samples` is 0"),
        (lambda: lesk.models.ggx().shader("cobol"), "`cobol` is not a shading language"),
        (lambda: lesk.models.ggx().shader("wgsl", math="loose"), "`math` is `loose`"),
    ],
)
def test_wrong_use_is_a_parameter_error_that_says_what_is_accepted(make, text):
    with pytest.raises(lesk.ParameterError) as error:
        make()
    assert text in str(error.value)
    assert isinstance(error.value, ValueError)


def test_vectors_that_are_not_finite_give_0_and_a_warning():
    with np.errstate(all="ignore"), pytest.warns(RuntimeWarning, match="1 of 2 vectors `wi` are not finite"):
        f = lesk.models.lambert(reflectance=1).eval([[0, 0, 1], [np.nan, 0, 1]], [0, 0, 1])
    assert f.tolist() == [[pytest.approx(1 / np.pi)] * 3, [0, 0, 0]]


def test_parameters_cannot_be_changed_in_place():
    width = np.array([0.1, 0.2])
    model = lesk.models.ggx(alpha_x=width)
    width[0] = 5
    assert model.params["alpha_x"].tolist() == [0.1, 0.2]
    with pytest.raises(ValueError, match="read-only"):
        model.params["alpha_x"][0] = 5
    assert model.replace(alpha_y=0.5).params["alpha_y"] == 0.5


def test_models_survive_pickling():
    model = lesk.models.ggx(alpha_x=0.1)
    assert repr(pickle.loads(pickle.dumps(model))) == repr(model) == "lesk.models.ggx(f0=1, alpha_x=0.1, alpha_y=0.2)"


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_shows_every_parameter_and_a_curve(name):
    text = lesk.models.ALL[name]()._repr_html_()
    assert all(f"<code>{p['name']}</code>" in text for p in lesk.models.ALL[name].info["parameters"])
    assert "<svg" in text and "nan" not in text


@pytest.mark.parametrize("name", NAMES)
def test_float32_agrees_with_float64_at_the_rounded_directions(name):
    model = lesk.models.ALL[name]()
    wi, wo = directions(2000).astype(np.float32), directions(2000, 1).astype(np.float32)
    exact = model.eval(wi.astype(np.float64), wo.astype(np.float64))
    # a few hundred roundings, each of half an epsilon, at the defaults, whose lobes are not narrow
    assert np.all(np.abs(model.eval(wi, wo) - exact) <= 500 * EPSILON * (np.abs(exact) + 1e-6))
