//! Measures exports: milliseconds per model for the five text languages, each from recording to text.

use lesk_shader::{Language, Options, Part, export};
use std::time::Instant;

fn main() -> Result<(), lesk_shader::Error> {
    const ROUNDS: u32 = 20;
    println!("{:28} {:>8} {:>8}  bytes of WGSL", "model", "eval", "all");
    for model in lesk_bsdf::registry::all() {
        let mut times = Vec::new();
        for parts in [&Part::ALL[..1], &Part::ALL[..]] {
            let mut best = f64::INFINITY;
            for _ in 0..ROUNDS {
                let start = Instant::now();
                for language in Language::ALL.into_iter().filter(|l| *l != Language::SpirV) {
                    export(model, parts, language, Options::default())?;
                }
                best = best.min(start.elapsed().as_secs_f64() * 1e3);
            }
            times.push(best);
        }
        let size = export(model, &Part::ALL, Language::Wgsl, Options::default())?.as_bytes().len();
        println!("{:28} {:8.2} {:8.2}  {size}", model.id(), times[0], times[1]);
    }
    Ok(())
}
