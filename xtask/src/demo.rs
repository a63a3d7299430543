//! `cargo xtask demo`: the demo scene and its page, from nothing.

use crate::process::{Error, run};
use crate::python::MAIN;
use crate::root;

/// Where the demo is written, unless the arguments say something else.
const OUTPUT: &str = "out/demo";

/// Sets everything up and runs `lesk demo` with the arguments given.
pub fn run_demo(arguments: &[String]) -> Result<(), Error> {
    MAIN.install_wheel()?;
    let mut lesk = MAIN.program("lesk");
    lesk.arg("demo").args(arguments);
    if names_output(arguments) {
        return run(&mut lesk);
    }
    run(lesk.args(["--output", OUTPUT]))?;
    let page = root().join(OUTPUT).join("index.html");
    if !page.is_file() {
        return Err(Error::Check { what: format!("`lesk demo` left no page {}", page.display()) });
    }
    println!("page: {}", page.display());
    Ok(())
}

/// Whether the arguments choose a folder themselves, or only ask for help.
fn names_output(arguments: &[String]) -> bool {
    let own =
        |argument: &str| matches!(argument, "-o" | "--output" | "--help" | "-h") || argument.starts_with("--output=");
    arguments.iter().any(|argument| own(argument))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_of_ones_own_is_recognised() {
        let names = |argument: &str| names_output(&[argument.to_string()]);
        assert!(names("-o") && names("--output") && names("--output=x"));
        assert!(!names("--quiet"));
    }
}
