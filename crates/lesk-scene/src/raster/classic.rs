//! The surface and the lights of the classic local model, which has no units.

use super::within;
use crate::error::{Place, Problem};
use crate::named::named;
use lesk_math::Vec3;

/// Which angle β is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Highlight {
    /// Between the viewer and the mirrored light (Phong 1975).
    #[default]
    Phong,
    /// Between the normal and the half vector, which has unit length (Blinn 1977).
    Blinn,
}
named!(Highlight, "highlight", Phong: "phong", Blinn: "blinn",);

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

/// What a colour may be.
const COLOR: [f64; 2] = [0.0, 1e9];
/// What a coefficient or an exponent may be.
pub(crate) const COEFFICIENT: [f64; 2] = [0.0, 1e6];

/// # Errors
/// A channel outside its range.
pub(crate) fn check_color(name: &str, color: [f32; 3]) -> Result<(), Problem> {
    if color.iter().all(|&c| within(c, COLOR)) {
        return Ok(());
    }
    Err(Problem::new(Place::NONE, format!("colour `{name}` is {color:?}, numbers from 0 to 1e9 are accepted")))
}

impl ClassicLight {
    /// # Errors
    /// A light without a direction, a colour outside its range.
    pub(crate) fn check(&self) -> Result<(), Problem> {
        check_color("color", self.color)?;
        let length = self.direction.length();
        if length > 1e-30 && length.is_finite() {
            return Ok(());
        }
        let text = format!("light has the direction {:?}, which has no length", self.direction.to_array());
        Err(Problem::new(Place::NONE, text))
    }
}

impl Classic {
    /// # Errors
    /// A number outside its range, a light without a direction.
    pub(super) fn check(&self) -> Result<(), Problem> {
        for (name, color) in [("ambient", self.ambient), ("diffuse", self.diffuse), ("specular", self.specular)] {
            check_color(name, color)?;
        }
        for (name, value) in [("ka", self.ka), ("kd", self.kd), ("ks", self.ks), ("shininess", self.shininess)] {
            if !within(value, COEFFICIENT) {
                let text = format!("`{name}` is {value}, 0 to {:e} is accepted", COEFFICIENT[1]);
                return Err(Problem::new(Place::NONE, text));
            }
        }
        self.lights.iter().try_for_each(ClassicLight::check)
    }

    /// What to tell the user: coefficients that together give back more than arrives.
    pub fn warning(&self) -> Option<String> {
        let sum = self.ka + self.kd + self.ks;
        (sum > 1.0).then(|| format!("ka + kd + ks is {sum:.3}: above 1, white light makes the picture clip"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
