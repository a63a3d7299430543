//! The system tools: the one list, and how they come to a machine.

use crate::process::{self, Error};
use crate::python;
use std::path::Path;

/// How to see whether a tool is there.
enum Probe {
    /// A program on the path.
    Program(&'static str),
    /// A file below one of the library folders.
    Library(&'static str),
    /// A module of the standard library that Debian packs apart.
    PythonModule(&'static str),
}

/// Which tasks use a tool.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// The demo and the tests.
    Main,
    /// The comparisons with other renderers.
    Bench,
}

/// A system tool.
struct Tool {
    used_by: Use,
    probe: Probe,
    /// Package of Debian that brings it.
    package: &'static str,
    /// What cannot be done without it.
    purpose: &'static str,
}

/// Every system tool that a task uses, besides Rust and Python.
const TOOLS: [Tool; 14] = [
    main(Probe::PythonModule("ensurepip"), "python3-venv", "the virtual environment"),
    main(Probe::Program("glslangValidator"), "glslang-tools", "validating GLSL, GLSL ES and HLSL"),
    main(Probe::Program("spirv-val"), "spirv-tools", "validating and counting SPIR-V"),
    main(Probe::Library("libEGL.so.1"), "libegl1", "running GLSL"),
    main(Probe::Library("libGL.so.1"), "libgl1", "running GLSL"),
    main(Probe::Library("libEGL_mesa.so.0"), "libegl-mesa0", "running GLSL without a graphics card"),
    main(Probe::Library("dri/swrast_dri.so"), "libgl1-mesa-dri", "running GLSL without a graphics card"),
    bench(Probe::Program("g++"), "g++", "comparing with Embree"),
    bench(Probe::Library("libembree3.so"), "libembree-dev", "comparing with Embree"),
    // Mitsuba refuses LLVM 14, and aborts on environment maps with 15
    bench(Probe::Library("libLLVM.so.19.1"), "libllvm19", "comparing with Mitsuba's vectorised variant"),
    bench(Probe::Library("libXrender.so.1"), "libxrender1", "comparing with Cycles"),
    bench(Probe::Library("libXi.so.6"), "libxi6", "comparing with Cycles"),
    bench(Probe::Library("libSM.so.6"), "libsm6", "comparing with Cycles"),
    bench(Probe::Library("libxkbcommon.so.0"), "libxkbcommon0", "comparing with Cycles"),
];

const fn main(probe: Probe, package: &'static str, purpose: &'static str) -> Tool {
    Tool { used_by: Use::Main, probe, package, purpose }
}

const fn bench(probe: Probe, package: &'static str, purpose: &'static str) -> Tool {
    Tool { used_by: Use::Bench, probe, package, purpose }
}

const LIBRARY_FOLDERS: [&str; 7] = [
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib64",
    "/usr/lib",
    "/usr/local/lib",
    "/opt/homebrew/lib",
    "/lib",
];

/// Sees to it that the system tools of the demo and the tests are there, and those of `used_by`.
///
/// As root on Debian the missing ones are installed. Elsewhere the command is printed, and one line for each
/// thing that cannot be done without them; with `CI` set a missing tool is an error.
pub fn ensure(used_by: Use) -> Result<(), Error> {
    let used = |tool: &&Tool| tool.used_by == Use::Main || tool.used_by == used_by;
    let mut missing: Vec<&Tool> = TOOLS.iter().filter(used).filter(|tool| !tool.is_there()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    if can_install() {
        install(&missing)?;
        missing.retain(|tool| !tool.is_there());
    }
    for tool in &missing {
        eprintln!("skipped: {} (`{}` is missing)", tool.purpose, tool.name());
    }
    match (missing.is_empty(), in_ci()) {
        (true, _) => Ok(()),
        (false, true) => Err(Error::Missing {
            what: format!("system tools are missing: {}", packages(&missing)),
            hint: format!("sudo {}", install_line(&missing)),
        }),
        (false, false) => {
            eprintln!("hint: on Debian `sudo {}` installs what is missing", install_line(&missing));
            Ok(())
        }
    }
}

/// Whether nobody watches, so that a missing part must fail: `CI` is set to something but `0` or `false`.
pub fn in_ci() -> bool {
    std::env::var("CI").is_ok_and(|value| !matches!(value.as_str(), "" | "0" | "false"))
}

impl Tool {
    fn is_there(&self) -> bool {
        match self.probe {
            Probe::Program(name) => on_path(name),
            Probe::Library(name) => {
                !cfg!(target_os = "linux") || LIBRARY_FOLDERS.iter().any(|folder| Path::new(folder).join(name).exists())
            }
            Probe::PythonModule(name) => python::system_python().is_ok_and(|python| {
                process::succeeds(process::command(python).args(["-c", &format!("import {name}")]))
            }),
        }
    }

    fn name(&self) -> &'static str {
        match self.probe {
            Probe::Program(name) | Probe::Library(name) | Probe::PythonModule(name) => name,
        }
    }
}

fn on_path(program: &str) -> bool {
    let file = format!("{program}{}", std::env::consts::EXE_SUFFIX);
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(&file).is_file())
}

/// Whether this is Debian or a child of it, and we are root.
fn can_install() -> bool {
    let release = std::fs::read_to_string("/etc/os-release").unwrap_or_default();
    is_debian(&release) && on_path("apt-get") && is_root()
}

fn is_debian(os_release: &str) -> bool {
    os_release
        .lines()
        .filter_map(|line| line.strip_prefix("ID=").or_else(|| line.strip_prefix("ID_LIKE=")))
        .any(|names| names.trim_matches('"').split(' ').any(|name| name == "debian"))
}

fn is_root() -> bool {
    process::capture(process::command("id").arg("-u")).is_ok_and(|id| id.trim() == "0")
}

fn install(missing: &[&Tool]) -> Result<(), Error> {
    println!("installing {}", packages(missing));
    let apt = |arguments: &[&str]| {
        process::capture(process::command("apt-get").args(arguments).env("DEBIAN_FRONTEND", "noninteractive"))
    };
    // an old list names packages that are gone; a repository that cannot be reached need not be the one we use
    if let Err(error) = apt(&["update"]) {
        eprintln!("warning: {error}");
    }
    let mut arguments = vec!["install", "--yes", "--no-install-recommends"];
    arguments.extend(missing.iter().map(|tool| tool.package));
    apt(&arguments).map(|_| ())
}

fn packages(tools: &[&Tool]) -> String {
    tools.iter().map(|tool| tool.package).collect::<Vec<_>>().join(" ")
}

fn install_line(tools: &[&Tool]) -> String {
    format!("apt-get install --no-install-recommends {}", packages(tools))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debian_and_its_children_are_recognised() {
        assert!(is_debian("NAME=\"Debian GNU/Linux\"\nID=debian\n"));
        assert!(is_debian("ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n"));
        assert!(!is_debian("ID=fedora\nID_LIKE=\"rhel\"\nNAME=debian\n"));
    }

    #[test]
    fn no_tool_is_listed_twice() {
        let mut names: Vec<_> = TOOLS.iter().map(Tool::name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), TOOLS.len());
    }

    #[test]
    fn the_install_line_names_the_packages_that_are_missing() {
        let missing: Vec<&Tool> = TOOLS.iter().filter(|tool| tool.package.ends_with("-tools")).collect();
        assert_eq!(install_line(&missing), "apt-get install --no-install-recommends glslang-tools spirv-tools");
    }
}
