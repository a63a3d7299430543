//! Materials of a scene, and the images on their parameters.

use crate::error::Place;
use lesk_image::Image;
use lesk_image::texture::{Channel, Interpolation, Role, Wrap};
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// A material.
#[derive(Clone, Debug)]
pub struct MaterialDescription {
    /// The name that objects use.
    pub name: String,
    /// The id of a model.
    pub model: String,
    /// Parameters by name; the others have the model's defaults.
    pub params: Vec<(String, Source, Place)>,
    /// What bends the shading normals.
    pub normal_map: Option<NormalMapDescription>,
    /// Whether an opaque surface scatters on its back.
    pub two_sided: bool,
    /// Where it is stated.
    pub place: Place,
}

impl MaterialDescription {
    /// A material with the model's defaults.
    pub fn new(name: impl Into<String>, model: impl Into<String>) -> Self {
        MaterialDescription {
            name: name.into(),
            model: model.into(),
            params: Vec::new(),
            normal_map: None,
            two_sided: true,
            place: Place::NONE,
        }
    }

    /// The same with a constant parameter: one number, or one per channel.
    #[must_use]
    pub fn set(mut self, name: impl Into<String>, value: &[f64]) -> Self {
        self.params.push((name.into(), Source::Constant(value.to_vec()), Place::NONE));
        self
    }

    /// The same with a textured parameter.
    #[must_use]
    pub fn texture(mut self, name: impl Into<String>, texture: TextureDescription) -> Self {
        self.params.push((name.into(), Source::Texture(texture), Place::NONE));
        self
    }
}

/// Where a parameter comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// One number, or one per channel.
    Constant(Vec<f64>),
    /// An image.
    Texture(TextureDescription),
}

/// Where an image comes from.
#[derive(Clone)]
pub enum Picture {
    /// A file: EXR, HDR, PNG or JPEG.
    File(PathBuf),
    /// The bytes of such a file.
    Encoded(Arc<[u8]>),
    /// An image in memory.
    Image(Arc<Image>),
}

/// The source, without the pixels.
impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Picture::File(file) => write!(f, "File({file:?})"),
            Picture::Encoded(bytes) => write!(f, "Encoded({} bytes)", bytes.len()),
            Picture::Image(image) => write!(f, "Image({} x {})", image.width(), image.height()),
        }
    }
}

/// An image on a parameter: the value is `scale * texel + offset`, clamped to the legal range.
#[derive(Clone, Debug)]
pub struct TextureDescription {
    /// The image.
    pub image: Picture,
    /// Colour or data; `None` takes what the parameter is.
    pub role: Option<Role>,
    /// Whether a file is taken as sRGB-encoded; `None` takes what its format says.
    pub srgb: Option<bool>,
    /// The number of a texel that a scalar reads.
    pub channel: Channel,
    /// Factor, per channel.
    pub scale: [f64; 3],
    /// Added after the factor.
    pub offset: f64,
    /// How it continues beyond 0 to 1.
    pub wrap: [Wrap; 2],
    /// Whether texels are blended.
    pub interpolation: Interpolation,
    /// Which set of the mesh's texture coordinates it uses, 0 or 1.
    pub uv_set: usize,
    /// Rows of the affine map from them to those of the picture; v runs upward in both.
    pub uv: [[f32; 3]; 2],
}

/// A picture of normals in tangent space: red along growing u, green along growing v, blue outward.
#[derive(Clone, Debug)]
pub struct NormalMapDescription {
    /// The picture; role, colour space, channel, scale and offset have no meaning here.
    pub texture: TextureDescription,
    /// Factor of the slopes; 1 is as the picture has them.
    pub strength: f64,
    /// Where it is stated.
    pub place: Place,
}

impl TextureDescription {
    /// An image as it is.
    pub fn new(image: Picture) -> Self {
        TextureDescription {
            image,
            role: None,
            srgb: None,
            channel: Channel::Red,
            scale: [1.0; 3],
            offset: 0.0,
            wrap: [Wrap::Repeat; 2],
            interpolation: Interpolation::Bilinear,
            uv_set: 0,
            uv: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }
}
