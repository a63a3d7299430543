//! Pictures whose answer is known, and what must not change them.

use lesk_raster::{Classic, ClassicLight, Correction, Count, Frame, Interpolation, Mode, Raster, Settings, Space};
use lesk_scene::Scene;
use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Duration;

fn parse(text: &str) -> Scene {
    Scene::parse(text, ".").unwrap_or_else(|e| panic!("{e}"))
}

/// A camera at (0, 0, 4) looking down on an object at the origin, 64 x 64 pixels, 40 degrees.
fn from_above(up: [f64; 3], object: &str, lights: &str) -> Scene {
    parse(&format!(
        "version = 1\n[camera]\neye = [0, 0, 4]\ntarget = [0, 0, 0]\nup = {up:?}\nfov = \"40 deg\"\n\
         [film]\nsize = [64, 64]\n[materials.m]\nmodel = \"lambert\"\nreflectance = 0.6\n\
         [[objects]]\nmaterial = \"m\"\n{object}\n{lights}"
    ))
}

const LAMP: &str = "[[lights]]\ntype = \"point\"\nposition = [0.5, 0.3, 1.5]\nintensity = \"100 cd\"\n";
const SQUARE: &str = "shape = \"rectangle\"\nwidth = \"2 m\"\nheight = \"2 m\"";

fn frame(scene: &Scene, settings: &Settings) -> Frame {
    Raster::new(Arc::new(scene.clone()), settings).unwrap_or_else(|e| panic!("{e}")).frame()
}

fn with(change: impl Fn(&mut Settings)) -> Settings {
    let mut settings = Settings::default();
    change(&mut settings);
    settings
}

/// Where the ray of a pixel centre meets the plane z = 0.
fn on_plane(x: usize, y: usize) -> [f64; 2] {
    let reach = 4.0 * 20f64.to_radians().tan();
    [(2.0 * (x as f64 + 0.5) / 64.0 - 1.0) * reach, (1.0 - 2.0 * (y as f64 + 0.5) / 64.0) * reach]
}

#[test]
fn a_square_under_a_lamp_has_the_luminance_of_the_closed_form() {
    // f32: positions of 1 m to 6e-8, a dozen roundings; faces of four corners are interpolated from a grid of 1/256 pixel,
    // and light changes by 4 % per pixel
    for (interpolation, tolerance) in [(Interpolation::Barycentric, 3e-6), (Interpolation::Bilinear, 1e-4)] {
        let settings = with(|s| s.interpolation = interpolation);
        let frame = frame(&from_above([0.0, 1.0, 0.0], SQUARE, LAMP), &settings);
        let mut covered = 0;
        for (k, rgb) in frame.rgb.as_chunks::<3>().0.iter().enumerate() {
            let [x, y] = on_plane(k % 64, k / 64);
            if x.abs() > 1.0 || y.abs() > 1.0 {
                assert_eq!(*rgb, [0.0; 3]);
                continue;
            }
            covered += 1;
            // L = rho / pi * I cos / d^2
            let d2 = (x - 0.5).powi(2) + (y - 0.3).powi(2) + 1.5f64.powi(2);
            let expected = 0.6 / PI * 100.0 * 1.5 / d2.powf(1.5);
            assert!((f64::from(rgb[0]) / expected - 1.0).abs() < tolerance, "{x} {y}: {rgb:?} {expected}");
        }
        assert_eq!(covered as u64, frame.work.samples);
        assert_eq!(frame.work.evaluations, frame.work.samples);
    }
}

