//! Points on surfaces: areas and densities against closed forms and against ray casting.

use lesk_geometry::*;
use lesk_math::{Vec3, vec3};
use std::f64::consts::PI;
use std::sync::Arc;

fn shapes() -> Vec<(&'static str, Geometry)> {
    vec![
        ("mesh", Geometry::Mesh(Arc::new(icosphere(1)))),
        ("cube", Geometry::cube()),
        ("rectangle", Geometry::Rectangle),
        ("sphere", Geometry::Sphere),
        ("disk", Geometry::Disk),
        ("tube", Geometry::Cylinder { capped: false }),
        ("cylinder", Geometry::Cylinder { capped: true }),
    ]
}

fn places() -> Vec<Transform> {
    let turn = Transform::rotate(vec3(1.0, 2.0, 3.0), 0.8).unwrap();
    vec![
        Transform::translate(0.3, -0.2, 4.0) * turn * Transform::scale(0.7, 0.7, 0.7).unwrap(),
        Transform::translate(0.3, -0.2, 4.0) * turn * Transform::scale(1.0, 0.5, 1.5).unwrap(),
        Transform::translate(0.3, -0.2, 4.0) * turn * Transform::scale(-1.0, 0.5, 0.8).unwrap(),
    ]
}

#[test]
fn areas_of_placed_shapes_have_their_closed_forms() {
    let area = |g: Geometry, x, y, z| AreaSampler::new(&g, &Transform::scale(x, y, z).unwrap()).unwrap().area();
    let close = |a: f64, b: f64, tolerance: f64| assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
    close(area(Geometry::Sphere, 2.0, 2.0, 2.0), 16.0 * PI, 1e-14);
    close(area(Geometry::Disk, 2.0, 3.0, 1.0), 6.0 * PI, 1e-12);
    close(area(Geometry::Rectangle, 2.0, 3.0, 1.0), 24.0, 1e-14);
    close(area(Geometry::Cylinder { capped: false }, 2.0, 2.0, 5.0), 20.0 * PI, 1e-12);
    close(area(Geometry::Cylinder { capped: true }, 2.0, 2.0, 5.0), 28.0 * PI, 1e-12);
    close(area(Geometry::cube(), 1.0, 2.0, 3.0), 88.0, 1e-12);
    // prolate spheroid with axes 1, 1, 2: 2 pi a^2 (1 + c / (a e) asin e), e = sqrt(3) / 2
    let e = 0.75f64.sqrt();
    close(area(Geometry::Sphere, 1.0, 1.0, 2.0), 2.0 * PI * (1.0 + 2.0 / e * e.asin()), 1e-4);
}

#[test]
fn surfaces_without_area_are_refused() {
    let empty = Mesh::new(MeshData::default()).unwrap().0;
    let e = AreaSampler::new(&Geometry::Mesh(Arc::new(empty)), &Transform::IDENTITY).unwrap_err();
    assert!(e.to_string().contains("area of 0 m²"), "{e}");
}

/// For every sample: a ray to it meets it, the surface there agrees, and so do both ways to ask for the density.
#[test]
fn samples_lie_where_rays_meet_the_surface() {
    for (name, geometry) in shapes() {
        for place in places() {
            let mut b = WorldBuilder::new();
            let g = b.geometry(geometry.clone());
            b.instance(g, place).unwrap();
            let world = b.build().unwrap();
            let sampler = world.area_sampler(0).unwrap();
            let x = vec3(0.1, 0.2, -0.3);
            for i in 0..200 {
                let u = [(i as f32 + 0.5) / 200.0, (0.5 + i as f32 * 0.618_034).fract()];
                let s = sampler.sample(u);
                let out = Ray::new(s.p + s.n, -s.n);
                let hit = world.intersect(&Ray { t_min: 0.999, t_max: 1.001, ..out }).expect(name);
                let surface = world.surface(&out, &hit);
                assert!((surface.p - s.p).length() < 1e-5, "{name} {surface:?} {s:?}");
                if hit.prim == s.prim {
                    assert!((surface.ng - s.n).length() < 2e-4, "{name} {surface:?} {s:?}");
                    let turn = (surface.uv[0] - s.uv[0]).abs();
                    assert!(!(1e-3..=0.999).contains(&turn), "{name} {surface:?} {s:?}");
                }
                assert!((sampler.pdf(hit.prim, surface.p) / s.pdf - 1.0).abs() < 1e-3, "{name}");
                let Some(s) = sampler.sample_from(x, u) else { continue };
                let again = sampler.pdf_from(x, s.prim, s.p, s.n);
                assert!((again / s.pdf - 1.0).abs() < 1e-3, "{name} {again} {s:?}");
            }
        }
    }
}

