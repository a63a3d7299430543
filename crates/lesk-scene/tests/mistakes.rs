//! What the reader says to typical mistakes, word for word: snapshots, so that a change of a message is seen.

use lesk_scene::{Scene, SceneError};

const HEAD: &str = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 0]\n";

fn error(text: &str) -> SceneError {
    Scene::parse(&format!("{HEAD}{text}"), "").expect_err("the scene has a mistake")
}

#[track_caller]
fn says(text: &str, expected: &str) {
    assert_eq!(error(text).to_string(), expected.trim_start_matches('\n'));
}

#[test]
fn a_length_without_a_unit() {
    says(
        "[[objects]]\nshape = \"sphere\"\nradius = 5\nmaterial = \"a\"\n[materials.a]\nmodel = \"lambert\"",
        r#"
error: `radius` is 5 without a unit
  --> scene:7:10
7 | radius = 5
  |          ^
hint: write text with a unit, for example `radius = "5 m"`"#,
    );
}

#[test]
fn a_unit_of_another_dimension() {
    says(
        "[[lights]]\ntype = \"point\"\nposition = [0, 0, 2]\nflux = \"300 lx\"",
        r#"
error: `flux`: `300 lx` is an illuminance, but a luminous flux (lm, klm) or a radiant flux (W, mW) is accepted
  --> scene:8:8
8 | flux = "300 lx"
  |        ^^^^^^^^
hint: lm is the whole flux, lx is per area: the lit area is needed"#,
    );
}

#[test]
fn watts_without_a_spectrum() {
    says(
        "[[lights]]\ntype = \"point\"\nposition = [0, 0, 2]\nflux = \"60 W\"",
        r#"
error: light: `60 W` counts watts, which need a named spectrum
  --> scene:8:8
8 | flux = "60 W"
  |        ^^^^^^
hint: add `spectrum`: `E`, `A`, `D50`, `D65`, `FL2`, `LED-B3` or another illuminant of the CIE, `AM1.5G`, or `blackbody 2700 K`"#,
    );
}

#[test]
fn a_misspelt_key() {
    says(
        "[film]\nfliter = \"box\"",
        r#"
error: unknown key `fliter` in film
  --> scene:6:1
6 | fliter = "box"
  | ^^^^^^
hint: did you mean `filter`?"#,
    );
}

#[test]
fn a_misspelt_material() {
    says(
        "[materials.copper]\nmodel = \"lambert\"\n[[objects]]\nshape = \"cube\"\nmaterial = \"coper\"",
        r#"
error: unknown material `coper`, there are `copper`
  --> scene:9:12
9 | material = "coper"
  |            ^^^^^^^
hint: did you mean `copper`?"#,
    );
}

#[test]
fn a_parameter_out_of_range_and_one_that_is_not_there() {
    says(
        "[materials.a]\nmodel = \"ggx\"\nalpha_x = 1.7\nroughness = 0.3",
        r#"
error: `alpha_x` is 1.7, but model `ggx` accepts 0.001 to 1
  --> scene:7:11
7 | alpha_x = 1.7
  |           ^^^

error: model `ggx` has no parameter `roughness`, it has `f0`, `alpha_x`, `alpha_y`
  --> scene:8:13
8 | roughness = 0.3
  |             ^^^
hint: `alpha` is a slope width; from a perceptual roughness r use alpha = r * r"#,
    );
}

#[test]
fn a_key_of_another_shape() {
    says(
        "[[objects]]\nshape = \"cube\"\nradius = \"1 m\"\nmaterial = \"a\"\n[materials.a]\nmodel = \"lambert\"",
        r#"
error: `radius` does not belong to object `cube`, but to `sphere`
  --> scene:7:1
7 | radius = "1 m"
  | ^^^^^^"#,
    );
}

#[test]
fn a_group_that_contains_itself() {
    says(
        "[groups.a]\nobjects = [{ shape = \"group\", group = \"b\" }]\n[groups.b]\nobjects = [{ shape = \"group\", group = \"a\" }]",
        r#"
error: group `a` contains itself: a -> b -> a
  --> scene:8:39
8 | objects = [{ shape = "group", group = "a" }]
  |                                       ^^^"#,
    );
}

#[test]
fn a_file_that_is_not_there() {
    let text = error("[[objects]]\nshape = \"mesh\"\nfile = \"no/such.obj\"").to_string();
    assert!(text.starts_with("error: object: ") && text.contains("no/such.obj"), "{text}");
    assert!(text.contains("\n  --> scene:7:8\n7 | file = \"no/such.obj\"\n  |        ^^^^^^^^^^^^^"), "{text}");
}

