//! The contract in `f32`: for unit directions (within 1e-5), legal parameters and |z| >= 1e-6 every output is finite, no
//! density or reflectance is negative, and what is drawn is a direction; outside, everything is 0.

mod common;

use common::Random;
use lesk_bsdf::batch::{self, Column, Target};
use lesk_bsdf::kernels::DRAW_OUTPUTS;
use lesk_bsdf::model::Domain;
use lesk_bsdf::params::{ParamSpec, defaults};
use lesk_bsdf::{Scatter, registry};
use lesk_math::{CHANNELS, Isa, Vec3, vec3};

/// Parameter tables: all ends of all ranges where these are few, else a random choice of ends; and defaults.
fn extremes(specs: &[ParamSpec], random: &mut Random) -> Vec<Vec<f32>> {
    const MOST: usize = 64;
    let corners = 1usize << specs.len();
    let corner = |bits: usize| -> Vec<f32> {
        let ends = specs.iter().enumerate();
        ends.flat_map(|(p, spec)| vec![spec.range[bits >> p & 1] as f32; spec.len()]).collect()
    };
    let mut tables: Vec<Vec<f32>> = if corners <= MOST {
        (0..corners).map(corner).collect()
    } else {
        (0..MOST).map(|_| corner(random.index(corners))).collect()
    };
    let middle: Vec<f32> = defaults(specs).iter().map(|&p| p as f32).collect();
    // one entry at an end, the others at their defaults
    let mut at = 0;
    for spec in specs {
        for end in spec.range {
            let mut table = middle.clone();
            table[at..at + spec.len()].fill(end as f32);
            tables.push(table);
        }
        at += spec.len();
    }
    tables.push(middle);
    tables
}

/// Directions where formulas degenerate: at the normal and next to it, at the horizon, along and between the axes, of
/// lengths that are off by 1e-5.
fn directions(domain: Domain) -> Vec<Vec3<f32>> {
    let cosines = [1.0, 1.0 - 1e-7, 0.9999, 0.99, 0.7, 0.3, 0.05, 1e-3, 1e-5, 1.0001e-6];
    let mut all = Vec::new();
    for (i, &z) in cosines.iter().enumerate() {
        for (j, azimuth) in [0.0f64, 45.0, 180.0, 271.0].into_iter().enumerate() {
            let (sin, cos) = azimuth.to_radians().sin_cos();
            let r = (1.0f64 - z * z).sqrt();
            let length = 1.0 + 1e-5 * ((i + j) % 3) as f64 - 1e-5;
            let w = vec3(r * cos, r * sin, z).map(|x| (x * length) as f32);
            let w = vec3(w.x, w.y, w.z.max(1e-6));
            all.push(w);
            if domain != Domain::Upper {
                all.push(vec3(w.x, w.y, -w.z));
            }
        }
    }
    all
}

/// All pairs of these directions, and random numbers with both ends of [0, 1).
struct Grid {
    wi: [Vec<f32>; 3],
    wo: [Vec<f32>; 3],
    u: [Vec<f32>; 3],
    n: usize,
}

impl Grid {
    fn new(domain: Domain, random: &mut Random) -> Grid {
        let directions = directions(domain);
        let mut pairs: Vec<(Vec3<f32>, Vec3<f32>)> = Vec::new();
        for &wi in &directions {
            for &wo in &directions {
                pairs.push((wi, wo));
            }
            pairs.push((vec3(-wi.x, -wi.y, wi.z), wi));
            if domain != Domain::Upper {
                pairs.push((-wi, wi));
            }
        }
        let u = |random: &mut Random| match random.index(5) {
            0 => 0.0,
            1 => 1.0 - f32::EPSILON / 2.0,
            _ => random.unit3_f32()[0],
        };
        let u: Vec<[f32; 3]> = pairs.iter().map(|_| [u(random), u(random), u(random)]).collect();
        Grid {
            wi: [0, 1, 2].map(|c| pairs.iter().map(|p| p.0.to_array()[c]).collect()),
            wo: [0, 1, 2].map(|c| pairs.iter().map(|p| p.1.to_array()[c]).collect()),
            u: [0, 1, 2].map(|c| u.iter().map(|u| u[c]).collect()),
            n: pairs.len(),
        }
    }

    fn at(rows: &[Vec<f32>; 3], i: usize) -> Vec3<f32> {
        vec3(rows[0][i], rows[1][i], rows[2][i])
    }
}

fn sound(values: &[f32]) -> bool {
    values.iter().all(|x| x.is_finite() && *x >= 0.0)
}

/// Checks one draw: wi, weight, pdf, delta.
#[track_caller]
fn assert_draw(model: &dyn Scatter, out: &[f32], wo: Vec3<f32>, table: &[f32]) {
    let length = (f64::from(out[0]).powi(2) + f64::from(out[1]).powi(2) + f64::from(out[2]).powi(2)).sqrt();
    // a mirrored direction keeps the 1e-5 that `wo` is off; facets seen under an angle c add 1e-5/c
    assert!((length - 1.0).abs() < 1e-3, "{} {wo:?} {table:?} drew {out:?}", model.id());
    assert!(sound(&out[3..]), "{} {wo:?} {table:?} drew {out:?}", model.id());
}

