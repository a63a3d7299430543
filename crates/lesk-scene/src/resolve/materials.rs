//! Materials: models by name, parameters by name, textures.

use super::Resolver;
use super::files::{Loaded, Reading};
use crate::description::{MaterialDescription, NormalMapDescription, Source, TextureDescription};
use crate::error::{Place, Problem, list, name_hint};
use crate::material::{Binding, MAX_PARAMS, Material, NormalMap};
use lesk_bsdf::params::{Kind, ParamSpec, defaults, offset_of};
use lesk_bsdf::{Scatter, registry};
use lesk_image::Transfer;
use lesk_image::texture::Role;
use lesk_image::tonemap::srgb_decode;
use lesk_light::rec709;

impl Resolver<'_> {
    pub(super) fn materials(&mut self) {
        for d in &self.description.materials {
            let known = self.material_names.contains_key(&d.name);
            if known {
                self.problem(Problem::new(d.place, format!("material `{}` is there twice", d.name)));
            }
            let material = self.material(d);
            let number = material.map(|m| self.add_material(m));
            self.material_names.entry(d.name.clone()).or_insert(number);
        }
    }

    pub(super) fn add_material(&mut self, material: Material) -> u32 {
        self.materials.push(material);
        self.materials.len() as u32 - 1
    }

    /// The material, or `None` with its problems kept.
    pub(super) fn material(&mut self, d: &MaterialDescription) -> Option<Material> {
        let model = self.model(&d.model, d.place)?;
        let specs = model.specs();
        if model.param_count() > MAX_PARAMS {
            let text =
                format!("model `{}` has {} parameters, up to {MAX_PARAMS} can be used", d.model, model.param_count());
            self.problem(Problem::new(d.place, text));
            return None;
        }
        let before = self.problems.len();
        let mut table: Vec<f32> = defaults(specs).into_iter().map(|v| v as f32).collect();
        let mut bindings = Vec::new();
        for (name, source, place) in &d.params {
            let Some((spec, entry)) = self.param(model, name, *place) else { continue };
            match source {
                Source::Constant(values) => {
                    if let Some(values) = self.constant(model, spec, values, *place) {
                        table[entry..entry + values.len()].copy_from_slice(&values);
                    }
                }
                Source::Texture(texture) => {
                    let about = format!("material `{}`: `{name}`", d.name);
                    bindings.extend(self.binding(&about, texture, spec, entry, *place));
                }
            }
        }
        let normal_map = d.normal_map.as_ref().and_then(|map| self.normal_map(&d.name, map));
        if self.problems.len() > before {
            return None;
        }
        let material = Material::new(&d.name, model, &table, d.two_sided);
        let material = bindings.into_iter().fold(material, Material::with);
        Some(normal_map.into_iter().fold(material, Material::with_normal_map))
    }

    fn normal_map(&mut self, name: &str, d: &NormalMapDescription) -> Option<NormalMap> {
        let t = &d.texture;
        let reading = Reading { role: Role::Data, srgb: None, wrap: t.wrap, interpolation: t.interpolation };
        let about = format!("material `{name}`: `normal_map`");
        let loaded = self.files.texture(&t.image, reading);
        let texture = self.check(d.place, &about, loaded)?.texture;
        if texture.channels() < 3 {
            let text = format!("{about}: the picture has {} channels, three are needed", texture.channels());
            self.problem(Problem::new(d.place, text));
            return None;
        }
        Some(NormalMap { texture, strength: d.strength as f32, uv_set: t.uv_set, uv: t.uv })
    }

    fn model(&mut self, id: &str, place: Place) -> Option<&'static dyn Scatter> {
        let found = registry::find(id);
        if found.is_none() {
            let known: Vec<&str> = registry::all().map(|m| m.id()).collect();
            self.problem(
                Problem::new(place, format!("unknown model `{id}`, accepted are {}", list(&known)))
                    .hint(name_hint(id, &known)),
            );
        }
        found
    }

    fn param(&mut self, model: &'static dyn Scatter, name: &str, place: Place) -> Option<(&'static ParamSpec, usize)> {
        let specs = model.specs();
        let found = specs.iter().find(|spec| spec.name == name).zip(offset_of(specs, name));
        if found.is_none() {
            let known: Vec<&str> = specs.iter().map(|s| s.name).collect();
            let text = format!("model `{}` has no parameter `{name}`, it has {}", model.id(), list(&known));
            let hint = if name.contains("roughness") && known.iter().any(|k| k.starts_with("alpha")) {
                "`alpha` is a slope width; from a perceptual roughness r use alpha = r * r".to_string()
            } else {
                name_hint(name, &known)
            };
            self.problem(Problem::new(place, text).hint(hint));
        }
        found
    }

    /// The values for the flat table: a colour may be one number, which is grey.
    fn constant(
        &mut self,
        model: &'static dyn Scatter,
        spec: &ParamSpec,
        values: &[f64],
        place: Place,
    ) -> Option<Vec<f32>> {
        let accepted = match spec.kind {
            Kind::Scalar => "one number is accepted",
            Kind::Color => "one number, or three for red, green and blue, are accepted",
        };
        let fits = values.len() == 1 || values.len() == 3 && spec.kind == Kind::Color;
        if !fits {
            let text = format!("`{}` has {} numbers, {accepted}", spec.name, values.len());
            self.problem(Problem::new(place, text));
            return None;
        }
        let [low, high] = spec.range;
        if let Some(bad) = values.iter().find(|v| !(low..=high).contains(*v)) {
            let text = format!("`{}` is {bad}, but model `{}` accepts {low} to {high}", spec.name, model.id());
            self.problem(Problem::new(place, text));
            return None;
        }
        let narrow = |v: f64| (v as f32).clamp(low as f32, high as f32);
        Some(match *values {
            [r, g, b] => rec709([r, g, b].map(narrow)).0.to_vec(),
            _ => vec![narrow(values[0]); spec.len()],
        })
    }

    fn binding(
        &mut self,
        about: &str,
        d: &TextureDescription,
        spec: &ParamSpec,
        entry: usize,
        place: Place,
    ) -> Option<Binding> {
        if !d.scale.iter().chain([&d.offset]).all(|v| v.is_finite() && v.abs() < 1e9) {
            self.problem(Problem::new(place, format!("{about}: scale and offset must be finite")));
            return None;
        }
        let usual = if spec.kind == Kind::Color { Role::Color } else { Role::Data };
        let role = d.role.unwrap_or(usual);
        let reading = Reading { role, srgb: d.srgb, wrap: d.wrap, interpolation: d.interpolation };
        let loaded = self.files.texture(&d.image, reading);
        let loaded = self.check(place, about, loaded)?;
        let binding = Binding {
            entry,
            len: spec.len(),
            texture: loaded.texture.clone(),
            channel: d.channel,
            scale: d.scale.map(|s| s as f32),
            offset: d.offset as f32,
            range: spec.range.map(|v| v as f32),
            uv_set: d.uv_set,
            uv: d.uv,
        };
        let repaired = loaded.texture.repaired();
        if repaired > 0 {
            self.note(format!("{about}: {repaired} numbers of the texture are not finite and count as 0"));
        }
        let outside = count_outside(&loaded, role, &binding);
        if outside > 0 {
            let [low, high] = spec.range;
            let (w, h) = loaded.texture.size();
            let all = u64::from(w) * u64::from(h);
            self.note(format!("{about}: {outside} of {all} texels lie outside {low} to {high} and are clamped"));
        }
        Some(binding)
    }
}

/// How many texels give a value outside the legal range.
fn count_outside(loaded: &Loaded, role: Role, binding: &Binding) -> u64 {
    let decode = role == Role::Color && loaded.image.transfer() == Transfer::Srgb;
    let value = |texel: f32, c: usize| {
        let texel = if !texel.is_finite() {
            0.0
        } else if decode {
            srgb_decode(texel)
        } else {
            texel
        };
        texel * binding.scale[c] + binding.offset
    };
    let legal = binding.range[0]..=binding.range[1];
    let used = if binding.len == 1 { 1 } else { 3 };
    let outside = |rgb: &[f32; 3]| !(0..used).all(|c| legal.contains(&value(rgb[c], c)));
    if used == 3 {
        return loaded.image.rgb_pixels().filter(|rgb| outside(rgb)).count() as u64;
    }
    let (w, h) = loaded.texture.size();
    let at = |x: u32, y: u32| {
        let uv = [(x as f32 + 0.5) / w as f32, 1.0 - (y as f32 + 0.5) / h as f32];
        loaded.texture.scalar(uv, binding.channel) * binding.scale[0] + binding.offset
    };
    (0..h).map(|y| (0..w).filter(|&x| !legal.contains(&at(x, y))).count() as u64).sum()
}
