//! The comment at the top of exported text.

use crate::{Language, Math, Options, Part, Product};
use lesk_bsdf::Scatter;
use lesk_bsdf::model::Domain;
use lesk_bsdf::params::ParamSpec;

/// The text with a comment that says what it is, where it comes from and how to call it.
pub fn with_header(text: &str, model: &dyn Scatter, what: &[Part], language: Language, options: Options) -> String {
    let (first, rest) = first_lines(text, language, options.product);
    let mut out = String::from(first);
    for line in lines(model, what, options) {
        out.push_str(if line.is_empty() { "//" } else { "// " });
        out.push_str(&line);
        out.push('\n');
    }
    out.push('\n');
    out.push_str(rest.trim_start());
    out
}

/// GLSL's `#version` must stay the first line; Metal needs its library.
fn first_lines(text: &str, language: Language, product: Product) -> (&str, &str) {
    match (language, product) {
        (Language::Msl, _) => ("#include <metal_stdlib>\nusing namespace metal;\n\n", text),
        (Language::GlslEs300 | Language::Glsl450, Product::Complete) => {
            text.split_at(text.find('\n').map_or(0, |n| n + 1))
        }
        _ => ("", text),
    }
}

fn lines(model: &dyn Scatter, what: &[Part], options: Options) -> Vec<String> {
    let facts = model.model();
    let math = match options.math {
        Math::Builtin => "",
        Math::Exact => ", with Lesk's own elementary functions",
    };
    let mut lines = vec![
        facts.title.to_owned(),
        format!("Source: {} ({}). Written by Lesk {}{math}.", facts.paper, facts.year, env!("CARGO_PKG_VERSION")),
        String::new(),
        "wi points to the light and wo to the viewer: unit vectors in the local frame, normal +z, tangent +x."
            .to_owned(),
    ];
    lines.extend(what.iter().map(|&part| part_line(model, part)));
    if !model.specs().is_empty() {
        lines.push(String::new());
        lines.push("Parameters:".to_owned());
        let width = model.specs().iter().map(|spec| spec.name.len()).max().unwrap_or(0);
        lines.extend(model.specs().iter().map(|spec| parameter_line(spec, width)));
    }
    if options.product == Product::Complete {
        lines.push(String::new());
        lines.push("One texel of each map is one direction; u holds numbers in [0, 1).".to_owned());
    }
    lines
}

fn part_line(model: &dyn Scatter, part: Part) -> String {
    let id = model.id();
    let zero = match model.model().domain {
        Domain::Upper => "; 0 unless both lie above the surface",
        Domain::BothSides | Domain::Sphere => "",
    };
    match part {
        Part::Eval => format!("{id}_eval: f(wi, wo) in 1/sr, without the cosine{zero}."),
        Part::Pdf => format!("{id}_pdf: the density with which {id}_sample draws wi, in 1/sr{zero}."),
        Part::Sample => {
            format!("{id}_sample: draws wi for wo; u are three numbers in [0, 1). A draw of density 0 failed.")
        }
        Part::Draw => format!(
            "{id}_draw: draws wi, with weight = f |wi.z| / pdf; delta is 1 where pdf is the probability of a delta lobe."
        ),
    }
}

fn parameter_line(spec: &ParamSpec, width: usize) -> String {
    let [low, high] = spec.range;
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" {}", spec.unit) };
    let doc = spec.doc.split_once(". ").map_or(spec.doc.to_owned(), |(first, _)| format!("{first}."));
    let doc = doc.replace('\n', " ");
    format!("  {:width$}  {low} to {high}{unit}. {doc}", spec.name)
}
