//! Shader source from the recorded formulas: one definition of a model becomes GLSL, WGSL, HLSL, MSL and SPIR-V.
//!
//! ```
//! use lesk_shader::{Language, Options, Part, export};
//! let ggx = lesk_bsdf::registry::find("ggx").unwrap();
//! let source = export(ggx, &[Part::Eval], Language::Wgsl, Options::default()).unwrap();
//! assert!(source.text().unwrap().contains("let h = wi + wo;"));
//! ```
//!
//! The steps: `record` runs the model with recorded numbers; `pack` turns scalars back into vectors, and `slim` undoes
//! that where it does not pay; `idiom` finds the functions and spellings that readers expect; `name` decides what becomes
//! a local; `backend` lowers all that to naga, whose writers know the languages.
//!
//! It compiles no shader and runs none.

mod backend;
mod error;
mod header;
mod idiom;
#[cfg(test)]
mod interpret;
mod language;
mod name;
mod pack;
mod packed;
mod record;
mod slim;
#[cfg(test)]
mod tests;

pub use error::Error;
pub use language::{Language, Math, Options, Part, Product, Source};

use lesk_bsdf::Scatter;
use packed::{Op, Packed, Type};
use std::sync::{Arc, Mutex, PoisonError};

/// One function, ready to be lowered.
struct Function {
    part: Part,
    packed: Packed,
    /// Name of each node that becomes a local.
    locals: Vec<Option<String>>,
    /// Name and type of each result.
    results: Vec<(&'static str, Type)>,
}

/// The functions of one model.
struct Unit {
    id: String,
    /// Names and types of the parameters.
    members: Vec<(String, Type)>,
    functions: Vec<Function>,
}

/// Writes the parts `what` of `model` in a language.
///
/// The functions are called `<id>_eval` and so on, and take directions in the local frame and a structure with the
/// model's parameters; the header comment of the text says more. Outside the model's domain they give 0, as the model
/// does. Non-finite arguments, and parameters outside their ranges, are the caller's business.
pub fn export(model: &dyn Scatter, what: &[Part], language: Language, options: Options) -> Result<Source, Error> {
    let repeated = |part: &Part| what.iter().filter(|other| *other == part).count() > 1;
    if what.is_empty() || what.iter().any(repeated) {
        return Err(Error::Parts { asked: what.iter().map(|part| part.name()).collect() });
    }
    let unit = last_unit(model, what, options.math)?;
    let source = backend::write(&unit, language, options.product)?;
    Ok(match source {
        Source::Text(text) => Source::Text(header::with_header(&text, model, what, language, options)),
        binary => binary,
    })
}

/// What a unit was made from: the recorded formulas of a model, parts and whose elementary functions.
#[derive(PartialEq)]
struct Key {
    /// Where they stand in memory, forever: no two models share a place.
    formulas: usize,
    parts: Vec<Part>,
    math: Math,
}

/// [`unit`], kept until another one is asked for: one after the other, a model is usually written in several languages,
/// and making the unit takes half of the time.
fn last_unit(model: &dyn Scatter, what: &[Part], math: Math) -> Result<Arc<Unit>, Error> {
    static LAST: Mutex<Option<(Key, Arc<Unit>)>> = Mutex::new(None);
    let formulas = model.forms().recorded.map_or(0, |formulas| std::ptr::from_ref(formulas).addr());
    let key = Key { formulas, parts: what.to_vec(), math };
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, unit)) = last.as_ref().filter(|(made_from, _)| *made_from == key) {
        return Ok(unit.clone());
    }
    let unit = Arc::new(unit(model, what, math)?);
    *last = Some((key, unit.clone()));
    Ok(unit)
}

fn unit(model: &dyn Scatter, what: &[Part], math: Math) -> Result<Unit, Error> {
    let names = model.specs().iter().map(|spec| backend::words::safe(spec.name));
    let members = names.zip(model.specs().iter().map(record::member_type)).collect();
    let mut unit = Unit { id: model.id().to_owned(), members, functions: Vec::new() };
    for &part in what {
        unit.functions.push(function(model, part, math)?);
    }
    Ok(unit)
}

fn function(model: &dyn Scatter, part: Part, math: Math) -> Result<Function, Error> {
    let recording = record::record(model, part, math)?;
    let mut packed = idiom::rewrite(&slim::slim(&pack::pack(&recording)?));
    if part == Part::Draw {
        name_outcome(&mut packed);
    }
    let members: Vec<String> = model.specs().iter().map(|spec| spec.name.to_owned()).collect();
    let locals = name::locals(&packed, &part.arguments(), &members);
    let results = recording.outputs.iter().map(|output| (output.name, output.ty())).collect();
    Ok(Function { part, packed, locals, results })
}

/// Names the condition under which a draw has a density: a delta lobe was taken or, without such lobes, it is valid.
fn name_outcome(packed: &mut Packed) {
    let [_, _, pdf, delta] = packed.outputs[..] else { return };
    if let Op::Select(condition, ..) = packed.nodes[pdf as usize] {
        let name = if packed.number(delta).is_some() { "valid" } else { "taken" };
        packed.names.entry(condition).or_insert(name);
    }
}
