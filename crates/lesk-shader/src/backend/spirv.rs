//! SPIR-V.

use crate::{Error, Language, Source};
use naga::back::spv;

pub(super) fn write(module: &naga::Module) -> Result<Source, Error> {
    let info = super::validated(module, Language::SpirV)?;
    let options = spv::Options { flags: spv::WriterFlags::DEBUG, ..spv::Options::default() };
    let words = spv::write_vec(module, &info, &options, None).map_err(|e| super::writer_error(Language::SpirV, &e))?;
    Ok(Source::Binary(words.iter().flat_map(|word| word.to_le_bytes()).collect()))
}
