//! What descriptions become.

use lesk_geometry::{EdgeRule, NormalRule, Ray, Transform};
use lesk_image::{Image, Transfer};
use lesk_light::{Light, Receiver};
use lesk_math::{Vec3, vec3};
use lesk_quantities::Quantity;
use lesk_scene::description::*;
use lesk_scene::raster::*;
use lesk_scene::{MAX_PARAMS, Scene, SceneDescription};
use std::path::PathBuf;
use std::sync::Arc;

const HEAD: &str = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 0]\n";

fn scene(text: &str) -> Scene {
    Scene::parse(&format!("{HEAD}{text}"), "").unwrap_or_else(|e| panic!("{e}"))
}

fn flux(scene: &Scene) -> f32 {
    scene.lights.list().iter().map(|l| l.flux(1.0)).sum()
}

#[test]
fn the_cornell_box_has_its_parts_where_they_belong() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes/cornell_box.toml");
    let scene = Scene::load(file).unwrap();
    assert_eq!((scene.film.width, scene.film.height, scene.render.spp), (512, 512, 256));
    let name = |d: Vec3<f32>| {
        let ray = Ray::new(vec3(0.0, -0.2, 0.4), d);
        let surface = scene.world.surface(&ray, &scene.world.intersect(&ray).unwrap());
        // every wall shows its outer side to the room
        assert!(surface.ng.dot(d) < 0.0);
        scene.object(&surface).name.clone()
    };
    assert_eq!(name(vec3(-1.0, 0.0, 0.0)), "left wall");
    assert_eq!(name(vec3(1.0, 0.0, 0.0)), "right wall");
    assert_eq!(name(vec3(0.0, 0.0, 1.0)), "ceiling");
    assert_eq!(name(vec3(0.0, 1.0, 0.0)), "back wall");
    assert_eq!(name(vec3(0.0, 0.2, 0.15)), "panel");
    assert!((flux(&scene) - 3000.0).abs() < 0.01);
    let lamp = scene.objects.iter().find(|o| o.name == "panel").unwrap();
    assert_eq!((lamp.light, lamp.material), (Some(0), None));
    // the panel shines downward
    let at = Receiver::opaque(vec3(0.0, 0.0, 0.4), Vec3::Z);
    assert!(scene.lights.sample(&at, 0.5, [0.5, 0.5]).is_some());
}

#[test]
fn a_thousand_lamps_come_from_three_groups() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes/many_lights.toml");
    let scene = Scene::load(file).unwrap();
    assert_eq!((scene.lights.list().len(), scene.objects.len()), (1000, 1002));
    assert!((flux(&scene) / 40_000.0 - 1.0).abs() < 1e-4);
}

#[test]
fn watts_become_lumens_by_their_spectrum_and_the_scene_says_so() {
    let scene = scene(
        "[[lights]]\nname = \"bulb\"\ntype = \"point\"\nposition = [0, 0, 2]\nflux = \"100 W\"\nspectrum = \"blackbody 2856 K\"",
    );
    // 16.446 lm/W over the whole spectrum (colour-science 0.4.7 tables)
    assert!((flux(&scene) - 1644.6).abs() < 0.1, "{}", flux(&scene));
    assert_eq!(scene.spectra, ["blackbody 2856 K"]);
    assert!(scene.notes.iter().any(|n| n.contains("100 W") && n.contains("K_m = 683.002 lm/W")), "{:?}", scene.notes);
}

#[test]
fn a_spot_given_by_its_flux_says_its_peak_intensity() {
    let spot = |amount: &str| {
        let fields =
            "type = \"spot\"\nposition = [0, 0, 2]\ndirection = [0, 0, -1]\nouter = \"30 deg\"\ninner = \"30 deg\"";
        scene(&format!("[[lights]]\nname = \"beam\"\n{fields}\n{amount}")).notes
    };
    // a hard cone: 1000 lm / (2 pi (1 - cos 30 deg)) = 1187.95 cd
    let notes = spot("flux = \"1000 lm\"");
    let expected = "light `beam`: the cone concentrates 1000 lm to 1187.95 cd on its axis";
    assert!(notes.iter().any(|n| n == expected), "{notes:?}");
    assert!(spot("intensity = \"1000 cd\"").iter().all(|n| !n.contains("cone")));
}

