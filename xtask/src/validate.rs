//! `cargo xtask validate`: renders against Mitsuba 3 and closed forms, and every claim in full.

use crate::process::{Error, run};
use crate::python::BENCH;

/// Runs `lesk check --full`, then `bench/validate.py` with the arguments given.
pub fn run_validate(arguments: &[String]) -> Result<(), Error> {
    BENCH.install_wheel()?;
    run(BENCH.program("lesk").args(["check", "--full"]))?;
    run(BENCH.python().arg("bench/validate.py").args(arguments))
}
