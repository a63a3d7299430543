//! The classic local model knows the interpolated normal and nothing else: against the closed form in f64, whose normals and
//! weights come from rays that meet the same faces.

use lesk_geometry::{Hit, World};
use lesk_math::Vec3;
use lesk_raster::{Classic, ClassicLight, Frame, Interpolation, Mode, Raster, Settings};
use lesk_scene::Scene;
use std::sync::Arc;

const SIZE: u32 = 96;

fn scene(object: &str, lights: &str) -> Scene {
    let text = format!(
        "version = 1\n[camera]\neye = [0.4, -4, 1.1]\ntarget = [0, 0, 0]\nfov = \"36 deg\"\n[film]\nsize = [{SIZE}, {SIZE}]\n\
         [materials.m]\nmodel = \"lambert\"\n[[objects]]\nmaterial = \"m\"\n{object}\n{lights}"
    );
    Scene::parse(&text, ".").unwrap_or_else(|e| panic!("{e}"))
}

const SPHERE: &str = "shape = \"sphere\"";
const PIPE: &str = "shape = \"cylinder\"\nradius = \"0.8 m\"\nheight = \"0.6 m\"\ncapped = false\n\
                    transform = [{ rotate = \"35 deg\", axis = [1, 0, 0] }]";

/// Lights from the side, from behind, from the viewer, and along the rim.
const LIGHTS: [[f32; 3]; 4] = [[1.0, 0.1, 0.2], [0.1, 1.0, 0.1], [0.1, -1.0, 0.2], [-0.3, 0.2, 1.0]];

fn model(light: [f32; 3]) -> Classic {
    let light = ClassicLight { direction: light.into(), color: [1.0; 3] };
    Classic { ka: 0.0, kd: 0.6, ks: 0.4, shininess: 10.0, lights: vec![light], ..Classic::default() }
}

/// I_D + I_S in f64.
fn closed_form(n: Vec3<f64>, wo: Vec3<f64>, light: [f32; 3]) -> f64 {
    let wi = Vec3::from(light.map(f64::from)).normalize();
    let cos_alpha = n.dot(wi).max(0.0);
    let cos_beta = (n * (2.0 * cos_alpha) - wi).dot(wo).max(0.0);
    if cos_alpha > 0.0 { 0.6 * cos_alpha + 0.4 * cos_beta.powi(10) } else { 0.0 }
}

struct Setup {
    scene: Scene,
    frame: Frame,
    world: World,
}

fn draw(object: &str, lights: &str, settings: &Settings) -> Setup {
    let scene = scene(object, lights);
    let mut raster = Raster::new(Arc::new(scene.clone()), settings).unwrap();
    let (frame, world) = (raster.frame(), raster.world().unwrap());
    Setup { scene, frame, world }
}

/// What a ray finds of a face: weights of its corners, their places and normals, turned as the face shows them.
struct Seen {
    weights: [f64; 3],
    positions: [Vec3<f64>; 3],
    normals: [Vec3<f64>; 3],
}

impl Setup {
    fn hit(&self, x: u32, y: u32) -> Option<Hit> {
        self.world.intersect(&self.scene.camera.ray([x as f32 + 0.5, y as f32 + 0.5], [0.5; 2]))
    }

    fn seen(&self, hit: &Hit) -> Seen {
        let mesh = self.world.geometry_of(hit.instance).mesh().unwrap();
        let [a, b, c] = mesh.corners(hit.prim as usize).map(|p| p.map(f64::from));
        let eye = self.scene.camera.position().map(f64::from);
        let sign = (b - a).cross(c - a).dot(eye - a).signum();
        let normals =
            mesh.triangles()[hit.prim as usize].map(|v| mesh.normals()[v as usize].map(f64::from).normalize() * sign);
        let (u, v) = (f64::from(hit.u), f64::from(hit.v));
        Seen { weights: [1.0 - u - v, u, v], positions: [a, b, c], normals }
    }

    fn towards_viewer(&self, p: Vec3<f64>) -> Vec3<f64> {
        (self.scene.camera.position().map(f64::from) - p).normalize()
    }

    /// Compares the pixels in whose neighbourhood rays meet one face alone; returns how many there were.
    fn compare(&self, expected: impl Fn(&Seen) -> f64, tolerance: f64) -> usize {
        let mut count = 0;
        for (x, y) in (1..SIZE - 1).flat_map(|y| (1..SIZE - 1).map(move |x| (x, y))) {
            let Some(hit) = self.hit(x, y) else { continue };
            let around = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
            if around.iter().any(|&(x, y)| self.hit(x, y).is_none_or(|h| h.prim != hit.prim)) {
                continue;
            }
            let value = f64::from(self.frame.rgb[3 * (y * SIZE + x) as usize]);
            let expected = expected(&self.seen(&hit));
            assert!((value - expected).abs() < tolerance, "{x}, {y}: {value}, {expected}");
            count += 1;
        }
        count
    }
}

fn settings(shading: Mode, light: Option<[f32; 3]>) -> Settings {
    Settings {
        shading,
        interpolation: Interpolation::Barycentric,
        tessellation: 12,
        classic: light.map(model),
        ..Settings::default()
    }
}