#[test]
fn colour_changes_the_ratios_of_a_light_and_not_its_strength() {
    for color in ["color = [1, 0.1, 0.02]", "temperature = \"2000 K\"", "spectrum = \"E\"", ""] {
        let text = format!("[[lights]]\ntype = \"point\"\nposition = [0, 0, 2]\nintensity = \"10 cd\"\n{color}");
        let scene = scene(&text);
        let Light::Point(point) = &scene.lights.list()[0] else { panic!() };
        assert!((point.intensity().luminance() - 10.0).abs() < 1e-4, "{color}");
    }
}

#[test]
fn steps_of_a_transform_are_applied_in_their_order() {
    let description = SceneDescription::parse(
        &format!(
            "{HEAD}[[objects]]\nshape = \"cube\"\nmaterial = \"a\"\n\
             transform = [{{ translate = [1, 0, 0] }}, {{ rotate = \"90 deg\" }}, {{ scale = [1, 1, 2] }}]"
        ),
        "",
    )
    .unwrap();
    let p = description.objects[0].transform.point(vec3(0.0, 0.0, 1.0));
    assert!((p - vec3(0.0, 1.0, 2.0)).length() < 1e-6, "{p:?}");
}

#[test]
fn look_at_turns_the_front_of_an_object_to_its_target() {
    let description = SceneDescription::parse(
        &format!(
            "{HEAD}[[objects]]\nshape = \"disk\"\nlight = {{ flux = \"1 lm\" }}\n\
             transform = {{ look_at = {{ from = [1, 2, 3], to = [1, 2, 0], up = [0, 1, 0] }} }}"
        ),
        "",
    )
    .unwrap();
    let t = description.objects[0].transform;
    assert!((t.point(Vec3::ZERO) - vec3(1.0, 2.0, 3.0)).length() < 1e-6);
    assert!((t.vector(vec3(0.0, 0.0, 1.0)) - vec3(0.0, 0.0, -1.0)).length() < 1e-6);
    assert!((t.vector(vec3(0.0, 1.0, 0.0)) - vec3(0.0, 1.0, 0.0)).length() < 1e-6);
}

#[test]
fn a_focal_length_of_50_mm_sees_39_6_degrees_and_f_2_opens_25_mm() {
    let text = "version = 1\n[camera]\neye = [0, -3, 0]\ntarget = [0, 0, 0]\nfocal_length = \"50 mm\"\nf_number = 2\n";
    let scene = Scene::parse(text, "").unwrap();
    // 2 atan(18/50)
    assert!((scene.camera.horizontal_fov().to_degrees() - 39.5978).abs() < 1e-4);
    assert!((scene.camera.lens_radius() - 0.0125).abs() < 1e-12);
    assert!((scene.camera.focus_distance() - 3.0).abs() < 1e-12);
}

fn textured(texture: TextureDescription) -> SceneDescription {
    let mut d = SceneDescription::new(CameraDescription::look_at([0.0, -3.0, 0.0], [0.0; 3]));
    d.materials.push(MaterialDescription::new("wood", "lambert").texture("reflectance", texture));
    d.materials.push(MaterialDescription::new("rough", "ggx").set("alpha_x", &[0.3]));
    d.objects.push(ObjectDescription::new(Shape::Sphere { radius: 1.0 }).material("wood"));
    d.lights.push(LightDescription::new(
        LightKind::Directional { direction: [0.0, 0.0, -1.0], diameter: 0.0 },
        Emission::new(Quantity::parse("1 klx").unwrap()),
    ));
    d
}

