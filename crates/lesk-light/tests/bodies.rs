//! Area lights that are bodies: what asking them gives, against what rays find.

use lesk_geometry::{Geometry, Ray, Surface, Transform, World, WorldBuilder};
use lesk_light::{Area, Light, Lights, Receiver};
use lesk_math::{Color, Vec3, vec3};
use std::f64::consts::{PI, TAU};

const TUBE: Geometry = Geometry::Cylinder { capped: false };
const ROD: Geometry = Geometry::Cylinder { capped: true };

/// Bodies of some decimetres around (0.3, -0.2, 2), turned, two of them mirrored.
fn bodies() -> Vec<(Geometry, Transform)> {
    let placed = |x: f64, y: f64, z: f64| {
        Transform::translate(0.3, -0.2, 2.0)
            * Transform::rotate(vec3(1.0, 2.0, 0.5), 0.9).unwrap()
            * Transform::scale(x, y, z).unwrap()
    };
    vec![
        (TUBE, placed(0.1, 0.1, 0.8)),
        (ROD, placed(0.3, 0.3, 0.4)),
        (ROD, placed(0.3, 0.15, -0.4)),
        (Geometry::Sphere, placed(0.4, 0.2, 0.3)),
        (Geometry::Sphere, placed(-0.4, 0.1, 0.3)),
    ]
}

fn lit(geometry: &Geometry, place: &Transform, two_sided: bool) -> (Lights, World) {
    let area = Area::new(geometry, place, Color::splat(100.0), two_sided).unwrap();
    let mut world = WorldBuilder::new();
    let number = world.geometry(geometry.clone());
    world.instance(number, *place).unwrap();
    (Lights::new(vec![Light::Area(area)]).unwrap(), world.build().unwrap())
}

/// Evenly spread pairs: Roberts' sequence R2, whose base solves x³ = x + 1.
fn pairs(count: u32) -> impl Iterator<Item = [f64; 2]> {
    (0..count).map(|i| [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|a| ((f64::from(i) + 0.5) * a).fract()))
}

#[test]
fn every_draw_is_seen_and_states_the_density_that_a_ray_finds() {
    for (geometry, place) in bodies() {
        let (lights, world) = lit(&geometry, &place, false);
        for p in [vec3(0.1f32, 0.0, 0.0), vec3(1.0, 0.9, 2.1), vec3(-0.9, -0.6, 2.7)] {
            let at = Receiver::anywhere(p);
            let (mut drawn, mut found) = (0, 0);
            for u in pairs(4096) {
                let Some(s) = lights.sample(&at, 0.5, u.map(|x| x as f32)) else { continue };
                drawn += 1;
                let ray = Ray::new(p, s.wi);
                let Some(hit) = world.intersect(&ray) else { continue };
                let surface = world.surface(&ray, &hit);
                // near a silhouette the ray may pass before the point
                if (hit.t / s.distance - 1.0).abs() < 1e-5 {
                    found += 1;
                    let pdf = lights.pdf_surface(&at, 0, &surface);
                    let grazing = surface.ng.dot(s.wi).abs() < 0.05;
                    assert!(grazing || (pdf / s.pdf - 1.0).abs() < 1e-3, "{geometry:?}: {pdf} {}", s.pdf);
                }
            }
            assert!(drawn > 4080 && found > 4000, "{geometry:?} {p:?}: {drawn} {found}");
        }
    }
}

#[test]
fn asking_gives_the_light_that_rays_meet_and_densities_add_up_to_one() {
    for (geometry, place) in bodies() {
        for two_sided in [false, true] {
            let (lights, world) = lit(&geometry, &place, two_sided);
            let at = Receiver::anywhere(vec3(1.0, 0.5, 1.8));
            let count = 1 << 20;
            let (mut density, mut light) = (0.0, 0.0);
            for [a, b] in pairs(count) {
                let (z, turn) = (1.0 - 2.0 * a, TAU * b);
                let r = (1.0 - z * z).sqrt();
                let wi = vec3(r * turn.cos(), r * turn.sin(), z).map(|x| x as f32);
                let ray = Ray::new(at.p, wi);
                let Some(hit) = world.intersect(&ray) else { continue };
                let surface = world.surface(&ray, &hit);
                density += f64::from(lights.pdf_surface(&at, 0, &surface));
                light += f64::from(lights.emitted(0, &surface, -wi).luminance());
            }
            let each = 4.0 * PI / f64::from(count);
            let from = Surface::at(at.p, Vec3::Z);
            let mut asked = 0.0;
            for u in pairs(1 << 16) {
                let Some(s) = lights.sample(&at, 0.5, u.map(|x| x as f32)) else { continue };
                // the inner sides of one that shines to both are hidden by the outer ones
                if !world.occluded(&s.shadow_ray(&from)) {
                    asked += f64::from(s.value.luminance() / s.pdf) / 65536.0;
                }
            }
            // 1 %: a million rays over the sphere
            assert!((asked / (light * each) - 1.0).abs() < 0.01, "{geometry:?}: {asked} {}", light * each);
            if !two_sided {
                assert!((density * each - 1.0).abs() < 0.01, "{geometry:?}: {}", density * each);
            }
        }
    }
}

#[test]
fn a_thin_tube_scatters_little() {
    // half of uniform draws are hidden and the rest scatter with the cosine: 2 of the mean; visible ones by projected area
    // leave what distance and cosines change along the tube
    let place = Transform::translate(-0.6, 0.0, 2.0)
        * Transform::rotate(vec3(0.0, 1.0, 0.0), PI / 2.0).unwrap()
        * Transform::scale(0.01, 0.01, 1.2).unwrap();
    let (lights, _) = lit(&TUBE, &place, false);
    let at = Receiver::opaque(vec3(0.0, 0.3, 0.0), Vec3::Z);
    let (mut sum, mut squares) = (0.0, 0.0);
    for u in pairs(4096) {
        let e = lights
            .sample(&at, 0.5, u.map(|x| x as f32))
            .map_or(0.0, |s| f64::from(s.value.luminance() * s.wi.z / s.pdf));
        (sum, squares) = (sum + e / 4096.0, squares + e * e / 4096.0);
    }
    assert!((squares / (sum * sum) - 1.0).sqrt() < 0.15, "{}", (squares / (sum * sum) - 1.0).sqrt());
}