#[test]
fn gouraud_interpolates_the_light_of_the_corners_bilinearly() {
    let scene = from_above([0.0, 1.0, 0.0], SQUARE, LAMP);
    let frame = frame(&scene, &with(|s| s.shading = Mode::Gouraud));
    assert_eq!(frame.work.evaluations, 4);
    let light = |x: f64, y: f64| {
        let d2 = (x - 0.5).powi(2) + (y - 0.3).powi(2) + 1.5f64.powi(2);
        0.6 / PI * 100.0 * 1.5 / d2.powf(1.5)
    };
    for (k, rgb) in frame.rgb.as_chunks::<3>().0.iter().enumerate() {
        let [x, y] = on_plane(k % 64, k / 64);
        if x.abs() > 1.0 || y.abs() > 1.0 {
            continue;
        }
        let (u, v) = (0.5 * (x + 1.0), 0.5 * (y + 1.0));
        let row = |y: f64| (1.0 - u) * light(-1.0, y) + u * light(1.0, y);
        let expected = (1.0 - v) * row(-1.0) + v * row(1.0);
        // corners stand on a grid of 1/256 pixel: 1/512 of 22 pixels, times the contrast across the square
        let tolerance = 1e-4 * expected + (light(1.0, 1.0) - light(-1.0, -1.0)).abs() / 512.0 / 22.0;
        assert!((f64::from(rgb[0]) - expected).abs() < tolerance, "{x} {y}: {} {expected}", rgb[0]);
    }
}

#[test]
fn flat_shading_gives_each_face_the_light_at_its_middle() {
    let frame = frame(&from_above([0.0, 1.0, 0.0], SQUARE, LAMP), &with(|s| s.shading = Mode::Flat));
    assert_eq!(frame.work.evaluations, 1);
    let d2 = 0.5f64.powi(2) + 0.3f64.powi(2) + 1.5f64.powi(2);
    let expected = 0.6 / PI * 100.0 * 1.5 / d2.powf(1.5);
    let lit: Vec<f32> = frame.rgb.iter().copied().filter(|v| *v > 0.0).collect();
    assert!(lit.iter().all(|v| (f64::from(*v) / expected - 1.0).abs() < 1e-6));
    assert_eq!(lit.len() as u64, 3 * frame.work.samples);
}

#[test]
fn bilinear_gouraud_changes_when_the_picture_turns_and_barycentric_does_not() {
    // a kite: a square would be a square again after a quarter turn; 45 degrees turn its rows into diagonals
    let square = "shape = \"rectangle\"\nwidth = \"1.6 m\"\nheight = \"1.6 m\"";
    let half = 0.5f64.sqrt();
    let difference = |interpolation| {
        let settings = with(|s| {
            s.shading = Mode::Gouraud;
            s.interpolation = interpolation;
        });
        let upright = frame(&from_above([0.0, 1.0, 0.0], square, LAMP), &settings);
        let turned = frame(&from_above([half, half, 0.0], square, LAMP), &settings);
        // the middle of the square is the same point in both
        let middle = |f: &Frame| {
            let at = |x: usize, y: usize| f64::from(f.rgb[3 * (64 * y + x)]);
            0.25 * (at(31, 31) + at(32, 31) + at(31, 32) + at(32, 32))
        };
        (middle(&upright) / middle(&turned) - 1.0).abs()
    };
    // upright: the mean of four corners; turned: the mean of two corners only
    assert!(difference(Interpolation::Bilinear) > 0.05, "{}", difference(Interpolation::Bilinear));
    // within a triangle light is linear on the surface; the diagonal crosses the middle, where pixels see both sides
    assert!(difference(Interpolation::Barycentric) < 0.02, "{}", difference(Interpolation::Barycentric));
}

#[test]
fn pictures_are_the_same_for_any_number_of_threads_and_in_used_memory() {
    let text = include_str!("../../../examples/scenes/demo.toml");
    let mut demo = Scene::parse(text, concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes")).unwrap();
    (demo.film.width, demo.film.height) = (160, 121);
    demo.camera = lesk_scene::Camera::new(*demo.camera.world_from_local(), [160, 121], 0.8, 0.0, 1.0).unwrap();
    // three chunks of faces each, and every depth twice: the first face shows
    let ball = "shape = \"sphere\"\n[[objects]]\nmaterial = \"b\"\nshape = \"sphere\"\n";
    let twins =
        from_above([0.0, 1.0, 0.0], ball, &format!("{LAMP}[materials.b]\nmodel = \"lambert\"\nreflectance = 0.1"));
    for (scene, shading) in
        [(&demo, Mode::Flat), (&demo, Mode::Gouraud), (&demo, Mode::Phong), (&twins, Mode::Flat), (&twins, Mode::Phong)]
    {
        let settings = with(|s| {
            (s.shading, s.aovs, s.tessellation) = (shading, true, 160);
        });
        let pictures = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut raster = Raster::new(Arc::new(scene.clone()), &settings).unwrap_or_else(|e| panic!("{e}"));
                let first = raster.frame();
                let mut second = first.clone();
                raster.draw(&mut second);
                [first, second]
            })
        };
        let result = |f: &Frame| {
            let work = Count { elapsed: Duration::ZERO, ..f.work };
            (f.rgb.iter().map(|v| v.to_bits()).collect::<Vec<_>>(), f.hits.clone(), work)
        };
        let [one, again] = pictures(1).map(|f| result(&f));
        assert!(one.2.samples > 1000 && one == again, "{shading:?}, again");
        for threads in [2, 5] {
            let all = pictures(threads).iter().all(|many| result(many) == one);
            assert!(all, "{shading:?}, {threads} threads");
        }
    }
}

