//! Values at three pairs of directions against an independent double-precision evaluation of the published formulas
//! (plain code, written from the papers before this crate existed), and smooth models against closed forms.

mod common;

use common::{direction, model, reference, table};
use lesk_bsdf::terms::{diffuse, facet, fresnel, masking, ndf};
use lesk_math::{Color, Vec3};

type Pair = [[f64; 2]; 2];

/// The geometries: (theta, phi) in degrees of `wi` and of `wo`.
const A: Pair = [[30.0, 0.0], [50.0, 140.0]];
const B: Pair = [[60.0, 20.0], [70.0, 215.0]];
/// Reaches the minimum of the V-groove and cos(phi_i - phi_o) > 0.
const C: Pair = [[75.0, 0.0], [10.0, 30.0]];

fn directions([[theta_i, phi_i], [theta_o, phi_o]]: Pair) -> (Vec3<f64>, Vec3<f64>) {
    (direction(theta_i, phi_i), direction(theta_o, phi_o))
}

/// Half a unit of the last printed digit.
fn half_unit(printed: &str) -> f64 {
    let (digits, exponent) = printed.split_once('e').unwrap_or((printed, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, fraction)| fraction.len() as i32);
    let exponent: i32 = exponent.parse().expect("an exponent");
    0.5 * 10f64.powi(exponent - decimals)
}

#[track_caller]
fn assert_printed(row: &str, value: f64, printed: &str) {
    let expected: f64 = printed.parse().expect("a number");
    // the last decimal of a printed 5 may round either way
    let allowed = half_unit(printed) * (1.0 + 1e-6);
    assert!((value - expected).abs() <= allowed, "{row}: {value:.12} instead of {printed}");
}

/// One row of the table: a model, its parameters, and what f must be.
struct Row {
    name: &'static str,
    model: &'static str,
    params: &'static [(&'static str, f64)],
    values: &'static [(Pair, &'static str)],
    reciprocal: bool,
}

const fn row(
    name: &'static str,
    model: &'static str,
    params: &'static [(&'static str, f64)],
    values: &'static [(Pair, &'static str)],
) -> Row {
    Row { name, model, params, values, reciprocal: true }
}

const GLOSS: &[(&str, f64)] = &[("diffuse", 0.0), ("specular", 1.0), ("shininess", 20.0)];

const ROWS: &[Row] = &[
    row("Lambert rho=.5", "lambert", &[("reflectance", 0.5)], &[(A, "0.15915494"), (B, "0.15915494")]),
    row("Modified Phong (n+2)/2pi n=20 ks=1", "modified_phong", GLOSS, &[(A, "0.13597647"), (B, "1.4561024")]),
    Row {
        reciprocal: false,
        ..row("Phong 1975 as BRDF: cos^n/cos_i n=20", "phong", GLOSS, &[(A, "0.044842551"), (B, "0.83172376")])
    },
    row("Blinn-Phong plain BRDF (n+8)/8pi n=20", "blinn_phong", GLOSS, &[(A, "0.39301113"), (B, "0.48878321")]),
    row(
        "Ward ax=.2 ay=.4",
        "ward",
        &[("diffuse", 0.0), ("specular", 1.0), ("alpha_x", 0.2), ("alpha_y", 0.4)],
        &[(A, "0.63074811"), (B, "1.3360121")],
    ),
    row(
        "Oren-Nayar qualitative sigma=30deg rho=.8",
        "oren_nayar",
        &[("reflectance", 0.8), ("sigma", std::f64::consts::FRAC_PI_6)],
        &[(A, "0.19687044"), (B, "0.19687044"), (C, ".209595388")],
    ),
    row(
        "Cook-Torrance (a), m=.3, Schlick F0=.04",
        "cook_torrance",
        &[("f0", 0.04), ("alpha", 0.3)],
        &[(A, ".023300836"), (B, ".21948735"), (C, "2.5709625e-5")],
    ),
    row(
        "GGX aniso .2/.4 correlated F=1",
        "ggx",
        &[("f0", 1.0), ("alpha_x", 0.2), ("alpha_y", 0.4)],
        &[(A, "0.69615512"), (B, "2.3216433"), (C, ".0253780661")],
    ),
    row(
        "GGX alpha=.3 correlated, exact conductor eta=.2 k=3.9",
        "ggx_conductor",
        &[("eta", 0.2), ("k", 3.9), ("alpha_x", 0.3), ("alpha_y", 0.3)],
        &[(A, "0.36349607"), (B, "1.2444544")],
    ),
    row(
        "Disney 2012 (wdas variant), linear base .5 grey",
        "disney_2012",
        &[
            ("base_color", 0.5),
            ("metallic", 0.3),
            ("subsurface", 0.2),
            ("specular", 0.5),
            ("roughness", 0.4),
            ("specular_tint", 0.0),
            ("anisotropic", 0.3),
            ("sheen", 0.5),
            ("sheen_tint", 0.0),
            ("clearcoat", 0.5),
            ("clearcoat_gloss", 0.6),
        ],
        &[(A, "0.13501869"), (B, "0.28896212"), (C, ".122773139")],
    ),
    row(
        "glTF 2.0 metallic-roughness (single mix, height-correlated V)",
        "metallic_roughness",
        &[("base_color", 0.5), ("metallic", 0.3), ("roughness", 0.4)],
        &[(A, "0.13488836"), (B, "0.32399168"), (C, ".097731756")],
    ),
];

