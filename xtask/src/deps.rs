//! `cargo xtask deps`: who imports whom.
//!
//! Each crate has a level and may depend on crates of lower levels only, never sideways or
//! upward. Tests and build scripts count too.

use crate::process::{Error, capture, cargo};
use serde_json::Value;

/// The level of each crate, as in ARCHITECTURE.md.
const LEVELS: [(&str, u8); 16] = [
    ("lesk-math", 0),
    ("lesk-derive", 0),
    ("lesk-quantities", 1),
    ("lesk-geometry", 1),
    ("lesk-bsdf", 2),
    ("lesk-image", 2),
    ("lesk-light", 3),
    ("lesk-scene", 4),
    ("lesk-check", 4),
    ("lesk-shader", 4),
    ("lesk-trace", 5),
    ("lesk-raster", 5),
    ("lesk", 6),
    ("lesk-py", 6),
    ("lesk-fuzz", 6),
    ("xtask", 6),
];

/// Checks the workspace.
pub fn run(arguments: &[String]) -> Result<(), Error> {
    if let Some(argument) = arguments.first() {
        let what = format!("`deps` takes no argument, but was given `{argument}`");
        return Err(Error::usage(what, "cargo xtask deps"));
    }
    let text = capture(cargo().args(["metadata", "--no-deps", "--format-version", "1"]))?;
    let metadata: Value =
        serde_json::from_str(&text).map_err(|error| Error::Check { what: format!("cargo metadata: {error}") })?;
    let faults = faults(&packages(&metadata), &LEVELS);
    if faults.is_empty() {
        println!("{} crates import lower levels only", LEVELS.len());
        return Ok(());
    }
    Err(Error::Check { what: faults.join("\n") })
}

/// A crate of the workspace and the names of all that it depends on.
struct Package {
    name: String,
    dependencies: Vec<String>,
}

fn packages(metadata: &Value) -> Vec<Package> {
    let name = |value: &Value| value["name"].as_str().unwrap_or_default().to_string();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    list(&metadata["packages"])
        .iter()
        .map(|package| Package {
            name: name(package),
            dependencies: list(&package["dependencies"]).iter().map(name).collect(),
        })
        .collect()
}

/// One line for each crate without a level, each level without a crate, and each import that is
/// not downward.
fn faults(packages: &[Package], levels: &[(&str, u8)]) -> Vec<String> {
    let level = |name: &str| levels.iter().find(|entry| entry.0 == name).map(|entry| entry.1);
    let mut faults = Vec::new();
    for (name, _) in levels {
        if !packages.iter().any(|package| package.name == *name) {
            faults.push(format!("`{name}` has a level, but is no crate of the workspace"));
        }
    }
    for Package { name, dependencies } in packages {
        let Some(own) = level(name) else {
            faults.push(format!("`{name}` has no level in xtask/src/deps.rs"));
            continue;
        };
        for dependency in dependencies {
            if let Some(other) = level(dependency).filter(|other| *other >= own) {
                faults.push(format!(
                    "`{name}` (level {own}) imports `{dependency}` (level {other}), \
                     but may import lower levels only"
                ));
            }
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const TWO_LEVELS: [(&str, u8); 3] = [("math", 0), ("derive", 0), ("bsdf", 2)];

    /// Metadata with the given imports of `math` and of `bsdf`.
    fn workspace(math: &[&str], bsdf: &[&str]) -> Vec<Package> {
        let imports =
            |names: &[&str]| -> Vec<_> { names.iter().map(|name| json!({"name": name, "kind": null})).collect() };
        packages(&json!({"packages": [
            {"name": "math", "dependencies": imports(math)},
            {"name": "derive", "dependencies": []},
            {"name": "bsdf", "dependencies": imports(bsdf)},
        ]}))
    }

    #[test]
    fn downward_and_foreign_imports_are_allowed() {
        assert!(faults(&workspace(&["libm"], &["math", "derive"]), &TWO_LEVELS).is_empty());
    }

    #[test]
    fn an_upward_import_is_a_fault() {
        let faults = faults(&workspace(&["bsdf"], &[]), &TWO_LEVELS);
        assert_eq!(faults.len(), 1);
        assert!(faults[0].starts_with("`math` (level 0) imports `bsdf` (level 2)"));
    }

    #[test]
    fn a_sideways_import_is_a_fault() {
        let faults = faults(&workspace(&["derive"], &[]), &TWO_LEVELS);
        assert!(faults[0].starts_with("`math` (level 0) imports `derive` (level 0)"));
    }

    #[test]
    fn a_crate_without_a_level_and_a_level_without_a_crate_are_faults() {
        let levels = [("math", 0), ("derive", 0), ("light", 3)];
        let faults = faults(&workspace(&[], &[]), &levels);
        assert_eq!(faults.len(), 2);
        assert!(faults[0].contains("`light` has a level"));
        assert!(faults[1].contains("`bsdf` has no level"));
    }
}
