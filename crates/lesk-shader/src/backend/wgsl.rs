//! WGSL.

use super::lower::Lowered;
use crate::{Error, Language, Source, Unit};
use naga::back::wgsl;

pub(super) fn write(lowered: Lowered, unit: &Unit) -> Result<Source, Error> {
    let info = super::validated(&lowered.module, Language::Wgsl)?;
    let text = wgsl::write_string(&lowered.module, &info, wgsl::WriterFlags::empty())
        .map_err(|e| super::writer_error(Language::Wgsl, &e))?;
    Ok(Source::Text(super::readable(&text, lowered, unit)))
}
