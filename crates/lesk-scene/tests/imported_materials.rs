//! Materials of glTF files: what their pictures do.

use lesk_geometry::Ray;
use lesk_image::{Image, Transfer, io};
use lesk_light::Light;
use lesk_math::{Vec3, vec3};
use lesk_scene::description::*;
use lesk_scene::{Scene, SceneDescription};
use std::path::{Path, PathBuf};

/// A square from (0, 0) to (1, 1) in the plane z = 0 with coordinates of both sets, and one material.
fn square(folder: &Path, material: &str, extensions: &str) -> Scene {
    let mut buffer: Vec<u8> = Vec::new();
    let mut put = |numbers: &[f32]| numbers.iter().for_each(|x| buffer.extend(x.to_le_bytes()));
    put(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    put(&[0.0, 0.0, 1.0].repeat(4));
    // the file's v runs downward: 1 at y = 0
    put(&[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    put(&[0.5; 8]);
    [0u8, 1, 2, 0, 2, 3].iter().for_each(|&i| buffer.push(i));
    std::fs::write(folder.join("a.bin"), &buffer).unwrap();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "extensionsUsed":[{extensions}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"TEXCOORD_1":3}},
        "indices":4,"material":0}}]}}],"materials":[{material}],
        "textures":[{{"source":0,"sampler":0}}],"samplers":[{{"magFilter":9728}}],"images":[{{"uri":"a.png"}}],
        "buffers":[{{"uri":"a.bin","byteLength":{}}}],
        "bufferViews":[{{"buffer":0,"byteLength":160}},{{"buffer":0,"byteOffset":160,"byteLength":6}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}},
        {{"bufferView":0,"byteOffset":48,"componentType":5126,"type":"VEC3","count":4}},
        {{"bufferView":0,"byteOffset":96,"componentType":5126,"type":"VEC2","count":4}},
        {{"bufferView":0,"byteOffset":128,"componentType":5126,"type":"VEC2","count":4}},
        {{"bufferView":1,"componentType":5121,"type":"SCALAR","count":6}}]}}"#,
        buffer.len()
    );
    std::fs::write(folder.join("a.gltf"), json).unwrap();
    file_scene(folder.join("a.gltf"))
}

fn file_scene(file: PathBuf) -> Scene {
    let mut d = SceneDescription::new(CameraDescription::look_at([0.5, 0.5, 3.0], [0.5, 0.51, 0.0]));
    d.objects.push(ObjectDescription::new(Shape::File { file, normals: Normals::File }));
    d.build().unwrap_or_else(|e| panic!("{e}"))
}

fn picture(folder: &Path, rgb: impl FnMut(u32, u32) -> [f32; 3]) {
    let image = Image::from_fn(2, 2, Transfer::Srgb, rgb).unwrap();
    io::write(folder.join("a.png"), &image).unwrap();
}

/// What is met below (x, y).
fn below(scene: &Scene, x: f32, y: f32) -> lesk_geometry::Surface {
    let ray = Ray::new(vec3(x, y, 1.0), vec3(0.0, 0.0, -1.0));
    scene.world.surface(&ray, &scene.world.intersect(&ray).expect("the square"))
}

#[test]
fn an_emission_picture_shines_where_its_texels_are() {
    let folder = tempfile::tempdir().unwrap();
    // white in the upper right corner, black elsewhere
    picture(folder.path(), |x, y| [f32::from(x == 1 && y == 0); 3]);
    let material = r#"{"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":100}}}"#;
    let scene = square(folder.path(), material, r#""KHR_materials_emissive_strength""#);
    let luminance = |x, y| scene.lights.emitted(0, &below(&scene, x, y), Vec3::Z).luminance();
    for (x, y, expected) in [(0.75, 0.75, 100.0), (0.25, 0.75, 0.0), (0.25, 0.25, 0.0), (0.75, 0.25, 0.0)] {
        assert!((luminance(x, y) - expected).abs() < 1e-3, "{x} {y}: {}", luminance(x, y));
    }
    let Light::Area(area) = &scene.lights.list()[0] else { panic!() };
    // pi L A of a quarter of the square; means are read at some places per texel
    let expected = std::f32::consts::PI * 100.0 * 0.25;
    assert!((area.flux() / expected - 1.0).abs() < 0.15, "{} {expected}", area.flux());
}

#[test]
fn a_picture_on_the_second_texture_coordinates_is_read_there() {
    let folder = tempfile::tempdir().unwrap();
    picture(folder.path(), |x, y| if (x, y) == (1, 1) { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] });
    // all of set 1 is (0.5, 0.5): the texel at whose corner it lies is the one to the lower right
    let material = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}}"#;
    let scene = square(folder.path(), material, "");
    let surface = below(&scene, 0.1, 0.1);
    let detail = scene.world.detail(&surface);
    let mut table = [0.0; lesk_scene::MAX_PARAMS];
    let got = scene.materials[0].params_at(detail.uvs, &mut table);
    assert!(scene.materials[0].needs_detail() && got[..3] == [1.0, 0.0, 0.0], "{got:?} {detail:?}");
}