#[test]
fn models_give_the_tabulated_values_at_a_b_and_c() {
    for row in ROWS {
        let model = model(row.model);
        let (f, params) = (reference(model).eval, table(model, row.params));
        for &(pair, printed) in row.values {
            let (wi, wo) = directions(pair);
            let value = f(&params, wi, wo);
            assert_printed(row.name, value.0[0], printed);
            let swapped = f(&params, wo, wi).0[0];
            let symmetric = (swapped - value.0[0]).abs() <= 1e-12 * swapped.abs();
            assert_eq!(symmetric, row.reciprocal, "{}: {swapped} swapped, {:?}", row.name, value);
        }
    }
}

#[test]
fn rough_dielectric_gives_the_tabulated_values_in_both_directions() {
    let model = model("rough_dielectric");
    let params = table(model, &[("ior", 1.5), ("alpha_x", 0.3), ("alpha_y", 0.3)]);
    let f = |wi, wo| (reference(model).eval)(&params, wi, wo).0[0];
    let (wi, wo) = (direction(30.0, 0.0), direction(160.0, 200.0));
    assert_printed("wi(30,0) wo(160,200)", f(wi, wo), "5.46522746");
    assert_printed("arguments swapped", f(wo, wi), "2.42898998");
    // eta^2, 4 rounding errors of each value
    assert!((f(wi, wo) / f(wo, wi) - 2.25).abs() < 2.25 * 16.0 * f64::EPSILON);
    // the facet: -(wi + 1.5 wo), upward
    let h = -(wi + wo * 1.5).normalize();
    assert_printed("its Fresnel term", fresnel::dielectric(1.5, wi.dot(h).abs()), ".0435259604");
}

/// Rows about terms, or about compositions of terms that are no model of their own.
#[test]
fn terms_give_the_tabulated_values_at_a_b_and_c() {
    let rows: &[(&str, fn(Vec3<f64>, Vec3<f64>) -> f64, &[(Pair, &str)])] = &[
        (
            "Cook-Torrance (a): normalised Beckmann m=.3, V-groove, 1/4, F=diel 1.5",
            |wi, wo| glass_cook_torrance(wi, wo, 0.3),
            &[(A, "0.025494289"), (B, "0.26495441"), (C, "2.71785248e-5")],
        ),
        (
            "Cook-Torrance (a), m=.5, F=diel 1.5",
            |wi, wo| glass_cook_torrance(wi, wo, 0.5),
            &[(A, ".020039862"), (B, ".17566513"), (C, ".0031183741")],
        ),
        ("V-groove G", |wi, wo| masking::v_groove(wi, wo, wi + wo), &[(C, "0.45977231")]),
        (
            "GGX aniso .2/.4 separable F=1",
            |wi, wo| ndf::ggx(wi + wo, 0.2, 0.4) * masking::smith_ggx_visibility_separable(wi, wo, 0.2, 0.4),
            &[(A, "0.69608612"), (B, "2.3114495")],
        ),
        (
            "Burley diffuse r=.5 rho=.8",
            |wi, wo| 0.8 * diffuse::burley(wi.z, wo.z, facet::half(wi, wo).1, 0.5),
            &[(A, "0.25484431"), (B, "0.24263544"), (C, ".266043856")],
        ),
        (
            "Disney HK subsurface r=.5 rho=.8",
            |wi, wo| 0.8 * diffuse::burley_subsurface(wi.z, wo.z, facet::half(wi, wo).1, 0.5),
            &[(A, "0.21075939"), (B, "0.34814266"), (C, ".241880236")],
        ),
        ("GTR1 a=.1 D only", |wi, wo| ndf::gtr1(wi + wo, 0.1), &[(A, "0.63383016"), (B, "0.77501557")]),
        (
            "glTF with separable Smith (spec text)",
            |wi, wo| {
                let (h, cos_d) = facet::half(wi, wo);
                let f0 = 0.7 * 0.04 + 0.3 * 0.5;
                let f = fresnel::schlick(Color::splat(f0), cos_d).0[0];
                let dv = ndf::ggx(h, 0.16, 0.16) * masking::smith_ggx_visibility_separable(wi, wo, 0.16, 0.16);
                (1.0 - f) * 0.5 * 0.7 / std::f64::consts::PI + f * dv
            },
            &[(A, "0.13488754"), (B, "0.32379777"), (C, ".0977316627")],
        ),
    ];
    for &(name, f, values) in rows {
        for &(pair, printed) in values {
            let (wi, wo) = directions(pair);
            assert_printed(name, f(wi, wo), printed);
        }
    }
}

