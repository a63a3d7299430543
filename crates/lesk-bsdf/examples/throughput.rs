//! Throughput of batches, M/s on one core: `cargo run --release -p lesk-bsdf --example throughput [MODEL]`.

use lesk_bsdf::batch::{self, Column, Target};
use lesk_bsdf::{params, registry};
use lesk_math::Isa;
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let only = std::env::args().nth(1);
    for n in [512, 1 << 20] {
        println!("{n} directions; eval SoA, eval (N,3), pdf, draw, eval with one array parameter; M/s");
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        let mut directions = || -> Vec<f32> {
            let one = |_| {
                let (u, phi) = (next(), next() * std::f32::consts::TAU);
                let (z, r) = (u.sqrt(), (1.0 - u).sqrt());
                [r * phi.cos(), r * phi.sin(), z]
            };
            (0..n).flat_map(one).collect()
        };
        let (wi, wo) = (directions(), directions());
        let u: Vec<f32> = (0..3 * n).map(|_| next()).collect();
        let split = |v: &[f32]| -> [Vec<f32>; 3] { [0, 1, 2].map(|c| v[c..].iter().step_by(3).copied().collect()) };
        let (wi3, wo3, u3) = (split(&wi), split(&wo), split(&u));
        let columns = |v: &'static [Vec<f32>; 3]| [0, 1, 2].map(|c| Column::contiguous(&v[c]));
        let leak = |v: [Vec<f32>; 3]| -> &'static [Vec<f32>; 3] { Box::leak(Box::new(v)) };
        let (wi3, wo3, u3) = (columns(leak(wi3)), columns(leak(wo3)), columns(leak(u3)));
        for model in registry::all().filter(|m| only.as_deref().is_none_or(|id| id == m.id())) {
            let values: Vec<f32> = params::defaults(model.specs()).iter().map(|&x| x as f32).collect();
            let uniform: Vec<Column> = values.iter().map(Column::uniform).collect();
            let last = vec![values[values.len() - 1]; n];
            let mut varying = uniform.clone();
            *varying.last_mut().unwrap() = Column::contiguous(&last);
            for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
                let mut rows: Vec<Vec<f32>> = vec![vec![0.0; n]; 8];
                let mut flat = vec![0.0; 3 * n];
                let mut time = |f: &mut dyn FnMut(&mut [Target], &mut [f32]) -> usize| {
                    let repeat = (1 << 21) / n;
                    let mut targets: Vec<Target> = rows.iter_mut().map(|row| Target::Row(row)).collect();
                    let mut seconds: Vec<f64> = (0..7)
                        .map(|_| {
                            let start = Instant::now();
                            for _ in 0..repeat {
                                f(&mut targets, &mut flat);
                            }
                            start.elapsed().as_secs_f64()
                        })
                        .collect();
                    seconds.sort_by(f64::total_cmp);
                    black_box(&targets);
                    (n * repeat) as f64 / seconds[1] * 1e-6
                };
                let a = time(&mut |r, _| batch::eval(model, isa, &uniform, wi3, wo3, n, &mut r[..3]));
                let (wi, wo) = (Column::interleaved(&wi, n), Column::interleaved(&wo, n));
                let b =
                    time(&mut |_, f| batch::eval(model, isa, &uniform, wi, wo, n, &mut [Target::Interleaved(f, 3)]));
                let c = time(&mut |r, _| batch::pdf(model, isa, &uniform, wi3, wo3, n, &mut r[..1]));
                let d = time(&mut |r, _| batch::draw(model, isa, &uniform, u3, wo3, n, &mut r[..8]));
                let e = time(&mut |r, _| batch::eval(model, isa, &varying, wi3, wo3, n, &mut r[..3]));
                println!("  {:24} {:9} {a:7.0} {b:7.0} {c:7.0} {d:7.0} {e:7.0}", model.id(), isa.name());
            }
        }
    }
}
