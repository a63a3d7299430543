//! The JSON Schema against the examples, by a small validator of the keywords that the schema uses.

use lesk_scene::json_schema;
use lesk_scene::raster::{Classic, RasterSettings};
use serde_json::{Map, Value, json};
use std::path::Path;

/// What is wrong with `value` by `schema`; empty for nothing.
fn problems(root: &Value, schema: &Value, value: &Value, at: &str) -> Vec<String> {
    if let Some(reference) = schema["$ref"].as_str() {
        let target = root.pointer(&reference[1..]).expect("references point into the schema");
        return problems(root, target, value, at);
    }
    let mut out = Vec::new();
    let mut demand = |holds: bool, what: &str| {
        if !holds {
            out.push(format!("{at}: {what}"));
        }
    };
    let number = value.as_f64();
    match schema["type"].as_str() {
        Some("object") => demand(value.is_object(), "no table"),
        Some("array") => demand(value.is_array(), "no list"),
        Some("string") => demand(value.is_string(), "no text"),
        Some("boolean") => demand(value.is_boolean(), "no boolean"),
        Some("number") => demand(value.is_number(), "no number"),
        Some("integer") => demand(value.is_i64() || value.is_u64(), "no integer"),
        Some(other) => panic!("unknown type {other}"),
        None => {}
    }
    if let (Some(low), Some(x)) = (schema["minimum"].as_f64(), number) {
        demand(x >= low, "too small");
    }
    if let (Some(high), Some(x)) = (schema["maximum"].as_f64(), number) {
        demand(x <= high, "too large");
    }
    if let Some(words) = schema["enum"].as_array() {
        demand(words.contains(value), "no such word");
    }
    if let Some(one) = schema.get("const") {
        demand(one == value, "another word");
    }
    if schema["pattern"].is_string() {
        // the one pattern: a number, then a unit
        let text = value.as_str().unwrap_or("").trim();
        let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c));
        demand(
            text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) && !unit.trim().is_empty(),
            "no quantity",
        );
    }
    for (combinator, exactly_one) in [("anyOf", false), ("oneOf", true)] {
        if let Some(cases) = schema[combinator].as_array() {
            let results: Vec<Vec<String>> = cases.iter().map(|c| problems(root, c, value, at)).collect();
            let valid = results.iter().filter(|r| r.is_empty()).count();
            if valid == 0 || exactly_one && valid > 1 {
                out.push(format!("{at}: {valid} cases of {combinator} hold: {results:?}"));
            }
        }
    }
    out.extend(inner_problems(root, schema, value, at));
    out
}

fn inner_problems(root: &Value, schema: &Value, value: &Value, at: &str) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(list) = value.as_array() {
        let bounds = (schema["minItems"].as_u64().unwrap_or(0), schema["maxItems"].as_u64().unwrap_or(u64::MAX));
        if !(bounds.0..=bounds.1).contains(&(list.len() as u64)) {
            out.push(format!("{at}: {} entries", list.len()));
        }
        if let Some(items) = schema.get("items") {
            out.extend(list.iter().enumerate().flat_map(|(i, v)| problems(root, items, v, &format!("{at}[{i}]"))));
        }
    }
    if let Some(table) = value.as_object() {
        let none = Map::new();
        let known = schema["properties"].as_object().unwrap_or(&none);
        for (key, v) in table {
            let path = format!("{at}.{key}");
            match (known.get(key), &schema["additionalProperties"]) {
                (Some(inner), _) => out.extend(problems(root, inner, v, &path)),
                (None, Value::Bool(false)) => out.push(format!("{path}: unknown")),
                (None, Value::Null) => {}
                (None, inner) => out.extend(problems(root, inner, v, &path)),
            }
        }
        for key in schema["required"].as_array().unwrap_or(&vec![]) {
            if !table.contains_key(key.as_str().unwrap_or("")) {
                out.push(format!("{at}: no {key}"));
            }
        }
    }
    out
}

