//! `cargo xtask test`: every check of the project, in the order in which a mistake shows cheapest.

use crate::process::{Error, cargo, run};
use crate::python::MAIN;
use crate::steps::{Area, Step};
use crate::{codegen, deps, steps, test_binaries, tools};

const STEPS: [Step; 17] = [
    Step { name: "tools", area: Area::Build, run: || tools::ensure(tools::Use::Main) },
    Step { name: "fmt", area: Area::Rust, run: format },
    Step { name: "deps", area: Area::Rust, run: || deps::run(&[]) },
    Step { name: "build", area: Area::Build, run: test_binaries::build },
    Step { name: "rust", area: Area::Rust, run: || test_binaries::run_area(Area::Rust) },
    Step { name: "models", area: Area::Models, run: || test_binaries::run_area(Area::Models) },
    Step { name: "shaders", area: Area::Shaders, run: || test_binaries::run_area(Area::Shaders) },
    Step { name: "doctest", area: Area::Rust, run: doctest },
    Step { name: "clippy", area: Area::Rust, run: clippy },
    Step { name: "mono", area: Area::Rust, run: mono },
    Step { name: "rustdoc", area: Area::Docs, run: rustdoc },
    Step { name: "wheel", area: Area::Build, run: || MAIN.install_wheel() },
    Step { name: "codegen", area: Area::Python, run: || codegen::run(&["--check".to_string()]) },
    Step { name: "ruff", area: Area::Python, run: ruff },
    Step { name: "mypy", area: Area::Python, run: mypy },
    Step { name: "pytest", area: Area::Python, run: pytest },
    Step { name: "docs", area: Area::Docs, run: docs },
];

/// Runs all steps, or those that are named.
pub fn run_steps(names: &[String]) -> Result<(), Error> {
    if let Some(unknown) = names.iter().find(|name| !step_names().contains(&name.as_str())) {
        let hint = format!("the steps are {}", step_names().join(", "));
        return Err(Error::usage(format!("no step `{unknown}`"), hint));
    }
    let chosen: Vec<&Step> =
        STEPS.iter().filter(|step| names.is_empty() || names.iter().any(|name| name == step.name)).collect();
    steps::run(&chosen)
}

/// The names of the steps, in order.
pub fn step_names() -> Vec<&'static str> {
    STEPS.iter().map(|step| step.name).collect()
}

fn format() -> Result<(), Error> {
    run(cargo().args(["fmt", "--all", "--check"]))
}

fn doctest() -> Result<(), Error> {
    run(cargo().args(["test", "--workspace", "--release", "--locked", "--doc"]))
}

fn clippy() -> Result<(), Error> {
    let arguments = ["clippy", "--workspace", "--all-targets", "--release", "--locked"];
    run(cargo().args(arguments).args(["--", "-D", "warnings"]))
}

/// The models with one colour channel instead of three.
fn mono() -> Result<(), Error> {
    run(cargo().args(["check", "--release", "--locked", "-p", "lesk-bsdf", "--features", "mono"]))
}

fn rustdoc() -> Result<(), Error> {
    let arguments = ["doc", "--workspace", "--no-deps", "--release", "--locked"];
    run(cargo().args(arguments).env("RUSTDOCFLAGS", "-D warnings"))
}

fn ruff() -> Result<(), Error> {
    MAIN.install()?;
    run(MAIN.program("ruff").args(["check"]))?;
    run(MAIN.program("ruff").args(["format", "--check"]))
}

fn mypy() -> Result<(), Error> {
    MAIN.install()?;
    run(&mut MAIN.program("mypy"))
}

fn pytest() -> Result<(), Error> {
    MAIN.install_wheel()?;
    run(MAIN.python().args(["-m", "pytest"]))
}

fn docs() -> Result<(), Error> {
    MAIN.install_wheel()?;
    run(MAIN.python().args(["-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "docs", "site"]))
}
