//! Materials and their textures.

use super::super::{Alpha, Asset, Description, ImageSource, Material, MetallicRoughness, Texture, Wrap};
use super::container::Document;
use super::{Error, Result, element};
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::material::AlphaMode;
use ::gltf::json::material::NormalTexture;
use ::gltf::json::texture::{Info, MagFilter, WrappingMode};
use ::gltf::json::{self, validation::Checked};

/// Adds all materials, in the order of the file.
pub(super) fn add_materials(document: &Document<'_>, asset: &mut Asset) -> Result<()> {
    let mut images: Vec<Option<ImageSource>> = Vec::new();
    for index in 0..document.root.images.len() {
        // an image that nothing uses may be broken
        images.push(match document.image(index) {
            Ok(image) => Some(image),
            Err(e) => {
                asset.warn(format!("image {index}: {e}"));
                None
            }
        });
    }
    for (number, material) in document.root.materials.iter().enumerate() {
        let reader = Reader { document, images: &images };
        let name = material.name.clone().unwrap_or_default();
        let place = |e: Error| e.at(format!("material {number} `{}`", name.escape_debug()));
        let description = reader.read(material).map_err(place)?;
        asset.materials.push(Material { name, description: Description::MetallicRoughness(description) });
    }
    Ok(())
}

struct Reader<'a> {
    document: &'a Document<'a>,
    images: &'a [Option<ImageSource>],
}

impl Reader<'_> {
    fn read(&self, m: &json::Material) -> Result<MetallicRoughness> {
        let pbr = &m.pbr_metallic_roughness;
        let normal = m.normal_texture.as_ref();
        let extensions = m.extensions.as_ref();
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |s| s.emissive_strength.0);
        let out = MetallicRoughness {
            base_color: pbr.base_color_factor.0,
            base_color_texture: self.texture(&pbr.base_color_texture)?,
            metallic: pbr.metallic_factor.0,
            roughness: pbr.roughness_factor.0,
            metallic_roughness_texture: self.texture(&pbr.metallic_roughness_texture)?,
            emissive: m.emissive_factor.0.map(|x| x * strength),
            emissive_texture: self.texture(&m.emissive_texture)?,
            normal_texture: normal.map(|n| self.normal_texture(n)).transpose()?.flatten(),
            normal_scale: normal.map_or(1.0, |n| n.scale),
            alpha: match m.alpha_mode {
                Checked::Valid(AlphaMode::Mask) => Alpha::Mask(m.alpha_cutoff.map_or(0.5, |c| c.0)),
                Checked::Valid(AlphaMode::Blend) => Alpha::Blend,
                Checked::Valid(AlphaMode::Opaque) => Alpha::Opaque,
                Checked::Invalid => return Err(Error::new("its alpha mode is unknown")),
            },
            double_sided: m.double_sided,
            ior: extensions.and_then(|e| e.ior.as_ref()).map_or(1.5, |i| i.ior.0),
            transmission: extensions.and_then(|e| e.transmission.as_ref()).map_or(0.0, |t| t.transmission_factor.0),
            solid: extensions.and_then(|e| e.volume.as_ref()).is_some_and(|v| v.thickness_factor.0 > 0.0),
        };
        check(&out)?;
        Ok(out)
    }

    fn texture(&self, info: &Option<Info>) -> Result<Option<Texture>> {
        let Some(info) = info else { return Ok(None) };
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        self.transformed(info.index.value(), info.tex_coord, transform)
    }

    fn normal_texture(&self, normal: &NormalTexture) -> Result<Option<Texture>> {
        let stated = normal.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
        let transform = stated.map(|value| json::deserialize::from_value::<TextureTransform>(value.clone()));
        let transform = transform.transpose().map_err(|e| Error::new(format!("KHR_texture_transform: {e}")))?;
        self.transformed(normal.index.value(), normal.tex_coord, transform.as_ref())
    }

    fn transformed(&self, index: usize, uv_set: u32, transform: Option<&TextureTransform>) -> Result<Option<Texture>> {
        let texture = self.indexed(index, transform.and_then(|t| t.tex_coord).unwrap_or(uv_set))?;
        Ok(texture.map(|texture| match transform {
            Some(t) => Texture { uv: upward(t.scale.0, t.rotation.0, t.offset.0), ..texture },
            None => texture,
        }))
    }

    /// `None` for a texture whose image is broken, of which a warning tells.
    fn indexed(&self, index: usize, uv_set: u32) -> Result<Option<Texture>> {
        let texture = element(&self.document.root.textures, index, "texture")?;
        let sampler = match texture.sampler {
            Some(s) => Some(element(&self.document.root.samplers, s.value(), "sampler")?),
            None => None,
        };
        let wrap = |mode: &Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let Some(image) = element(self.images, texture.source.value(), "image")? else { return Ok(None) };
        if uv_set > 1 {
            return Err(Error::new(format!("texture {index} uses texture coordinates {uv_set}"))
                .hint("the sets 0 and 1 are accepted"));
        }
        Ok(Some(Texture {
            image: image.clone(),
            uv_set: uv_set as usize,
            uv: IDENTITY,
            wrap: sampler.map_or([Wrap::Repeat; 2], |s| [wrap(&s.wrap_s), wrap(&s.wrap_t)]),
            smooth: sampler.is_none_or(|s| s.mag_filter != Some(Checked::Valid(MagFilter::Nearest))),
        }))
    }
}

const IDENTITY: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// The map of `KHR_texture_transform`, T R S of its text, between coordinates whose v runs upward: the file's run
/// downward, so that it is turned over before and after.
fn upward(scale: [f32; 2], rotation: f32, offset: [f32; 2]) -> [[f32; 3]; 2] {
    let (sin, cos) = rotation.sin_cos();
    // u' = su cos u + sv sin v + ou, v' = -su sin u + sv cos v + ov, with v = 1 - v_up and v'_up = 1 - v'
    let [su, sv] = scale;
    [[su * cos, -sv * sin, sv * sin + offset[0]], [su * sin, sv * cos, 1.0 - sv * cos - offset[1]]]
}

/// Refuses factors out of the ranges of the specification.
fn check(m: &MetallicRoughness) -> Result<()> {
    let within = |what: &str, x: f32, low: f32, high: f32| {
        if (low..=high).contains(&x) {
            Ok(())
        } else {
            Err(Error::new(format!("`{what}` is {x}, {low} to {high} is accepted")))
        }
    };
    for x in m.base_color {
        within("baseColorFactor", x, 0.0, 1.0)?;
    }
    for x in m.emissive {
        within("emissiveFactor", x, 0.0, f32::MAX)?;
    }
    within("metallicFactor", m.metallic, 0.0, 1.0)?;
    within("roughnessFactor", m.roughness, 0.0, 1.0)?;
    within("transmissionFactor", m.transmission, 0.0, 1.0)?;
    within("normalTexture.scale", m.normal_scale, -f32::MAX, f32::MAX)?;
    // 0 stands for a metal-like limit of the extension
    if m.ior != 0.0 {
        within("ior", m.ior, 1.0, 100.0)?;
    }
    Ok(())
}
