//! How a scene is rasterised.

use super::{Field, Kind, Section, field, needed};
use crate::raster::{
    COEFFICIENT, CREASE, Correction, FlatPoint, Highlight, Interpolation, Mode, QUADRATURE, SUBDIVIDE, SUPERSAMPLING,
    Space, TESSELLATION,
};
use lesk_geometry::NormalRule;
use lesk_quantities::Dimension;

pub(crate) const RASTER: &[Field] = &[
    field(
        "shading",
        Kind::Choice(Mode::NAMES),
        "At which points models are evaluated: pixels, vertices or faces; phong where absent.",
    ),
    field(
        "interpolation",
        Kind::Choice(Interpolation::NAMES),
        "Inside faces: along edges, then along the span of a scanline, or within triangles; bilinear where absent.",
    ),
    field(
        "correction",
        Kind::Choice(Correction::NAMES),
        "Where interpolation is linear: on the surface or on the screen; perspective where absent.",
    ),
    field(
        "normals",
        Kind::Choice(&NormalRule::NAMES),
        "Vertex normals: of the surface or file, or of the faces around by a rule; given where absent.",
    ),
    field(
        "crease_angle",
        Kind::Quantity(&[Dimension::Angle], CREASE),
        "Edges with a larger angle between their faces are real; as the mesh stores them where absent.",
    ),
    field("tessellation", Kind::Integer(TESSELLATION), "Faces around a sphere, disk or cylinder; 64 where absent."),
    field(
        "subdivide",
        Kind::Integer(SUBDIVIDE),
        "How often the faces of meshes are cut into four, on the surface that their normals state; 0 where absent.",
    ),
    field("renormalize", Kind::Bool, "Whether interpolated normals are brought to unit length; true where absent."),
    field("supersampling", Kind::Integer(SUPERSAMPLING), "Samples along each side of a pixel; 1 where absent."),
    field(
        "quadrature",
        Kind::Integer(QUADRATURE),
        "Points per light that has an area or fills the sky; 16 where absent.",
    ),
    field("shadows", Kind::Bool, "Whether rays look for obstacles between a point and its lights; false where absent."),
    field("cull", Kind::Bool, "Whether faces that show their back are left out; false where absent."),
    field(
        "flat_point",
        Kind::Choice(FlatPoint::NAMES),
        "The point of a face in flat shading, the mean of its corners or the first one; centroid where absent.",
    ),
    field(
        "space",
        Kind::Choice(Space::NAMES),
        "What sums of light are: light, or codes of a screen, wrong on purpose; linear where absent.",
    ),
    field(
        "classic",
        Kind::Table(Section::Plain("classic", CLASSIC)),
        "The classic local model for all objects, instead of their materials.",
    ),
];

pub(crate) const CLASSIC: &[Field] = &[
    field("ambient", Kind::Numbers(3), "C_A, colour of the ambient light; [1, 1, 1] where absent."),
    field("diffuse", Kind::Numbers(3), "C_D, colour of the surface; [1, 1, 1] where absent."),
    field("specular", Kind::Numbers(3), "C_S, colour of the highlight; [1, 1, 1] where absent."),
    field("ka", Kind::Number(COEFFICIENT), "k_A, share of the ambient light; 0.1 where absent."),
    field("kd", Kind::Number(COEFFICIENT), "k_D, diffuse share; 0.5 where absent."),
    field("ks", Kind::Number(COEFFICIENT), "k_S, share of the highlight; 0.4 where absent."),
    field("shininess", Kind::Number(COEFFICIENT), "h, exponent of the highlight; 50 where absent."),
    field(
        "highlight",
        Kind::Choice(Highlight::NAMES),
        "Its angle: between viewer and mirrored light, or between normal and half vector; phong where absent.",
    ),
    field(
        "lights",
        Kind::List(Section::Plain("classic light", CLASSIC_LIGHT)),
        "Lights without units, each with `direction` and `color`; those of the scene where absent.",
    ),
];

pub(crate) const CLASSIC_LIGHT: &[Field] = &[
    needed("direction", Kind::Numbers(3), "Towards the light."),
    field("color", Kind::Numbers(3), "C_L; [1, 1, 1] where absent."),
];
