//! Shades a scene file: `cargo run --release -p lesk-raster --example shade SCENE OUT.png [flat|gouraud|phong] [FRAMES] [cull]`.

use lesk_image::{ToneMapper, io, tonemap};
use lesk_raster::{Frame, Raster, Settings};
use lesk_scene::Scene;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(scene), Some(out)) = (arguments.next(), arguments.next()) else {
        return Err("usage: shade SCENE OUT.png [flat|gouraud|phong] [FRAMES] [cull]".into());
    };
    let scene = Arc::new(Scene::load(&scene)?);
    let mut settings = Settings::default();
    if let Some(mode) = arguments.next() {
        settings.shading = mode.parse()?;
    }
    let frames = arguments.next().map_or(Ok(1), |n| n.parse())?;
    settings.cull = arguments.next().is_some_and(|word| word == "cull");
    let mut raster = Raster::new(scene.clone(), &settings)?;
    raster.warnings().iter().for_each(|w| eprintln!("warning: {w}"));
    let mut frame = Frame::default();
    let mut times = Vec::new();
    for _ in 0..frames {
        raster.draw(&mut frame);
        times.push(frame.work.elapsed.as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    println!("{:?}, median {:.2} ms", frame.work, times[times.len() / 2]);
    let image = frame.film()?.image();
    let ev100 = scene.film.ev100.or_else(|| tonemap::meter(&image)).unwrap_or(0.0);
    io::write(&out, &tonemap::develop(&image, ev100, ToneMapper::Srgb))?;
    Ok(())
}