fn glass_cook_torrance(wi: Vec3<f64>, wo: Vec3<f64>, alpha: f64) -> f64 {
    let (h, cos_d) = facet::half(wi, wo);
    let f = fresnel::dielectric(1.5, cos_d);
    f * ndf::beckmann(h, alpha, alpha) * masking::v_groove(wi, wo, h) / (4.0 * wi.z * wo.z)
}

#[test]
fn conductor_term_gives_the_tabulated_value_at_45_degrees() {
    assert_printed(".2 + 3.9i", fresnel::conductor(0.2, 3.9, std::f64::consts::FRAC_1_SQRT_2), ".9500431802");
}

/// At 45 degrees the p-polarised reflectance is the square of the s-polarised one, which for eta = 1.5 gives
/// 0.0502399110122... (40-digit evaluation of Fresnel's equations).
#[test]
fn dielectric_term_gives_the_closed_form_at_45_degrees() {
    assert_printed("eta = 1.5", fresnel::dielectric(1.5, std::f64::consts::FRAC_1_SQRT_2), "0.0502399110122");
}

/// The delta lobes at `wo`.
fn lobes(id: &str, values: &[(&str, f64)], wo: Vec3<f64>) -> [lesk_bsdf::bsdf::Delta<f64>; 2] {
    let model = model(id);
    (reference(model).delta)(&table(model, values), wo).expect("a smooth model has delta lobes")
}

fn assert_close(a: f64, b: f64) {
    assert!((a - b).abs() <= 16.0 * f64::EPSILON * b.abs().max(1.0), "{a} instead of {b}");
}

#[test]
fn mirror_reflects_its_reflectance_into_the_mirror_direction() {
    let wo = direction(40.0, 70.0);
    let [lobe, none] = lobes("mirror", &[("reflectance", 0.7)], wo);
    assert_eq!(lobe.wi.to_array(), [-wo.x, -wo.y, wo.z]);
    assert_eq!((lobe.weight, lobe.probability), (Color::splat(0.7), 1.0));
    assert_eq!((none.weight, none.probability), (Color::BLACK, 0.0));
}

#[test]
fn conductor_at_normal_incidence_is_the_closed_form() {
    for (eta, k) in [(0.01, 0.0), (0.2, 3.9), (1.38, 1.92), (10.0, 20.0)] {
        let [lobe, _] = lobes("conductor", &[("eta", eta), ("k", k)], Vec3::Z);
        // born1999: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2)
        let closed = ((eta - 1.0f64).powi(2) + k * k) / ((eta + 1.0f64).powi(2) + k * k);
        assert_close(lobe.weight.0[0], closed);
    }
}

#[test]
fn dielectric_at_normal_incidence_is_the_closed_form() {
    for ior in [0.25f64, 0.75, 1.0, 1.5, 4.0] {
        for (wo, eta) in [(Vec3::Z, ior), (-Vec3::Z, 1.0 / ior)] {
            let [mirrored, refracted] = lobes("dielectric", &[("ior", ior)], wo);
            let closed = ((eta - 1.0) / (eta + 1.0)).powi(2);
            assert_close(mirrored.weight.0[0], closed);
            assert_close(refracted.weight.0[0], (1.0 - closed) / (eta * eta));
            assert_close(refracted.wi.z, -wo.z);
        }
    }
}

/// At the angle whose tangent is eta, p-polarised light is not reflected: F is half of the s-polarised part, which is
/// ((eta^2 - 1)/(eta^2 + 1))^2.
#[test]
fn dielectric_at_brewsters_angle_is_the_closed_form() {
    for ior in [0.5f64, 1.33, 1.5, 2.4] {
        let wo = Vec3::from_spherical(ior.atan(), 0.3);
        let [mirrored, _] = lobes("dielectric", &[("ior", ior)], wo);
        let s = (ior * ior - 1.0) / (ior * ior + 1.0);
        assert_close(mirrored.weight.0[0], 0.5 * s * s);
    }
}

#[test]
fn dielectric_refracts_by_snells_law_and_keeps_power() {
    for wo in [direction(35.0, 10.0), direction(80.0, 200.0), direction(160.0, 330.0)] {
        let [mirrored, refracted] = lobes("dielectric", &[("ior", 1.5)], wo);
        let eta = if wo.z > 0.0 { 1.5 } else { 1.0 / 1.5 };
        assert_close(refracted.wi.length(), 1.0);
        assert_close(eta * refracted.wi.x, -wo.x);
        assert_close(eta * refracted.wi.y, -wo.y);
        assert!(refracted.wi.z * wo.z < 0.0);
        assert_close(mirrored.probability + refracted.probability, 1.0);
        assert_close(mirrored.weight.0[0] + refracted.weight.0[0] * eta * eta, 1.0);
    }
}

#[test]
fn dielectric_beyond_the_critical_angle_reflects_everything() {
    let wo = direction(180.0 - 41.9, 0.0); // the critical angle of 1.5 is 41.81 degrees
    let [mirrored, refracted] = lobes("dielectric", &[("ior", 1.5)], wo);
    assert_eq!((mirrored.weight, mirrored.probability), (Color::WHITE, 1.0));
    assert_eq!((refracted.weight, refracted.probability), (Color::BLACK, 0.0));
}
