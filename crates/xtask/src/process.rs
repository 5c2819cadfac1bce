//! Running other programs.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The first program with this name in `PATH` or the `sbin` folders.
pub fn program(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path)
        .chain(["/usr/sbin", "/sbin"].map(PathBuf::from))
        .map(|folder| folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX)))
        .find(|file| file.is_file())
}

/// The output of a program; `None` if it can't be started or fails.
pub fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let program = self::program(program)?;
    let output = Command::new(program)
        .args(arguments)
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A cargo command in the workspace's folder, with the cargo that started this program.
pub fn cargo(arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(arguments).current_dir(crate::root::root());
    if std::env::var_os("CI").is_some() {
        // Incremental compilation only costs time and disk on a machine that builds once.
        command.env("CARGO_INCREMENTAL", "0");
        // Half of each test program is debug information, and there are a hundred programs: 15 GB of disk otherwise.
        command.env("CARGO_PROFILE_DEV_DEBUG", "false");
        // The least work in sum: `pliant-deform` takes 146 s of processor time with one unit and 193 s with sixteen.
        command.env("CARGO_PROFILE_DEV_CODEGEN_UNITS", "1");
    }
    command
}

/// The folder of cargo's downloads.
pub fn cargo_home() -> PathBuf {
    std::env::var_os("CARGO_HOME").map_or_else(
        || std::env::home_dir().unwrap_or_default().join(".cargo"),
        PathBuf::from,
    )
}

/// Cargo's target folder.
pub fn target_folder() -> PathBuf {
    let root = crate::root::root();
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |folder| root.join(folder))
}

/// Runs a command and waits for it.
///
/// # Errors
/// One sentence with the command line, if it can't be started or fails.
pub fn succeed(command: &mut Command) -> Result<(), String> {
    let words = words(command);
    let status = command
        .status()
        .map_err(|e| format!("`{words}` can't be started: {e}."))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("`{words}` failed ({status})."))
    }
}

/// The output of a command.
///
/// # Errors
/// One sentence with the command line, if it can't be started or fails.
pub fn said(command: &mut Command) -> Result<String, String> {
    let words = words(command);
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.map_err(|e| format!("`{words}` can't be started: {e}."))?;
    match output.status.success() {
        true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        false => Err(format!("`{words}` failed ({}).", output.status)),
    }
}

/// The command line.
pub fn words(command: &Command) -> String {
    let name = std::path::Path::new(command.get_program())
        .file_name()
        .unwrap_or_default()
        .to_string_lossy();
    let arguments = command.get_args().map(OsStr::to_string_lossy);
    std::iter::once(name).chain(arguments).collect::<Vec<_>>().join(" ")
}