#[test]
fn textures_are_scaled_and_clamped_and_what_is_clamped_is_counted() {
    // columns of 0, 0.5, 1 and 4
    let image = Image::from_fn(4, 1, Transfer::Linear, |x, _| [[0.0, 0.5, 1.0, 4.0][x as usize]; 3]).unwrap();
    let mut texture = TextureDescription::new(Picture::Image(Arc::new(image)));
    texture.scale = [0.5, 0.25, 0.5];
    texture.offset = 0.1;
    let scene = textured(texture).build().unwrap();
    let wood = &scene.materials[0];
    let mut table = [f32::NAN; MAX_PARAMS];
    for (x, expected) in [(0, [0.1; 3]), (1, [0.35, 0.225, 0.35]), (2, [0.6, 0.35, 0.6]), (3, [1.0; 3])] {
        let got = wood.params([(x as f32 + 0.5) / 4.0, 0.5], &mut table);
        (0..3).for_each(|c| assert!((got[c] - expected[c]).abs() < 1e-6, "{got:?} {expected:?}"));
    }
    let note = "material `wood`: `reflectance`: 1 of 4 texels lie outside 0 to 1 and are clamped";
    assert!(scene.notes.iter().any(|n| n == note), "{:?}", scene.notes);
    let rough = scene.materials[1].params([0.0; 2], &mut table);
    assert_eq!((rough.len(), rough[3], rough[4]), (5, 0.3, 0.2));
}

#[test]
fn colours_of_srgb_images_are_decoded_and_data_is_not() {
    let image = |transfer| Arc::new(Image::from_fn(1, 1, transfer, |_, _| [0.5f32; 3]).unwrap());
    let value = |t: TextureDescription| {
        let scene = textured(t).build().unwrap();
        let mut table = [0.0; MAX_PARAMS];
        scene.materials[0].params([0.5; 2], &mut table)[0]
    };
    // IEC 61966-2-1: ((0.5 + 0.055)/1.055)^2.4
    let decoded = ((0.5f32 + 0.055) / 1.055).powf(2.4);
    let mut t = TextureDescription::new(Picture::Image(image(Transfer::Srgb)));
    assert!((value(t.clone()) - decoded).abs() < 1e-6);
    t.srgb = Some(false);
    assert_eq!(value(t.clone()), 0.5);
    t.role = Some(lesk_image::texture::Role::Data);
    t.srgb = None;
    assert_eq!(value(t), 0.5);
    let mut linear = TextureDescription::new(Picture::Image(image(Transfer::Linear)));
    assert_eq!(value(linear.clone()), 0.5);
    linear.srgb = Some(true);
    assert!((value(linear) - decoded).abs() < 1e-6);
}

#[test]
fn scenes_that_render_alike_have_one_fingerprint_and_others_another() {
    let one = "[[objects]]\nshape = \"sphere\"\nmaterial = \"a\"\n[materials.a]\nmodel = \"lambert\"\n";
    let print = |text: &str| scene(text).fingerprint;
    assert_eq!(print(one), print(&format!("# a comment\n\n{one}[render]\nspp = 7\n")));
    assert_ne!(print(one), print(&one.replace("sphere", "cube")));
    assert_ne!(print(one), print(&format!("{one}reflectance = 0.6\n")));
    let mesh = |x: f32| {
        let mut data = lesk_geometry::cube().into_data();
        data.positions[0].x = x;
        let mut d = SceneDescription::new(CameraDescription::look_at([0.0, -3.0, 0.0], [0.0; 3]));
        d.materials.push(MaterialDescription::new("a", "lambert"));
        let mesh = Triangles(Arc::new(lesk_geometry::Mesh::new(data).unwrap().0));
        d.objects.push(ObjectDescription::new(Shape::Mesh(mesh)).material("a"));
        d.build().unwrap().fingerprint
    };
    assert_eq!(mesh(-1.0), mesh(-1.0));
    assert_ne!(mesh(-1.0), mesh(-1.5));
}

