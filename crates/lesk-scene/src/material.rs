//! Materials: a model, and where each of its parameters comes from.

use lesk_bsdf::Scatter;
use lesk_bsdf::model::Domain;
use lesk_bsdf::params::offset_of;
use lesk_geometry::{Detail, Surface};
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
    normal_map: Option<NormalMap>,
    needs_detail: bool,
    two_sided: bool,
    /// What the model says, looked up once.
    domain: Domain,
    count: usize,
    ior: Option<usize>,
    may_be_delta: bool,
}

/// A picture of normals in tangent space: red along growing u, green along growing v, blue outward.
#[derive(Clone, Debug)]
pub struct NormalMap {
    /// The picture, read as data.
    pub texture: Arc<Texture>,
    /// Factor of the slopes.
    pub strength: f32,
    /// Which set of texture coordinates it reads, 0 or 1.
    pub uv_set: usize,
    /// Rows of the affine map of the texture coordinates.
    pub uv: [[f32; 3]; 2],
}

impl NormalMap {
    /// The shading normal of a surface as a hit gave it: not turned to any viewer.
    pub fn normal(&self, surface: &Surface, detail: &Detail) -> Vec3<f32> {
        let [x, y, z] = self.texture.rgb(mapped(&self.uv, detail.uvs[self.uv_set])).map(|v| 2.0 * v - 1.0);
        surface.bent(detail, [x * self.strength, y * self.strength, z])
    }
}

/// An affine map of texture coordinates.
#[inline]
fn mapped(rows: &[[f32; 3]; 2], [u, v]: [f32; 2]) -> [f32; 2] {
    rows.map(|row| row[0] * u + row[1] * v + row[2])
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
    /// Which set of texture coordinates it reads, 0 or 1.
    pub uv_set: usize,
    /// Rows of the affine map of the texture coordinates.
    pub uv: [[f32; 3]; 2],
}

impl Binding {
    /// Writes the values at the texture coordinates into the flat table.
    fn read(&self, uvs: [[f32; 2]; 2], out: &mut [f32; MAX_PARAMS]) {
        let uv = mapped(&self.uv, uvs[self.uv_set]);
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
            normal_map: None,
            needs_detail: false,
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
        self.needs_detail |= binding.uv_set > 0;
        self.bindings.push(binding);
        self
    }

    /// The same material with a normal map.
    #[must_use]
    pub fn with_normal_map(mut self, map: NormalMap) -> Self {
        self.needs_detail = true;
        self.normal_map = Some(map);
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

    /// The normal map, where it has one.
    pub fn normal_map(&self) -> Option<&NormalMap> {
        self.normal_map.as_ref()
    }

    /// Whether it reads more of a surface than its first texture coordinates: then [`params_at`](Self::params_at) and
    /// [`normal_map`](Self::normal_map) want `World::detail`.
    #[inline]
    pub fn needs_detail(&self) -> bool {
        self.needs_detail
    }

    /// The model's flat parameter table at the texture coordinates, as `Scatter` takes it: the constants themselves, or a
    /// copy of them with what the textures say, written into `out`.
    #[inline]
    pub fn params<'a>(&'a self, uv: [f32; 2], out: &'a mut [f32; MAX_PARAMS]) -> &'a [f32] {
        self.params_at([uv; 2], out)
    }

    /// [`params`](Self::params) at texture coordinates of both sets.
    #[inline]
    pub fn params_at<'a>(&'a self, uvs: [[f32; 2]; 2], out: &'a mut [f32; MAX_PARAMS]) -> &'a [f32] {
        if self.bindings.is_empty() {
            return &self.constants[..self.count];
        }
        *out = self.constants;
        for binding in &self.bindings {
            binding.read(uvs, out);
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
            .field("normal_map", &self.normal_map.is_some())
            .field("two_sided", &self.two_sided)
            .finish()
    }
}
