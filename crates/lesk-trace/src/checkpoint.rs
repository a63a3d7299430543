//! Checkpoints: the exact sums of a film, and what must be the same for going on with them.
//!
//! Format: the line `LESK CHECKPOINT 1`, one line of facts as `key=value` separated by spaces, then the film.

use crate::render::Settings;
use lesk_image::{Film, ImageError, atomic_write};
use lesk_math::Isa;
use lesk_scene::Scene;
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

const MAGIC: &str = "LESK CHECKPOINT 1";
/// No line of a checkpoint is longer.
const LINE: u64 = 4096;

/// What decides the bits of a picture besides the number of samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    facts: Vec<(&'static str, String)>,
}

impl Identity {
    /// Of a scene with settings, in this version on this instruction set.
    pub fn new(scene: &Scene, settings: &Settings) -> Identity {
        let render = &settings.render;
        let fingerprint: String = scene.fingerprint.iter().map(|byte| format!("{byte:02x}")).collect();
        Identity {
            facts: vec![
                ("version", env!("CARGO_PKG_VERSION").to_owned()),
                ("isa", Isa::current().name().to_owned()),
                ("scene", fingerprint),
                ("seed", render.seed.to_string()),
                ("max_depth", render.max_depth.to_string()),
                ("roulette_depth", render.roulette_depth.to_string()),
                ("split", render.split.join("+")),
                ("aovs", render.aovs.to_string()),
                ("shadow_terminator", render.shadow_terminator.name().to_owned()),
            ],
        }
    }

    fn line(&self) -> String {
        let facts: Vec<_> = self.facts.iter().map(|(k, v)| format!("{k}={v}")).collect();
        facts.join(" ")
    }

    /// What differs from the facts in a checkpoint, as text; `None` if nothing does.
    fn difference(&self, line: &str) -> Option<String> {
        let theirs: Vec<(&str, &str)> = line.split(' ').filter_map(|fact| fact.split_once('=')).collect();
        let differs = |(key, ours): &(&str, String)| {
            let found = theirs.iter().find(|(k, _)| k == key).map_or("nothing", |(_, v)| v);
            (found != ours).then(|| format!("`{key}` is `{found}` in it and `{ours}` now"))
        };
        let all: Vec<_> = self.facts.iter().filter_map(differs).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }
}

/// Why a checkpoint cannot be used.
#[derive(Debug)]
pub enum CheckpointError {
    Io(io::Error),
    /// Not a checkpoint, or a damaged one.
    Malformed(String),
    /// It belongs to another picture.
    Mismatch(String),
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            CheckpointError::Io(e) => write!(f, "cannot read the checkpoint: {e}"),
            CheckpointError::Malformed(what) => write!(f, "the checkpoint is damaged: {what}"),
            CheckpointError::Mismatch(what) => {
                write!(f, "the checkpoint belongs to another picture: {what}\nhint: render without `--resume`")
            }
        }
    }
}

impl std::error::Error for CheckpointError {}

/// Writes a checkpoint in place of an older one; on failure the older one stays.
///
/// # Errors
/// What the file system says.
pub fn save(path: &Path, identity: &Identity, film: &Film) -> Result<(), ImageError> {
    let head = format!("{MAGIC}\n{}\n", identity.line());
    atomic_write(path, Some(head.len() as u64 + film.saved_size()), |out| {
        out.write_all(head.as_bytes())?;
        film.save(out)
    })
}

/// Fills the film from a checkpoint.
///
/// # Errors
/// A file that cannot be read, is damaged, or belongs to another picture.
pub fn load(path: &Path, identity: &Identity, film: &mut Film) -> Result<(), CheckpointError> {
    let mut reader = BufReader::new(File::open(path).map_err(CheckpointError::Io)?);
    if line(&mut reader)? != MAGIC {
        return Err(CheckpointError::Malformed(format!("it does not begin with `{MAGIC}`")));
    }
    let facts = line(&mut reader)?;
    if let Some(what) = identity.difference(&facts) {
        return Err(CheckpointError::Mismatch(what));
    }
    film.restore(&mut reader).map_err(|e| CheckpointError::Malformed(e.to_string()))
}

fn line(reader: &mut impl BufRead) -> Result<String, CheckpointError> {
    let mut bytes = Vec::new();
    io::Read::take(&mut *reader, LINE).read_until(b'\n', &mut bytes).map_err(CheckpointError::Io)?;
    let text = String::from_utf8(bytes).map_err(|_| CheckpointError::Malformed("its head is no text".into()))?;
    match text.strip_suffix('\n') {
        Some(line) => Ok(line.to_owned()),
        None => Err(CheckpointError::Malformed("its head ends early".into())),
    }
}