#[test]
fn a_camera_inside_a_room_sees_its_walls_everywhere() {
    // faces reach behind the camera: without clipping they would leave holes
    let text = "version = 1\n[camera]\neye = [0.3, 0.2, 0.1]\ntarget = [1, 0.6, 0.3]\nfov = \"120 deg\"\n\
                [film]\nsize = [90, 70]\n[materials.m]\nmodel = \"lambert\"\n[[objects]]\nshape = \"cube\"\nedge = \"4 m\"\n\
                material = \"m\"\n[[lights]]\ntype = \"point\"\nposition = [0, 0, 1]\nintensity = \"100 cd\"\n";
    let scene = parse(text);
    for shading in [Mode::Flat, Mode::Gouraud, Mode::Phong] {
        let frame = frame(&scene, &with(|s| s.shading = shading));
        assert_eq!(frame.work.samples, 90 * 70, "{shading:?}");
        assert!(frame.rgb.iter().all(|v| *v > 0.0 && v.is_finite()), "{shading:?}");
    }
    // clipping keeps what is interpolated: the walls by the closed form, in f32 on faces that are cut
    let frame = frame(&scene, &Settings::default());
    let camera = &scene.camera;
    for (k, rgb) in frame.rgb.as_chunks::<3>().0.iter().enumerate() {
        let ray = camera.ray([(k % 90) as f32 + 0.5, (k / 90) as f32 + 0.5], [0.5; 2]);
        let (o, d) = (ray.o.to_array().map(f64::from), ray.d.to_array().map(f64::from));
        let t = (0..3).map(|c| (2.0f64.copysign(d[c]) - o[c]) / d[c]).fold(f64::INFINITY, f64::min);
        let p = [0, 1, 2].map(|c| o[c] + t * d[c]);
        let axis = (0..3).max_by(|&a, &b| p[a].abs().total_cmp(&p[b].abs())).unwrap();
        let to = [-p[0], -p[1], 1.0 - p[2]];
        let d2: f64 = to.iter().map(|v| v * v).sum();
        let expected = 0.5 / PI * 100.0 * to[axis].abs() / d2.powf(1.5);
        let edge = (0..3).filter(|&c| p[c].abs() > 1.97).count() > 1;
        // faces of four corners are interpolated from the grid: 1/512 pixel of 90
        assert!(edge || (f64::from(rgb[0]) / expected - 1.0).abs() < 2e-3, "pixel {k}: {rgb:?} {expected}");
    }
}

