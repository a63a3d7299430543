//! `cargo xtask bench`: Lesk and its peers, side by side in one run.

use crate::process::{Error, run};
use crate::python::BENCH;

/// Sets up an environment with the peers and runs `bench/run.py` with the arguments given.
pub fn run_bench(arguments: &[String]) -> Result<(), Error> {
    BENCH.install_wheel()?;
    run(BENCH.python().arg("bench/run.py").args(arguments))
}
