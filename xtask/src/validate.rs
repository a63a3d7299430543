//! `cargo xtask validate`: renders against Mitsuba 3, readings against closed forms and Radiance, every claim in full.

use crate::process::{Error, run};
use crate::python::BENCH;

/// Runs `lesk check --full`, `lesk validate lights` and the comparison with Radiance, then `bench/validate.py` with the arguments given.
pub fn run_validate(arguments: &[String]) -> Result<(), Error> {
    BENCH.install_wheel()?;
    run(BENCH.program("lesk").args(["check", "--full"]))?;
    run(BENCH.program("lesk").args(["validate", "lights"]))?;
    run(BENCH.python().arg("bench/radiance_office.py"))?;
    run(BENCH.python().arg("bench/validate.py").args(arguments))
}
