//! `cargo xtask codegen`: files that are derived from the registry and kept in the repository.

use crate::process::{Error, at, capture};
use crate::python::MAIN;
use crate::root;

/// A file and the program of the environment that prints its content.
struct Generated {
    path: &'static str,
    program: &'static str,
    arguments: &'static [&'static str],
}

// -P: the folder of the script holds the package's sources, which lack the compiled part
const GENERATED: [Generated; 1] =
    [Generated { path: "python/lesk/models.pyi", program: "python", arguments: &["-P", "python/stubs.py"] }];

/// Writes the files; with `--check`, compares them instead.
pub fn run(arguments: &[String]) -> Result<(), Error> {
    let check = match arguments {
        [] => false,
        [flag] if flag == "--check" => true,
        _ => return Err(Error::usage("`codegen` takes `--check` only", "cargo xtask codegen")),
    };
    MAIN.install_wheel()?;
    GENERATED.iter().try_for_each(|file| if check { file.compare() } else { file.write() })
}

impl Generated {
    fn content(&self) -> Result<String, Error> {
        capture(MAIN.program(self.program).args(self.arguments))
    }

    fn write(&self) -> Result<(), Error> {
        let path = root().join(self.path);
        at(&path, std::fs::write(&path, self.content()?))?;
        println!("wrote {}", self.path);
        Ok(())
    }

    fn compare(&self) -> Result<(), Error> {
        let path = root().join(self.path);
        if at(&path, std::fs::read_to_string(&path))? == self.content()? {
            println!("{} is up to date", self.path);
            return Ok(());
        }
        Err(Error::Check { what: format!("{} is out of date\nhint: `cargo xtask codegen` writes it", self.path) })
    }
}
