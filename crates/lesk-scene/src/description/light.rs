//! The lights of a scene, and what lies behind everything.

use super::material::{Picture, TextureDescription};
use crate::error::Place;
use lesk_light::{Mounting, Spectrum, Up};
use lesk_quantities::Quantity;
use std::path::PathBuf;

/// How strong a light is, and of which colour.
#[derive(Clone, Debug)]
pub struct Emission {
    /// lm, cd, lx or cd/m²; with a spectrum also W, W/sr, W/m² or W/m²/sr.
    pub amount: Quantity,
    /// The colour.
    pub color: LightColor,
    /// Where it is stated.
    pub place: Place,
}

impl Emission {
    /// White light.
    pub fn new(amount: Quantity) -> Self {
        Emission { amount, color: LightColor::White, place: Place::NONE }
    }

    /// Light of a named spectrum.
    pub fn of(amount: Quantity, spectrum: Spectrum) -> Self {
        Emission { amount, color: LightColor::Spectrum(spectrum), place: Place::NONE }
    }
}

/// The colour of a light; it does not change how strong the light is.
#[derive(Clone, Copy, Debug)]
pub enum LightColor {
    /// The white of the film, D65.
    White,
    /// Linear Rec.709, of which only the ratios count.
    Rgb([f64; 3]),
    /// A named spectrum.
    Spectrum(Spectrum),
}

/// Light from a surface.
#[derive(Clone, Debug)]
pub struct AreaLightDescription {
    /// Flux or luminance.
    pub emission: Emission,
    /// Whether both sides shine.
    pub two_sided: bool,
    /// A picture that multiplies the luminance, or shares out the flux; its role, channel, scale and offset have no
    /// meaning here.
    pub texture: Option<TextureDescription>,
}

/// A light that is no surface.
#[derive(Clone, Debug)]
pub struct LightDescription {
    /// Its name in reports; may be empty.
    pub name: String,
    /// What it is.
    pub kind: LightKind,
    /// How strong.
    pub emission: Emission,
    /// Where it is stated.
    pub place: Place,
}

impl LightDescription {
    /// A light without a name.
    pub fn new(kind: LightKind, emission: Emission) -> Self {
        LightDescription { name: String::new(), kind, emission, place: Place::NONE }
    }
}

/// The kind of a light.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// Into all directions: flux or intensity.
    Point {
        /// Metres.
        position: [f64; 3],
    },
    /// Into a cone: flux or axial intensity.
    Spot {
        /// Metres.
        position: [f64; 3],
        /// The axis.
        direction: [f64; 3],
        /// Half angles of full intensity and of the edge, radians.
        half_angles: [f64; 2],
    },
    /// From infinitely far: perpendicular illuminance.
    Directional {
        /// In which the light travels.
        direction: [f64; 3],
        /// Angular diameter of the disk that it comes from, radians; 0 for parallel light.
        diameter: f64,
    },
    /// A picture thrown by a lens: flux.
    Projector {
        /// The picture.
        image: Picture,
        /// Metres.
        position: [f64; 3],
        /// The axis.
        direction: [f64; 3],
        /// What is up in the picture.
        up: [f64; 3],
        /// Full opening across the width, radians.
        width: f64,
    },
}

/// A luminaire from a photometric file.
#[derive(Clone, Debug)]
pub struct LuminaireDescription {
    /// Its name in reports; may be empty.
    pub name: String,
    /// The IES or EULUMDAT file.
    pub file: PathBuf,
    /// The lamp set of an EULUMDAT file, from 0.
    pub lamp_set: usize,
    /// Where it hangs.
    pub mounting: Mounting,
    /// Luminous flux instead of that of the file.
    pub flux: Option<Quantity>,
    /// Factor of the flux: dimming times maintenance factor.
    pub factor: f64,
    /// The colour.
    pub color: LightColor,
    /// Where it is stated.
    pub place: Place,
}

/// What lies behind everything.
#[derive(Clone, Debug)]
pub struct EnvironmentDescription {
    /// A picture or a constant.
    pub kind: EnvironmentKind,
    /// Which axis points to the zenith.
    pub up: Up,
    /// Where it is stated.
    pub place: Place,
}

/// The kind of an environment.
#[derive(Clone, Debug)]
pub enum EnvironmentKind {
    /// A latitude-longitude map.
    Map {
        /// The picture.
        image: Picture,
        /// Turn about the zenith, counter-clockwise seen from above, radians.
        rotation: f64,
        /// What its numbers mean.
        strength: MapStrength,
    },
    /// The same luminance everywhere.
    Sky {
        /// Luminance, or the illuminance of a horizontal plane.
        emission: Emission,
        /// Whether it ends at the horizon.
        dome: bool,
    },
    /// A CIE general sky.
    CieSky {
        /// Type, 1 to 16.
        number: u32,
        /// Elevation and azimuth of the sun (from north, clockwise seen from above), radians.
        sun: [f64; 2],
        /// Reflectance of the ground, 0 to 1.
        ground: f64,
        /// Luminance of the zenith, or the illuminance of a horizontal plane by the sky.
        emission: Emission,
    },
    /// The cloudless sky of Hosek and Wilkie, in its own physical units.
    HosekSky {
        /// 1 to 10.
        turbidity: f64,
        /// Elevation and azimuth of the sun, as for a CIE sky.
        sun: [f64; 2],
        /// Reflectance of the ground, linear Rec.709.
        ground: [f64; 3],
    },
}

/// How strong an environment map is.
#[derive(Clone, Copy, Debug)]
pub enum MapStrength {
    /// cd/m² per unit of the picture.
    Scale(f64),
    /// Illuminance of a horizontal plane by the upper half, lx.
    Illuminance(f64),
    /// Mean luminance over all directions, cd/m².
    Luminance(f64),
}