#[test]
fn screen_linear_interpolation_bends_what_perspective_keeps_straight() {
    // a long floor seen from its end: perspective-correct Phong is the closed form, screen-linear is not
    let text = "version = 1\n[camera]\neye = [0, -6, 1]\ntarget = [0, 0, 0]\nfov = \"50 deg\"\n\
                [film]\nsize = [64, 64]\n[materials.m]\nmodel = \"lambert\"\n[[objects]]\nshape = \"rectangle\"\n\
                width = \"4 m\"\nheight = \"10 m\"\nmaterial = \"m\"\n[[lights]]\ntype = \"point\"\nposition = [0, 0, 2]\n\
                intensity = \"100 cd\"\n";
    let scene = parse(text);
    let worst = |correction| {
        let settings = with(|s| {
            s.correction = correction;
            s.interpolation = Interpolation::Barycentric;
        });
        let frame = frame(&scene, &settings);
        let mut worst = 0.0f64;
        for (k, rgb) in frame.rgb.as_chunks::<3>().0.iter().enumerate().filter(|(_, rgb)| rgb[0] > 0.0) {
            let ray = scene.camera.ray([(k % 64) as f32 + 0.5, (k / 64) as f32 + 0.5], [0.5; 2]);
            let (o, d) = (ray.o.map(f64::from), ray.d.map(f64::from));
            let t = -o.z / d.z;
            let (x, y) = (o.x + t * d.x, o.y + t * d.y);
            let expected = 0.5 / PI * 100.0 * 2.0 / (x * x + y * y + 4.0f64).powf(1.5);
            worst = worst.max((f64::from(rgb[0]) / expected - 1.0).abs());
        }
        worst
    };
    assert!(worst(Correction::Perspective) < 1e-5, "{}", worst(Correction::Perspective));
    assert!(worst(Correction::Screen) > 0.5, "{}", worst(Correction::Screen));
}

#[test]
fn the_classic_model_with_the_bridge_is_lambert_and_without_units_is_the_lecture() {
    let scene = from_above([0.0, 1.0, 0.0], SQUARE, LAMP);
    let lambert = frame(&scene, &Settings::default());
    let classic = Classic { ka: 0.0, kd: 0.6, ks: 0.0, ..Classic::default() };
    let bridged = frame(&scene, &with(|s| s.classic = Some(classic.clone())));
    for (a, b) in lambert.rgb.iter().zip(&bridged.rgb) {
        assert!((a - b).abs() <= 8.0 * f32::EPSILON * a, "{a} {b}");
    }
    // a light along the normal, seen from above: I = k_A + k_D + k_S in the middle of the picture
    let light = ClassicLight { direction: lesk_math::vec3(0.0, 0.0, 2.0), color: [1.0; 3] };
    let whole = Classic { lights: vec![light], ..Classic::default() };
    let frame = frame(&scene, &with(|s| s.classic = Some(whole.clone())));
    let middle = frame.rgb[3 * (32 * 64 + 32)];
    // half a pixel off the axis: cos^50 of 2 * 0.3 degrees
    assert!((middle - 1.0).abs() < 3e-3, "{middle}");
}

#[test]
fn gamma_space_reads_sums_as_codes() {
    let scene = from_above([0.0, 1.0, 0.0], SQUARE, LAMP);
    let light = ClassicLight { direction: lesk_math::vec3(0.0, 0.0, 1.0), color: [1.0; 3] };
    let half = Classic { ka: 0.0, kd: 0.5, ks: 0.0, lights: vec![light], ..Classic::default() };
    let settings = with(|s| {
        s.classic = Some(half.clone());
        s.space = Space::Gamma;
    });
    let middle = frame(&scene, &settings).rgb[3 * (32 * 64 + 32)];
    // IEC 61966-2-1: the code 0.5 is ((0.5 + 0.055)/1.055)^2.4 of white
    assert!((f64::from(middle) - (0.555f64 / 1.055).powf(2.4)).abs() < 1e-6, "{middle}");
}

#[test]
fn normals_that_keep_their_length_darken_the_middle_of_faces() {
    let sun = "[[lights]]\ntype = \"directional\"\ndirection = [0, 0, -1]\nilluminance = \"100 lx\"\n";
    let scene = from_above([0.0, 1.0, 0.0], "shape = \"sphere\"", sun);
    let picture = |renormalize| {
        frame(
            &scene,
            &with(|s| {
                s.renormalize = renormalize;
                s.tessellation = 6;
            }),
        )
        .rgb
    };
    let (unit, kept) = (picture(true), picture(false));
    assert!(unit.iter().zip(&kept).all(|(u, k)| *k <= u * (1.0 + 1e-5)));
    assert!(unit.iter().zip(&kept).any(|(u, k)| *k < 0.9 * u));
}

