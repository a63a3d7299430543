//! `[raster]`: how a scene is rasterised.

use super::fields::{Expected, Fields, Problems};
use super::node::Node;
use crate::error::Problem;
use crate::raster::{Classic, ClassicLight, RasterSettings, check_color};
use crate::schema::{CLASSIC, CLASSIC_LIGHT};
use lesk_geometry::EdgeRule;
use std::str::FromStr;

pub(super) fn settings(settings: &mut RasterSettings, fields: &Fields, problems: &mut Problems) {
    fn choose<T: FromStr>(value: &mut T, fields: &Fields, name: &str) {
        if let Some(chosen) = fields.text(name).and_then(|text| text.parse().ok()) {
            *value = chosen;
        }
    }
    choose(&mut settings.shading, fields, "shading");
    choose(&mut settings.interpolation, fields, "interpolation");
    choose(&mut settings.correction, fields, "correction");
    choose(&mut settings.normals, fields, "normals");
    choose(&mut settings.flat_point, fields, "flat_point");
    choose(&mut settings.space, fields, "space");
    settings.edges = fields.si("crease_angle").map_or(settings.edges, EdgeRule::Crease);
    for (name, value) in [
        ("tessellation", &mut settings.tessellation),
        ("subdivide", &mut settings.subdivide),
        ("supersampling", &mut settings.supersampling),
        ("quadrature", &mut settings.quadrature),
    ] {
        *value = fields.integer(name).map_or(*value, |i| i as u32);
    }
    for (name, value) in
        [("renormalize", &mut settings.renormalize), ("shadows", &mut settings.shadows), ("cull", &mut settings.cull)]
    {
        *value = fields.bool(name).unwrap_or(*value);
    }
    settings.classic = fields.node("classic").and_then(|node| classic(node, problems));
}

fn classic(node: &Node, problems: &mut Problems) -> Option<Classic> {
    let fields = Fields::of(node, &Expected::plain("classic", CLASSIC), problems)?;
    let mut model = Classic::default();
    for (name, value) in
        [("ambient", &mut model.ambient), ("diffuse", &mut model.diffuse), ("specular", &mut model.specular)]
    {
        *value = color(&fields, name, *value, problems);
    }
    for (name, value) in
        [("ka", &mut model.ka), ("kd", &mut model.kd), ("ks", &mut model.ks), ("shininess", &mut model.shininess)]
    {
        *value = fields.number(name).map_or(*value, |x| x as f32);
    }
    model.highlight = fields.text("highlight").and_then(|text| text.parse().ok()).unwrap_or(model.highlight);
    model.lights = fields.list("lights").iter().filter_map(|node| light(node, problems)).collect();
    Some(model)
}

fn light(node: &Node, problems: &mut Problems) -> Option<ClassicLight> {
    let fields = Fields::of(node, &Expected::plain("classic light", CLASSIC_LIGHT), problems)?;
    let direction = fields.numbers::<3>("direction")?.map(|x| x as f32);
    let light = ClassicLight { direction: direction.into(), color: color(&fields, "color", [1.0; 3], problems) };
    if let Err(problem) = light.check() {
        problems.add(Problem { place: fields.place_of("direction"), ..problem });
        return None;
    }
    Some(light)
}

/// A colour in its range; else what is usual, and a problem.
fn color(fields: &Fields, name: &str, usual: [f32; 3], problems: &mut Problems) -> [f32; 3] {
    let Some(color) = fields.numbers::<3>(name).map(|c| c.map(|x| x as f32)) else { return usual };
    match check_color(name, color) {
        Ok(()) => color,
        Err(problem) => {
            problems.add(Problem { place: fields.place_of(name), ..problem });
            usual
        }
    }
}
