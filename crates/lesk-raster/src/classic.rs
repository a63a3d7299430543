//! The classic local model: intensities without units.
//!
//! $$ I = I_A + \sum_L (I_D + I_S),\quad I_A = C_A C_D k_A,\quad I_D = C_L C_D k_D \cos\alpha,\quad
//! I_S = C_L C_S k_S \cos^h\beta $$
//!
//! α is the angle between normal and light, β the one between viewer and mirrored light (Phong 1975), or between normal
//! and half vector (Blinn 1977). The bridge to units: a light of illuminance E⊥ at the surface, perpendicular to its
//! direction, counts as C_L = E⊥/π. Then C_D k_D is the albedo of a Lambert surface, and I is a luminance in cd/m².

use crate::error::{Error, Result};
use lesk_math::{CHANNELS, Color, Vec3};

/// Which angle β is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Highlight {
    /// Between the viewer and the mirrored light.
    #[default]
    Phong,
    /// Between the normal and the half vector, which has unit length.
    Blinn,
}

/// A light without units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassicLight {
    /// Towards the light; any length but zero.
    pub direction: Vec3<f32>,
    /// C_L.
    pub color: [f32; 3],
}

/// Surface and lights of the classic local model, the same for all objects.
#[derive(Clone, Debug, PartialEq)]
pub struct Classic {
    /// C_A: colour of the ambient light.
    pub ambient: [f32; 3],
    /// C_D: colour of the surface.
    pub diffuse: [f32; 3],
    /// C_S: colour of the highlight.
    pub specular: [f32; 3],
    /// k_A.
    pub ka: f32,
    /// k_D.
    pub kd: f32,
    /// k_S.
    pub ks: f32,
    /// h, the exponent of the highlight.
    pub shininess: f32,
    /// The angle of the highlight.
    pub highlight: Highlight,
    /// Lights without units; where there are none, those of the scene with C_L = E⊥/π.
    pub lights: Vec<ClassicLight>,
}

impl Default for Classic {
    fn default() -> Self {
        Classic {
            ambient: [1.0; 3],
            diffuse: [1.0; 3],
            specular: [1.0; 3],
            ka: 0.1,
            kd: 0.5,
            ks: 0.4,
            shininess: 50.0,
            highlight: Highlight::Phong,
            lights: Vec::new(),
        }
    }
}

impl Classic {
    pub(crate) fn check(&self) -> Result<()> {
        let colors = [("ambient", self.ambient), ("diffuse", self.diffuse), ("specular", self.specular)];
        let lights = self.lights.iter().map(|l| ("light", l.color));
        for (name, color) in colors.into_iter().chain(lights) {
            if !color.iter().all(|c| (0.0..=1e9).contains(c)) {
                return Err(Error::new(format!("colour `{name}` is {color:?}, numbers from 0 to 1e9 are accepted")));
            }
        }
        for (name, value, most) in
            [("ka", self.ka, 1e6), ("kd", self.kd, 1e6), ("ks", self.ks, 1e6), ("shininess", self.shininess, 1e6)]
        {
            if !(0.0..=most).contains(&value) {
                return Err(Error::new(format!("`{name}` is {value}, 0 to {most:e} is accepted")));
            }
        }
        let direction = |l: &&ClassicLight| !(l.direction.length() > 1e-30 && l.direction.length().is_finite());
        match self.lights.iter().find(direction) {
            Some(l) => {
                Err(Error::new(format!("light has the direction {:?}, which has no length", l.direction.to_array())))
            }
            None => Ok(()),
        }
    }

    /// What to tell the user: coefficients that together give back more than arrives.
    pub fn warning(&self) -> Option<String> {
        let sum = self.ka + self.kd + self.ks;
        (sum > 1.0).then(|| format!("ka + kd + ks is {sum:.3}: above 1, white light makes the picture clip"))
    }

    /// I_A.
    pub fn ambient_term(&self) -> Color<f32> {
        color(|c| self.ambient[c] * self.diffuse[c] * self.ka)
    }

    /// I_D + I_S of a light of colour `light`; `n`, `wi` and `wo` are unit vectors. Nothing where the light is behind
    /// the surface.
    pub fn light_term(&self, n: Vec3<f32>, wi: Vec3<f32>, wo: Vec3<f32>, light: Color<f32>) -> Color<f32> {
        let cos_alpha = n.dot(wi);
        if cos_alpha <= 0.0 {
            return Color::BLACK;
        }
        let cos_beta = match self.highlight {
            Highlight::Phong => (n * (2.0 * cos_alpha) - wi).dot(wo),
            Highlight::Blinn => n.dot((wi + wo).normalize()),
        };
        // 0^0 would be 1: a highlight behind the viewer is none
        let highlight = if cos_beta > 0.0 { cos_beta.min(1.0).powf(self.shininess) * self.ks } else { 0.0 };
        let part = |c: usize| self.diffuse[c] * self.kd * cos_alpha + self.specular[c] * highlight;
        light * color(part)
    }
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
        let [r, g, b] = model.light_term(Vec3::Z, wi, Vec3::Z, light).0;
        // I_D = 2 C_D 0.5 cos 60, I_S = 2 * 0.4 * cos^3 60
        let specular = 2.0 * 0.4 * 0.125;
        for (value, expected) in [(r, 0.25 + specular), (g, 0.5 + specular), (b, 0.125 + specular)] {
            assert!((value - expected).abs() < 4.0 * f32::EPSILON);
        }
        let ambient = model.ambient_term().0;
        assert!((ambient[0] - 0.05).abs() < f32::EPSILON && (ambient[1] - 0.1).abs() < f32::EPSILON);
        // Blinn's half vector is 30 deg off the normal
        let blinn = Classic { highlight: Highlight::Blinn, kd: 0.0, ..model };
        let expected = 2.0 * 0.4 * 0.75f32.sqrt().powi(3);
        assert!((blinn.light_term(Vec3::Z, wi, Vec3::Z, light).0[0] - expected).abs() < 4.0 * f32::EPSILON);
    }

    #[test]
    fn light_from_behind_gives_nothing() {
        let model = Classic { shininess: 0.0, ..Classic::default() };
        let term = model.light_term(Vec3::Z, vec3(0.0, 0.6, -0.8), Vec3::Z, Color::WHITE);
        assert_eq!(term, Color::BLACK);
    }

    #[test]
    fn coefficients_above_one_are_a_warning_and_no_error() {
        let bright = Classic { ka: 0.0, kd: 0.5, ks: 1.0, ..Classic::default() };
        assert!(bright.check().is_ok());
        assert!(bright.warning().unwrap().contains("1.5"));
        assert!(Classic::default().warning().is_none());
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let bad = Classic { kd: -0.5, ..Classic::default() };
        assert!(bad.check().unwrap_err().to_string().contains("`kd` is -0.5"));
        let dark = ClassicLight { direction: Vec3::ZERO, color: [1.0; 3] };
        let bad = Classic { lights: vec![dark], ..Classic::default() };
        assert!(bad.check().unwrap_err().to_string().contains("no length"));
    }
}
