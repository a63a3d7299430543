//! The JSON Schema of scene files, for editors and other programs.

use super::sections::{MATERIAL_COMMON, ROOT, STEP, TEXTURE};
use super::{Field, Kind, Section, Variants};
use lesk_bsdf::params::{Kind as ParamKind, ParamSpec};
use lesk_bsdf::registry;
use lesk_quantities::Dimension;
use serde_json::{Map, Value, json};

/// A number with a unit, as text.
const QUANTITY: &str = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*[^0-9\s].*$";

/// The JSON Schema (draft 2020-12) of scene files, made from the same table that the reader checks.
pub fn json_schema() -> Value {
    let mut schema = object("Lesk scene", ROOT);
    let entries = schema.as_object_mut().expect("an object was just made");
    entries.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    entries.insert("title".into(), json!("Lesk scene, version 1"));
    entries.insert(
        "$defs".into(),
        json!({
            "object": variants(&super::OBJECT),
            "material": materials(),
            "texture": object("texture", TEXTURE),
            "step": object("step of a transform", STEP),
        }),
    );
    schema
}

fn object(title: &str, fields: &[Field]) -> Value {
    let properties: Map<String, Value> = fields.iter().map(|f| (f.name.to_string(), property(f))).collect();
    let required: Vec<&str> = fields.iter().filter(|f| f.required).map(|f| f.name).collect();
    json!({
        "title": title,
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(field: &Field) -> Value {
    let mut value = kind(&field.kind);
    if let Some(entries) = value.as_object_mut() {
        entries.insert("description".into(), json!(field.doc));
    }
    value
}

fn kind(kind: &Kind) -> Value {
    let numbers = |n: usize| json!({ "type": "array", "items": { "type": "number" }, "minItems": n, "maxItems": n });
    match kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Bool => json!({ "type": "boolean" }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Choices(words) => json!({ "type": "array", "items": { "enum": words }, "uniqueItems": true }),
        Kind::Integer([low, high]) => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Kind::Number([low, high]) => limits(json!({ "type": "number" }), *low, *high),
        Kind::Numbers(n) => numbers(*n),
        Kind::NumberOr(n) => json!({ "anyOf": [{ "type": "number" }, numbers(*n)] }),
        Kind::Integers(n, [low, high]) => {
            let item = json!({ "type": "integer", "minimum": low, "maximum": high });
            json!({ "type": "array", "items": item, "minItems": n, "maxItems": n })
        }
        Kind::Matrix => json!({ "type": "array", "items": numbers(4), "minItems": 3, "maxItems": 3 }),
        Kind::Quantity(dimensions, _) => {
            json!({ "type": "string", "pattern": QUANTITY, "examples": examples(dimensions) })
        }
        Kind::Exposure => {
            let text = json!({ "type": "string", "pattern": QUANTITY, "examples": ["8 EV"] });
            json!({ "anyOf": [limits(json!({ "type": "number" }), -50.0, 50.0), text] })
        }
        Kind::Table(inner) => section(inner),
        Kind::List(inner) => json!({ "type": "array", "items": section(inner) }),
        Kind::Named(inner) => json!({ "type": "object", "additionalProperties": section(inner) }),
        Kind::Steps => {
            let step = json!({ "$ref": "#/$defs/step" });
            json!({ "anyOf": [step, { "type": "array", "items": step }] })
        }
    }
}

fn limits(mut value: Value, low: f64, high: f64) -> Value {
    if low > -1e300 {
        value["minimum"] = json!(low);
    }
    if high < 1e300 {
        value["maximum"] = json!(high);
    }
    value
}

fn examples(dimensions: &[Dimension]) -> Vec<String> {
    dimensions.iter().map(|d| format!("1 {}", d.examples()[0])).collect()
}

fn section(section: &Section) -> Value {
    match section {
        Section::Plain(name, fields) => object(name, fields),
        // objects stand in groups too: a definition of their own
        Section::Variants(v) if v.name == super::OBJECT.name => json!({ "$ref": "#/$defs/object" }),
        Section::Variants(v) => variants(v),
        Section::Material => json!({ "$ref": "#/$defs/material" }),
    }
}

fn variants(v: &Variants) -> Value {
    let case = |(word, own): &(&str, &[Field])| {
        let fields: Vec<Field> = v.common.iter().chain(*own).copied().collect();
        let mut value = object(&format!("{} {word}", v.name), &fields);
        value["properties"][v.tag] = json!({ "const": word });
        if let Some(required) = value["required"].as_array_mut() {
            required.insert(0, json!(v.tag));
        }
        value
    };
    json!({ "oneOf": v.cases.iter().map(case).collect::<Vec<Value>>() })
}

fn materials() -> Value {
    let material = |model: &'static dyn lesk_bsdf::Scatter| {
        let mut value = object(&format!("material {}", model.id()), MATERIAL_COMMON);
        value["description"] = json!(model.model().title);
        value["properties"]["model"] = json!({ "const": model.id() });
        value["required"] = json!(["model"]);
        for spec in model.specs() {
            value["properties"][spec.name] = param(spec);
        }
        value
    };
    json!({ "oneOf": registry::all().map(material).collect::<Vec<Value>>() })
}

fn param(spec: &ParamSpec) -> Value {
    let number = json!({ "type": "number", "minimum": spec.range[0], "maximum": spec.range[1] });
    let texture = json!({ "$ref": "#/$defs/texture" });
    let mut any = vec![number.clone(), texture];
    if spec.kind == ParamKind::Color {
        any.push(json!({ "type": "array", "items": number, "minItems": 3, "maxItems": 3 }));
    }
    let default: Value = match spec.default {
        [one] => json!(one),
        many => json!(many),
    };
    json!({ "anyOf": any, "description": spec.doc.trim(), "default": default })
}
