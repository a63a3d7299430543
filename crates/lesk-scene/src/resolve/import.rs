//! Meshes of other programs, with their materials and lights.

use super::Resolver;
use super::files::Reading;
use super::objects::{Part, about};
use crate::description::{
    MaterialDescription, NormalMapDescription, Normals, ObjectDescription, Picture, TextureDescription,
};
use crate::error::Place;
use lesk_geometry::Transform;
use lesk_geometry::import::{
    Alpha, Asset, Description, ImageSource, LightKind, MetallicRoughness, Mtl, Texture, Wrap as AssetWrap,
};
use lesk_image::texture::{Channel, Interpolation, Role, Wrap};
use lesk_light::{Area, Directional, EmissionMap, Light, LightError, Point, Spot, rec709};
use lesk_math::{Color, Vec3, vec3};
use std::path::Path;

/// What a material of a file became.
#[derive(Clone)]
struct Imported {
    material: Option<u32>,
    /// Luminance that it emits, cd/m², and the picture that multiplies it.
    emission: [f32; 3],
    emission_map: Option<TextureDescription>,
    two_sided: bool,
}

impl Resolver<'_> {
    /// Places everything of a file.
    pub(super) fn file(
        &mut self,
        d: &ObjectDescription,
        file: &Path,
        normals: Normals,
        transform: Transform,
        material: Option<u32>,
    ) {
        let asset = self.files.asset(file);
        let Some((path, asset)) = self.check(d.place, &about(&d.name), asset) else { return };
        asset.warnings.iter().for_each(|w| self.note(format!("{}: {w}", path.display())));
        let imported = self.imported(&path, &asset, material, d.place);
        for placed in &asset.instances {
            let mesh = &asset.meshes[placed.mesh];
            let own = mesh.material.and_then(|i| imported.get(i));
            let number = material.or(own.and_then(|own| own.material));
            if number.is_none() && d.light.is_none() {
                let name = path.display();
                let text =
                    format!("mesh `{}` of `{name}` has no material\nhint: give the object a `material`", mesh.name);
                self.check::<(), _>(d.place, "", Err(text));
                return;
            }
            let part = Part {
                name: if placed.name.is_empty() { &d.name } else { &placed.name },
                geometry: self.mesh(&mesh.mesh, normals, self.tangent_set(number)),
                transform: transform * placed.world_from_local,
                material: number,
                place: d.place,
            };
            match own.filter(|own| material.is_none() && d.light.is_none() && own.emission != [0.0; 3]) {
                Some(own) => self.glowing(part, own, d.place),
                None => self.instance(part, d),
            }
        }
        for light in &asset.lights {
            self.file_light(light, &path, &transform, d.place);
        }
    }

    fn glowing(&mut self, part: Part, own: &Imported, place: Place) {
        let luminance = rec709(own.emission);
        let area = match &own.emission_map {
            Some(d) => self.mapped(&part, d, luminance, own.two_sided, place),
            None => {
                let area = Area::new(self.geometry(part.geometry), &part.transform, luminance, own.two_sided);
                self.check(place, &about(part.name), area)
            }
        };
        let Some(area) = area else { return };
        self.instance_with(part, Some(area));
    }

    /// A light with a picture on it.
    pub(super) fn mapped(
        &mut self,
        part: &Part,
        d: &TextureDescription,
        luminance: Color<f32>,
        two_sided: bool,
        place: Place,
    ) -> Option<Area> {
        let reading = Reading { role: Role::Color, srgb: d.srgb, wrap: d.wrap, interpolation: d.interpolation };
        let loaded = self.files.texture(&d.image, reading);
        let loaded = self.check(place, &about(part.name), loaded)?;
        let geometry = self.geometry(part.geometry);
        let mapped = EmissionMap::new(loaded.texture, geometry, &part.transform, d.uv_set, d.uv)
            .and_then(|map| Area::mapped(map, luminance, two_sided));
        self.check(place, &about(part.name), mapped)
    }

    /// The materials of a file as materials of the scene, made once per file.
    fn imported(&mut self, path: &Path, asset: &Asset, material: Option<u32>, place: Place) -> Vec<Imported> {
        let file = path.display().to_string();
        let mut out = Vec::new();
        for (i, m) in asset.materials.iter().enumerate() {
            let name = if m.name.is_empty() { format!("{file}#{i}") } else { format!("{file}#{}", m.name) };
            let (description, emission, two_sided) = match &m.description {
                Description::Mtl(mtl) => (self.mtl(&name, mtl), mtl.ke, false),
                Description::MetallicRoughness(mr) => {
                    (self.metallic_roughness(&name, mr), mr.emissive, mr.double_sided)
                }
            };
            let emission_map = match &m.description {
                Description::Mtl(mtl) => mtl.map_ke.as_ref(),
                Description::MetallicRoughness(mr) => mr.emissive_texture.as_ref(),
            };
            let emission_map = emission_map.map(texture);
            // an override needs none of the file's materials
            let number = if material.is_none() { self.imported_material(&name, description, place) } else { None };
            out.push(Imported { material: number, emission, emission_map, two_sided });
        }
        out
    }

    fn imported_material(&mut self, name: &str, mut d: MaterialDescription, place: Place) -> Option<u32> {
        if let Some(known) = self.material_names.get(name) {
            return *known;
        }
        d.place = place;
        d.params.iter_mut().for_each(|(_, _, p)| *p = place);
        let number = self.material(&d).map(|m| self.add_material(m));
        self.material_names.insert(name.to_string(), number);
        number
    }

    fn mtl(&mut self, name: &str, mtl: &Mtl) -> MaterialDescription {
        if mtl.d < 1.0 {
            self.note(format!("material `{name}`: opacity {} is ignored, the surface is opaque", mtl.d));
        }
        let (kd, ks) = (mtl.kd.map(unit), mtl.ks.map(unit));
        if ks == [0.0; 3] && mtl.map_ks.is_none() {
            return with_image(MaterialDescription::new(name, "lambert"), "reflectance", kd, mtl.map_kd.as_ref());
        }
        // both together may not reflect more than arrives
        let most = (0..3).map(|c| kd[c] + ks[c]).fold(1.0, f64::max);
        if most > 1.0 {
            self.note(format!("material `{name}`: Kd + Ks is {most:.3}, both are divided by it"));
        }
        let m =
            MaterialDescription::new(name, "modified_phong").set("shininess", &[f64::from(mtl.ns).clamp(1.0, 1000.0)]);
        let m = with_image(m, "diffuse", kd.map(|v| v / most), mtl.map_kd.as_ref());
        with_image(m, "specular", ks.map(|v| v / most), mtl.map_ks.as_ref())
    }

    fn metallic_roughness(&mut self, name: &str, mr: &MetallicRoughness) -> MaterialDescription {
        if mr.alpha != Alpha::Opaque {
            self.note(format!("material `{name}`: opacity is ignored, the surface is opaque"));
        }
        if mr.transmission > 0.0 && mr.solid {
            return self.glass(name, mr);
        }
        if mr.transmission > 0.0 {
            let share = mr.transmission;
            self.note(format!(
                "material `{name}`: transmission {share} of a thin sheet is ignored, the surface is opaque"
            ));
        }
        if mr.ior != 1.5 {
            self.note(format!("material `{name}`: index of refraction {} is ignored, the model has 1.5", mr.ior));
        }
        let [r, g, b, _] = mr.base_color.map(unit);
        let mut m = MaterialDescription::new(name, "metallic_roughness");
        m = with_image(m, "base_color", [r, g, b], mr.base_color_texture.as_ref());
        let image = mr.metallic_roughness_texture.as_ref();
        // roughness is in green, metalness in blue
        for (param, factor, channel) in
            [("metallic", mr.metallic, Channel::Blue), ("roughness", mr.roughness, Channel::Green)]
        {
            m = match image {
                None => m.set(param, &[unit(factor)]),
                Some(image) => {
                    let mut t = texture(image);
                    (t.channel, t.scale) = (channel, [unit(factor); 3]);
                    m.texture(param, t)
                }
            };
        }
        m.normal_map = normal_map(mr);
        m
    }

    /// A body of clear glass: what `KHR_materials_transmission` and `KHR_materials_volume` describe, without colour.
    fn glass(&mut self, name: &str, mr: &MetallicRoughness) -> MaterialDescription {
        let [r, g, b, _] = mr.base_color;
        if mr.transmission < 1.0 || mr.metallic > 0.0 || [r, g, b] != [1.0; 3] || mr.base_color_texture.is_some() {
            self.note(format!(
                "material `{name}`: taken as clear glass, colour and what it does not transmit are ignored"
            ));
        }
        let ior = f64::from(mr.ior).clamp(1.001, 4.0);
        let alpha = f64::from(mr.roughness * mr.roughness);
        // below, the lobe is narrower than rough_dielectric accepts
        let mut m = if alpha < 1e-3 {
            MaterialDescription::new(name, "dielectric")
        } else {
            MaterialDescription::new(name, "rough_dielectric").set("alpha_x", &[alpha]).set("alpha_y", &[alpha])
        };
        m = m.set("ior", &[ior]);
        m.normal_map = normal_map(mr);
        m
    }

    fn file_light(&mut self, d: &lesk_geometry::import::Light, path: &Path, transform: &Transform, place: Place) {
        if d.intensity == 0.0 || d.color == [0.0; 3] {
            return;
        }
        let world = *transform * d.world_from_local;
        let position = world.point(Vec3::ZERO);
        let direction = world.vector(vec3(0.0, 0.0, -1.0));
        let value = rec709(d.color.map(|c| c * d.intensity));
        let light: Result<Light, LightError> = match d.kind {
            LightKind::Point => Point::new(position, value).map(Light::Point),
            LightKind::Directional => Directional::new(direction, value).map(Light::Directional),
            LightKind::Spot { inner, outer } => {
                Spot::new(position, direction, value, [f64::from(inner), f64::from(outer)]).map(Light::Spot)
            }
        };
        let about = format!("light `{}` of `{}`", d.name, path.display());
        if let Some(light) = self.check(place, &about, light) {
            self.lights.push(light);
        }
    }
}

