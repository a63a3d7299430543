//! How a scene is rasterised: flat, Gouraud or Phong shading, and all that goes with it.
//!
//! `lesk_raster` does it; here stand the names, the defaults and the ranges, for scene files and callers alike.

mod classic;

pub(crate) use classic::{COEFFICIENT, check_color};
pub use classic::{Classic, ClassicLight, Highlight};

use crate::error::{Place, Problem};
use crate::named::named;
use crate::scene::ShadowTerminator;
use lesk_geometry::{EdgeRule, NormalRule};
use std::f64::consts::PI;

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
pub struct RasterSettings {
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
    /// Faces around a sphere, disk or cylinder.
    pub tessellation: u32,
    /// How often the faces of meshes are cut into four, on the surface that their normals state.
    pub subdivide: u32,
    /// Whether interpolated normals are brought to unit length.
    pub renormalize: bool,
    /// Samples along each side of a pixel.
    pub supersampling: u32,
    /// Points per light that is not a point.
    pub quadrature: u32,
    /// Whether rays look for obstacles between a point and its lights.
    pub shadows: bool,
    /// Where rays to lights start, and which lights a face sees; `None` is what `[render]` of the scene says.
    pub shadow_terminator: Option<ShadowTerminator>,
    /// Whether faces that show their back are left out.
    pub cull: bool,
    /// The point of flat shading.
    pub flat_point: FlatPoint,
    /// Light, or codes of a screen.
    pub space: Space,
    /// The classic local model instead of the materials of the scene.
    pub classic: Option<Classic>,
    /// Whether albedo, normal, depth and ids are kept; a scene file says it for both engines, under `[render]`.
    pub aovs: bool,
}

impl Default for RasterSettings {
    fn default() -> Self {
        RasterSettings {
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

/// What the whole numbers of the settings may be.
pub(crate) const TESSELLATION: [i64; 2] = [3, 4096];
pub(crate) const SUBDIVIDE: [i64; 2] = [0, 8];
pub(crate) const SUPERSAMPLING: [i64; 2] = [1, 16];
pub(crate) const QUADRATURE: [i64; 2] = [1, 4096];
/// What the crease angle may be, radians.
pub(crate) const CREASE: [f64; 2] = [0.0, PI];

/// False for NaN.
fn within(value: f32, [low, high]: [f64; 2]) -> bool {
    (low..=high).contains(&f64::from(value))
}

impl RasterSettings {
    /// # Errors
    /// A number outside its range, named.
    pub fn check(&self) -> Result<(), Problem> {
        for (name, value, [low, high]) in [
            ("tessellation", self.tessellation, TESSELLATION),
            ("subdivide", self.subdivide, SUBDIVIDE),
            ("supersampling", self.supersampling, SUPERSAMPLING),
            ("quadrature", self.quadrature, QUADRATURE),
        ] {
            if !(low..=high).contains(&i64::from(value)) {
                let text = format!("`{name}` is {value}, {low} to {high} is accepted");
                return Err(Problem::new(Place::NONE, text));
            }
        }
        if let EdgeRule::Crease(angle) = self.edges
            && !(CREASE[0]..=CREASE[1]).contains(&angle)
        {
            let deg = angle.to_degrees();
            return Err(Problem::new(Place::NONE, format!("crease angle is {deg} deg, 0 to 180 deg is accepted")));
        }
        self.classic.as_ref().map_or(Ok(()), Classic::check)
    }
}
