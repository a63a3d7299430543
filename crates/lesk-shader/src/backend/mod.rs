//! The only user of naga: lowering, validation, writing, and what makes the written text readable.
//!
//! naga's representation changes with each major release; nothing outside this module names it.

mod entry;
mod glsl;
mod hlsl;
mod lower;
mod msl;
mod spirv;
mod tidy;
mod wgsl;
pub mod words;

use crate::{Error, Function, Language, Part, Product, Source, Unit};
use lower::{Lowered, Names};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// Writes a unit in a language.
pub fn write(unit: &Unit, language: Language, product: Product) -> Result<Source, Error> {
    let names = if language == Language::SpirV { Names::Plain } else { Names::Placeholders(Vec::new()) };
    // Metal's float3 takes 16 bytes; elsewhere a number may follow a vector after 12
    let vector_size = if language == Language::Msl { 16 } else { 12 };
    let mut lowered = lower::lower(unit, names, vector_size)?;
    let textures = if product == Product::Complete { entry::fragment(&mut lowered, unit) } else { Vec::new() };
    match language {
        Language::GlslEs300 | Language::Glsl450 => glsl::write(lowered, unit, language, product, &textures),
        Language::Wgsl => wgsl::write(lowered, unit),
        Language::Hlsl => hlsl::write(lowered, unit, product),
        Language::Msl => msl::write(lowered, unit, product),
        Language::SpirV => spirv::write(&lowered.module),
    }
}

fn validated(module: &naga::Module, language: Language) -> Result<ModuleInfo, Error> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(module).map_err(|e| writer_error(language, &e.into_inner()))
}

fn writer_error(language: Language, error: &dyn core::error::Error) -> Error {
    let mut message = error.to_string();
    let mut source = error.source();
    while let Some(inner) = source {
        message = format!("{message}: {inner}");
        source = inner.source();
    }
    Error::Writer { language: language.name(), message }
}

/// Puts the names in place and drops what a reader does not need.
fn readable(text: &str, lowered: Lowered, unit: &Unit) -> String {
    let result = |function: &Function| match function.part {
        Part::Eval => "f",
        Part::Pdf => "pdf",
        Part::Sample => "sampled",
        Part::Draw => "drawn",
    };
    let calls: Vec<&str> = unit.functions.iter().map(result).collect();
    match lowered.names {
        Names::Placeholders(names) => tidy::tidy(text, &names, &calls),
        Names::Plain => text.to_owned(),
    }
}
