//! Choosing one of many lights: probabilities, and agreement of sampling and density.

use lesk_geometry::surfaces::{SURFACES, vector};
use lesk_geometry::{Geometry, Ray, Transform, WorldBuilder, icosphere};
use lesk_light::{Answer, Area, Directional, FarRectangles, Light, Lights, Point, Receiver, Sky, Spot, Target};
use lesk_math::{Color, Isa, Vec3, vec3};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// A sequence of numbers in [0, 1): splitmix64.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    }

    fn point(&mut self, size: f32) -> Vec3<f32> {
        vec3(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5) * (2.0 * size)
    }

    fn direction(&mut self) -> Vec3<f32> {
        loop {
            let v = self.point(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// Lights of every finite kind, in a cube of 5 m.
fn mixed(count: usize, seed: u64) -> Vec<Light> {
    let mut r = Numbers(seed);
    let mut light = |i: usize| {
        let (p, d) = (r.point(5.0), r.direction());
        let strength = Color::splat(0.1 + 100.0 * r.next().powi(4));
        let size = f64::from(0.01 + 0.5 * r.next());
        let place = Transform::translate(p.x.into(), p.y.into(), p.z.into())
            * Transform::rotate(d.map(f64::from), 2.0).unwrap()
            * Transform::scale(size, size, size).unwrap();
        match i % 5 {
            0 => Light::Point(Point::new(p, strength).unwrap()),
            1 => Light::Spot(Spot::new(p, d, strength, [0.2, 0.5]).unwrap()),
            2 => Light::Area(Area::new(&Geometry::Rectangle, &place, strength, i.is_multiple_of(2)).unwrap()),
            3 => Light::Area(Area::new(&Geometry::Sphere, &place, strength, false).unwrap()),
            _ => Light::Area(Area::new(&Geometry::cube(), &place, strength, false).unwrap()),
        }
    };
    (0..count).map(&mut light).collect()
}

/// The probability of every part of every light.
fn probabilities(lights: &Lights, at: &Receiver) -> Vec<Vec<f32>> {
    let numbers = 0..lights.list().len() as u32;
    numbers.map(|i| (0..lights.part_count(i)).map(|part| lights.pmf(at, i, part)).collect()).collect()
}

fn receiver(r: &mut Numbers) -> Receiver {
    let p = r.point(6.0);
    if r.next() < 0.7 { Receiver::opaque(p, r.direction()) } else { Receiver::anywhere(p) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn probabilities_sum_to_one_and_are_never_zero_where_light_arrives(count in 1usize..80, seed: u64) {
        let lights = mixed(count, seed);
        let all = Lights::new(lights.clone()).unwrap();
        let mut r = Numbers(seed ^ 0xabcd);
        for _ in 0..8 {
            let at = receiver(&mut r);
            let probabilities = probabilities(&all, &at);
            let sum: f64 = probabilities.iter().flatten().map(|p| f64::from(*p)).sum();
            // 1: every sample finds a light; 0: none arrives anywhere. 1e-5: f32 products along 10 levels
            prop_assert!(sum < 1e-30 || (sum - 1.0).abs() < 1e-5 || sum < 1.0, "{sum}");
            for (light, parts) in lights.iter().zip(&probabilities) {
                for (part, probability) in parts.iter().enumerate() {
                    for _ in 0..4 {
                        let u = [r.next(), r.next()];
                        let Some(s) = light.sample(part as u32, &at, u) else { continue };
                        let arrives = at.n.is_none_or(|n| n.dot(s.wi) > 1e-4) && s.value.max_component() > 0.0;
                        prop_assert!(!arrives || *probability > 0.0, "{light:?} {at:?} {s:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn samples_state_the_probability_of_their_light(count in 1usize..60, seed: u64) {
        let lights = mixed(count, seed);
        let all = Lights::new(lights.clone()).unwrap();
        let mut r = Numbers(seed ^ 0x1234);
        for _ in 0..50 {
            let at = receiver(&mut r);
            let (u_light, u) = (r.next(), [r.next(), r.next()]);
            if let Some(s) = all.sample(&at, u_light, u) {
                if s.delta {
                    let p = probabilities(&all, &at)[s.light as usize][0];
                    prop_assert_eq!(s.pdf, p);
                }
                prop_assert!((s.wi.length() - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn lights_are_chosen_as_often_as_their_probability_says() {
    let lights = Lights::new(mixed(40, 7)).unwrap();
    let at = Receiver::opaque(vec3(0.3, -0.2, 0.1), Vec3::Z);
    let n = 200_000;
    let mut counts: Vec<Vec<usize>> = (0..40).map(|i| vec![0; lights.part_count(i) as usize]).collect();
    for i in 0..n {
        let u = ((i as f64 + 0.5) / n as f64) as f32;
        if let Some((light, part, _)) = lights.choose(&at, u) {
            counts[light as usize][part as usize] += 1;
        }
    }
    let expected = probabilities(&lights, &at);
    for (count, p) in counts.iter().flatten().zip(expected.iter().flatten()) {
        let expected = f64::from(*p) * n as f64;
        // evenly spaced numbers: each light has its share up to one number per level of the tree
        assert!((*count as f64 - expected).abs() <= 16.0, "{count} {expected}");
    }
}

#[test]
fn density_of_a_hit_is_that_of_the_sample_that_leads_there() {
    let shapes = [
        Geometry::Rectangle,
        Geometry::Disk,
        Geometry::Sphere,
        Geometry::Cylinder { capped: true },
        Geometry::cube(),
        Geometry::Mesh(Arc::new(icosphere(2))),
    ];
    let mut r = Numbers(3);
    for shape in shapes {
        let place = Transform::translate(0.5, 0.2, 3.0)
            * Transform::rotate(vec3(0.3, -1.0, 0.4), 2.4).unwrap()
            * Transform::scale(0.7, 0.7, 0.7).unwrap();
        let mut builder = WorldBuilder::new();
        let geometry = builder.geometry(shape.clone());
        builder.instance(geometry, place).unwrap();
        let world = builder.build().unwrap();
        let area = Area::new(&shape, &place, Color::WHITE, true).unwrap();
        // so dark that many samples are left for the area
        let lights = Lights::new(vec![Light::Area(area), Light::Sky(Sky::new(Color::splat(0.005)).unwrap())]).unwrap();
        let mut compared = 0;
        for _ in 0..400 {
            let at = Receiver::opaque(r.point(1.0), vec3(0.0, 0.0, 1.0));
            let Some(s) = lights.sample(&at, r.next(), [r.next(), r.next()]) else { continue };
            if s.light != 0 {
                let (_, pdf) = lights.escaped(&at, s.wi).next().unwrap();
                assert!((pdf / s.pdf - 1.0).abs() < 1e-4, "sky {pdf} {}", s.pdf);
                continue;
            }
            let ray = Ray::new(at.p, s.wi);
            let Some(hit) = world.intersect(&ray) else { continue };
            if (hit.t / s.distance - 1.0).abs() > 1e-4 {
                continue; // the sample lies on the far side
            }
            let surface = world.surface(&ray, &hit);
            let grazing = surface.ng.dot(s.wi).abs() < 0.02;
            let pdf = lights.pdf_surface(&at, 0, &surface);
            // 2e-3: the hit is another f32 point than the sample, which the cosine of 0.02 magnifies
            assert!(grazing || (pdf / s.pdf - 1.0).abs() < 2e-3, "{shape:?}: {pdf} {}", s.pdf);
            compared += 1;
        }
        assert!(compared > 50, "{shape:?}: {compared}");
    }
}

#[test]
fn density_of_a_rectangle_integrates_to_one_near_and_far() {
    let rectangle = Geometry::Mesh(Arc::new(lesk_geometry::rectangle()));
    let place =
        Transform::translate(0.0, 0.0, 1.0) * Transform::rotate_x(PI) * Transform::scale(0.4, 0.3, 1.0).unwrap();
    let mut builder = WorldBuilder::new();
    let geometry = builder.geometry(rectangle.clone());
    builder.instance(geometry, place).unwrap();
    let world = builder.build().unwrap();
    let light = Light::Area(Area::new(&rectangle, &place, Color::WHITE, false).unwrap());
    let lights = Lights::new(vec![light]).unwrap();
    assert_eq!(lights.part_count(0), 1);
    // sampled by solid angle from 0.2 and 0.8 m below, by area from 3 and 9 m
    for p in [vec3(0.1, -0.2, 0.8), vec3(0.3, 0.5, 0.2), vec3(1.0, 0.0, -2.0), vec3(0.0, 4.0, -8.0)] {
        let at = Receiver::anywhere(p);
        let n = 200;
        let mut sum = 0.0;
        for k in 0..n * n {
            let [x, y] = [k % n, k / n].map(|i| 2.0 * (i as f32 + 0.5) / n as f32 - 1.0);
            let to = vec3(0.4 * x, 0.3 * y, 1.0) - p;
            let ray = Ray::new(p, to);
            let hit = world.intersect(&ray).expect("the rectangle is in sight");
            let surface = world.surface(&ray, &hit);
            let solid_angle = to.z / to.length().powi(3) * 0.48 / (n * n) as f32;
            sum += f64::from(lights.pdf_surface(&at, 0, &surface) * solid_angle);
        }
        assert!((sum - 1.0).abs() < 1e-3, "{p:?}: {sum}"); // midpoint rule, 200 x 200
    }
}

#[test]
fn ten_thousand_emissive_triangles_are_integrated_with_few_samples() {
    // a tessellated sphere: E = π L (R/d)² = Φ / (4π d²)
    let mesh = Geometry::Mesh(Arc::new(icosphere(5)));
    let place = Transform::translate(0.0, 0.0, 2.0) * Transform::scale(0.5, 0.5, 0.5).unwrap();
    let light = Area::new(&mesh, &place, Color::WHITE * 1000.0, false).unwrap();
    let lights = Lights::new(vec![Light::Area(light)]).unwrap();
    let at = Receiver::opaque(Vec3::ZERO, Vec3::Z);
    assert_eq!(probabilities(&lights, &at)[0].len(), 20_480);
    let mut r = Numbers(11);
    let n = 4000;
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..n {
        let value = lights
            .sample(&at, r.next(), [r.next(), r.next()])
            .map_or(0.0, |s| f64::from(s.value.luminance() * s.wi.z.max(0.0) / s.pdf));
        sum += value;
        squares += value * value;
    }
    let mean = sum / n as f64;
    let deviation = (squares / n as f64 - mean * mean).sqrt();
    let expected = PI * 1000.0 * 0.0625;
    // four standard errors, plus the smaller cross-section of the flat triangles (0.1 %)
    assert!((mean - expected).abs() < 4.0 * deviation / (n as f64).sqrt() + 1e-3 * expected, "{mean} {expected}");
    assert!(deviation < 1.0 * mean, "one sample scatters by {}", deviation / mean);
}

#[test]
fn error_at_equal_samples_does_not_grow_with_the_number_of_lights() {
    // the same flux spread over more and more lamps in a plane; relative deviation of one sample
    let deviation = |side: usize| {
        let count = side * side;
        let lamp = |i: usize| {
            let at = |k: usize| (k as f32 + 0.5) / side as f32 * 20.0 - 10.0;
            let p = vec3(at(i % side), at(i / side), 2.0);
            Light::Point(Point::from_flux(p, Color::splat(1e5 / count as f32)).unwrap())
        };
        let lights = Lights::new((0..count).map(lamp).collect()).unwrap();
        let (mut r, n) = (Numbers(5), 4000);
        let (mut ratio, places) = (0.0, 20);
        for _ in 0..places {
            let p = r.point(9.0);
            let at = Receiver::opaque(vec3(p.x, p.y, 0.0), Vec3::Z);
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..n / places {
                let s = lights.sample(&at, r.next(), [0.5; 2]);
                let v = s.map_or(0.0, |s| f64::from(s.value.luminance() * s.wi.z.max(0.0) / s.pdf));
                sum += v;
                squares += v * v;
            }
            let mean = sum / (n / places) as f64;
            ratio += (squares / (n / places) as f64 / (mean * mean) - 1.0) / places as f64;
        }
        ratio.sqrt()
    };
    let (many, four_times_as_many) = (deviation(64), deviation(128));
    // the error of 4,096 and of 16,384 lights is the same; a uniform choice from A = 400 m² at h = 2 m scatters by
    // sqrt(A / (8π h²) - 1) = 1.7
    assert!(many < 1.0 && four_times_as_many < 1.1 * many, "{many} {four_times_as_many}");
}

#[test]
fn coinciding_lights_and_receivers_on_lights_do_not_break_the_tree() {
    let at_origin = |_| Light::Point(Point::new(Vec3::ZERO, Color::WHITE).unwrap());
    let lights = Lights::new((0..100).map(at_origin).collect()).unwrap();
    let at = Receiver::opaque(vec3(0.0, 0.0, -1.0), Vec3::Z);
    let sum: f32 = probabilities(&lights, &at).into_iter().flatten().sum();
    assert!((sum - 1.0).abs() < 1e-5);
    assert!(lights.sample(&Receiver::opaque(Vec3::ZERO, Vec3::Z), 0.3, [0.5; 2]).is_none());
    assert!(Lights::new(vec![]).unwrap().sample(&at, 0.5, [0.5; 2]).is_none());
}

#[test]
fn distant_lights_are_chosen_by_their_illuminance_but_for_an_even_quarter() {
    // a sky of 1 cd/m2 can give at most 4π lx, a sun 999 times that: shares of 1 and 999 of 1000
    let sky = Light::Sky(Sky::new(Color::WHITE).unwrap());
    let sun = Light::Directional(Directional::new(-Vec3::Z, Color::splat(999.0 * 4.0 * PI as f32)).unwrap());
    let lights = Lights::new(vec![sky, sun]).unwrap();
    let at = Receiver::opaque(Vec3::ZERO, Vec3::Z);
    let expected = [0.25 / 2.0 + 0.75 / 1000.0, 0.25 / 2.0 + 0.75 * 999.0 / 1000.0];
    let n = 100_000;
    let mut counts = [0u32; 2];
    (0..n).filter_map(|i| lights.choose(&at, (i as f32 + 0.5) / n as f32)).for_each(|(l, ..)| counts[l as usize] += 1);
    for (light, expected) in expected.into_iter().enumerate() {
        assert!((lights.pmf(&at, light as u32, 0) - expected).abs() < 1e-6);
        assert!((counts[light] as f32 / n as f32 - expected).abs() < 1e-4);
    }
}

#[test]
fn near_and_distant_lights_share_choices_by_what_they_give_here() {
    let lamp = Light::Point(Point::new(vec3(0.0, 0.0, 1.0), Color::splat(4.0 * PI as f32)).unwrap());
    let sky = Light::Sky(Sky::new(Color::WHITE).unwrap());
    let lights = Lights::new(vec![sky, lamp]).unwrap();
    // 4π cd at 1 m give 4π lx, which is the most that the sky can give; at 10 m they give a hundredth
    for (height, share) in [(1.0, 0.5), (10.0, 1.0 / 101.0)] {
        let at = Receiver::opaque(vec3(0.0, 0.0, 1.0 - height), Vec3::Z);
        let (sky, lamp) = (lights.pmf(&at, 0, 0), lights.pmf(&at, 1, 0));
        assert!((lamp - (0.125 + 0.75 * share)).abs() < 1e-5, "{height}: {lamp}");
        assert!((sky + lamp - 1.0).abs() < 1e-6);
    }
    // below the horizon of the surface the lamp gives nothing, and takes no choices
    let below = Receiver::opaque(Vec3::ZERO, -Vec3::Z);
    assert_eq!((lights.pmf(&below, 0, 0), lights.pmf(&below, 1, 0)), (1.0, 0.0));
}

#[test]
fn rectangles_noted_together_are_sampled_as_each_alone() {
    let lights = Lights::new(mixed(100, 3)).unwrap();
    let (mut r, mut noted, mut lit) = (Numbers(11), 0, 0);
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for _ in 0..100 {
            let mut far = FarRectangles::default();
            let asked: [_; SURFACES] = std::array::from_fn(|_| {
                (Receiver::opaque(r.point(5.0), r.direction()), r.next(), [r.next(), r.next()])
            });
            let answers = std::array::from_fn::<_, SURFACES, _>(|i| {
                let (at, u_light, u) = &asked[i];
                lights.sample_or_note(at, *u_light, *u, i, &mut far)
            });
            far.sample(isa);
            for (i, ((at, u_light, u), answer)) in asked.iter().zip(answers).enumerate() {
                let alone = lights.sample(at, *u_light, *u);
                match (answer, alone) {
                    (Some(Answer::Noted), Some(alone)) => {
                        let Target::Surface(target) = alone.target else { panic!("a rectangle has a surface") };
                        assert_eq!((vector(&far.wi, i), far.pdf[i]), (alone.wi, alone.pdf), "{isa:?}");
                        assert_eq!((vector(&far.p, i), vector(&far.n, i)), (target.p, target.n), "{isa:?}");
                        assert_eq!((far.value.map(|row| row[i]), far.lift[i]), (alone.value.0, target.lift), "{isa:?}");
                        lit += 1;
                    }
                    (Some(Answer::Noted), None) => assert_eq!(far.pdf[i], 0.0, "{isa:?}"),
                    (answer, alone) => assert_eq!(format!("{answer:?}"), format!("{:?}", alone.map(Answer::Sample))),
                }
                noted += usize::from(matches!(answer, Some(Answer::Noted)));
            }
        }
    }
    assert!(lit > 100 && noted > lit, "{lit} of {noted} noted rectangles shine on their receivers");
}
