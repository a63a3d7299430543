//! The classic local model: intensities without units.
//!
//! $$ I = I_A + \sum_L (I_D + I_S),\quad I_A = C_A C_D k_A,\quad I_D = C_L C_D k_D \cos\alpha,\quad
//! I_S = C_L C_S k_S \cos^h\beta $$
//!
//! α is the angle between normal and light, β the one between viewer and mirrored light (Phong 1975), or between normal
//! and half vector (Blinn 1977). The bridge to units: a light of illuminance E⊥ at the surface, perpendicular to its
//! direction, counts as C_L = E⊥/π. Then C_D k_D is the albedo of a Lambert surface, and I is a luminance in cd/m².

use lesk_math::{CHANNELS, Color, Vec3};
use lesk_scene::raster::{Classic, Highlight};

/// I_A.
pub(crate) fn ambient_term(model: &Classic) -> Color<f32> {
    color(|c| model.ambient[c] * model.diffuse[c] * model.ka)
}

/// I_D + I_S of a light of colour `light`; `n`, `wi` and `wo` are unit vectors. Nothing where the light is behind the
/// surface.
pub(crate) fn light_term(model: &Classic, n: Vec3<f32>, wi: Vec3<f32>, wo: Vec3<f32>, light: Color<f32>) -> Color<f32> {
    let cos_alpha = n.dot(wi);
    if cos_alpha <= 0.0 {
        return Color::BLACK;
    }
    let cos_beta = match model.highlight {
        Highlight::Phong => (n * (2.0 * cos_alpha) - wi).dot(wo),
        Highlight::Blinn => n.dot((wi + wo).normalize()),
    };
    // 0^0 would be 1: a highlight behind the viewer is none
    let highlight = if cos_beta > 0.0 { cos_beta.min(1.0).powf(model.shininess) * model.ks } else { 0.0 };
    let part = |c: usize| model.diffuse[c] * model.kd * cos_alpha + model.specular[c] * highlight;
    light * color(part)
}

/// A colour from three numbers; a monochrome build takes the first ones.
pub(crate) fn color(part: impl Fn(usize) -> f32) -> Color<f32> {
    let mut out = Color::BLACK;
    for c in 0..CHANNELS {
        out.0[c] = part(c.min(2));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::vec3;

    #[test]
    fn terms_are_those_of_the_lecture() {
        // alpha = 60 deg; the mirror direction is 60 deg on the other side; the viewer looks along the normal
        let model = Classic { ka: 0.1, kd: 0.5, ks: 0.4, shininess: 3.0, ..Classic::default() };
        let model = Classic { diffuse: [0.5, 1.0, 0.25], ..model };
        let wi = vec3(0.75f32.sqrt(), 0.0, 0.5);
        let light = color(|_| 2.0);
        let [r, g, b] = light_term(&model, Vec3::Z, wi, Vec3::Z, light).0;
        // I_D = 2 C_D 0.5 cos 60, I_S = 2 * 0.4 * cos^3 60
        let specular = 2.0 * 0.4 * 0.125;
        for (value, expected) in [(r, 0.25 + specular), (g, 0.5 + specular), (b, 0.125 + specular)] {
            assert!((value - expected).abs() < 4.0 * f32::EPSILON);
        }
        let ambient = ambient_term(&model).0;
        assert!((ambient[0] - 0.05).abs() < f32::EPSILON && (ambient[1] - 0.1).abs() < f32::EPSILON);
        // Blinn's half vector is 30 deg off the normal
        let blinn = Classic { highlight: Highlight::Blinn, kd: 0.0, ..model };
        let expected = 2.0 * 0.4 * 0.75f32.sqrt().powi(3);
        assert!((light_term(&blinn, Vec3::Z, wi, Vec3::Z, light).0[0] - expected).abs() < 4.0 * f32::EPSILON);
    }

    #[test]
    fn light_from_behind_gives_nothing() {
        let model = Classic { shininess: 0.0, ..Classic::default() };
        let term = light_term(&model, Vec3::Z, vec3(0.0, 0.6, -0.8), Vec3::Z, Color::WHITE);
        assert_eq!(term, Color::BLACK);
    }
}
