//! Materials of a scene file.

use super::fields::{Expected, Fields, Problems, real};
use super::node::{Data, Entry, Node};
use crate::description::{MaterialDescription, NormalMapDescription, Picture, Source, TextureDescription};
use crate::error::{Problem, list};
use crate::schema::{LIGHT_TEXTURE, MATERIAL_COMMON, NORMAL_MAP, TEXTURE};
use lesk_bsdf::registry;
use lesk_image::texture::{Channel, Interpolation, Role, Wrap};

/// The model of a material that states none that is known: keeps its name, so that objects can use it.
const STAND_IN: &str = "lambert";

pub(super) fn material(entry: &Entry, problems: &mut Problems) -> MaterialDescription {
    let mut material = MaterialDescription::new(&entry.key, STAND_IN);
    material.place = entry.place;
    let name = format!("material `{}`", crate::error::shown(&entry.key));
    let Some(entries) = entry.node.entries() else {
        let text = format!("{name} is {}, a table is accepted", entry.node.shown());
        problems.add(Problem::new(entry.node.place, text));
        return material;
    };
    match entries.iter().find(|e| e.key == "model").map(|e| (&e.node.data, e.node.place)) {
        Some((Data::Text(model), place)) => {
            material.model = model.clone();
            material.place = place;
        }
        other => {
            let known: Vec<&str> = registry::all().map(|m| m.id()).collect();
            let what = if other.is_some() { "has a `model` that is no text" } else { "has no `model`" };
            let text = format!("{name} {what}, one of {} is accepted", list(&known));
            problems.add(Problem::new(other.map_or(entry.place, |(_, place)| place), text));
            return material;
        }
    }
    for e in entries.iter().filter(|e| e.key != "model") {
        if e.key == "normal_map" {
            material.normal_map = normal_map(&e.node, problems);
        } else if let Some(field) = MATERIAL_COMMON.iter().find(|f| f.name == e.key) {
            match super::fields::check(field, &e.node) {
                Ok(super::fields::Checked::Bool(two_sided)) => material.two_sided = two_sided,
                Ok(_) => {}
                Err(problem) => problems.add(problem),
            }
        } else if let Some(source) = source(&e.key, &e.node, problems) {
            material.params.push((e.key.clone(), source, e.node.place));
        }
    }
    material
}

/// A number, three numbers, or a table of a texture.
fn source(name: &str, node: &Node, problems: &mut Problems) -> Option<Source> {
    let values = match &node.data {
        Data::Table(_) => return texture(node, problems).map(Source::Texture),
        Data::List(nodes) => nodes.iter().map(real).collect::<Option<Vec<f64>>>(),
        _ => real(node).map(|x| vec![x]),
    };
    if let Some(values) = values.filter(|v| (1..=3).contains(&v.len())) {
        return Some(Source::Constant(values));
    }
    let name = crate::error::shown(name);
    let text = format!("`{name}` is {}, a number, three numbers or a texture is accepted", node.shown());
    problems.add(Problem::new(node.place, text).hint("a texture is `{ file = \"wood.png\" }`"));
    None
}

fn texture(node: &Node, problems: &mut Problems) -> Option<TextureDescription> {
    let fields = Fields::of(node, &Expected::plain("texture", TEXTURE), problems)?;
    let mut t = TextureDescription::new(Picture::File(fields.text("file")?.into()));
    t.role = fields.text("role").map(|r| if r == "color" { Role::Color } else { Role::Data });
    t.srgb = fields.text("color_space").map(|c| c == "srgb");
    t.channel = fields.text("channel").and_then(|c| c.parse().ok()).unwrap_or(Channel::Red);
    t.scale = fields.numbers("scale").unwrap_or(t.scale);
    t.offset = fields.number("offset").unwrap_or(t.offset);
    lay(&fields, &mut t);
    Some(t)
}

fn normal_map(node: &Node, problems: &mut Problems) -> Option<NormalMapDescription> {
    let fields = Fields::of(node, &Expected::plain("normal map", NORMAL_MAP), problems)?;
    let mut texture = TextureDescription::new(Picture::File(fields.text("file")?.into()));
    lay(&fields, &mut texture);
    Some(NormalMapDescription { texture, strength: fields.number("strength").unwrap_or(1.0), place: node.place })
}

/// The picture on a light.
pub(super) fn light_texture(node: &Node, problems: &mut Problems) -> Option<TextureDescription> {
    let fields = Fields::of(node, &Expected::plain("light texture", LIGHT_TEXTURE), problems)?;
    let mut texture = TextureDescription::new(Picture::File(fields.text("file")?.into()));
    texture.srgb = fields.text("color_space").map(|c| c == "srgb");
    lay(&fields, &mut texture);
    Some(texture)
}

/// How a picture is laid over a surface.
fn lay(fields: &Fields, t: &mut TextureDescription) {
    t.wrap = match fields.text("wrap") {
        Some("mirror") => [Wrap::Mirror; 2],
        Some("clamp") => [Wrap::Clamp; 2],
        _ => [Wrap::Repeat; 2],
    };
    if fields.text("interpolation") == Some("nearest") {
        t.interpolation = Interpolation::Nearest;
    }
    let pair = |name: &str, usual: [f32; 2]| fields.numbers(name).map_or(usual, |v: [f64; 2]| v.map(|x| x as f32));
    let ([su, sv], [ou, ov]) = (pair("uv_scale", [1.0; 2]), pair("uv_offset", [0.0; 2]));
    t.uv = [[su, 0.0, ou], [0.0, sv, ov]];
}