#[test]
fn rasterising_is_as_the_scene_says() {
    let scene = scene(
        r#"
        [render]
        aovs = true
        [raster]
        shading = "gouraud"
        interpolation = "barycentric"
        correction = "screen"
        normals = "max1999"
        crease_angle = "180 deg"
        tessellation = 12
        subdivide = 3
        renormalize = false
        supersampling = 4
        quadrature = 9
        shadows = true
        cull = true
        flat_point = "first"
        space = "gamma"
        [raster.classic]
        ambient = [0.1, 0.2, 0.3]
        diffuse = [0.4, 0.5, 0.6]
        specular = [0.7, 0.8, 0.9]
        ka = 0.2
        kd = 0.3
        ks = 0.5
        shininess = 7
        highlight = "blinn"
        lights = [{ direction = [0, 0, 2], color = [3, 2, 1] }, { direction = [1, 0, 0] }]
        "#,
    );
    let lights = vec![
        ClassicLight { direction: vec3(0.0, 0.0, 2.0), color: [3.0, 2.0, 1.0] },
        ClassicLight { direction: vec3(1.0, 0.0, 0.0), color: [1.0; 3] },
    ];
    let classic = Classic {
        ambient: [0.1, 0.2, 0.3],
        diffuse: [0.4, 0.5, 0.6],
        specular: [0.7, 0.8, 0.9],
        ka: 0.2,
        kd: 0.3,
        ks: 0.5,
        shininess: 7.0,
        highlight: Highlight::Blinn,
        lights,
    };
    // each is another than by default
    let expected = RasterSettings {
        shading: Mode::Gouraud,
        interpolation: Interpolation::Barycentric,
        correction: Correction::Screen,
        normals: NormalRule::Max1999,
        edges: EdgeRule::Crease(std::f64::consts::PI),
        tessellation: 12,
        subdivide: 3,
        renormalize: false,
        supersampling: 4,
        quadrature: 9,
        shadows: true,
        shadow_terminator: None,
        cull: true,
        flat_point: FlatPoint::First,
        space: Space::Gamma,
        classic: Some(classic),
        aovs: true,
    };
    assert_eq!(scene.raster, expected);
}

#[test]
fn problems_of_a_description_name_what_they_are_about() {
    let mut d = SceneDescription::new(CameraDescription::look_at([0.0, -3.0, 0.0], [0.0; 3]));
    d.objects.push(ObjectDescription::new(Shape::Sphere { radius: f64::NAN }).material("a"));
    let mut flat = ObjectDescription::new(Shape::Rectangle { size: [0.0, 1.0] })
        .light(Emission::new(Quantity::parse("5 lm").unwrap()));
    flat.name = "flat".into();
    d.objects.push(flat);
    d.materials.push(MaterialDescription::new("a", "lambert").set("reflectance", &[f64::NAN]));
    let error = d.build().unwrap_err();
    let text = error.to_string();
    for part in ["`reflectance` is NaN", "object `flat` has the extent 0 m"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(error.problems().len(), 2, "{text}");
    assert!(!text.contains("-->"), "{text}");
}

#[test]
fn a_scene_without_light_says_so() {
    let dark = scene("");
    assert!(dark.notes.iter().any(|n| n.contains("no light")));
    assert!(dark.world.intersect(&Ray::new(Vec3::ZERO, Vec3::Z)).is_none());
}

/// The folder of data for the tests, where it is there.
fn shared(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("LESK_SHARED")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")), PathBuf::from);
    let file = root.join("data").join(path);
    if !file.exists() {
        println!("skipped: {} is not there", file.display());
        return None;
    }
    Some(file)
}

fn file_scene(file: PathBuf) -> Scene {
    let mut d = SceneDescription::new(CameraDescription::look_at([0.0, -3.0, 0.0], [0.0; 3]));
    let shape = Shape::File { file, normals: Normals::File };
    d.objects.push(ObjectDescription::new(shape).at(Transform::rotate_x(std::f64::consts::FRAC_PI_2)));
    d.build().unwrap_or_else(|e| panic!("{e}"))
}

fn model(scene: &Scene, object: usize) -> &'static str {
    scene.materials[scene.objects[object].material.unwrap() as usize].model().id()
}

