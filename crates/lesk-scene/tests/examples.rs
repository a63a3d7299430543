//! The scenes of `examples/scenes`.

use lesk_scene::Scene;
use std::path::{Path, PathBuf};

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "toml"));
    files.sort();
    files
}

#[test]
fn every_example_loads() {
    assert!(examples().len() >= 5);
    for file in examples() {
        let scene = Scene::load(&file).unwrap_or_else(|e| panic!("{e}"));
        assert!(!scene.title.is_empty(), "{}", file.display());
    }
}
