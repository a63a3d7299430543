//! Stamps: a step whose inputs have not changed since its last success need not run again.

use crate::process::{Error, at};
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

/// A file that holds the hash of the inputs of the last success.
pub struct Stamp {
    path: PathBuf,
    hash: String,
}

impl Stamp {
    /// The stamp in the file `path` for the content of the files and folders `inputs` and for `facts`.
    pub fn new(path: PathBuf, inputs: &[PathBuf], facts: &[&str]) -> Result<Self, Error> {
        let mut hasher = DefaultHasher::new();
        facts.hash(&mut hasher);
        for input in inputs {
            hash_tree(input, &mut hasher)?;
        }
        Ok(Self { path, hash: format!("{:016x}", hasher.finish()) })
    }

    /// Whether the last success had these inputs.
    pub fn is_fresh(&self) -> bool {
        std::fs::read_to_string(&self.path).is_ok_and(|hash| hash == self.hash)
    }

    /// Notes a success.
    pub fn set(&self) -> Result<(), Error> {
        at(&self.path, std::fs::write(&self.path, &self.hash))
    }
}

/// Hashes names and content, in the order of the names; a path that is not there counts as such.
fn hash_tree(path: &Path, hasher: &mut DefaultHasher) -> Result<(), Error> {
    path.hash(hasher);
    if path.is_file() {
        at(path, std::fs::read(path))?.hash(hasher);
    } else if path.is_dir() {
        let entries = at(path, std::fs::read_dir(path))?;
        let mut children: Vec<_> = entries.filter_map(Result::ok).map(|entry| entry.path()).collect();
        children.retain(|child| !child.ends_with("__pycache__"));
        children.sort();
        for child in &children {
            hash_tree(child, hasher)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_is_fresh_until_content_or_facts_change() {
        let folder = std::env::temp_dir().join(format!("lesk-stamp-{}", std::process::id()));
        let input = folder.join("input");
        std::fs::create_dir_all(&input).unwrap();
        std::fs::write(input.join("a"), "1").unwrap();
        let stamp = |fact| Stamp::new(folder.join("stamp"), std::slice::from_ref(&input), &[fact]).unwrap();

        assert!(!stamp("x").is_fresh());
        stamp("x").set().unwrap();
        assert!(stamp("x").is_fresh());
        assert!(!stamp("y").is_fresh());
        std::fs::write(input.join("a"), "2").unwrap();
        assert!(!stamp("x").is_fresh());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