#[test]
fn gltf_files_bring_their_materials_and_glowing_surfaces() {
    for (path, glows, textured) in
        [("CornellBox.glb", true, false), ("NormalTangentTest/NormalTangentTest.glb", false, true)]
    {
        let Some(file) = shared(&format!("meshes/gltf/{path}")) else { continue };
        let scene = file_scene(file);
        assert!((0..scene.objects.len()).all(|i| model(&scene, i) == "metallic_roughness"), "{path}");
        assert_eq!(!scene.lights.is_empty(), glows, "{path}");
        assert_eq!(scene.materials.iter().any(|m| !m.bindings().is_empty()), textured, "{path}");
    }
}

#[test]
fn obj_files_bring_diffuse_and_shiny_materials_and_lamps() {
    let dir = tempfile::tempdir().unwrap();
    let mtl =
        "newmtl matt\nKd 0.2 0.4 0.6\nnewmtl shiny\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 40\nnewmtl lamp\nKd 0 0 0\nKe 7 7 7\n";
    std::fs::write(dir.path().join("a.mtl"), mtl).unwrap();
    let obj =
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nusemtl matt\nf 1 2 3\nusemtl shiny\nf 1 2 3\nusemtl lamp\nf 1 2 3\n";
    std::fs::write(dir.path().join("a.obj"), obj).unwrap();
    let scene = file_scene(dir.path().join("a.obj"));
    assert_eq!([0, 1, 2].map(|i| model(&scene, i)), ["lambert", "modified_phong", "lambert"]);
    let mut table = [0.0; MAX_PARAMS];
    assert_eq!(scene.materials[0].params([0.0; 2], &mut table), [0.2, 0.4, 0.6]);
    // diffuse and specular are brought to 1 together
    let phong = scene.materials[1].params([0.0; 2], &mut table);
    assert!((phong[0] + phong[3] - 1.0).abs() < 1e-6 && phong[6] == 40.0, "{phong:?}");
    // one square metre of 7 cd/m², one side: π L A
    assert!((flux(&scene) - 7.0 * std::f32::consts::PI).abs() < 1e-4);
    assert_eq!(scene.objects[2].light, Some(0));
}

#[test]
fn cameras_and_lights_of_a_gltf_file_are_used() {
    let dir = tempfile::tempdir().unwrap();
    let gltf = r#"{
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1] }],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "spot", "intensity": 50, "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.4 } } ] } },
        "cameras": [{ "type": "perspective", "name": "front", "perspective": { "yfov": 0.5, "znear": 0.1 } }],
        "nodes": [
            { "camera": 0, "name": "front", "translation": [0, 1, 5] },
            { "translation": [0, 3, 0], "rotation": [-0.70710678, 0, 0, 0.70710678],
              "extensions": { "KHR_lights_punctual": { "light": 0 } } } ] }"#;
    std::fs::write(dir.path().join("a.gltf"), gltf).unwrap();
    let text = "version = 1\n[camera]\nfile = \"a.gltf\"\n[film]\nsize = [200, 100]\n[[objects]]\nshape = \"mesh\"\nfile = \"a.gltf\"\n";
    let scene = Scene::parse(text, dir.path()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.camera.position(), vec3(0.0, 1.0, 5.0));
    // twice as wide as high
    let expected = 2.0 * (2.0 * (0.25f64).tan()).atan();
    assert!((scene.camera.horizontal_fov() - expected).abs() < 1e-6);
    let Light::Spot(spot) = &scene.lights.list()[0] else { panic!() };
    assert_eq!(spot.intensity().luminance(), 50.0);
    // the node turns -z down
    let below = scene.lights.sample(&Receiver::opaque(Vec3::ZERO, vec3(0.0, 1.0, 0.0)), 0.5, [0.5; 2]).unwrap();
    assert!((below.value.luminance() - 50.0 / 9.0).abs() < 1e-4);
}