#[test]
fn single_calls_are_finite_on_a_grid_of_extremes() {
    for model in registry::all() {
        let mut random = Random::new(1);
        let grid = Grid::new(model.model().domain, &mut random);
        for table in extremes(model.specs(), &mut random) {
            for i in 0..grid.n {
                let (wi, wo) = (Grid::at(&grid.wi, i), Grid::at(&grid.wo, i));
                let (f, pdf) = model.eval_pdf(&table, wi, wo);
                assert!(sound(&f.0) && sound(&[pdf]), "{} {wi:?} {wo:?} {table:?}: {f:?} {pdf}", model.id());
                let s = model.draw(&table, wo, Grid::at(&grid.u, i).to_array());
                let out = [&[s.wi.x, s.wi.y, s.wi.z] as &[f32], &s.weight.0, &[s.pdf, s.delta]].concat();
                assert_draw(model, &out, wo, &table);
                for lobe in model.delta(&table, wo).into_iter().flatten() {
                    let length = lobe.wi.map(f64::from).length();
                    // refraction stretches the 1e-5 by up to eta^2 = 16
                    assert!((length - 1.0).abs() < 2e-4, "{} {wo:?} {table:?}: {lobe:?}", model.id());
                    assert!(sound(&lobe.weight.0) && sound(&[lobe.probability]), "{} {wo:?} {lobe:?}", model.id());
                }
            }
        }
    }
}

#[test]
fn batches_are_finite_on_a_grid_of_extremes() {
    for model in registry::all() {
        let mut random = Random::new(2);
        let grid = Grid::new(model.model().domain, &mut random);
        let columns = |rows: &'static [Vec<f32>; 3]| [0, 1, 2].map(|c| Column::contiguous(&rows[c]));
        let grid: &'static Grid = Box::leak(Box::new(grid));
        let mut rows = vec![vec![0.0f32; grid.n]; CHANNELS + 1 + DRAW_OUTPUTS];
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            for table in extremes(model.specs(), &mut random) {
                let params: Vec<Column> = table.iter().map(Column::uniform).collect();
                let mut targets: Vec<Target> = rows.iter_mut().map(|row| Target::Row(row)).collect();
                let (f, rest) = targets.split_at_mut(CHANNELS);
                let (pdf, draw) = rest.split_at_mut(1);
                let (wi, wo, u) = (columns(&grid.wi), columns(&grid.wo), columns(&grid.u));
                batch::eval(model, isa, &params, wi, wo, grid.n, f);
                batch::pdf(model, isa, &params, wi, wo, grid.n, pdf);
                batch::draw(model, isa, &params, u, wo, grid.n, draw);
                for i in 0..grid.n {
                    let at: Vec<f32> = rows.iter().map(|row| row[i]).collect();
                    let (wi, wo) = (Grid::at(&grid.wi, i), Grid::at(&grid.wo, i));
                    let here = format!("{} {} {wi:?} {wo:?} {table:?}: {at:?}", model.id(), isa.name());
                    assert!(sound(&at[..CHANNELS + 1]), "{here}");
                    assert_draw(model, &at[CHANNELS + 1..], wo, &table);
                }
            }
        }
    }
}

#[test]
fn directions_outside_the_domain_scatter_nothing() {
    let (inf, nan) = (f32::INFINITY, f32::NAN);
    let good = vec3(0.6f32, 0.0, 0.8);
    let odd = [
        vec3(1.0, 0.0, 0.0),
        vec3(0.0, 1.0, 9e-7),
        vec3(nan, 0.0, 1.0),
        vec3(0.0, nan, 1.0),
        vec3(0.0, 0.0, nan),
        vec3(inf, 0.0, 1.0),
        vec3(0.0, -inf, 1.0),
        vec3(0.0, 0.0, inf),
        Vec3::ZERO,
    ];
    for model in registry::all() {
        let table: Vec<f32> = defaults(model.specs()).iter().map(|&p| p as f32).collect();
        let below = (model.model().domain == Domain::Upper).then_some(vec3(0.6f32, 0.0, -0.8));
        for w in odd.into_iter().chain(below) {
            for (wi, wo) in [(w, good), (good, w), (w, w)] {
                let (f, pdf) = model.eval_pdf(&table, wi, wo);
                assert_eq!((f.0, pdf), ([0.0; CHANNELS], 0.0), "{} {wi:?} {wo:?}", model.id());
            }
            let s = model.draw(&table, w, [0.3, 0.6, 0.2]);
            assert_eq!((s.weight.0, s.pdf), ([0.0; CHANNELS], 0.0), "{} {w:?} drew {s:?}", model.id());
            assert!(s.wi.map(f64::from).length().is_finite(), "{} {w:?} drew {s:?}", model.id());
        }
    }
}
