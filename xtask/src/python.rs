//! The virtual environments and the wheel in them.

use crate::process::{self, Error, at, capture, command, run};
use crate::stamp::Stamp;
use crate::{root, tools};
use std::path::PathBuf;
use std::process::Command;

/// A virtual environment in the root of the project.
pub struct Environment {
    folder: &'static str,
    tools: tools::Use,
    /// The extras of `pyproject.toml` that it holds, besides what the package itself needs.
    extras: &'static [&'static str],
    /// An extra that does not exist for every machine, and what is skipped without it.
    optional: Option<(&'static str, &'static str)>,
}

/// What the demo and the tests use.
pub const MAIN: Environment =
    Environment { folder: ".venv", tools: tools::Use::Main, extras: &["dev", "docs"], optional: None };

/// What the comparisons with other renderers use.
pub const BENCH: Environment = Environment {
    folder: ".venv-bench",
    tools: tools::Use::Bench,
    extras: &["bench"],
    optional: Some(("cycles", "comparing with Cycles")),
};

/// Prints the requirements of the package (not with `--only`) and of the extras named, one per line.
const REQUIREMENTS: &str = "
import sys, tomllib
with open('pyproject.toml', 'rb') as file:
    project = tomllib.load(file)['project']
optional = project['optional-dependencies']
own = [] if '--only' in sys.argv else project['dependencies']
print(*own, *(r for extra in sys.argv[1:] if extra in optional for r in optional[extra]), sep='\\n')
";

/// What the wheel is made from.
const SOURCES: [&str; 6] = ["pyproject.toml", "Cargo.toml", "Cargo.lock", "crates", "data", "python/lesk"];

impl Environment {
    /// Creates the environment where it is missing, and installs what `pyproject.toml` asks for.
    pub fn install(&self) -> Result<(), Error> {
        tools::ensure(self.tools)?;
        let system = system_python()?;
        let version = capture(command(&system).arg("--version"))?;
        let requirements = capture(command(&system).args(["-c", REQUIREMENTS]).args(self.extras))?;
        let stamp = Stamp::new(self.path().join("installed"), &[], &[&version, &requirements])?;
        if stamp.is_fresh() && process::succeeds(self.python().arg("--version")) {
            return Ok(());
        }
        println!("installing Python packages in {}", self.folder);
        run(command(&system).args(["-m", "venv", "--clear"]).arg(self.path()))?;
        run(self.pip().arg("install").args(requirements.lines()))?;
        self.install_optional()?;
        stamp.set()
    }

    fn install_optional(&self) -> Result<(), Error> {
        let Some((extra, purpose)) = self.optional else { return Ok(()) };
        let requirements = capture(self.python().args(["-c", REQUIREMENTS, "--only", extra]))?;
        if run(self.pip().arg("install").args(requirements.lines())).is_err() {
            eprintln!("skipped: {purpose} ({} cannot be installed here)", requirements.trim());
        }
        Ok(())
    }

    /// Builds the wheel and installs it; nothing happens when no source has changed.
    pub fn install_wheel(&self) -> Result<(), Error> {
        self.install()?;
        let stamp = Stamp::new(self.path().join("wheel"), &SOURCES.map(|source| root().join(source)), &[])?;
        if stamp.is_fresh() && process::succeeds(self.python().args(["-c", "import lesk"])) {
            return Ok(());
        }
        let wheel = build_wheel()?;
        run(self.pip().args(["install", "--force-reinstall", "--no-deps"]).arg(wheel))?;
        stamp.set()
    }

    /// The Python of the environment, with its programs first on the path.
    pub fn python(&self) -> Command {
        self.program("python")
    }

    /// A program that the environment holds.
    pub fn program(&self, name: &str) -> Command {
        let programs = self.path().join(PROGRAMS);
        let mut command = command(programs.join(format!("{name}{}", std::env::consts::EXE_SUFFIX)));
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders = std::iter::once(programs).chain(std::env::split_paths(&path));
        let joined = std::env::join_paths(folders).expect("the folders come from a path");
        command.env("PATH", joined).env("VIRTUAL_ENV", self.path()).env_remove("PYTHONHOME");
        command
    }

    fn pip(&self) -> Command {
        let mut pip = self.python();
        pip.args(["-m", "pip", "--disable-pip-version-check", "--quiet"]);
        pip
    }

    fn path(&self) -> PathBuf {
        root().join(self.folder)
    }
}

const PROGRAMS: &str = if cfg!(windows) { "Scripts" } else { "bin" };

/// Builds the wheel with the profile that `pyproject.toml` names, in cargo's own target folder, and gives its path.
fn build_wheel() -> Result<PathBuf, Error> {
    let folder = wheel_folder();
    if folder.exists() {
        at(&folder, std::fs::remove_dir_all(&folder))?;
    }
    MAIN.install()?;
    run(MAIN.program("maturin").args(["build", "--locked", "--out"]).arg(&folder))?;
    let entries = at(&folder, std::fs::read_dir(&folder))?;
    entries
        .filter_map(Result::ok)
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|extension| extension == "whl"))
        .ok_or_else(|| Error::Check { what: format!("maturin left no wheel in {}", folder.display()) })
}

fn wheel_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    root().join(target.unwrap_or_else(|| "target".into())).join("wheels-xtask")
}

/// A Python of at least 3.11 on the path.
pub fn system_python() -> Result<PathBuf, Error> {
    let names = ["python3", "python3.14", "python3.13", "python3.12", "python3.11", "python"];
    let recent = "import sys; sys.exit(sys.version_info < (3, 11))";
    names.iter().find(|name| process::succeeds(command(name).args(["-c", recent]))).map(PathBuf::from).ok_or_else(
        || Error::Missing {
            what: "no Python of at least 3.11 is on the path".to_string(),
            hint: "on Debian 12 and later `apt-get install python3 python3-venv` brings one".to_string(),
        },
    )
}