fn normal_map(mr: &MetallicRoughness) -> Option<NormalMapDescription> {
    mr.normal_texture.as_ref().map(|image| NormalMapDescription {
        texture: texture(image),
        strength: mr.normal_scale.into(),
        place: Place::NONE,
    })
}

/// A factor of a file within 0 to 1.
fn unit(v: f32) -> f64 {
    f64::from(v).clamp(0.0, 1.0)
}

fn with_image(m: MaterialDescription, name: &str, factor: [f64; 3], image: Option<&Texture>) -> MaterialDescription {
    match image {
        None => m.set(name, &factor),
        Some(image) => {
            let mut t = texture(image);
            t.scale = factor;
            m.texture(name, t)
        }
    }
}

fn texture(image: &Texture) -> TextureDescription {
    let picture = match &image.image {
        ImageSource::File(path) => Picture::File(path.clone()),
        ImageSource::Embedded { bytes, .. } => Picture::Encoded(bytes.clone()),
    };
    let wrap = |w| match w {
        AssetWrap::Repeat => Wrap::Repeat,
        AssetWrap::Mirror => Wrap::Mirror,
        AssetWrap::Clamp => Wrap::Clamp,
    };
    let mut t = TextureDescription::new(picture);
    t.wrap = image.wrap.map(wrap);
    t.interpolation = if image.smooth { Interpolation::Bilinear } else { Interpolation::Nearest };
    (t.uv_set, t.uv) = (image.uv_set, image.uv);
    t
}
