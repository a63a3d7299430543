//! The rules between forms of light. Each holds for watts, lumens and photons alike.

use super::assumptions::{Assumptions, Need};
use crate::{Form, exposure, radiometry};
use std::f64::consts::PI;

/// What a rule starts or ends with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Node {
    Light(Form),
    Exposure,
    Temperature,
}

/// One step from node to node.
pub(super) struct Rule {
    pub from: Node,
    pub to: Node,
    pub needs: &'static [Need],
    /// Used where it is given: the angle of incidence.
    pub takes: &'static [Need],
    pub formula: &'static str,
    /// The assumption in words; `{d}` and others stand for the numbers.
    pub assumption: &'static str,
    pub apply: fn(f64, &Assumptions) -> f64,
}

const fn rule(
    from: Node,
    to: Node,
    needs: &'static [Need],
    formula: &'static str,
    assumption: &'static str,
    apply: fn(f64, &Assumptions) -> f64,
) -> Rule {
    Rule { from, to, needs, takes: &[], formula, assumption, apply }
}

impl Rule {
    const fn with_incidence(mut self) -> Rule {
        self.takes = &[Need::Incidence];
        self
    }

    /// The assumption with its numbers.
    pub fn says(&self, a: &Assumptions) -> String {
        let angle = |need, otherwise| {
            format!("{:.6}", a.or(need, otherwise).to_degrees()).trim_end_matches('0').trim_end_matches('.').to_string()
        };
        let number = |need| format!("{}", a.get(need));
        let mut text = self.assumption.to_string();
        for (place, value) in [
            ("{d}", number(Need::Distance)),
            ("{a}", angle(Need::Cone, 0.0)),
            ("{omega}", number(Need::SolidAngle)),
            ("{A}", number(Need::Area)),
            ("{rho}", number(Need::Reflectance)),
            ("{theta}", angle(Need::Incidence, 0.0)),
            ("{t}", number(Need::Time)),
        ] {
            text = text.replace(place, &value);
        }
        text
    }
}

fn cos_incidence(a: &Assumptions) -> f64 {
    a.or(Need::Incidence, 0.0).cos()
}

/// 2π (1 - cos a) = 4π sin²(a/2) keeps its digits for narrow cones.
pub(super) fn cone_solid_angle(half_angle: f64) -> f64 {
    4.0 * PI * (0.5 * half_angle).sin().powi(2)
}

const ENERGY: Node = Node::Light(Form::Energy);
const FLUX: Node = Node::Light(Form::Flux);
const INTENSITY: Node = Node::Light(Form::Intensity);
const IRRADIANCE: Node = Node::Light(Form::Irradiance);
const RADIANCE: Node = Node::Light(Form::Radiance);
const DOSE: Node = Node::Light(Form::Exposure);

use Need::*;

