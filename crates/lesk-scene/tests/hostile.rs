//! Whatever the text, the reader answers: it neither panics nor hangs.

use lesk_scene::Scene;
use proptest::prelude::*;

const SCENES: [&str; 4] = [
    include_str!("../../../examples/scenes/cornell_box.toml"),
    include_str!("../../../examples/scenes/glossy_spheres.toml"),
    include_str!("../../../examples/scenes/lights_in_all_units.toml"),
    include_str!("../../../examples/scenes/many_lights.toml"),
];

/// Pieces that mean something to the reader.
const WORDS: [&str; 40] = [
    "inf",
    "nan",
    "-1",
    "0",
    "1e308",
    "-1e308",
    "9223372036854775807",
    "[]",
    "{}",
    "[[",
    "]]",
    "\"",
    "'''",
    "=",
    "\n",
    "[objects]",
    "[[objects]]",
    "[camera]",
    "[materials]",
    "[groups.row]",
    "group = \"row\"",
    "shape = \"group\"",
    "\"1 lm\"",
    "\"1e300 lm\"",
    "\"-5 cm\"",
    "\"0 m\"",
    "\"1e-300 m\"",
    "true",
    "1979-05-27",
    "model = \"ggx\"",
    "version = 1",
    "size = [65536, 65536]",
    "transform = {}",
    "scale = 0",
    "matrix = [[0,0,0,0],[0,0,0,0],[0,0,0,0]]",
    "é",
    "\u{0}",
    "file = \"/dev/zero\"",
    "file = \"\"",
    "shape = \"mesh\"",
];

/// Replaces pieces of a scene by words.
fn mutated(scene: usize, edits: &[(prop::sample::Index, usize, prop::sample::Index)]) -> String {
    let mut text: Vec<char> = SCENES[scene % SCENES.len()].chars().collect();
    for (at, length, word) in edits {
        let start = at.index(text.len());
        let end = (start + length).min(text.len());
        text.splice(start..end, word.get(&WORDS).chars());
    }
    text.into_iter().collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn mutated_scenes_give_a_scene_or_an_error(
        scene: usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12, any::<prop::sample::Index>()), 1..6),
    ) {
        let text = mutated(scene, &edits);
        if let Err(error) = Scene::parse(&text, "no-such-folder") {
            prop_assert!(!error.problems().is_empty());
            prop_assert!(error.to_string().starts_with("error: "));
        }
    }

    #[test]
    fn arbitrary_text_gives_an_error(text in "(?s).{0,200}") {
        let error = Scene::parse(&text, "").expect_err("no camera");
        prop_assert!(error.to_string().starts_with("error: "));
    }
}

#[test]
fn deep_nesting_is_an_error_and_not_a_crash() {
    for (open, close) in [("[", "]"), ("{ a = ", " }")] {
        let text = format!("x = {}1{}", open.repeat(100_000), close.repeat(100_000));
        assert!(Scene::parse(&text, "").is_err());
    }
}

#[test]
fn groups_that_multiply_beyond_all_memory_are_refused() {
    let mut text = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 0]\n".to_string();
    let two = |name: &str| {
        format!("objects = [{0}, {0}, {0}, {0}]\n", format!("{{ shape = \"group\", group = \"{name}\" }}"))
    };
    for i in 1..40 {
        text += &format!("[groups.g{i}]\n{}", two(&format!("g{}", i - 1)));
    }
    text += "[groups.g0]\nobjects = [{ shape = \"sphere\", light = { flux = \"1 lm\" } }]\n";
    text += "[[objects]]\nshape = \"group\"\ngroup = \"g39\"\n";
    let error = Scene::parse(&text, "").unwrap_err().to_string();
    assert!(error.contains("group `g39` brings the scene to more than 4194304 objects"), "{error}");
}

#[test]
fn circles_below_groups_that_multiply_are_found_at_once() {
    let mut text = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 0]\n".to_string();
    for i in 0..60 {
        let inner = format!("{{ shape = \"group\", group = \"g{}\" }}", i32::max(i - 1, 0));
        text += &format!("[groups.g{i}]\nobjects = [{inner}, {inner}]\n");
    }
    text += "[[objects]]\nshape = \"group\"\ngroup = \"g59\"\n";
    let error = Scene::parse(&text, "").unwrap_err().to_string();
    assert!(error.contains("group `g0` contains itself: g0 -> g0"), "{error}");
}

#[test]
fn a_long_chain_of_groups_is_refused_and_not_a_crash() {
    let mut text = "version = 1\n[camera]\neye = [0, -3, 1]\ntarget = [0, 0, 0]\n".to_string();
    for i in 1..20_000 {
        text += &format!("[groups.g{i}]\nobjects = [{{ shape = \"group\", group = \"g{}\" }}]\n", i - 1);
    }
    text += "[groups.g0]\nobjects = []\n[[objects]]\nshape = \"group\"\ngroup = \"g19999\"\n";
    let error = Scene::parse(&text, "").unwrap_err().to_string();
    assert!(error.contains("is nested 20000 deep, up to 64 is accepted"), "{error}");
}
