//! A flat floor whose normal map leans everywhere the same way is lit as a floor that leans.

mod common;

use common::settings;
use lesk_image::{Image, Transfer};
use lesk_quantities::Quantity;
use lesk_scene::SceneDescription;
use lesk_scene::description::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// Luminance of a floor of reflectance 0.5 under 1000 lx of parallel light, seen from above.
fn luminance(from: [f64; 3], normal: Option<[f32; 3]>, turn_deg: f64) -> (f64, f64) {
    let mut d = SceneDescription::new(CameraDescription::look_at([0.0, -0.1, 3.0], [0.0; 3]));
    (d.film.width, d.film.height) = (8, 8);
    let mut clay = MaterialDescription::new("clay", "lambert").set("reflectance", &[0.5]);
    clay.normal_map = normal.map(|n| {
        let image = Image::from_fn(1, 1, Transfer::Linear, |_, _| n.map(|x| 0.5 * (x + 1.0))).unwrap();
        NormalMapDescription {
            texture: TextureDescription::new(Picture::Image(Arc::new(image))),
            strength: 1.0,
            place: Default::default(),
        }
    });
    d.materials.push(clay);
    let turn = lesk_geometry::Transform::rotate_z(turn_deg.to_radians());
    d.objects.push(ObjectDescription::new(Shape::Rectangle { size: [50.0, 50.0] }).material("clay").at(turn));
    let amount = Quantity::parse("1000 lx").unwrap();
    d.lights.push(LightDescription::new(
        LightKind::Directional { direction: from.map(|x| -x), diameter: 0.0 },
        Emission::new(amount),
    ));
    common::mean(&d.build().unwrap(), &settings(16, 1))
}

#[test]
fn a_leaning_normal_map_lights_a_floor_by_the_cosine_to_the_leaning_normal() {
    let lit = |cosine: f64| 0.5 * 1000.0 * cosine / PI;
    let lean = [0.6, 0.0, 0.8];
    // along u, against u, across; and with the floor turned by 90 degrees, so that u runs along y
    for (from, turn, cosine) in [
        ([0.6, 0.0, 0.8], 0.0, 1.0),
        ([-0.6, 0.0, 0.8], 0.0, 0.28),
        ([0.0, 0.6, 0.8], 0.0, 0.64),
        ([0.0, 0.6, 0.8], 90.0, 1.0),
    ] {
        let (value, _) = luminance(from, Some(lean), turn);
        // f32 directions
        assert!((value / lit(cosine) - 1.0).abs() < 1e-4, "{from:?} {turn}: {value} {}", lit(cosine));
    }
    let (flat, _) = luminance([0.6, 0.0, 0.8], None, 0.0);
    assert!((flat / lit(0.8) - 1.0).abs() < 1e-4, "{flat}");
}