#[test]
fn a_light_without_strength() {
    says(
        "[environment]\ntype = \"sky\"",
        r#"
error: sky does not say how strong it is, `luminance` or `illuminance` is accepted
  --> scene:5:1
5 | [environment]
  | ^^^^^^^^^^^^^
hint: for example `luminance = "1000 cd/m2"`"#,
    );
}

#[test]
fn a_camera_that_looks_at_itself() {
    let text = "version = 1\n[camera]\neye = [1, 1, 1]\ntarget = [1, 1, 1]\n";
    assert_eq!(
        Scene::parse(text, "").unwrap_err().to_string(),
        r#"error: camera looks from [1.0, 1.0, 1.0] to [1.0, 1.0, 1.0] with up [0.0, 0.0, 1.0], which gives no direction to the right
  --> scene:2:1
2 | [camera]
  | ^^^^^^^^
hint: eye and target must differ, and `up` must not be parallel to the view"#
    );
}

#[test]
fn text_that_is_no_toml() {
    let text = error("[film\nsize = [1, 2]").to_string();
    assert!(text.starts_with("error: not valid TOML: ") && text.contains("\n  --> scene:5:"), "{text}");
}

#[test]
fn no_camera_and_no_version() {
    let text = Scene::parse("title = \"x\"", "").unwrap_err().to_string();
    assert!(text.contains("error: the scene has no `version`\nhint: "), "{text}");
    assert!(text.contains("error: the scene has no `camera`\nhint: "), "{text}");
}

#[test]
fn infinities_and_zero_scales() {
    says(
        "[[objects]]\nshape = \"cube\"\nlight = { flux = \"5 lm\" }\ntransform = [{ translate = [0, inf, 0] }, { scale = 0 }]",
        r#"
error: `translate` holds inf, finite numbers are accepted
  --> scene:8:32
8 | transform = [{ translate = [0, inf, 0] }, { scale = 0 }]
  |                                ^^^

error: transform cannot be inverted: its condition number is NaN, at most 1e10 is accepted
  --> scene:8:53
8 | transform = [{ translate = [0, inf, 0] }, { scale = 0 }]
  |                                                     ^
hint: a scale of zero along some axis flattens a shape; use a small one instead"#,
    );
}

#[test]
fn two_ways_to_say_the_same() {
    says(
        "[[lights]]\ntype = \"point\"\nposition = [0, 0, 2]\nflux = \"300 lm\"\nintensity = \"20 cd\"",
        r#"
error: `intensity` and `flux` are both there, one of them is accepted
  --> scene:9:13
9 | intensity = "20 cd"
  |             ^^^^^^^"#,
    );
}

#[test]
fn all_mistakes_of_a_file_are_reported_in_the_order_of_its_lines() {
    let error = error(
        r#"
fvo = "40 deg"
[film]
size = [0, 480]
[render]
spp = -1
[materials.a]
model = "lamberd"
[[objects]]
shape = "sphere"
radius = "-1 m"
material = "a"
[[objects]]
shape = "teapod"
[[lights]]
type = "spot"
position = [0, 0, 1]
direction = [0, 0, -1]
outer = "20 deg"
inner = "30 deg"
intensity = "10 cd"
[environment]
type = "sky"
luminance = "0 cd/m2"
"#,
    );
    let lines: Vec<usize> = error.problems().iter().map(|p| error.position(p).unwrap().0).collect();
    assert_eq!(lines, [6, 8, 10, 12, 15, 18, 19, 28], "{error}");
}

#[test]
fn mistakes_of_rasterising() {
    says(
        "[raster]\nshading = \"gourod\"\ncrease_angle = \"200 deg\"\nsubdivide = 9\nculll = true\n[raster.classic]\ndiffuse = [1, -1, 0]\nlights = [{ direction = [0, 0, 0] }]",
        r#"
error: `shading` is "gourod", one of `phong`, `gouraud`, `flat` is accepted
  --> scene:6:11
6 | shading = "gourod"
  |           ^^^^^^^^
hint: did you mean `gouraud`?

error: `crease_angle` is `200 deg`, 0 to 180 deg is accepted
  --> scene:7:16
7 | crease_angle = "200 deg"
  |                ^^^^^^^^^

error: `subdivide` is 9, a whole number from 0 to 8 is accepted
  --> scene:8:13
8 | subdivide = 9
  |             ^

error: unknown key `culll` in raster
  --> scene:9:1
9 | culll = true
  | ^^^^^
hint: did you mean `cull`?

error: colour `diffuse` is [1.0, -1.0, 0.0], numbers from 0 to 1e9 are accepted
  --> scene:11:11
11 | diffuse = [1, -1, 0]
   |           ^^^^^^^^^^

error: light has the direction [0.0, 0.0, 0.0], which has no length
  --> scene:12:25
12 | lights = [{ direction = [0, 0, 0] }]
   |                         ^^^^^^^^^"#,
    );
}
