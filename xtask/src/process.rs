//! Running commands, and the one error type.

use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Why a task stopped.
#[derive(Debug)]
pub enum Error {
    /// A command ended with something else than success.
    Failed { command: String, status: String },
    /// A command could not be started.
    NotStarted { command: String, reason: String },
    /// A file could not be read or written.
    File { path: PathBuf, reason: String },
    /// A check came out false.
    Check { what: String },
    /// Something that a task needs is not there.
    Missing { what: String, hint: String },
    /// The command line asks for something that does not exist.
    Usage { what: String, hint: String },
}

impl Error {
    /// A command line that asks for something that does not exist.
    pub fn usage(what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Usage { what: what.into(), hint: hint.into() }
    }

    /// 1 for a check that came out false, 2 for everything that kept it from running.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Failed { .. } | Self::Check { .. } => 1,
            _ => 2,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Failed { command, status } => write!(f, "`{command}` failed: {status}"),
            Self::NotStarted { command, reason } => write!(f, "`{command}` did not start: {reason}"),
            Self::File { path, reason } => write!(f, "{reason}: {}", path.display()),
            Self::Check { what } => write!(f, "{what}"),
            Self::Missing { what, hint } | Self::Usage { what, hint } => write!(f, "{what}\nhint: {hint}"),
        }
    }
}

/// Adds the path to what the file system said.
pub fn at<T>(path: &Path, result: std::io::Result<T>) -> Result<T, Error> {
    result.map_err(|error| Error::File { path: path.to_path_buf(), reason: error.to_string() })
}

/// A command that runs in the root of the project.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(crate::root());
    command
}

/// The cargo that runs this program.
pub fn cargo() -> Command {
    command(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Runs a command to its end, its output going where ours goes.
pub fn run(command: &mut Command) -> Result<(), Error> {
    let status = command.status().map_err(|error| not_started(command, &error))?;
    check(command, status)
}

/// Runs a command to its end and gives its standard output; its errors go where ours go.
pub fn capture(command: &mut Command) -> Result<String, Error> {
    let output = command.stderr(Stdio::inherit()).output().map_err(|error| not_started(command, &error))?;
    let Output { status, stdout, .. } = output;
    check(command, status)?;
    Ok(String::from_utf8_lossy(&stdout).into_owned())
}

/// Whether a command can be run and ends with success; it prints nothing.
pub fn succeeds(command: &mut Command) -> bool {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

fn check(command: &Command, status: std::process::ExitStatus) -> Result<(), Error> {
    if status.success() {
        return Ok(());
    }
    Err(Error::Failed { command: line(command), status: status.to_string() })
}

fn not_started(command: &Command, error: &std::io::Error) -> Error {
    Error::NotStarted { command: line(command), reason: error.to_string() }
}

/// The command as one would type it, cut where it is long.
pub fn line(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let line = words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
    if line.chars().count() <= 160 {
        return line;
    }
    line.chars().take(157).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_command_names_itself_and_its_status() {
        let error = run(cargo().arg("no-such-command").stderr(Stdio::null())).unwrap_err();
        assert!(error.to_string().contains("no-such-command` failed: exit status: 101"), "{error}");
        assert_eq!(error.exit_code(), 1);
    }

    #[test]
    fn a_program_that_does_not_exist_is_reported() {
        let error = run(&mut command("lesk-no-such-program")).unwrap_err();
        assert!(error.to_string().starts_with("`lesk-no-such-program` did not start"), "{error}");
        assert_eq!(error.exit_code(), 2);
    }
}