#[test]
fn a_film_holds_all_samples_and_layers_of_a_frame() {
    let scene = from_above([0.0, 1.0, 0.0], SQUARE, LAMP);
    let settings = with(|s| {
        s.supersampling = 3;
        s.aovs = true;
    });
    let film = frame(&scene, &settings).film().unwrap();
    assert_eq!((film.width(), film.height(), film.sample_count(5, 5)), (64, 64, 9));
    let planes = film.planes(&[]).unwrap();
    let plane = |name: &str| planes.planes().iter().find(|p| p.name == name).unwrap_or_else(|| panic!("{name}"));
    let float = |name: &str, k: usize| match &plane(name).samples {
        lesk_image::Samples::Float(v) | lesk_image::Samples::Half(v) => v[k],
        lesk_image::Samples::Uint(v) => v[k] as f32,
    };
    let k = 32 * 64 + 32;
    assert!((float("depth.Z", k) - 4.0).abs() < 1e-3);
    assert!((float("albedo.R", k) - 0.6).abs() < 1e-5);
}

#[test]
fn numbers_out_of_range_are_errors_that_name_them() {
    let scene = from_above([0.0, 1.0, 0.0], SQUARE, LAMP);
    let message =
        |settings: Settings| Raster::new(Arc::new(scene.clone()), &settings).err().expect("an error").to_string();
    assert!(message(with(|s| s.supersampling = 0)).contains("`supersampling` is 0"));
    assert!(message(with(|s| s.tessellation = 5000)).contains("3 to 4096"));
    let steep = lesk_geometry::EdgeRule::Crease(4.0);
    assert!(message(with(|s| s.edges = steep)).contains("0 to 180 deg"));
    assert!("cubic".parse::<Interpolation>().unwrap_err().to_string().contains("bilinear, barycentric"));
}

#[test]
fn an_area_light_by_quadrature_approaches_the_closed_form_of_a_disk() {
    // illuminance on the axis of a disk of radius r and luminance L at height h: E = pi L r^2 / (h^2 + r^2)
    let disk = "[[objects]]\nshape = \"disk\"\nradius = \"0.5 m\"\ntransform = [{ rotate = \"180 deg\", axis = [1, 0, 0] }, \
                { translate = [0, 0, 6] }]\nlight = { luminance = \"1000 cd/m2\" }\n";
    let scene = from_above([0.0, 1.0, 0.0], SQUARE, disk);
    let frame = frame(&scene, &with(|s| s.quadrature = 256));
    let middle = f64::from(frame.rgb[3 * (32 * 64 + 32)]);
    let expected = 0.6 / PI * PI * 1000.0 * 0.25 / (36.0 + 0.25);
    // small and far: the integrand varies by 1 %, 256 points integrate it to better than a tenth of that
    assert!((middle / expected - 1.0).abs() < 1e-3, "{middle} {expected}");
}

#[test]
fn a_spot_lights_a_floor_by_its_formula_on_its_axis_and_off_it() {
    // 2 m above the origin, looking down: theta is the angle to its axis and at the floor, d = 2/cos(theta), and
    // L = rho/pi I(theta) cos(theta)/d^2 with I = I0 s^2 (3 - 2s), s = (cos(theta) - cos(30 deg))/(cos(10 deg) - cos(30 deg))
    let spot = "[[lights]]\ntype = \"spot\"\nposition = [0, 0, 2]\ndirection = [0, 0, -1]\ninner = \"10 deg\"\n\
                outer = \"30 deg\"\nintensity = \"100 cd\"\n";
    for shading in [Mode::Phong, Mode::Gouraud] {
        // the cone ends before the corners of the square: Gouraud shading misses it
        let frame = frame(&from_above([0.0, 1.0, 0.0], SQUARE, spot), &with(|s| s.shading = shading));
        let (mut full, mut partly, mut dark) = (0, 0, 0);
        for (k, rgb) in frame.rgb.as_chunks::<3>().0.iter().enumerate() {
            let [x, y] = on_plane(k % 64, k / 64);
            if x.abs() > 1.0 || y.abs() > 1.0 || shading == Mode::Gouraud {
                assert_eq!(*rgb, [0.0; 3]);
                continue;
            }
            let cosine = 2.0 / (x * x + y * y + 4.0).sqrt();
            let [inner, outer] = [10f64, 30.0].map(|a| a.to_radians().cos());
            let s = ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0);
            let expected = 0.6 / PI * 100.0 * s * s * (3.0 - 2.0 * s) * cosine.powi(3) / 4.0;
            // bilinear weights on a grid of 1/256 pixel; the falloff is steepest in the middle of the step, 5 % per pixel
            assert!((f64::from(rgb[0]) - expected).abs() < 2e-4 * 0.6 / PI * 25.0, "{x} {y}: {rgb:?} {expected}");
            full += usize::from(s == 1.0);
            partly += usize::from(s > 0.0 && s < 1.0);
            dark += usize::from(s == 0.0);
        }
        if shading == Mode::Phong {
            assert!(full > 100 && partly > 500 && dark > 100, "{full} {partly} {dark}");
        }
    }
}

