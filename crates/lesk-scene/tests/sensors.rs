//! Sensors of scene files.

use lesk_scene::sensor::{Form, Quantity, Response};
use lesk_scene::{Scene, SceneError};

const HEAD: &str = "version = 1\ncamera = { eye = [0, -9, 9], target = [0, 0, 0] }\n";

fn parse(body: &str) -> Result<Scene, SceneError> {
    Scene::parse(&format!("{HEAD}{body}"), ".")
}

fn sensor(body: &str) -> lesk_scene::Sensor {
    parse(&format!("[[sensors]]\nname = \"s\"\n{body}")).unwrap_or_else(|e| panic!("{e}")).sensors.remove(0)
}

#[test]
fn grid_faces_u_cross_v_and_leaves_its_margin_out() {
    let grid = sensor(
        "type = \"grid\"\ncorner = [0, 8, 0]\nu = [6, 0, 0]\nv = [0, 0, 3]\nmargin = \"50 cm\"\nspacing = \"50 cm\"",
    );
    assert_eq!(grid.response, Response::Planar { normal: [0.0, -1.0, 0.0] });
    assert_eq!(grid.shape(), [4, 10]);
    let first = grid.probes()[0].position;
    assert!((first.x - 0.75).abs() < 1e-12 && (first.y - 8.0).abs() < 1e-12 && (first.z - 0.75).abs() < 1e-12);
}

#[test]
fn grid_without_a_spacing_has_that_of_the_standard() {
    // 10 m: 1 m
    let grid = sensor("type = \"grid\"\ncorner = [0, 0, 0]\nu = [10, 0, 0]\nv = [0, 5, 0]");
    assert_eq!(grid.shape(), [5, 10]);
    let line = sensor("type = \"line\"\nfrom = [0, 0, 0]\nto = [0, 10, 0]");
    assert_eq!(line.shape(), [1, 10]);
}

#[test]
fn limits_are_those_of_the_task_unless_the_sensor_has_its_own() {
    let desk = sensor("type = \"point\"\nposition = [0, 0, 0]\ntask = \"office.writing\"\nmin_mean = \"0.4 klx\"");
    let limits = desk.limits();
    assert_eq!((limits.mean, limits.uniformity, limits.ugr), (Some(400.0), Some(0.6), Some(19.0)));
}

#[test]
fn watts_need_a_spectrum_and_name_it() {
    let watts = sensor("type = \"point\"\nposition = [0, 0, 0]\nquantity = \"radiometric\"\nspectrum = \"E\"");
    assert_eq!(watts.unit(), "W/m2");
    assert!(matches!(watts.quantity, Quantity::Radiometric(_)));
    // colour-science 0.4.7, 380 to 780 nm: 182.46 lm/W
    assert!((watts.quantity.per_lumen() * 182.46 - 1.0).abs() < 1e-4);
    assert!(watts.quantity.conversion().contains("182.46 lm/W (E, 380 to 780 nm"));
}

#[test]
fn sensors_change_no_picture() {
    let plain = parse("").unwrap();
    let measured =
        parse("measure = { error = 0.5 }\n[[sensors]]\nname = \"s\"\ntype = \"point\"\nposition = [0, 0, 0]").unwrap();
    assert_eq!(plain.fingerprint, measured.fingerprint);
    assert_eq!(measured.measure.error, 0.5);
}

#[test]
fn faulty_sensors_say_what_is_wrong() {
    for (body, expected) in [
        ("type = \"pont\"", "`type` is \"pont\", one of `point`, `line`"),
        ("type = \"point\"", "sensor `point` has no `position`"),
        ("type = \"point\"\nposition = [0, 0, 0]\nnormal = [0, 0, 0]", "it must have a length"),
        (
            "type = \"point\"\nposition = [0, 0, 0]\nspacing = \"1 m\"",
            "does not belong to sensor `point`, but to `line`",
        ),
        ("type = \"point\"\nposition = [0, 0, 0]\ntask = \"office.writting\"", "did you mean `office.writing`?"),
        ("type = \"point\"\nposition = [0, 0, 0]\ntask = \"moon\"", "`lesk lux --tasks` lists them"),
        ("type = \"point\"\nposition = [0, 0, 0]\nquantity = \"radiometric\"", "needs a named spectrum"),
        ("type = \"point\"\nposition = [0, 0, 0]\nspectrum = \"E\"", "the quantity is photometric"),
        ("type = \"point\"\nposition = [0, 0, 0]\nreceiver = \"semicylindrical\"", "has no `facing`"),
        ("type = \"point\"\nposition = [0, 0, 0]\nfacing = [1, 0, 0]", "does not belong to receiver `planar`"),
        ("type = \"line\"\nfrom = [0, 0, 0]\nto = [0, 0, 0]", "are the same point"),
        ("type = \"line\"\nfrom = [0, 0, 0]\nto = [9e9, 0, 0]\nspacing = \"1 mm\"", "up to 4194304 are accepted"),
        ("type = \"grid\"\ncorner = [0, 0, 0]\nu = [1, 0, 0]\nv = [2, 0, 0]", "span no area"),
        ("type = \"grid\"\ncorner = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 1, 0]\nmargin = \"1 m\"", "leaves nothing"),
        (
            "type = \"grid\"\ncorner = [0, 0, 0]\nu = [1e9, 0, 0]\nv = [0, 1e9, 0]\nspacing = \"1 mm\"",
            "make `spacing` larger",
        ),
        ("type = \"luminance\"\nposition = [0, 0, 0]", "has no `direction`"),
        ("type = \"luminance\"\nposition = [0, 0, 0]\ntarget = [0, 0, 0]", "it must have a length"),
        ("type = \"luminance\"\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nopening = \"200 deg\"", "below 180 deg"),
        ("type = \"glare\"\nposition = [0, 0, 0]\ndirection = [0, 0, 1]", "are parallel"),
        ("type = \"camera\"\neye = [0, 0, 0]\ntarget = [0, 0, 0]", "camera"),
    ] {
        let error = parse(&format!("[[sensors]]\nname = \"s\"\n{body}")).map(|_| body).unwrap_err().to_string();
        assert!(error.contains(expected), "{body}\n{error}");
    }
    assert!(matches!(sensor("type = \"point\"\nposition = [0, 0, 0]").form, Form::Point { .. }));
}
