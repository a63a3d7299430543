//! Materials: a model, and where each of its parameters comes from.

use lesk_bsdf::Scatter;
use lesk_bsdf::model::Domain;
use lesk_bsdf::params::offset_of;
use lesk_image::Texture;
use lesk_image::texture::Channel;
use lesk_math::{CHANNELS, Vec3};
use std::fmt;
use std::sync::Arc;

/// The longest flat parameter table that a material can hold.
pub const MAX_PARAMS: usize = 32;

/// A model with one source per entry of its flat parameter table: a constant, or a texture.
#[derive(Clone)]
pub struct Material {
    name: String,
    model: &'static dyn Scatter,
    constants: [f32; MAX_PARAMS],
    bindings: Vec<Binding>,
    two_sided: bool,
    /// What the model says, looked up once.
    domain: Domain,
    count: usize,
    ior: Option<usize>,
    may_be_delta: bool,
}

/// A texture that gives one parameter.
#[derive(Clone, Debug)]
pub struct Binding {
    /// The first entry in the flat table.
    pub entry: usize,
    /// How many entries: 1, or one per channel.
    pub len: usize,
    /// The image.
    pub texture: Arc<Texture>,
    /// The number of a texel that a scalar reads; a colour reads all of them.
    pub channel: Channel,
    /// Factor of the texel, one per entry.
    pub scale: [f32; 3],
    /// Added to the scaled texel.
    pub offset: f32,
    /// Legal values: what lies outside is clamped.
    pub range: [f32; 2],
    /// Factor and offset of the texture coordinates.
    pub uv: [[f32; 2]; 2],
}

impl Binding {
    /// Writes the values at the texture coordinates into the flat table.
    fn read(&self, uv: [f32; 2], out: &mut [f32; MAX_PARAMS]) {
        let uv = [0, 1].map(|i| uv[i] * self.uv[0][i] + self.uv[1][i]);
        let texel = if self.len == CHANNELS && CHANNELS == 3 {
            self.texture.rgb(uv)
        } else {
            [self.texture.scalar(uv, self.channel); 3]
        };
        for c in 0..self.len {
            let value = texel[c] * self.scale[c] + self.offset;
            out[self.entry + c] = value.clamp(self.range[0], self.range[1]);
        }
    }
}

impl Material {
    /// A material of constants, given as the flat table of the model; legal values are the caller's duty, as is a
    /// table of the model's length. `two_sided` decides whether an opaque surface scatters on its back.
    ///
    /// # Panics
    /// If the table does not have the model's length, or more than [`MAX_PARAMS`] entries.
    pub fn new(name: impl Into<String>, model: &'static dyn Scatter, constants: &[f32], two_sided: bool) -> Self {
        assert_eq!(constants.len(), model.param_count(), "model `{}`", model.id());
        let mut table = [0.0; MAX_PARAMS];
        table[..constants.len()].copy_from_slice(constants);
        Material {
            name: name.into(),
            model,
            constants: table,
            bindings: Vec::new(),
            two_sided,
            domain: model.model().domain,
            count: constants.len(),
            ior: offset_of(model.specs(), "ior"),
            may_be_delta: model.delta(constants, Vec3::Z).is_some(),
        }
    }

    /// The same material with a texture for one parameter.
    ///
    /// # Panics
    /// If the entries of the binding are not in the table.
    #[must_use]
    pub fn with(mut self, binding: Binding) -> Self {
        assert!(binding.len <= 3 && binding.entry + binding.len <= self.model.param_count());
        self.bindings.push(binding);
        self
    }

    /// Its name in the scene.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its model.
    pub fn model(&self) -> &'static dyn Scatter {
        self.model
    }

    /// Whether an opaque surface scatters on its back as on its front; without, the back is black.
    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Whether light may pass through the surface.
    pub fn transmits(&self) -> bool {
        self.domain != Domain::Upper
    }

    /// The directions that its model accepts.
    #[inline]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// The entry of the flat table that holds the refractive index `ior`, where the model has one.
    #[inline]
    pub fn ior_entry(&self) -> Option<usize> {
        self.ior
    }

    /// Whether the model has delta lobes for light from the normal; without, it is not worth asking for them.
    #[inline]
    pub fn may_be_delta(&self) -> bool {
        self.may_be_delta
    }

    /// The textures.
    pub fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// The model's flat parameter table at the texture coordinates, as `Scatter` takes it: the constants themselves, or a
    /// copy of them with what the textures say, written into `out`.
    #[inline]
    pub fn params<'a>(&'a self, uv: [f32; 2], out: &'a mut [f32; MAX_PARAMS]) -> &'a [f32] {
        if self.bindings.is_empty() {
            return &self.constants[..self.count];
        }
        *out = self.constants;
        for binding in &self.bindings {
            binding.read(uv, out);
        }
        &out[..self.count]
    }
}

impl fmt::Debug for Material {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Material")
            .field("name", &self.name)
            .field("model", &self.model.id())
            .field("constants", &&self.constants[..self.model.param_count()])
            .field("bindings", &self.bindings.len())
            .field("two_sided", &self.two_sided)
            .finish()
    }
}