#[test]
fn a_normal_texture_bends_the_shading_normal_along_the_tangents() {
    let folder = tempfile::tempdir().unwrap();
    // 8 bits of (0.6, 0, 0.8): 127.5 * 1.6 = 204, 127.5, 127.5 * 1.8 = 229.5
    picture(folder.path(), |_, _| [204.0 / 255.0, 128.0 / 255.0, 230.0 / 255.0]);
    let material = r#"{"normalTexture":{"index":0}}"#;
    let scene = square(folder.path(), material, "");
    let surface = below(&scene, 0.3, 0.6);
    let detail = scene.world.detail(&surface);
    let normal = scene.materials[0].normal_map().expect("it has one").normal(&surface, &detail);
    // u runs along x; the picture has 8 bits
    assert!((normal - vec3(0.6, 0.0, 0.8)).length() < 0.01, "{normal:?}");
    assert_eq!(detail.tangent, vec3(1.0, 0.0, 0.0));
}

#[test]
fn a_transmitting_body_is_glass_and_a_thin_sheet_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    picture(folder.path(), |_, _| [1.0; 3]);
    let material = |roughness: f32, volume: &str| {
        format!(
            r#"{{"name":"g","pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":{roughness}}},
            "extensions":{{"KHR_materials_transmission":{{"transmissionFactor":1}},"KHR_materials_ior":{{"ior":1.33}}{volume}}}}}"#
        )
    };
    let used = r#""KHR_materials_transmission","KHR_materials_ior","KHR_materials_volume""#;
    let solid = r#","KHR_materials_volume":{"thicknessFactor":0.1}"#;
    for (roughness, volume, model) in
        [(0.0, solid, "dielectric"), (0.5, solid, "rough_dielectric"), (0.5, "", "metallic_roughness")]
    {
        let scene = square(folder.path(), &material(roughness, volume), used);
        assert_eq!(scene.materials[0].model().id(), model);
        let mut table = [0.0; lesk_scene::MAX_PARAMS];
        let params = scene.materials[0].params([0.0; 2], &mut table);
        if model != "metallic_roughness" {
            assert_eq!(params[0], 1.33);
            assert!(scene.notes.iter().all(|n| !n.contains("transmission")), "{:?}", scene.notes);
        } else {
            assert!(scene.notes.iter().any(|n| n.contains("thin sheet")), "{:?}", scene.notes);
        }
    }
}

#[test]
fn a_scene_file_may_give_a_material_a_normal_map() {
    let folder = tempfile::tempdir().unwrap();
    picture(folder.path(), |_, _| [204.0 / 255.0, 128.0 / 255.0, 230.0 / 255.0]);
    let text = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 0]\n[materials.m]\nmodel = \"lambert\"\n\
                normal_map = { file = \"a.png\", strength = -1, uv_scale = [2, 2] }\n\
                [[objects]]\nshape = \"rectangle\"\nmaterial = \"m\"\n";
    let scene = Scene::parse(text, folder.path()).unwrap_or_else(|e| panic!("{e}"));
    let surface = below(&scene, 0.1, 0.2);
    let normal = scene.materials[0].normal_map().unwrap().normal(&surface, &scene.world.detail(&surface));
    assert!((normal - vec3(-0.6, 0.0, 0.8)).length() < 0.01, "{normal:?}");
    let wrong = text.replace("strength", "strenght");
    let error = Scene::parse(&wrong, folder.path()).unwrap_err().to_string();
    assert!(error.contains("did you mean `strength`?"), "{error}");
}
