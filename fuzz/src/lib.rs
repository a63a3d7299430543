//! Fuzzing of every reader of files: what must hold for any bytes.
//!
//! ```sh
//! cargo run --release -p lesk-fuzz --example seeds          # good files to start from, in fuzz/corpus
//! cargo +nightly fuzz run fuzz_gltf -- -max_total_time=60
//! cargo run --release -p lesk-fuzz --bin fuzz_gltf -- FILE...  # replays files, on stable Rust
//! ```
//!
//! The same readers have a corpus of damaged files in the tests of their crates, which run on stable Rust with every
//! `cargo xtask test`; this crate looks longer and with coverage as its guide.

use lesk_geometry::import::{self, Asset};
use lesk_image::{Image, io};
use std::path::Path;

/// Makes a program of a reader: a fuzz target under `cargo fuzz`, else one that replays the files it is given.
#[macro_export]
macro_rules! target {
    ($reader:ident) => {
        #[cfg(fuzzing)]
        libfuzzer_sys::fuzz_target!(|bytes: &[u8]| $crate::$reader(bytes));

        #[cfg(not(fuzzing))]
        fn main() -> std::io::Result<()> {
            $crate::replay($crate::$reader)
        }
    };
}

/// Gives every file of the command line to a reader.
///
/// # Errors
/// A file that cannot be read.
pub fn replay(reader: fn(&[u8])) -> std::io::Result<()> {
    for file in std::env::args().skip(1) {
        reader(&std::fs::read(&file)?);
        println!("{file}: fine");
    }
    Ok(())
}

/// Wavefront OBJ.
pub fn obj(bytes: &[u8]) {
    asset(import::obj::from_bytes(bytes));
}

/// Wavefront MTL.
pub fn mtl(bytes: &[u8]) {
    asset(import::mtl::from_bytes(bytes));
}

/// PLY, ascii and binary.
pub fn ply(bytes: &[u8]) {
    asset(import::ply::from_reader(bytes, bytes.len() as u64, "fuzz"));
}

/// glTF and GLB.
pub fn gltf(bytes: &[u8]) {
    asset(import::gltf::from_bytes(bytes));
}

/// Radiance HDR.
pub fn hdr(bytes: &[u8]) {
    image(io::hdr::decode(bytes));
}

/// PNG.
pub fn png(bytes: &[u8]) {
    image(io::png::decode(bytes));
}

/// OpenEXR.
pub fn exr(bytes: &[u8]) {
    image(io::exr::decode(bytes).and_then(|planes| planes.picture()));
}

/// Tables of spectra.
pub fn spectrum(bytes: &[u8]) {
    if let Ok(light) = lesk_quantities::Spectrum::from_text("fuzz", &String::from_utf8_lossy(bytes)) {
        assert!(light.energy(None) > 0.0 && light.energy(None).is_finite());
        let _ = lesk_quantities::colorimetry::color_rendering(&light);
    }
}

/// Quantities as text, like `1 W @ 600 nm`.
pub fn quantity(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(given) = lesk_quantities::conversion::Given::parse(text) {
        let again = lesk_quantities::conversion::Given::parse(&given.to_string());
        assert_eq!(again.as_ref(), Ok(&given));
    }
}

/// Scene files. The folder that they name does not exist: the fuzzer opens no file.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Err(error) = lesk_scene::Scene::parse(text, Path::new("no-such-folder")) {
        assert!(error.to_string().starts_with("error: "), "{error}");
    }
}

/// What holds for every mesh file: a message, or indices within their lists and finite positions.
fn asset(result: lesk_geometry::Result<Asset>) {
    let asset = match result {
        Ok(asset) => asset,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    for m in &asset.meshes {
        let count = m.mesh.positions().len() as u32;
        assert!(m.mesh.triangles().iter().flatten().all(|&i| i < count));
        assert!(m.mesh.positions().iter().all(|p| p.length().is_finite()));
        assert!(m.material.is_none_or(|i| i < asset.materials.len()));
    }
    assert!(asset.instances.iter().all(|i| i.mesh < asset.meshes.len()));
}

/// What holds for every picture: a message, or as many numbers as its size says.
fn image(result: Result<Image, lesk_image::ImageError>) {
    match result {
        Ok(image) => {
            assert_eq!(image.data().len(), image.width() as usize * image.height() as usize * image.channels());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
