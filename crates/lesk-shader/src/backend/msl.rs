//! Metal's language.

use super::lower::Lowered;
use super::{entry, tidy};
use crate::{Error, Language, Product, Source, Unit};
use naga::back::msl;

pub(super) fn write(lowered: Lowered, unit: &Unit, product: Product) -> Result<Source, Error> {
    let info = super::validated(&lowered.module, Language::Msl)?;
    let mut options = msl::Options { lang_version: (2, 0), ..msl::Options::default() };
    options.per_entry_point_map.insert(entry::NAME.to_owned(), bindings(unit));
    let (text, _) = msl::write_string(&lowered.module, &info, &options, &msl::PipelineOptions::default())
        .map_err(|e| super::writer_error(Language::Msl, &e))?;
    let text = tidy::without_lines(&text, |line| {
        line.starts_with('#')
            || line.starts_with("using ")
            || line.starts_with("// language")
            || (product == Product::Functions && line.contains(" _pad"))
    });
    let text = text.replace("metal::", "");
    Ok(Source::Text(super::readable(&text, lowered, unit)))
}

fn bindings(unit: &Unit) -> msl::EntryPointResources {
    let mut resources = msl::EntryPointResources::default();
    let place = |binding| naga::ResourceBinding { group: 0, binding };
    let params = msl::BindTarget { buffer: Some(0), ..msl::BindTarget::default() };
    resources.resources.insert(place(0), params);
    for k in 0..entry::arguments(unit).len() as u8 {
        let texture = msl::BindTarget { texture: Some(k), ..msl::BindTarget::default() };
        resources.resources.insert(place(u32::from(k) + 1), texture);
    }
    resources
}
