//! HLSL.

use super::lower::Lowered;
use crate::{Error, Language, Product, Source, Unit};
use naga::back::hlsl;

pub(super) fn write(lowered: Lowered, unit: &Unit, product: Product) -> Result<Source, Error> {
    let info = super::validated(&lowered.module, Language::Hlsl)?;
    let (options, pipeline) = (hlsl::Options::default(), hlsl::PipelineOptions::default());
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &pipeline)
        .write(&lowered.module, &info, None)
        .map_err(|e| super::writer_error(Language::Hlsl, &e))?;
    let text = match product {
        // padding matters in a buffer only
        Product::Functions => super::tidy::without_lines(&text, |line| line.contains("_pad")),
        Product::Complete => text,
    };
    Ok(Source::Text(super::readable(&text, lowered, unit)))
}
