//! `cargo xtask codegen`: files that are derived from the registry and kept in the repository.

use crate::process::{Error, run as run_command};
use crate::python::MAIN;

/// Writes the files of `python/stubs.py`; with `--check`, compares them instead.
pub fn run(arguments: &[String]) -> Result<(), Error> {
    let check = match arguments {
        [] => false,
        [flag] if flag == "--check" => true,
        _ => return Err(Error::usage("`codegen` takes `--check` only", "cargo xtask codegen")),
    };
    MAIN.install_wheel()?;
    // -P: the folder of the script holds the package's sources, which lack the compiled part
    run_command(MAIN.python().args(["-P", "python/stubs.py", if check { "--check" } else { "--write" }]))
}