fn from_toml(text: &str) -> Value {
    fn value(v: &toml_edit::Value) -> Value {
        match v {
            toml_edit::Value::String(s) => json!(s.value()),
            toml_edit::Value::Integer(i) => json!(i.value()),
            toml_edit::Value::Float(x) => json!(x.value()),
            toml_edit::Value::Boolean(b) => json!(b.value()),
            toml_edit::Value::Datetime(d) => json!(d.value().to_string()),
            toml_edit::Value::Array(a) => a.iter().map(value).collect(),
            toml_edit::Value::InlineTable(t) => t.iter().map(|(k, v)| (k.to_string(), value(v))).collect(),
        }
    }
    fn item(i: &toml_edit::Item) -> Value {
        match i {
            toml_edit::Item::None => Value::Null,
            toml_edit::Item::Value(v) => value(v),
            toml_edit::Item::Table(t) => table(t),
            toml_edit::Item::ArrayOfTables(a) => a.iter().map(table).collect(),
        }
    }
    fn table(t: &toml_edit::Table) -> Value {
        t.iter().map(|(k, v)| (k.to_string(), item(v))).collect()
    }
    table(toml_edit::Document::parse(text).unwrap().as_table())
}

#[test]
fn every_example_is_valid() {
    let schema = json_schema();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let found = problems(&schema, &schema, &from_toml(&std::fs::read_to_string(&path).unwrap()), "");
            assert!(found.is_empty(), "{}: {found:#?}", path.display());
        }
    }
}

#[test]
fn mistakes_are_invalid() {
    let schema = json_schema();
    let good = include_str!("../../../examples/scenes/cornell_box.toml");
    for (from, to) in [
        ("version = 1", "version = 2"),
        ("model = \"lambert\"", "model = \"lambret\""),
        ("size = [512, 512]", "size = [512]"),
        ("width = \"55 cm\"", "width = 55"),
        ("shape = \"cube\"", "shape = \"disk\""),
        ("fov = \"38 deg\"", "fvo = \"38 deg\""),
        ("reflectance = [0.73, 0.735, 0.73]", "reflectance = [1.73, 0.735, 0.73]"),
    ] {
        assert!(good.contains(from), "{from}");
        let found = problems(&schema, &schema, &from_toml(&good.replacen(from, to, 1)), "");
        assert!(!found.is_empty(), "{to}");
    }
}

#[test]
fn every_model_is_in_the_schema_and_no_parameter_has_the_name_of_a_key() {
    let schema = json_schema();
    let materials = schema["$defs"]["material"]["oneOf"].as_array().unwrap();
    let models: Vec<&str> = lesk_bsdf::registry::all().map(|m| m.id()).collect();
    assert_eq!(materials.len(), models.len());
    for model in lesk_bsdf::registry::all() {
        for spec in model.specs() {
            assert!(!["model", "two_sided"].contains(&spec.name), "{}: {}", model.id(), spec.name);
        }
    }
}

#[test]
fn the_schema_says_what_rasterising_does_by_default() {
    let schema = json_schema();
    let raster = &schema["properties"]["raster"]["properties"];
    let usual = RasterSettings::default();
    let model = Classic::default();
    let says = |section: &Value, key: &str, value: String| {
        let text = section[key]["description"].as_str().unwrap();
        assert!(text.ends_with(&format!("; {value} where absent.")), "{key}: {text}");
    };
    for (key, value) in [
        ("shading", usual.shading.name().to_string()),
        ("interpolation", usual.interpolation.name().to_string()),
        ("correction", usual.correction.name().to_string()),
        ("normals", usual.normals.name().to_string()),
        ("tessellation", usual.tessellation.to_string()),
        ("subdivide", usual.subdivide.to_string()),
        ("renormalize", usual.renormalize.to_string()),
        ("supersampling", usual.supersampling.to_string()),
        ("quadrature", usual.quadrature.to_string()),
        ("shadows", usual.shadows.to_string()),
        ("cull", usual.cull.to_string()),
        ("flat_point", usual.flat_point.name().to_string()),
        ("space", usual.space.name().to_string()),
    ] {
        says(raster, key, value);
    }
    let classic = &raster["classic"]["properties"];
    for (key, value) in [
        ("ambient", "[1, 1, 1]".to_string()),
        ("ka", model.ka.to_string()),
        ("kd", model.kd.to_string()),
        ("ks", model.ks.to_string()),
        ("shininess", model.shininess.to_string()),
        ("highlight", model.highlight.name().to_string()),
    ] {
        says(classic, key, value);
    }
    assert_eq!([model.ambient, model.diffuse, model.specular], [[1.0; 3]; 3]);
}