/// All rules; [`super::source`]-like formulas of `crate::source` and `crate::exposure` are used where they exist.
#[rustfmt::skip]
pub(super) static RULES: &[Rule] = &[
    rule(FLUX, INTENSITY, &[], "I = Φ / 4π", "shines alike in all directions", |x, _| crate::source::point_intensity(x)),
    rule(INTENSITY, FLUX, &[], "Φ = 4π I", "shines alike in all directions", |x, _| x * 4.0 * PI),
    rule(FLUX, INTENSITY, &[Cone], "I = Φ / (2π (1 - cos a))", "even within a cone of half-angle {a}°, nothing outside", |x, a| crate::source::cone_intensity(x, a.get(Cone))),
    rule(INTENSITY, FLUX, &[Cone], "Φ = 2π (1 - cos a) I", "even within a cone of half-angle {a}°, nothing outside", |x, a| x * cone_solid_angle(a.get(Cone))),
    rule(FLUX, INTENSITY, &[SolidAngle], "I = Φ / Ω", "even within {omega} sr, nothing outside", |x, a| x / a.get(SolidAngle)),
    rule(INTENSITY, FLUX, &[SolidAngle], "Φ = Ω I", "even within {omega} sr, nothing outside", |x, a| x * a.get(SolidAngle)),
    rule(FLUX, INTENSITY, &[Lambertian], "I = Φ / π", "a flat Lambertian source, seen along its normal", |x, _| x / PI),
    rule(INTENSITY, FLUX, &[Lambertian], "Φ = π I", "a flat Lambertian source, seen along its normal", |x, _| x * PI),

    rule(INTENSITY, IRRADIANCE, &[Distance], "E = I cos θ / d²", "at {d} m, θ = {theta}° from the normal of the lit surface", |x, a| x * cos_incidence(a) / a.get(Distance).powi(2)).with_incidence(),
    rule(IRRADIANCE, INTENSITY, &[Distance], "I = E d² / cos θ", "at {d} m, θ = {theta}° from the normal of the lit surface", |x, a| x * a.get(Distance).powi(2) / cos_incidence(a)).with_incidence(),
    rule(FLUX, IRRADIANCE, &[Area], "E = Φ / A", "evenly over {A} m²", |x, a| x / a.get(Area)),
    rule(IRRADIANCE, FLUX, &[Area], "Φ = E A", "evenly over {A} m²", |x, a| x * a.get(Area)),

    rule(IRRADIANCE, RADIANCE, &[Reflectance], "L = ρ E / π", "seen on a Lambertian surface of reflectance {rho}", |x, a| x * a.get(Reflectance) / PI),
    rule(RADIANCE, IRRADIANCE, &[Reflectance], "E = π L / ρ", "seen on a Lambertian surface of reflectance {rho}", |x, a| x * PI / a.get(Reflectance)),
    rule(IRRADIANCE, RADIANCE, &[Lambertian], "L = M / π", "exitance of a Lambertian surface", |x, _| x / PI),
    rule(RADIANCE, IRRADIANCE, &[Lambertian], "M = π L", "exitance of a Lambertian surface", |x, _| x * PI),
    rule(IRRADIANCE, RADIANCE, &[Dome], "L = E / π", "an even hemisphere above the surface", |x, _| x / PI),
    rule(RADIANCE, IRRADIANCE, &[Dome], "E = π L", "an even hemisphere above the surface", |x, _| crate::source::dome_illuminance(x)),
    rule(IRRADIANCE, RADIANCE, &[SolidAngle], "L = E / (Ω cos θ)", "an even source of {omega} sr, θ = {theta}° from the normal", |x, a| x / (a.get(SolidAngle) * cos_incidence(a))).with_incidence(),
    rule(RADIANCE, IRRADIANCE, &[SolidAngle], "E = L Ω cos θ", "an even source of {omega} sr, θ = {theta}° from the normal", |x, a| x * a.get(SolidAngle) * cos_incidence(a)).with_incidence(),

    rule(RADIANCE, INTENSITY, &[Area], "I = L A", "a surface of {A} m², seen along its normal", |x, a| x * a.get(Area)),
    rule(INTENSITY, RADIANCE, &[Area], "L = I / A", "a surface of {A} m², seen along its normal", |x, a| x / a.get(Area)),
    rule(RADIANCE, FLUX, &[Area, Lambertian], "Φ = π L A", "a Lambertian surface of {A} m²", |x, a| crate::source::lambert_flux(x, a.get(Area))),
    rule(FLUX, RADIANCE, &[Area, Lambertian], "L = Φ / (π A)", "a Lambertian surface of {A} m²", |x, a| crate::source::lambert_luminance(x, a.get(Area))),

    rule(FLUX, ENERGY, &[Time], "Q = Φ t", "constant for {t} s", |x, a| x * a.get(Time)),
    rule(ENERGY, FLUX, &[Time], "Φ = Q / t", "constant for {t} s", |x, a| x / a.get(Time)),
    rule(IRRADIANCE, DOSE, &[Time], "H = E t", "constant for {t} s", |x, a| x * a.get(Time)),
    rule(DOSE, IRRADIANCE, &[Time], "E = H / t", "constant for {t} s", |x, a| x / a.get(Time)),
    rule(ENERGY, DOSE, &[Area], "H = Q / A", "evenly over {A} m²", |x, a| x / a.get(Area)),
    rule(DOSE, ENERGY, &[Area], "Q = H A", "evenly over {A} m²", |x, a| x * a.get(Area)),

    rule(Node::Exposure, RADIANCE, &[], "L = K/100 · 2^EV", "reflected-light meter, K = 12.5 cd s/m²", |x, _| exposure::mean_luminance(x)),
    rule(RADIANCE, Node::Exposure, &[], "EV = log2(100 L / K)", "reflected-light meter, K = 12.5 cd s/m²", |x, _| exposure::ev100_of_luminance(x)),
    rule(Node::Exposure, IRRADIANCE, &[], "E = C/100 · 2^EV", "incident-light meter with a dome, C = 250 lx s", |x, _| exposure::illuminance(x)),
    rule(IRRADIANCE, Node::Exposure, &[], "EV = log2(100 E / C)", "incident-light meter with a dome, C = 250 lx s", |x, _| (100.0 * x / exposure::C).log2()),
    rule(Node::Temperature, RADIANCE, &[], "L = σ T⁴ / π", "black body, whole spectrum", |x, _| radiometry::blackbody_radiance(x)),
];
