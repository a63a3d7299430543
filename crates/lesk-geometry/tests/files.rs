//! Files of other programs in the shared data folder; skipped where that is absent.

use lesk_geometry::import::{Asset, Description, ImageSource};
use std::path::PathBuf;

fn shared(file: &str) -> Option<PathBuf> {
    let root = std::env::var_os("LESK_SHARED").map(PathBuf::from);
    let root = root.unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").into());
    let path = root.join("data/meshes").join(file);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {} is absent", path.display());
    None
}

fn read(file: &str) -> Option<Asset> {
    let path = shared(file)?;
    Some(Asset::read(&path).unwrap_or_else(|e| panic!("{e}")))
}

fn triangles(asset: &Asset) -> usize {
    asset.meshes.iter().map(|m| m.mesh.triangles().len()).sum()
}

#[test]
fn obj_files_have_the_faces_that_their_manifest_counts() {
    // 12600 quads; 468 quads and 32 triangles; spot in two forms
    for (file, quads, singles) in
        [("teapot.obj", 12600, 0), ("suzanne.obj", 468, 32), ("spot/spot_triangulated.obj", 0, 5856)]
    {
        let Some(asset) = read(file) else { continue };
        let dropped: usize = asset.warnings.iter().filter(|w| w.contains("without area")).count();
        let found = triangles(&asset);
        assert!(found == 2 * quads + singles || dropped > 0, "{file}: {found} {:?}", asset.warnings);
    }
}

#[test]
fn the_cornell_box_has_its_materials() {
    let Some(asset) = read("cornellbox/CornellBox-Original-Merged.obj") else { return };
    assert!(triangles(&asset) >= 30, "{:?}", asset.warnings);
    // its material library is not there: a warning, not an error
    assert!(asset.warnings.iter().any(|w| w.contains("material library")), "{:?}", asset.warnings);
}

#[test]
fn the_teapot_in_quads_agrees_with_the_built_in_one() {
    let Some(asset) = read("teaset/teapot_quads.obj") else { return };
    let own = lesk_geometry::teapot(8);
    let mesh = &asset.meshes[0].mesh;
    assert_eq!(mesh.triangles().len(), own.triangles().len());
    // the file has six digits; the diagonals differ
    assert!((mesh.area() / own.area() - 1.0).abs() < 1e-3, "{} {}", mesh.area(), own.area());
    assert!(asset.warnings.is_empty(), "{:?}", asset.warnings);
}

#[test]
fn gltf_files_are_read_with_nodes_materials_and_images() {
    for file in [
        "boombox.glb",
        "shaderball.glb",
        "shaderball/neutral_objects.glb",
        "shaderball/openpbr_objects.glb",
        "gltf/AnalyticalCubes/AnalyticalCubes.gltf",
        "gltf/AnalyticalSpheres/AnalyticalSpheres.gltf",
        "gltf/CornellBox.glb",
        "gltf/NormalTangentTest/NormalTangentTest.glb",
        "gltf/TextureCoordinateTest/TextureCoordinateTest.gltf",
    ] {
        let Some(asset) = read(file) else { continue };
        println!(
            "{file}: {} meshes, {} triangles, {} instances, {} materials, {} cameras, {} lights; {:?}",
            asset.meshes.len(),
            triangles(&asset),
            asset.instances.len(),
            asset.materials.len(),
            asset.cameras.len(),
            asset.lights.len(),
            asset.warnings
        );
        assert!(triangles(&asset) > 0 && !asset.instances.is_empty(), "{file}");
        let is_gltf = |d: &Description| matches!(d, Description::MetallicRoughness(_));
        assert!(asset.materials.iter().all(|m| is_gltf(&m.description)));
    }
}

#[test]
fn embedded_and_neighbouring_images_are_found() {
    let image = |file: &str| {
        let asset = read(file)?;
        let textures = asset.materials.into_iter().filter_map(|m| match m.description {
            Description::MetallicRoughness(m) => m.base_color_texture,
            Description::Mtl(_) => None,
        });
        textures.map(|t| t.image).next()
    };
    if let Some(ImageSource::Embedded { bytes, .. }) = image("gltf/NormalTangentTest/NormalTangentTest.glb") {
        assert!(bytes.starts_with(b"\x89PNG") || bytes.starts_with(b"\xff\xd8"));
    }
    if let Some(ImageSource::File(path)) = image("gltf/AnalyticalCubes/AnalyticalCubes.gltf") {
        assert!(path.ends_with("AnalyticalCubes_BaseColor.png") && path.exists());
    }
}

#[test]
fn extensions_that_are_left_out_are_named() {
    let Some(asset) = read("gltf/AnisotropyBarnLamp/AnisotropyBarnLamp.gltf") else { return };
    for name in ["KHR_materials_anisotropy", "KHR_materials_clearcoat"] {
        assert!(asset.warnings.iter().any(|w| w.contains(name)), "{:?}", asset.warnings);
    }
}
