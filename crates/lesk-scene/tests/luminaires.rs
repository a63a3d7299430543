//! Luminaires, suns, skies and projectors in scene files.

use lesk_light::{Light, Receiver};
use lesk_math::{Vec3, vec3};
use lesk_scene::Scene;
use std::path::PathBuf;

/// An isotropic lamp of 100 cd, 4π 100 lm, with an opening of 0.4 x 0.1 m along C0 and C90.
const ISOTROPIC: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0.1 0.4 0\n0 1 9\n0 180\n0\n100 100\n";

const HEAD: &str = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 1]\n";

/// A folder with the lamp's file, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("lesk-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join("lamp.ies"), ISOTROPIC).unwrap();
        Folder(path)
    }

    fn scene(&self, lights: &str) -> Result<Scene, String> {
        Scene::parse(&format!("{HEAD}{lights}"), &self.0).map_err(|e| e.to_string())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_luminaire_is_a_light_with_an_object_for_its_opening() {
    let folder = Folder::new("luminaire");
    let scene = folder
        .scene("[[lights]]\ntype = \"luminaire\"\nname = \"L\"\nfile = \"lamp.ies\"\nposition = [0, 0, 2]\ndimming = 0.5\n")
        .unwrap();
    let full = 400.0 * std::f32::consts::PI;
    let [Light::Luminaire(lamp)] = scene.lights.list() else { panic!("{:?}", scene.lights.list().len()) };
    assert!((lamp.flux() / (0.5 * full) - 1.0).abs() < 1e-6);
    assert_eq!(scene.objects.len(), 1);
    assert_eq!((scene.objects[0].light, scene.objects[0].material), (Some(0), None));
    // the file's ballast factor of 0 is a warning, which becomes a note
    assert!(scene.notes.iter().any(|n| n.contains("line 4") && n.contains("ballast factor")), "{:?}", scene.notes);
    assert!(scene.files.iter().any(|f| f.ends_with("lamp.ies")));
    // I / d² far below
    let at = Receiver::opaque(vec3(0.0, 0.0, -98.0), Vec3::Z);
    let sample = scene.lights.sample(&at, 0.5, [0.5, 0.5]).unwrap();
    let illuminance = sample.value.luminance() * sample.wi.z / sample.pdf;
    assert!((illuminance / (50.0 / 1e4) - 1.0).abs() < 1e-4, "{illuminance}");
}

#[test]
fn flux_and_maintenance_replace_and_reduce_what_the_file_says() {
    let folder = Folder::new("flux");
    let scene = folder
        .scene("[[lights]]\ntype = \"luminaire\"\nfile = \"lamp.ies\"\nposition = [0, 0, 2]\nflux = \"2000 lm\"\nmaintenance = 0.8\n")
        .unwrap();
    let [Light::Luminaire(lamp)] = scene.lights.list() else { panic!() };
    assert!((lamp.flux() / 1600.0 - 1.0).abs() < 1e-6);
}

/// The lamp with a TILT section: 1 straight down, 0.8 at 90 degrees.
const TILTING: &str =
    "IESNA:LM-63-2002\nTILT=INCLUDE\n1\n2\n0 90\n1 0.8\n1 -1 1 2 1 1 2 0.1 0.4 0\n1 1 9\n0 180\n0\n100 100\n";

/// 100 mW/sr in all directions.
const RADIANT: &str =
    "IES:LM-63-2019\n[_INTENSITYUNITS] mW/sr\nTILT=NONE\n1 -1 1 2 1 1 2 0.1 0.4 0\n1 1.00001 9\n0 180\n0\n100 100\n";

fn only_luminaire(folder: &Folder, rest: &str) -> (f32, Vec<String>) {
    let scene = folder.scene(&format!("[[lights]]\ntype = \"luminaire\"\nposition = [0, 0, 2]\n{rest}")).unwrap();
    let [Light::Luminaire(lamp)] = scene.lights.list() else { panic!() };
    (lamp.flux(), scene.notes)
}

#[test]
fn a_tilted_luminaire_gives_what_its_tilt_section_leaves() {
    let folder = Folder::new("tilt");
    std::fs::write(folder.0.join("tilt.ies"), TILTING).unwrap();
    let full = 400.0 * std::f32::consts::PI;
    for (direction, expected) in [
        ("[0, 0, -1]", 1.0),
        ("[1, 0, 0]", 0.8),
        ("[0, 1, -1]", 0.9), // 45 degrees, linear between the two
        ("[0, 0, 1]", 0.8),  // beyond the last angle
    ] {
        let (flux, notes) = only_luminaire(&folder, &format!("file = \"tilt.ies\"\ndirection = {direction}\n"));
        assert!((flux / (full * expected) - 1.0).abs() < 1e-5, "{direction}: {flux}");
        assert!(notes.iter().any(|n| n.contains("(TILT)")), "{notes:?}");
    }
    // a stated flux is that of the luminaire as it hangs
    let (flux, _) = only_luminaire(&folder, "file = \"tilt.ies\"\ndirection = [1, 0, 0]\nflux = \"500 lm\"\n");
    assert!((flux / 500.0 - 1.0).abs() < 1e-5);
}

#[test]
fn a_file_in_watts_needs_a_spectrum_or_a_flux() {
    let folder = Folder::new("watts");
    std::fs::write(folder.0.join("watts.ies"), RADIANT).unwrap();
    // 4 π 0.1 W at the efficacy of illuminant E over 380 to 780 nm, 182.4 lm/W (K_m 106.857 nm / 400 nm)
    let (flux, notes) = only_luminaire(&folder, "file = \"watts.ies\"\nspectrum = \"E\"\n");
    let expected = 0.4 * std::f32::consts::PI * 683.002 * 106.857 / 400.0;
    assert!((flux / expected - 1.0).abs() < 1e-4, "{flux} {expected}");
    assert!(notes.iter().any(|n| n.contains("W of the file are") && n.contains("(E, 380 to 780 nm")), "{notes:?}");
    let (flux, _) = only_luminaire(&folder, "file = \"watts.ies\"\nflux = \"500 lm\"\n");
    assert!((flux / 500.0 - 1.0).abs() < 1e-5);
    let (flux, _) = only_luminaire(&folder, "file = \"watts.ies\"\nflux = \"2 W\"\nspectrum = \"E\"\n");
    assert!((flux / (expected * 2.0 / 0.4 / std::f32::consts::PI) - 1.0).abs() < 1e-4);
    let error = folder
        .scene("[[lights]]\ntype = \"luminaire\"\nposition = [0, 0, 2]\nfile = \"watts.ies\"\n")
        .err()
        .unwrap_or_default();
    assert!(error.contains("`watts.ies` counts watts, which need a named spectrum"), "{error}");
    assert!(error.contains("or `flux` in lm"), "{error}");
}

#[test]
fn sun_and_sky_stand_by_place_and_time() {
    let folder = Folder::new("sun");
    let place = "latitude = \"51.5 deg\"\nlongitude = \"0 deg\"\ntime = \"2025-03-20T12:00Z\"\n";
    let scene = folder
        .scene(&format!(
            "[[lights]]\ntype = \"sun\"\n{place}illuminance = \"80 klx\"\n\
             [environment]\ntype = \"cie_sky\"\nnumber = 12\n{place}illuminance = \"10 klx\"\n"
        ))
        .unwrap();
    let [Light::Directional(sun), Light::Environment(sky)] = scene.lights.list() else { panic!() };
    // lights.md, section 5: 38.5234 deg high at 177.6478 deg
    let (high, round) = (38.5234f32.to_radians(), 177.6478f32.to_radians());
    let toward = vec3(high.cos() * round.sin(), high.cos() * round.cos(), high.sin());
    assert!((sun.direction() + toward).length() < 1e-5);
    assert!((sky.illuminance() / 1e4 - 1.0).abs() < 1e-5);
    let opposite = vec3(-toward.x, -toward.y, toward.z);
    assert!(sky.radiance(toward).luminance() > 3.0 * sky.radiance(opposite).luminance());
}

#[test]
fn mistakes_are_told_with_their_place() {
    let folder = Folder::new("mistakes");
    for (text, message) in [
        ("[[lights]]\ntype = \"luminaire\"\nfile = \"none.ies\"\nposition = [0, 0, 2]\n", "cannot read"),
        ("[[lights]]\ntype = \"luminaire\"\nposition = [0, 0, 2]\n", "has no `file`"),
        ("[[lights]]\ntype = \"luminaire\"\nfile = \"lamp.ies\"\nposition = [0, 0, 2]\nlamp_set = 99\n", "lamp_set"),
        ("[[lights]]\ntype = \"luminaire\"\nfile = \"lamp.ies\"\nposition = [0, 0, 2]\ndimming = 2\n", "dimming"),
        ("[[lights]]\ntype = \"sun\"\nilluminance = \"1 lx\"\n", "no place"),
        ("[[lights]]\ntype = \"sun\"\nelevation = \"9 deg\"\ntime = \"x\"\nilluminance = \"1 lx\"\n", "both there"),
        (
            "[[lights]]\ntype = \"sun\"\nlatitude = \"69.65 deg\"\nlongitude = \"18.96 deg\"\ntime = \"2025-12-21T11:00Z\"\nilluminance = \"1 lx\"\n",
            "below the horizon",
        ),
        ("[environment]\ntype = \"cie_sky\"\nnumber = 17\nluminance = \"1 cd/m2\"\n", "number"),
        ("[environment]\ntype = \"cie_sky\"\nnumber = 12\nluminance = \"1 cd/m2\"\n", "no place"),
        (
            "[[lights]]\ntype = \"projector\"\nfile = \"none.png\"\nposition = [0, 0, 2]\nwidth = \"30 deg\"\nflux = \"9 lm\"\n",
            "has no `direction`",
        ),
    ] {
        let error = folder.scene(text).err().unwrap_or_else(|| panic!("accepted: {text}"));
        assert!(error.contains(message), "{text}: {error}");
    }
}

#[test]
fn a_hosek_sky_and_its_sun_have_their_own_strength() {
    let folder = Folder::new("hosek");
    let scene = folder
        .scene(
            "[[lights]]\ntype = \"sun\"\nelevation = \"40 deg\"\nazimuth = \"90 deg\"\nturbidity = 2\n\
             [environment]\ntype = \"hosek_sky\"\nelevation = \"40 deg\"\nazimuth = \"90 deg\"\nturbidity = 2\nground = 0.2\n",
        )
        .unwrap();
    let [Light::Directional(sun), Light::Environment(sky)] = scene.lights.list() else { panic!() };
    // the authors' code: 14034.7 lx; 6e-4 for the texels
    assert!((sky.illuminance() / 14034.7 - 1.0).abs() < 6e-4, "{}", sky.illuminance());
    // the authors' code, 360 to 720 nm in steps of 1 nm: see the test of lesk-light
    assert!((sun.illuminance().luminance() / 76792.72 - 1.0).abs() < 1e-4, "{}", sun.illuminance().luminance());
    assert!(sun.direction().x < -0.7);
    assert!(scene.notes.iter().any(|n| n.contains("76793 lx perpendicular")), "{:?}", scene.notes);
}

#[test]
fn mistakes_of_hosek_skies_are_told() {
    let folder = Folder::new("hosek-mistakes");
    let sky = |rest: &str| format!("[environment]\ntype = \"hosek_sky\"\nelevation = \"40 deg\"\n{rest}\n");
    let sun = |rest: &str| format!("[[lights]]\ntype = \"sun\"\nelevation = \"40 deg\"\nturbidity = 2\n{rest}\n");
    for (text, message) in [
        (sky(""), "has no `turbidity`"),
        (sky("turbidity = 0.5"), "`turbidity` is 0.5, a number from 1 to 10 is accepted"),
        (sky("turbidity = 2\nground = 2"), "reflectance of the ground is 2"),
        (sky("turbidity = 2\nground = [0.1, 0.2]"), "`ground` has 2 entries, 3 numbers are accepted"),
        (sky("turbidity = 2\nilluminance = \"9 lx\""), "`illuminance` does not belong to environment `hosek_sky`"),
        (sun("illuminance = \"9 lx\""), "`illuminance` and `turbidity` are both there"),
        (sun("color = [1, 1, 1]"), "`color` and `turbidity` are both there"),
        (sun("time = \"x\""), "`elevation` and `time` are both there"),
        ("[[lights]]\ntype = \"sun\"\nturbidity = 2\n".to_string(), "the sun has no place"),
        ("[[lights]]\ntype = \"sun\"\nelevation = \"0 deg\"\nturbidity = 10\n".to_string(), "no light comes through"),
    ] {
        let error = folder.scene(&text).err().unwrap_or_else(|| panic!("accepted: {text}"));
        assert!(error.contains(message), "{text}: {error}");
    }
}
