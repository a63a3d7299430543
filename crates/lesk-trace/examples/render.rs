//! Renders a scene file to a picture: `cargo run --release -p lesk-trace --example render SCENE OUT [SPP [SEED]]`; OUT.exr
//! is linear, any other format is developed.

use lesk_image::{ToneMapper, io, tonemap};
use lesk_scene::Scene;
use lesk_trace::{Settings, film_for, render};
use std::error::Error;
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(scene), Some(out)) = (arguments.next(), arguments.next()) else {
        return Err("usage: render SCENE OUT [SPP [SEED]]".into());
    };
    let scene = Scene::load(&scene)?;
    let mut settings = Settings { render: scene.render.clone(), time: None };
    if let Some(spp) = arguments.next() {
        settings.render.spp = spp.parse()?;
    }
    if let Some(seed) = arguments.next() {
        settings.render.seed = seed.parse()?;
    }
    let mut film = film_for(&scene, &settings)?;
    let start = std::time::Instant::now();
    render(&scene, &settings, &mut film, |_, _| ControlFlow::Continue(()));
    let samples = f64::from(film.width()) * f64::from(film.height()) * f64::from(settings.render.spp);
    println!("{:.3} Msamples/s", samples / start.elapsed().as_secs_f64() * 1e-6);
    let image = film.image();
    if out.ends_with(".exr") {
        return Ok(io::write(&out, &image)?);
    }
    let ev100 = scene.film.ev100.or_else(|| tonemap::meter(&image)).unwrap_or(0.0);
    println!("exposed for EV100 {ev100:.2}");
    io::write(&out, &tonemap::develop(&image, ev100, ToneMapper::Srgb))?;
    Ok(())
}