#[test]
fn vertices_are_lit_by_their_own_normals_in_front_of_the_silhouette_and_behind_it() {
    // light from anywhere; 1e-5: cos^10 multiplies the error of an f32 cosine, 1e-7, by ten, and rays find their weights in f32
    for (object, least) in [(SPHERE, 1500), (PIPE, 500)] {
        for light in LIGHTS {
            let setup = draw(object, "", &settings(Mode::Gouraud, Some(light)));
            let mut bright = 0.0f64;
            let count = setup.compare(
                |seen| {
                    let parts = [0, 1, 2].map(|k| {
                        let wo = setup.towards_viewer(seen.positions[k]);
                        seen.weights[k] * closed_form(seen.normals[k], wo, light)
                    });
                    parts.iter().sum()
                },
                1e-5,
            );
            setup.frame.rgb.iter().for_each(|&v| bright = bright.max(f64::from(v)));
            assert!(count > least, "{object}, {light:?}: {count} pixels");
            assert!(bright <= 1.0, "{bright}");
        }
    }
}

#[test]
fn pixels_are_lit_by_the_interpolated_normal_and_no_face_turns_black_as_a_whole() {
    for (object, least) in [(SPHERE, 1500), (PIPE, 500)] {
        for light in LIGHTS {
            let setup = draw(object, "", &settings(Mode::Phong, Some(light)));
            let expected = |seen: &Seen| {
                let mean =
                    |of: &[Vec3<f64>; 3]| of[0] * seen.weights[0] + of[1] * seen.weights[1] + of[2] * seen.weights[2];
                closed_form(mean(&seen.normals).normalize(), setup.towards_viewer(mean(&seen.positions)), light)
            };
            let count = setup.compare(expected, 1e-5);
            assert!(count > least, "{object}, {light:?}: {count} pixels");
        }
    }
}

#[test]
fn the_terminator_of_a_coarse_sphere_has_no_steps() {
    // light from the side: brightness is continuous over the border between two faces, so neighbouring pixels differ by
    // no more than the slope of the cosine: k_D * pixel / radius, and pixels at the rim, where faces turn away fast, do not
    // count. A face that went black as a whole would leave a step of k_D * sin of the angle between faces, 0.6 * 0.26.
    let light = [1.0, 0.0, 0.2];
    let matte = Classic { ks: 0.0, ..model(light) };
    let setup = draw(SPHERE, "", &Settings { classic: Some(matte), ..settings(Mode::Phong, None) });
    let lit = |x: u32, y: u32| setup.frame.rgb[3 * (y * SIZE + x) as usize];
    let mut largest = 0.0f32;
    for y in SIZE / 2 - 12..SIZE / 2 + 12 {
        for x in SIZE / 2 - 20..SIZE / 2 + 20 {
            largest = largest.max((lit(x, y) - lit(x + 1, y)).abs());
        }
    }
    // 96 pixels are 2.6 m at the sphere: 0.6 * 0.027 / 1, and the interpolated normal turns up to twice as fast
    assert!(largest < 0.035, "{largest}");
}

#[test]
fn light_from_behind_makes_no_rim_of_any_material() {
    // behind the sphere as the viewer sees it: what shows is turned from the light
    let sun = "[[lights]]\ntype = \"directional\"\ndirection = [0.4, -4, 1.1]\nilluminance = \"100 lx\"\n";
    let front = "[[lights]]\ntype = \"directional\"\ndirection = [-0.4, 4, -1.1]\nilluminance = \"100 lx\"\n";
    for shading in [Mode::Gouraud, Mode::Flat, Mode::Phong] {
        let dark = draw(SPHERE, sun, &settings(shading, None));
        assert!(dark.frame.work.samples > 2000);
        assert!(dark.frame.rgb.iter().all(|&v| v == 0.0), "{shading:?}");
        let lit = draw(SPHERE, front, &settings(shading, None));
        assert!(lit.frame.rgb.iter().any(|&v| v > 10.0), "{shading:?}");
    }
}

#[test]
fn an_open_surface_is_lit_on_both_sides() {
    let square = "shape = \"rectangle\"\nwidth = \"2 m\"\nheight = \"2 m\"\ntransform = [{ rotate = \"90 deg\", axis = [1, 0, 0] }]";
    let turned = square.replace("90 deg", "-90 deg");
    for shading in [Mode::Flat, Mode::Gouraud, Mode::Phong] {
        let [front, back] = [square, &turned].map(|object| {
            // spans of a square are the same on both sides, its diagonals are not
            let bilinear =
                Settings { interpolation: Interpolation::Bilinear, ..settings(shading, Some([0.3, -1.0, 0.4])) };
            let setup = draw(object, "", &bilinear);
            f64::from(setup.frame.rgb[3 * (SIZE / 2 * SIZE + SIZE / 2) as usize])
        });
        assert!(front > 0.4 && (front - back).abs() < 1e-3, "{shading:?}: {front}, {back}");
    }
}