#[test]
fn a_plate_under_a_uniform_sky_has_the_luminance_of_its_reflectance() {
    // E = pi L, so the plate shows rho L
    let sky = "[environment]\ntype = \"sky\"\nluminance = \"1000 cd/m2\"\n";
    let middle = |object: &str, sky: &str| {
        let frame = frame(&from_above([0.0, 1.0, 0.0], object, sky), &with(|s| s.quadrature = 1024));
        (f64::from(frame.rgb[3 * (32 * 64 + 32)]), f64::from(frame.rgb[0]))
    };
    // Hammersley's 1024 points: the mean of a cosine over the half sphere to 1 %
    let (plate, behind) = middle(SQUARE, sky);
    assert!((plate / 600.0 - 1.0).abs() < 0.01, "{plate}");
    assert_eq!(behind, 1000.0);
    let dome = format!("{sky}dome = true\n");
    let (above, _) = middle(SQUARE, &dome);
    assert!((above / 600.0 - 1.0).abs() < 0.01, "{above}");
    let tilted = format!("{SQUARE}\ntransform = {{ rotate = \"60 deg\", axis = [1, 0, 0] }}");
    let (side, _) = middle(&tilted, &dome);
    // a plate that leans by b sees the share (1 + cos b)/2 of the dome
    assert!((side / (600.0 * 0.75) - 1.0).abs() < 0.02, "{side}");
}

#[test]
fn a_supersampled_pixel_is_the_share_of_it_that_a_face_covers() {
    // parallel light: the square has one luminance, 0.6/pi 100 lx, and a pixel at its border the covered share of it
    let sun = "[[lights]]\ntype = \"directional\"\ndirection = [0, 0, -1]\nilluminance = \"100 lx\"\n";
    let scene = from_above([0.0, 1.0, 0.0], "shape = \"rectangle\"\nwidth = \"1.37 m\"\nheight = \"1.61 m\"", sun);
    let film = frame(&scene, &with(|s| s.supersampling = 8)).film().unwrap();
    let planes = film.planes(&[]).unwrap();
    let red = planes.planes().iter().find(|p| p.name == "R").unwrap();
    let lesk_image::Samples::Float(red) = &red.samples else { panic!("floats") };
    let pixel = 2.0 * 4.0 * 20f64.to_radians().tan() / 64.0;
    let covered = |k: usize, half: f64| {
        let low = (k as f64 - 32.0) * pixel;
        ((low + pixel).min(half) - low.max(-half)).clamp(0.0, pixel) / pixel
    };
    let mut partly = 0;
    for (k, value) in red.iter().enumerate() {
        let share = covered(k % 64, 0.685) * covered(63 - k / 64, 0.805);
        let found = f64::from(*value) / (0.6 / PI * 100.0);
        // 8 samples across: a border is placed to 1/16 of a pixel, in x and in y
        assert!((found - share).abs() <= 2.0 / 16.0 + 1e-5, "pixel {k}: {found} {share}");
        partly += usize::from(found > 0.05 && found < 0.95);
    }
    assert!(partly > 50, "{partly}");
}
