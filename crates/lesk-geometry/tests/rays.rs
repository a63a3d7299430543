//! Ray casting against brute force, closed forms and closed meshes, for every instruction set of this machine.

use lesk_geometry::*;
use lesk_math::{Isa, Vec3, vec3};
use std::sync::Arc;

/// A small generator of random numbers (PCG-XSH-RR 64/32, O'Neill 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let x = (((self.0 >> 18) ^ self.0) >> 27) as u32;
        (x.rotate_right((self.0 >> 59) as u32) >> 8) as f32 / (1 << 24) as f32
    }
    fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }
    fn vector(&mut self) -> Vec3<f32> {
        vec3(self.signed(), self.signed(), self.signed())
    }
    fn direction(&mut self) -> Vec3<f32> {
        loop {
            let v = self.vector();
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalize();
            }
        }
    }
}

fn available() -> Vec<Isa> {
    Isa::ALL.into_iter().filter(|isa| isa.is_available()).collect()
}

fn world_of(geometry: Geometry, place: Transform, isa: Isa) -> World {
    let mut b = WorldBuilder::new().isa(isa);
    let g = b.geometry(geometry);
    b.instance(g, place).unwrap();
    b.build().unwrap()
}

fn soup(count: usize, size: f32, seed: u64) -> Mesh {
    let mut r = Random(seed);
    let mut data = MeshData::default();
    for i in 0..count as u32 {
        let center = r.vector();
        data.positions.extend((0..3).map(|_| center + r.vector() * size));
        data.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    Mesh::new(data).unwrap().0
}

/// Möller & Trumbore 1997, in f64: the parameter, and how far inside the nearest edge the hit is (barycentric).
fn exact(o: Vec3<f32>, d: Vec3<f32>, c: [Vec3<f32>; 3]) -> Option<(f64, f64)> {
    let wide = |v: Vec3<f32>| vec3(v.x as f64, v.y as f64, v.z as f64);
    let [a, b, c] = c.map(wide);
    let (o, d) = (wide(o), wide(d));
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let s = o - a;
    let q = s.cross(e1);
    let (u, v, t) = (s.dot(p) / det, d.dot(q) / det, e2.dot(q) / det);
    let inside = u.min(v).min(1.0 - u - v);
    (t > 0.0 && inside > -1e-4).then_some((t, inside))
}

#[test]
fn hits_in_random_triangle_soups_agree_with_brute_force() {
    for (count, size) in [(1, 1.0), (3, 0.5), (9, 0.5), (60, 0.3), (2000, 0.1), (500, 1.0)] {
        let mesh = Arc::new(soup(count, size, count as u64));
        for isa in available() {
            let world = world_of(Geometry::Mesh(mesh.clone()), Transform::IDENTITY, isa);
            let mut r = Random(7);
            for _ in 0..1000 {
                let (o, d) = (r.vector() * 2.0, r.direction());
                let all: Vec<_> = (0..mesh.triangles().len()).filter_map(|i| exact(o, d, mesh.corners(i))).collect();
                // hits within 1e-4 of an edge may go either way in f32
                let sure = all.iter().filter(|h| h.1 > 1e-4).map(|h| h.0).fold(f64::INFINITY, f64::min);
                let possible = all.iter().map(|h| h.0).fold(f64::INFINITY, f64::min);
                let ray = Ray::new(o, d);
                let t = world.intersect(&ray).map_or(f64::INFINITY, |h| h.t as f64);
                let slack = 1e-4 * (1.0 + t.min(10.0));
                assert!(t <= sure + slack && t >= possible - slack, "{isa:?} {t} {sure} {possible}");
                if sure.is_finite() || possible.is_infinite() {
                    assert_eq!(world.occluded(&ray), sure.is_finite());
                }
            }
        }
    }
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let mut b = WorldBuilder::new();
    let g = b.geometry(Geometry::Mesh(Arc::new(soup(3000, 0.1, 5))));
    let s = b.geometry(Geometry::Sphere);
    b.instance(g, Transform::IDENTITY).unwrap();
    b.instance(g, Transform::rotate_x(1.0)).unwrap();
    b.instance(s, Transform::scale(0.2, 0.3, 0.4).unwrap()).unwrap();
    let worlds: Vec<World> = available().into_iter().map(|isa| b.clone().isa(isa).build().unwrap()).collect();
    let mut r = Random(3);
    for _ in 0..20_000 {
        let ray = Ray::new(r.vector() * 1.5, r.direction());
        let first = worlds[0].intersect(&ray);
        for w in &worlds[1..] {
            assert_eq!(w.intersect(&ray), first);
            assert_eq!(w.occluded(&ray), first.is_some());
        }
    }
}

/// Rays from inside aimed exactly at vertices and at points of edges of a closed mesh.
fn assert_no_leaks(mesh: &Mesh, place: Transform, isa: Isa, rays: usize) {
    let world = world_of(Geometry::Mesh(Arc::new(mesh.clone())), place, isa);
    let mut r = Random(11);
    for i in 0..rays {
        let t = mesh.triangles()[i % mesh.triangles().len()];
        let [a, b] = [t[i % 3], t[(i + 1) % 3]].map(|v| place.point(mesh.positions()[v as usize]));
        let s = [0.0, 0.5, r.unit()][i % 3];
        let target = a + (b - a) * s;
        let o = place.point(r.vector() * 0.3);
        for d in [target - o, (target - o).normalize()] {
            assert!(world.intersect(&Ray::new(o, d)).is_some(), "{isa:?} ray {i} leaks at {target:?}");
            assert!(world.occluded(&Ray::new(o, d)));
        }
    }
}

#[test]
fn rays_aimed_at_edges_and_vertices_of_closed_meshes_never_leak() {
    let places = [
        Transform::IDENTITY,
        Transform::translate(1000.0, -300.0, 77.0) * Transform::rotate_x(0.3),
        Transform::scale(1e-3, 1e-3, 1e-3).unwrap(),
        Transform::scale(1.0, 30.0, 0.1).unwrap(),
    ];
    for isa in available() {
        for place in places {
            assert_no_leaks(&icosphere(4), place, isa, 20_000);
            assert_no_leaks(&uv_sphere(40, 20), place, isa, 20_000);
            assert_no_leaks(&cube(), place, isa, 5_000);
        }
    }
}

#[test]
fn axis_parallel_rays_through_a_grid_of_shared_edges_never_leak() {
    // every ray runs exactly along box faces, edges and vertices
    let n = 16;
    let mut data = MeshData::default();
    for i in 0..(n + 1) * (n + 1) {
        data.positions.push(vec3((i % (n + 1)) as f32, (i / (n + 1)) as f32, 0.0));
    }
    for (x, y) in (0..n).flat_map(|x| (0..n).map(move |y| (x, y))) {
        let a = y * (n + 1) + x;
        data.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
    }
    let mesh = Geometry::Mesh(Arc::new(Mesh::new(data).unwrap().0));
    for isa in available() {
        let world = world_of(mesh.clone(), Transform::IDENTITY, isa);
        for (i, j) in (0..=4 * n).flat_map(|i| (0..=4 * n).map(move |j| (i, j))) {
            let o = vec3(i as f32 / 4.0, j as f32 / 4.0, 3.0);
            for zero in [0.0, -0.0] {
                let hit = world.intersect(&Ray::new(o, vec3(zero, zero, -1.0))).expect("inside the grid");
                assert_eq!(hit.t, 3.0);
            }
        }
    }
}

#[test]
fn instances_are_hit_like_copies_of_their_triangles() {
    let mesh = Arc::new(soup(400, 0.15, 9));
    let mut r = Random(1);
    let places: Vec<Transform> = (0..20)
        .map(|i| {
            let v = r.vector() * 4.0;
            Transform::translate(v.x as f64, v.y as f64, v.z as f64)
                * Transform::rotate(vec3(1.0, i as f64, 2.0), i as f64).unwrap()
                * Transform::scale(0.5 + r.unit() as f64, 1.0, if i % 2 == 0 { 1.0 } else { -1.5 }).unwrap()
        })
        .collect();
    let (mut shared, mut copied) = (WorldBuilder::new(), WorldBuilder::new());
    let g = shared.geometry(Geometry::Mesh(mesh.clone()));
    for p in &places {
        shared.instance(g, *p).unwrap();
        let own = copied.geometry(Geometry::Mesh(mesh.clone()));
        copied.instance(own, *p).unwrap();
    }
    let (shared, copied) = (shared.build().unwrap(), copied.build().unwrap());
    assert!(shared.tree_bytes() * 5 < copied.tree_bytes());
    let mut different = 0;
    for _ in 0..20_000 {
        let ray = Ray::new(r.vector() * 6.0, r.direction());
        match (shared.intersect(&ray), copied.intersect(&ray)) {
            (Some(a), Some(b)) if (a.instance, a.prim) == (b.instance, b.prim) => {
                // the place of a hit on a grazed triangle is as uncertain as 1 / cosine
                let (s, c) = (shared.surface(&ray, &a), copied.surface(&ray, &b));
                let cosine = s.ng.dot(ray.d).abs().max(1e-3);
                assert!((a.t - b.t).abs() < 2e-5 / cosine, "{a:?} {b:?}");
                assert!((s.p - c.p).length() < 1e-4 / cosine && s.ng == c.ng);
            }
            (None, None) => {}
            _ => different += 1,
        }
    }
    // only rays that pass an edge within rounding may differ
    assert!(different <= 4, "{different} of 20000 rays differ");
}

#[test]
fn spheres_are_hit_where_the_closed_form_says() {
    let mut b = WorldBuilder::new();
    let g = b.geometry(Geometry::Sphere);
    let (c, radius) = (vec3(3.0, -2.0, 10.0), 1.5f32);
    let place = Transform::translate(3.0, -2.0, 10.0) * Transform::scale(1.5, 1.5, 1.5).unwrap();
    b.instance(g, place).unwrap();
    let world = b.build().unwrap();
    let mut r = Random(2);
    for _ in 0..10_000 {
        let (o, d) = (r.vector() * 3.0, (c + r.vector() * 2.0).normalize());
        let ray = Ray::new(o, d);
        let f = [o.x - c.x, o.y - c.y, o.z - c.z].map(f64::from);
        let dd = [d.x, d.y, d.z].map(f64::from);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (qa, qb, qc) = (dot(dd, dd), dot(f, dd), dot(f, f) - (radius as f64).powi(2));
        let disc = qb * qb - qa * qc;
        if disc.abs() < 1e-6 {
            continue;
        }
        let expected = (disc > 0.0).then(|| (-qb - disc.sqrt()) / qa);
        let hit = world.intersect(&ray);
        assert_eq!(hit.is_some(), expected.is_some());
        if let (Some(h), Some(t)) = (hit, expected) {
            assert!((h.t as f64 - t).abs() < 1e-6 * t);
            let s = world.surface(&ray, &h);
            assert!(((s.p - c).length() - radius).abs() < 4e-6);
            assert!((s.ng - (s.p - c) / radius).length() < 4e-6);
        }
    }
}

#[test]
fn rays_that_leave_a_surface_never_meet_it_again() {
    let mut r = Random(21);
    let sizes = [1e-3, 1.0, 50.0, 1e4];
    let mut worst = 0;
    for (size, far) in sizes.into_iter().flat_map(|s| [0.0, 1.0, 100.0].map(|f| (s, f * s))) {
        for instanced in [false, true] {
            let mesh = Arc::new(soup(1, 1.0, size as u64 + far as u64));
            let mut b = WorldBuilder::new();
            let g = b.geometry(Geometry::Mesh(mesh));
            let turned = Transform::rotate(vec3(1.0, 0.3, -2.0), size + far).unwrap();
            let scaled = Transform::scale(size, size, 0.5 * size).unwrap();
            let place = Transform::translate(far, -far, 0.5 * far) * turned * scaled;
            b.instance(g, place).unwrap();
            if instanced {
                b.instance(g, place * Transform::translate(1e3, 1e3, 1e3)).unwrap();
            }
            let world = b.build().unwrap();
            let sampler = world.area_sampler(0).unwrap();
            for _ in 0..2000 {
                let target = sampler.sample([r.unit(), r.unit()]);
                let o = target.p + (target.n + r.direction() * 0.9) * size as f32;
                let ray = Ray::new(o, target.p - o);
                let Some(hit) = world.intersect(&ray).filter(|h| h.instance == 0) else { continue };
                let s = world.surface(&ray, &hit);
                for _ in 0..8 {
                    let away = Ray::leaving(&s, r.direction());
                    worst += world.intersect(&away).is_some_and(|h| h.instance == 0) as u32;
                    // grazing
                    let flat = r.direction();
                    let along = flat - s.ng * (s.ng.dot(flat) * 0.9999);
                    worst += world.intersect(&Ray::leaving(&s, along)).is_some_and(|h| h.instance == 0) as u32;
                }
            }
        }
    }
    assert_eq!(worst, 0);
}

#[test]
fn rays_that_leave_a_curved_shape_outward_never_meet_it_again() {
    let mut r = Random(5);
    for geometry in [Geometry::Sphere, Geometry::Disk, Geometry::Cylinder { capped: true }] {
        for (size, far) in [(1.0, 0.0), (1e-3, 1.0), (1e4, 1e4), (3.0, 1000.0)] {
            let place = Transform::translate(far, far, -far) * Transform::scale(size, size, 2.0 * size).unwrap();
            let world = world_of(geometry.clone(), place * Transform::rotate_x(0.7), Isa::Baseline);
            for _ in 0..3000 {
                let center = world.bounds().center();
                let o = center + r.direction() * (5.0 * size as f32);
                let ray = Ray::new(o, center + r.vector() * (0.8 * size as f32) - o);
                let Some(hit) = world.intersect(&ray) else { continue };
                let s = world.surface(&ray, &hit);
                let d = r.direction();
                let outward = if d.dot(s.ng) < 0.0 { -d } else { d };
                assert!(!world.occluded(&Ray::leaving(&s, outward)), "{geometry:?} {size} {far}");
                // inward, a closed shape is met exactly on its other side
                if !matches!(geometry, Geometry::Disk) {
                    let inner = world.intersect(&Ray::leaving(&s, -outward));
                    assert!(inner.is_some_and(|h| h.t > 0.0));
                }
            }
        }
    }
}

#[test]
fn degenerate_rays_hit_nothing() {
    for isa in available() {
        let world = world_of(Geometry::cube(), Transform::IDENTITY, isa);
        let o = vec3(0.0, 0.0, -3.0);
        let z = vec3(0.0, 0.0, 1.0);
        let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        for x in bad {
            assert!(world.intersect(&Ray::new(vec3(x, 0.0, -3.0), z)).is_none());
            assert!(world.intersect(&Ray::new(o, vec3(x, 0.0, 1.0))).is_none());
            assert!(!world.occluded(&Ray::new(o, vec3(0.0, x, 1.0))));
        }
        for (o, d) in
            [([0.0, 1e27, 0.0], [1.0, 0.0, 0.0]), ([0.0, 1e38, 1e38], [1.0, 1e-10, 1e-10]), ([1e30; 3], [1e-17; 3])]
        {
            let ray = Ray::new(Vec3::from(o), Vec3::from(d));
            assert!(world.intersect(&ray).is_none() && !world.occluded(&ray));
        }
        assert!(world.intersect(&Ray::new(o, Vec3::ZERO)).is_none());
        let part = |t_min, t_max| world.intersect(&Ray { o, d: z, t_min, t_max }).map(|h| h.t);
        assert_eq!(part(0.0, f32::INFINITY), Some(2.0));
        assert_eq!(part(-5.0, 2.0), None);
        assert_eq!(part(2.0, 9.0), Some(4.0));
        assert_eq!(part(2.5, 3.5), None);
        assert_eq!(part(f32::NAN, 9.0), Some(2.0));
        assert_eq!(part(0.0, f32::NAN), None);
        assert_eq!(part(9.0, 1.0), None);
    }
}

#[test]
fn directions_of_any_length_hit_and_t_counts_in_that_length() {
    let world = world_of(Geometry::cube(), Transform::IDENTITY, Isa::current());
    for length in [1e-12f32, 1e-3, 1.0, 1e12] {
        let hit = world.intersect(&Ray::new(vec3(0.2, 0.3, -3.0), vec3(0.0, 0.0, length))).unwrap();
        assert!((hit.t * length - 2.0).abs() < 1e-6);
    }
}

/// Meshes in the world tree and in trees of their own, of which two coincide exactly; curved shapes; some of both at equal
/// distances from rays along z.
fn world_of_all_kinds(isa: Isa) -> World {
    let mut b = WorldBuilder::new().isa(isa);
    let alone = b.geometry(Geometry::Mesh(Arc::new(soup(3000, 0.1, 5))));
    let shared = b.geometry(Geometry::Mesh(Arc::new(soup(500, 0.2, 6))));
    let (cube, sphere, disk) = (b.geometry(Geometry::cube()), b.geometry(Geometry::Sphere), b.geometry(Geometry::Disk));
    b.instance(alone, Transform::IDENTITY).unwrap();
    for place in [Transform::rotate_x(1.0), Transform::rotate_x(1.0), Transform::translate(0.5, 0.0, 0.0)] {
        b.instance(shared, place).unwrap();
    }
    b.instance(sphere, Transform::scale(0.2, 0.3, 0.4).unwrap()).unwrap();
    for geometry in [disk, disk, cube, sphere] {
        b.instance(geometry, Transform::translate(0.0, 0.0, -2.0)).unwrap();
    }
    b.build().unwrap()
}

/// Rays of all kinds, some of them none.
fn rays_of_all_kinds(count: usize) -> Vec<Ray> {
    let mut r = Random(3);
    let ray = |i: usize| {
        let mut ray = Ray::new(r.vector() * 1.5, r.direction() * 3.0);
        match i % 16 {
            0 => ray.d.x = f32::NAN,
            1 => ray.o.y = f32::INFINITY,
            2 => ray.d = Vec3::ZERO,
            3 => (ray.t_min, ray.t_max) = (2.0, 1.0),
            4 => ray.t_max = f32::NAN,
            5 | 6 => (ray.t_min, ray.t_max) = (0.1, 0.3),
            // straight at a cube of side 2, a sphere and two disks around (0, 0, -2)
            7 | 8 => ray = Ray::new(vec3(0.0, 0.0, 9.0), -Vec3::Z),
            9 => ray.d = vec3(0.0, -0.0, 1.0),
            // so far away or so short that no number of the box test is left
            10 => ray.o = vec3(0.0, 1e27, r.signed() * 1e27),
            11 => (ray.o, ray.d) = (vec3(0.0, 1e3, 1e3), vec3(2e-18, 0.0, 0.0)),
            12 => (ray.o, ray.d) = (vec3(1e30, 1e30, 1e30), vec3(1e-17, 1e-17, 1e-17)),
            _ => {}
        }
        ray
    };
    (0..count).map(ray).collect()
}

#[test]
fn many_rays_at_once_meet_what_each_meets_alone() {
    for isa in available() {
        let world = world_of_all_kinds(isa);
        let (mut caster, mut hits, mut occluded) = (Caster::default(), vec![], vec![]);
        // every filling of the last group; the room is used again
        for count in (0..200).chain([20_000]) {
            let rays = rays_of_all_kinds(count);
            world.intersect_all(&rays, &mut caster, &mut hits);
            world.occluded_all(&rays, &mut caster, &mut occluded);
            assert_eq!((hits.len(), occluded.len()), (count, count));
            for (i, ray) in rays.iter().enumerate() {
                assert_eq!(hits[i], world.intersect(ray), "{isa:?}, {ray:?}");
                assert_eq!(occluded[i], world.occluded(ray), "{isa:?}, {ray:?}");
            }
        }
        let met = hits.iter().flatten();
        let instances: std::collections::BTreeSet<u32> = met.map(|hit| hit.instance).collect();
        assert!(instances.len() >= 7, "only instances {instances:?} are met");
    }
}

#[test]
fn hits_at_the_end_of_many_rays_do_not_count() {
    for isa in available() {
        let corners = vec![vec3(0.0, 0.0, -1.0), vec3(1.0, 0.0, -1.0), vec3(0.0, 1.0, -1.0)];
        let one = MeshData { positions: corners, triangles: vec![[0, 1, 2]], ..MeshData::default() };
        let world = world_of(Geometry::Mesh(Arc::new(Mesh::new(one).unwrap().0)), Transform::IDENTITY, isa);
        let (mut caster, mut hits, mut occluded) = (Caster::default(), vec![], vec![]);
        let ray = |t_max| Ray { t_max, ..Ray::new(vec3(0.2, 0.3, -3.0), Vec3::Z) };
        world.intersect_all(&[ray(2.0), ray(2.0f32.next_up())], &mut caster, &mut hits);
        world.occluded_all(&[ray(2.0), ray(2.0f32.next_up())], &mut caster, &mut occluded);
        assert_eq!(hits.iter().map(|hit| hit.map(|hit| hit.t)).collect::<Vec<_>>(), [None, Some(2.0)]);
        assert_eq!(occluded, [false, true]);
        // a sphere, which is no triangle: t = 2 on its axis
        let world = world_of(Geometry::Sphere, Transform::IDENTITY, isa);
        let ray = |t_max| Ray { t_max, ..Ray::new(vec3(0.0, 0.0, -3.0), Vec3::Z) };
        world.intersect_all(&[ray(2.0), ray(2.0f32.next_up())], &mut caster, &mut hits);
        assert_eq!(hits.iter().map(|hit| hit.map(|hit| hit.t)).collect::<Vec<_>>(), [None, Some(2.0)]);
    }
}

#[test]
fn an_empty_world_has_no_hits() {
    let world = WorldBuilder::new().build().unwrap();
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    assert!(world.intersect(&ray).is_none() && !world.occluded(&ray));
    let mut hits = vec![];
    world.intersect_all(&[ray; 3], &mut Caster::default(), &mut hits);
    assert_eq!(hits, [None; 3]);
    assert!(world.bounds().is_empty());
    let mut b = WorldBuilder::new();
    b.geometry(Geometry::cube());
    assert!(b.build().unwrap().intersect(&ray).is_none());
    assert!(WorldBuilder::new().instance(0, Transform::IDENTITY).is_err());
}

#[test]
fn ten_thousand_equal_triangles_and_nested_scales_build_and_answer() {
    let one = [vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
    let equal = MeshData { positions: one.to_vec(), triangles: vec![[0, 1, 2]; 10_000], ..MeshData::default() };
    // triangles that shrink by a factor of 1.01 each: deep trees
    let mut nested = MeshData::default();
    for i in 0..4000u32 {
        let s = 1.01f32.powi(-(i as i32));
        nested.positions.extend(one.map(|p| p * s));
        nested.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    for data in [equal, nested] {
        let mesh = Mesh::new(data).unwrap().0;
        let world = world_of(Geometry::Mesh(Arc::new(mesh)), Transform::IDENTITY, Isa::current());
        let hit = world.intersect(&Ray::new(vec3(0.2, 0.2, 1.0), vec3(0.0, 0.0, -1.0))).unwrap();
        // of equal distances, the lowest number
        assert_eq!((hit.t, hit.prim), (1.0, 0));
        let mut hits = vec![];
        world.intersect_all(&[Ray::new(vec3(0.2, 0.2, 1.0), -Vec3::Z)], &mut Caster::default(), &mut hits);
        assert_eq!(hits, [Some(hit)]);
    }
}
