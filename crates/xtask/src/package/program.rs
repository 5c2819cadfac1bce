//! The program, stripped, and its debug information beside it.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::glibc::{self, Linked};
use super::release::Release;
use crate::process::{cargo_home, succeed};
use crate::tool::Tool;

/// The tools for stripping.
pub const TOOLS: &[Tool] = &[Tool {
    program: "objcopy",
    install: "apt install binutils",
}];

/// A built program.
pub struct Program {
    /// The program without debug information.
    pub program: PathBuf,
    /// Its debug information, to which it refers.
    pub debug_info: PathBuf,
}

/// Builds Pliant and puts it with its debug information into `folder`.
///
/// # Errors
/// One sentence naming the command that failed.
pub fn build(release: &Release, folder: &Path) -> Result<Program, String> {
    let with_all = compile(&[])?;
    let built = Program {
        program: folder.join("pliant"),
        debug_info: folder.join(format!("{}.debug", release.name())),
    };
    let objcopy = || Command::new("objcopy");
    succeed(
        objcopy()
            .args(["--only-keep-debug", "--compress-debug-sections=zlib"])
            .args([&with_all, &built.debug_info]),
    )?;
    let link = format!("--add-gnu-debuglink={}", built.debug_info.display());
    let strip = ["--strip-all", "--remove-section=.comment", &link];
    succeed(objcopy().args(strip).args([&with_all, &built.program]))?;
    Ok(built)
}

/// Compiles the program with more arguments for its linker, and returns its path.
///
/// # Errors
/// One sentence if it can't be compiled.
pub fn compile(link_arguments: &[String]) -> Result<PathBuf, String> {
    println!("Building Pliant for its packages; the first time takes some minutes.");
    let Linked {
        command: mut rustc,
        folder,
    } = glibc::rustc()?;
    rustc.args([
        "--locked",
        "--profile",
        "dist",
        "--package",
        "pliant-app",
        "--bin",
        "pliant",
        "--",
    ]);
    rustc.args(
        link_arguments
            .iter()
            .flat_map(|argument| ["-C".to_owned(), format!("link-arg={argument}")]),
    );
    succeed(rustc.env("RUSTFLAGS", neutral_paths()))?;
    let name = format!("pliant{}", std::env::consts::EXE_SUFFIX);
    Ok(folder.join(name))
}

/// Compiler flags that keep this machine's folders out of the program.
pub fn neutral_paths() -> String {
    let given = std::env::var("RUSTFLAGS").unwrap_or_default();
    let neutral = |folder: &Path, name: &str| format!("--remap-path-prefix={}={name}", folder.display());
    let flags = [
        given,
        neutral(&cargo_home(), "/cargo"),
        neutral(&crate::root::root(), "/pliant"),
    ];
    flags.join(" ").trim().to_owned()
}
