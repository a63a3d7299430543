//! The test programs of the workspace, run one area at a time.
//!
//! `cargo test --workspace` builds them all with one set of features; running them from here, instead of calling
//! cargo again for some packages, keeps that set and so compiles nothing twice.

use crate::process::{Error, capture, cargo, run};
use crate::steps::Area;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A program made by `cargo test`, and the folder of its package.
struct TestBinary {
    program: PathBuf,
    package: PathBuf,
}

/// Builds the tests, the examples and the programs of the workspace.
pub fn build() -> Result<(), Error> {
    list().map(|_| ())
}

/// Runs the unit and integration tests of the packages that belong to an area.
pub fn run_area(area: Area) -> Result<(), Error> {
    let binaries = list()?;
    let mut chosen = binaries.iter().filter(|binary| area_of(&binary.package) == area).peekable();
    if chosen.peek().is_none() {
        return Err(Error::Check { what: format!("no test program belongs to the area {area:?}") });
    }
    chosen.try_for_each(|binary| {
        println!("   {}", binary.program.display());
        let mut command = Command::new(&binary.program);
        // what cargo sets for a test that it runs
        command.current_dir(&binary.package).env("CARGO_MANIFEST_DIR", &binary.package);
        run(&mut command)
    })
}

/// Where the tests of a package are booked.
fn area_of(package: &Path) -> Area {
    match package.file_name().and_then(|name| name.to_str()) {
        Some("lesk-bsdf" | "lesk-check") => Area::Models,
        Some("lesk-shader") => Area::Shaders,
        _ => Area::Rust,
    }
}

fn list() -> Result<Vec<TestBinary>, Error> {
    let messages = capture(cargo().args([
        "test",
        "--workspace",
        "--release",
        "--locked",
        "--no-run",
        "--message-format=json-render-diagnostics",
    ]))?;
    let mut binaries: Vec<_> = messages.lines().filter_map(parse).collect();
    // cargo reports them as they are ready
    binaries.sort_by(|a, b| (&a.package, &a.program).cmp(&(&b.package, &b.program)));
    Ok(binaries)
}

/// The test program that a line of cargo's messages reports, if it reports one.
fn parse(message: &str) -> Option<TestBinary> {
    let message: Value = serde_json::from_str(message).ok()?;
    if message["profile"]["test"] != true {
        return None;
    }
    let package = Path::new(message["manifest_path"].as_str()?).parent()?;
    Some(TestBinary { program: message["executable"].as_str()?.into(), package: package.into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    // fields as in the Cargo book, "External tools", JSON messages: artifact messages
    #[test]
    fn only_test_programs_are_taken_from_the_messages() {
        let message = |test: bool, executable: &str| {
            format!(
                r#"{{"reason":"compiler-artifact","manifest_path":"/w/crates/lesk-math/Cargo.toml",
                "profile":{{"test":{test}}},"executable":{executable}}}"#
            )
        };
        let binary = parse(&message(true, r#""/t/lesk_math-1""#)).unwrap();
        assert_eq!(binary.program, Path::new("/t/lesk_math-1"));
        assert_eq!(binary.package, Path::new("/w/crates/lesk-math"));
        assert!(parse(&message(false, r#""/t/lesk""#)).is_none());
        assert!(parse(&message(true, "null")).is_none());
        assert!(parse("warning: not a message").is_none());
    }

    #[test]
    fn models_and_shaders_have_areas_of_their_own() {
        assert_eq!(area_of(Path::new("/w/crates/lesk-bsdf")), Area::Models);
        assert_eq!(area_of(Path::new("/w/crates/lesk-shader")), Area::Shaders);
        assert_eq!(area_of(Path::new("/w/crates/lesk-math")), Area::Rust);
    }
}