/// The integral of 1/pdf-weighted visibility is the solid angle; counted independently by uniform directions.
#[test]
fn densities_over_solid_angle_integrate_to_the_visible_solid_angle() {
    let n = 1 << 17;
    // the R2 sequence (Roberts 2018)
    let point = |i: usize| [0.754_877_666_2, 0.569_840_290_998].map(|a: f64| (0.5 + a * i as f64).fract() as f32);
    for (name, geometry) in shapes() {
        for place in places() {
            let mut b = WorldBuilder::new();
            let g = b.geometry(geometry.clone());
            b.instance(g, place).unwrap();
            let world = b.build().unwrap();
            let sampler = world.area_sampler(0).unwrap();
            let x = vec3(0.1, 0.2, 1.0);
            let (mut by_sampler, mut by_cone) = (0.0, 0.0);
            // all shapes lie within 53 degrees around +z seen from x
            let cos_max = 0.6;
            for i in 0..n {
                let u = point(i);
                if let Some(s) = sampler.sample_from(x, u) {
                    let d = s.p - x;
                    let free = !world.occluded(&Ray { o: x, d, t_min: 0.0, t_max: 1.0 - 1e-4 });
                    by_sampler += if free { 1.0 / s.pdf as f64 } else { 0.0 };
                }
                let z = 1.0 - u[0] * (1.0 - cos_max);
                let (r, phi) = ((1.0 - z * z).sqrt(), u[1] * std::f32::consts::TAU);
                let d = vec3(r * phi.cos(), r * phi.sin(), z);
                by_cone += world.occluded(&Ray::new(x, d)) as u32 as f64 * 2.0 * PI * (1.0 - cos_max as f64);
            }
            // 1 %: silhouettes among 131072 points, of which some thousand hit
            assert!((by_sampler / by_cone - 1.0).abs() < 0.01, "{name}: {by_sampler} {by_cone}");
        }
    }
}

#[test]
fn mesh_samples_are_uniform_over_triangles_of_unequal_area() {
    let data = MeshData {
        positions: vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(-9.0, 0.0, 0.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..MeshData::default()
    };
    let mesh = Geometry::Mesh(Arc::new(Mesh::new(data).unwrap().0));
    let sampler = AreaSampler::new(&mesh, &Transform::IDENTITY).unwrap();
    let n = 200;
    let samples =
        (0..n * n).map(|i| sampler.sample([(i % n) as f32 + 0.5, (i / n) as f32 + 0.5].map(|v| v / n as f32)));
    let mut count = 0;
    let mut sum = Vec3::<f32>::ZERO;
    for s in samples {
        count += (s.prim == 0) as usize;
        sum = sum + s.p * (1.0 / (n * n) as f32);
    }
    assert_eq!(count, n * n / 10);
    // centroid of the whole triangle (1, 0), (0, 1), (-9, 0); 200 x 200 midpoints and f32 sums
    assert!((sum - vec3(-8.0 / 3.0, 1.0 / 3.0, 0.0)).length() < 5e-3, "{sum:?}");
}

#[test]
fn rays_between_a_receiver_and_a_sample_are_free_on_open_sight() {
    let mut b = WorldBuilder::new();
    let g = b.geometry(Geometry::Rectangle);
    let s = b.geometry(Geometry::Sphere);
    b.instance(g, Transform::scale(100.0, 100.0, 1.0).unwrap()).unwrap();
    let place = Transform::translate(0.0, 0.0, 3.0) * Transform::scale(0.5, 0.5, 0.5).unwrap();
    let ball = b.instance(s, place).unwrap();
    let world = b.build().unwrap();
    let sampler = world.area_sampler(ball).unwrap();
    for i in 0..1000 {
        let f = i as f32;
        let o = vec3((f * 0.37).sin() * 40.0, (f * 0.61).cos() * 40.0, 2.0);
        let down = Ray::new(o, vec3(0.1, 0.2, -1.0));
        let surface = world.surface(&down, &world.intersect(&down).unwrap());
        let light = sampler.sample_from(surface.p, [(f + 0.5) / 1000.0, (f * 0.618).fract()]).unwrap();
        assert!(!world.occluded(&Ray::to_sample(&surface, &light)), "{i}");
        assert!(world.occluded(&Ray::to_point(&surface, surface.p + (light.p - surface.p) * 2.0)), "{i}");
    }
}
