//! The one front door: sets up what a task needs, then runs it.
//!
//! `cargo xtask --help` lists the tasks. What a task needs is installed by the task:
//! system tools by [`tools`], Python packages and the wheel by [`python`].
//! It does not build anything itself; cargo, maturin and the tools do.

mod bench;
mod codegen;
mod demo;
mod deps;
mod process;
mod python;
mod stamp;
mod steps;
mod test;
mod test_binaries;
mod tools;
mod validate;

use process::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// A task of the command line.
struct Task {
    name: &'static str,
    arguments: &'static str,
    about: &'static str,
    run: fn(&[String]) -> Result<(), Error>,
}

const TASKS: [Task; 6] = [
    Task { name: "demo", arguments: "[ARGS]", about: "render the demo scene and its page", run: demo::run_demo },
    Task { name: "test", arguments: "[STEP...]", about: "run all checks, or the steps named", run: test::run_steps },
    Task {
        name: "bench",
        arguments: "[--quick]",
        about: "measure Lesk and its peers side by side",
        run: bench::run_bench,
    },
    Task {
        name: "validate",
        arguments: "[ARGS]",
        about: "compare renders with Mitsuba 3, run every check in full",
        run: validate::run_validate,
    },
    Task { name: "deps", arguments: "", about: "check who imports whom", run: deps::run },
    Task {
        name: "codegen",
        arguments: "[--check]",
        about: "write the files that are derived from the registry, or compare them",
        run: codegen::run,
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn dispatch(arguments: &[String]) -> Result<(), Error> {
    let Some((name, rest)) = arguments.split_first() else {
        print!("{}", help());
        return Ok(());
    };
    if matches!(name.as_str(), "--help" | "-h" | "help") {
        print!("{}", help());
        return Ok(());
    }
    match TASKS.iter().find(|task| task.name == name) {
        Some(task) => (task.run)(rest),
        None => Err(Error::usage(format!("no task `{name}`"), "`cargo xtask --help` lists the tasks")),
    }
}

fn help() -> String {
    let mut text = String::from("usage: cargo xtask TASK\n\n");
    for task in &TASKS {
        text += &format!("  {:<20} {}\n", format!("{} {}", task.name, task.arguments), task.about);
    }
    text += &format!("\nsteps of test: {}\n", test::step_names().join(" "));
    text
}

/// The root of the project.
fn root() -> PathBuf {
    let manifest = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().expect("xtask lies in the root").to_path_buf()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_names_every_task() {
        assert!(TASKS.iter().all(|task| help().contains(task.about)));
    }

    #[test]
    fn an_unknown_task_is_a_usage_error() {
        let error = dispatch(&["tset".to_string()]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
    }
}
