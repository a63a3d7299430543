//! Writes good files for every target into fuzz/corpus, for the fuzzer to start from.

use lesk_image::{Image, Planes, Transfer, io};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("fuzz lies in the root");
    let corpus = root.join("fuzz/corpus");
    let save = |target: &str, name: &str, bytes: &[u8]| {
        let folder = corpus.join(format!("fuzz_{target}"));
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(name), bytes)
    };
    let meshes = root.join("crates/lesk-geometry/tests/corpus");
    for (target, name) in
        [("obj", "pyramid.obj"), ("mtl", "materials.mtl"), ("ply", "ascii.ply"), ("gltf", "triangle.gltf")]
    {
        save(target, name, &std::fs::read(meshes.join(name))?)?;
    }
    for entry in std::fs::read_dir(root.join("examples/scenes"))? {
        let path = entry?.path();
        save("scene", &path.file_name().expect("a file").to_string_lossy(), &std::fs::read(&path)?)?;
    }
    let picture = Image::from_fn(40, 30, Transfer::Srgb, |x, y| {
        [x as f32 / 40.0, y as f32 / 30.0, ((x * 7 + y * 13) as f32 * 0.1).sin().abs()]
    })?;
    save("hdr", "gradient.hdr", &io::hdr::encode(&picture)?)?;
    save("png", "gradient.png", &io::png::encode(&picture, io::png::Depth::Eight, &[("note", "seed")])?)?;
    let mut planes = Planes::new(40, 30)?;
    planes.push_image("", &picture)?;
    save("exr", "gradient.exr", &io::exr::encode(&planes)?)?;
    save("spectrum", "lamp.csv", b"nm,W/m2/nm\n400,0.1\n550,1.5\n700,0.2\n")?;
    save("quantity", "line.txt", b"1 W @ 600 nm")?;
    println!("seeds are in {}", corpus.display());
    Ok(())
}
