//! Objects, groups and transforms of a scene file.

use super::fields::{Expected, Fields, Problems};
use super::lights::area_light;
use super::node::{Data, Entry, Node};
use crate::description::{GroupDescription, Normals, ObjectDescription, Shape};
use crate::error::Problem;
use crate::schema::{GROUP, LOOK_AT, OBJECT, STEP};
use lesk_geometry::Transform;
use lesk_math::Vec3;
use std::f64::consts::PI;

pub(super) fn group(entry: &Entry, problems: &mut Problems) -> GroupDescription {
    let name = format!("group `{}`", crate::error::shown(&entry.key));
    let fields = Fields::of(&entry.node, &Expected::plain(&name, GROUP), problems);
    let nodes = fields.map_or(&[][..], |f| f.list("objects"));
    let objects = nodes.iter().filter_map(|n| object(n, problems)).collect();
    GroupDescription { name: entry.key.clone(), objects, place: entry.place }
}

pub(super) fn object(node: &Node, problems: &mut Problems) -> Option<ObjectDescription> {
    let (kind, fields) = Fields::variant(node, &OBJECT, problems)?;
    let light = fields.node("light").map(|n| area_light(n, problems));
    let transform = transform(&fields, problems);
    let mut object = ObjectDescription::new(shape(kind, &fields, problems)?);
    object.name = fields.text("name").unwrap_or_default().to_string();
    object.material = fields.text("material").map(str::to_string);
    object.transform = transform?;
    object.light = match light {
        Some(light) => Some(light?),
        None => None,
    };
    // a mistake is best marked at the line that names the file or the material
    let marked = ["file", "group", "material"].into_iter().find(|n| fields.has(n));
    object.place = marked.map_or(fields.place, |n| fields.place_of(n));
    Some(object)
}

fn shape(kind: &str, fields: &Fields, problems: &mut Problems) -> Option<Shape> {
    // an extent that is there but faulty has been reported: the object is left out
    let extent = |name: &str| if fields.has(name) { fields.si(name) } else { Some(1.0) };
    Some(match kind {
        "sphere" => Shape::Sphere { radius: extent("radius")? },
        "disk" => Shape::Disk { radius: extent("radius")? },
        "rectangle" => Shape::Rectangle { size: [extent("width")?, extent("height")?] },
        "cube" => match fields.one_of(&["edge", "size"], problems) {
            Some("size") => Shape::Cube { size: fields.numbers("size")? },
            _ => Shape::Cube { size: [extent("edge")?; 3] },
        },
        "cylinder" => Shape::Cylinder {
            radius: extent("radius")?,
            height: extent("height")?,
            capped: fields.bool("capped").unwrap_or(true),
        },
        "teapot" => {
            let level = if fields.has("level") { fields.integer("level")? } else { 16 };
            Shape::Teapot { level: level as u32 }
        }
        "group" => Shape::Group(fields.text("group")?.to_string()),
        _ => {
            let normals = match fields.text("normals") {
                Some("smooth") => Normals::Smooth,
                Some("flat") => Normals::Flat,
                _ => Normals::File,
            };
            Shape::File { file: fields.text("file")?.into(), normals }
        }
    })
}

/// All steps under the key `transform`, the first one applied first.
pub(super) fn transform(fields: &Fields, problems: &mut Problems) -> Option<Transform> {
    let Some(node) = fields.node("transform") else {
        return if fields.has("transform") { None } else { Some(Transform::IDENTITY) };
    };
    let steps = match &node.data {
        Data::List(nodes) => nodes.as_slice(),
        _ => std::slice::from_ref(node),
    };
    let made: Vec<Option<Transform>> = steps.iter().map(|n| step(n, problems)).collect();
    let mut all = Transform::IDENTITY;
    for step in made {
        all = step? * all;
    }
    if !all.rows().iter().flatten().all(|x| x.is_finite()) {
        problems.add(Problem::new(node.place, "`transform` is not finite when its steps are put together"));
        return None;
    }
    Some(all)
}

fn step(node: &Node, problems: &mut Problems) -> Option<Transform> {
    let fields = Fields::of(node, &Expected::plain("transform", STEP), problems)?;
    let names = ["translate", "rotate", "scale", "look_at", "matrix"];
    let Some(kind) = fields.one_of(&names, problems) else {
        let text = "step of `transform` says nothing, one of `translate`, `rotate`, `scale`, `look_at` or `matrix` is accepted";
        problems.add(Problem::new(fields.place, text));
        return None;
    };
    if fields.has("axis") && kind != "rotate" {
        let text = "`axis` goes with `rotate` only";
        problems.add(Problem::new(fields.place_of("axis"), text));
    }
    let made = match kind {
        "translate" => {
            let [x, y, z] = fields.numbers("translate")?;
            Ok(Transform::translate(x, y, z))
        }
        "rotate" => {
            let axis = if fields.has("axis") { fields.numbers("axis")? } else { [0.0, 0.0, 1.0] };
            Transform::rotate(Vec3::from(axis), fields.si("rotate")?)
        }
        "scale" => {
            let [x, y, z] = fields.numbers("scale")?;
            Transform::scale(x, y, z)
        }
        "look_at" => {
            let inner = Fields::of(fields.node("look_at")?, &Expected::plain("look_at", LOOK_AT), problems)?;
            let up = if inner.has("up") { inner.numbers("up")? } else { [0.0, 0.0, 1.0] };
            let [from, to, up] = [inner.numbers("from")?, inner.numbers("to")?, up].map(Vec3::from);
            // a camera looks along -z; an object shows its +z
            Transform::look_at(from, to, up).map(|t| t * Transform::rotate_y(PI))
        }
        _ => Transform::from_rows(fields.rows("matrix")?),
    };
    made.map_err(|e| problems.add(Problem::from_text(fields.place_of(kind), &e.to_string()))).ok()
}
