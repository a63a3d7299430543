//! What is chosen by name.

use crate::classic::Classic;
use crate::error::{Error, Result};
use lesk_geometry::{EdgeRule, NormalRule};
use lesk_scene::ShadowTerminator;
use std::str::FromStr;

/// Gives an enum names: `ALL`, `name` and `FromStr`.
macro_rules! named {
    ($Type:ident, $what:literal, $($Variant:ident: $name:literal,)*) => {
        impl $Type {
            /// All of them, the default first.
            pub const ALL: &[Self] = &[$(Self::$Variant),*];

            /// Its name in commands and files.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$Variant => $name),*
                }
            }
        }

        impl FromStr for $Type {
            type Err = Error;

            fn from_str(name: &str) -> Result<Self> {
                Self::ALL.iter().copied().find(|x| x.name() == name).ok_or_else(|| {
                    let known: Vec<_> = Self::ALL.iter().map(|x| x.name()).collect();
                    Error::new(format!("there is no {} `{name}`, but {} are accepted", $what, known.join(", ")))
                })
            }
        }
    };
}

/// Where the model is evaluated, and what is interpolated between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// At every pixel, with interpolated normals (Phong 1975).
    #[default]
    Phong,
    /// At every vertex; light is interpolated (Gouraud 1971).
    Gouraud,
    /// Once per face.
    Flat,
}
named!(Mode, "shading", Phong: "phong", Gouraud: "gouraud", Flat: "flat",);

/// How values inside a face come from its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Along the edges, then along the span of a scanline: what scanline hardware did. Turning a face of four or more
    /// corners on the screen changes its inside.
    #[default]
    Bilinear,
    /// Within the triangles that a face is cut into: the same however it is turned.
    Barycentric,
}
named!(Interpolation, "interpolation", Bilinear: "bilinear", Barycentric: "barycentric",);

/// In which space interpolation is linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Correction {
    /// On the surface (hyperbolic on the screen).
    #[default]
    Perspective,
    /// On the screen, as early rasterisers did.
    Screen,
}
named!(Correction, "correction", Perspective: "perspective", Screen: "screen",);

/// What the sums of light mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Space {
    /// Light.
    #[default]
    Linear,
    /// Codes of a screen, sRGB-encoded, clipped at white: wrong on purpose, as pictures once were made.
    Gamma,
}
named!(Space, "space", Linear: "linear", Gamma: "gamma",);

/// The point that stands for a face in flat shading; its normal is that of the face (Newell's method).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FlatPoint {
    /// The mean of its corners.
    #[default]
    Centroid,
    /// Its first corner (the provoking vertex of OpenGL, first convention).
    First,
}
named!(FlatPoint, "flat point", Centroid: "centroid", First: "first",);

/// How to shade.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Flat, Gouraud or Phong.
    pub shading: Mode,
    /// Bilinear or barycentric.
    pub interpolation: Interpolation,
    /// Linear on the surface or on the screen.
    pub correction: Correction,
    /// Where vertex normals come from.
    pub normals: NormalRule,
    /// Which edges are real.
    pub edges: EdgeRule,
    /// Faces around a sphere, disk or cylinder: 3 to 4096.
    pub tessellation: u32,
    /// How often the faces of meshes are cut into four, on the surface that their normals state: 0 to 8.
    pub subdivide: u32,
    /// Whether interpolated normals are brought to unit length.
    pub renormalize: bool,
    /// Samples along each side of a pixel: 1 to 16.
    pub supersampling: u32,
    /// Points per light that is not a point: 1 to 4096.
    pub quadrature: u32,
    /// Whether rays look for obstacles between a point and its lights.
    pub shadows: bool,
    /// Where rays to lights start, and which lights a face sees; `None` is what the scene says.
    pub shadow_terminator: Option<ShadowTerminator>,
    /// Whether faces that show their back are left out.
    pub cull: bool,
    /// The point of flat shading.
    pub flat_point: FlatPoint,
    /// Light, or codes of a screen.
    pub space: Space,
    /// The classic local model instead of the materials of the scene.
    pub classic: Option<Classic>,
    /// Whether albedo, normal, depth and ids are kept.
    pub aovs: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            shading: Mode::default(),
            interpolation: Interpolation::default(),
            correction: Correction::default(),
            normals: NormalRule::default(),
            edges: EdgeRule::Stored,
            tessellation: 64,
            subdivide: 0,
            renormalize: true,
            supersampling: 1,
            quadrature: 16,
            shadows: false,
            shadow_terminator: None,
            cull: false,
            flat_point: FlatPoint::default(),
            space: Space::default(),
            classic: None,
            aovs: false,
        }
    }
}

impl Settings {
    /// # Errors
    /// A number outside its range, named.
    pub(crate) fn check(&self) -> Result<()> {
        for (name, value, least, most) in [
            ("tessellation", self.tessellation, 3, 4096),
            ("subdivide", self.subdivide, 0, 8),
            ("supersampling", self.supersampling, 1, 16),
            ("quadrature", self.quadrature, 1, 4096),
        ] {
            if !(least..=most).contains(&value) {
                return Err(Error::new(format!("`{name}` is {value}, {least} to {most} is accepted")));
            }
        }
        if let EdgeRule::Crease(angle) = self.edges
            && !(0.0..=std::f64::consts::PI + 1e-9).contains(&angle)
        {
            let deg = angle.to_degrees();
            return Err(Error::new(format!("crease angle is {deg} deg, 0 to 180 deg is accepted")));
        }
        self.classic.as_ref().map_or(Ok(()), Classic::check)
    }
}
