//! GLSL, ES 3.00 and 4.50.

use super::lower::Lowered;
use super::{entry, tidy};
use crate::{Error, Language, Product, Source, Unit};
use naga::back::glsl;

pub(super) fn write(
    mut lowered: Lowered,
    unit: &Unit,
    language: Language,
    product: Product,
    textures: &[String],
) -> Result<Source, Error> {
    if product == Product::Functions {
        // the writer wants an entry point; it is cut off below
        let mut main = naga::Function::default();
        main.body.push(naga::Statement::Return { value: None }, naga::Span::UNDEFINED);
        lowered.module.entry_points.push(entry::entry_point(main));
    }
    let info = super::validated(&lowered.module, language)?;
    let text = raw(&lowered, &info, language, textures.len() as u32)?;
    let text = match product {
        Product::Functions => functions_only(&text),
        Product::Complete => global_names(&text, unit, textures),
    };
    Ok(Source::Text(super::readable(&text, lowered, unit)))
}

fn raw(lowered: &Lowered, info: &naga::valid::ModuleInfo, language: Language, textures: u32) -> Result<String, Error> {
    let version = match language {
        Language::GlslEs300 => glsl::Version::Embedded { version: 300, is_webgl: true },
        _ => glsl::Version::Desktop(450),
    };
    let place = |binding| (naga::ResourceBinding { group: 0, binding }, binding as u8);
    let options = glsl::Options {
        version,
        writer_flags: glsl::WriterFlags::empty(),
        binding_map: (0..=textures).map(place).collect(),
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: naga::ShaderStage::Fragment,
        entry_point: entry::NAME.to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = naga::proc::BoundsCheckPolicies::default();
    let error = |e: glsl::Error| super::writer_error(language, &e);
    glsl::Writer::new(&mut text, &lowered.module, info, &options, &pipeline, policies)
        .map_err(error)?
        .write()
        .map_err(error)?;
    Ok(text)
}

fn functions_only(text: &str) -> String {
    let text = text.split("void main()").next().unwrap_or(text);
    tidy::without_lines(text, |line| line.starts_with('#') || line.starts_with("precision "))
}

/// The writer's names of globals to ours.
fn global_names(text: &str, unit: &Unit, textures: &[String]) -> String {
    let mut text = text.replace("_group_0_binding_0_fs", "params");
    for (k, texture) in textures.iter().enumerate() {
        text = text.replace(&format!("_group_0_binding_{}_fs", k + 1), texture);
    }
    for (k, target) in entry::targets(unit).iter().enumerate() {
        text = text.replace(&format!("_fs2p_location{k}"), &format!("{target}_target"));
    }
    text.replace("_block_0Fragment", "Block")
}
