//! `cargo xtask python`: the Python package as a wheel and the Blender add-on around it, and the tests of both, each in
//! an environment of its own.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::process::{build_program, said, succeed, target_folder};
use crate::tool::Tool;
use crate::{files, root};

const PYTHON: Tool = Tool {
    program: "python3",
    install: "apt install python3 python3-venv",
};

/// What the add-on's tests run on; there is a build of it for one version of Python alone.
const BLENDER: &str = "bpy==4.2.0";
const BLENDER_PYTHON: Tool = Tool {
    program: "python3.11",
    install: "apt install python3.11-venv, or pyenv install 3.11",
};

/// Builds the wheel and the add-on into `target/python`, installs the wheel into a clean environment, and runs its tests
/// and the notebook there; then the add-on's in one with Blender.
///
/// # Errors
/// One sentence naming what is missing or what failed.
pub fn python() -> Result<(), String> {
    let python = PYTHON.find()?;
    let folder = target_folder().join("python");
    build_program()?;
    let wheel = wheel(&python, &folder)?;
    println!("made: {}", wheel.display());
    let extension = extension(&python, &wheel, &folder)?;
    println!("made: {}", extension.display());

    let clean = folder.join("clean");
    files::remove_folder(&clean)?;
    let clean = environment(&python, &clean)?;
    let with_tests = format!("{}[test]", wheel.display());
    install(&clean, &[&with_tests])?;
    tests(&clean, "crates/python/tests", &extension)?;

    let Ok(python) = BLENDER_PYTHON.find() else {
        println!(
            "skipped: the add-on's tests ({} is not installed: {})",
            BLENDER_PYTHON.program, BLENDER_PYTHON.install
        );
        return Ok(());
    };
    let blender = environment(&python, &folder.join("blender"))?;
    install(&blender, &["pytest", BLENDER])?;
    // It is as new as the other, whatever its version says.
    install(
        &blender,
        &["--force-reinstall", "--no-deps", &wheel.display().to_string()],
    )?;
    tests(&blender, "blender/tests", &extension)
}

/// The wheel, built by maturin.
fn wheel(python: &Path, folder: &Path) -> Result<PathBuf, String> {
    let tools = environment(python, &folder.join("tools"))?;
    install(&tools, &["maturin>=1.9.4,<2"])?;
    let wheels = folder.join("wheels");
    files::fresh_folder(&wheels)?;
    let mut maturin = Command::new(&tools);
    maturin.args(["-m", "maturin", "build", "--release", "--locked"]);
    maturin.args(["--manifest-path", "crates/python/Cargo.toml", "--out"]);
    succeed(maturin.arg(&wheels).current_dir(root()))?;
    let made = files::all_files(&wheels)?;
    let made = made
        .into_iter()
        .find(|file| file.extension().is_some_and(|extension| extension == "whl"));
    made.map(|file| wheels.join(file))
        .ok_or_else(|| format!("maturin left no wheel in {}.", wheels.display()))
}

/// The add-on with the wheel in it, as Blender installs it.
fn extension(python: &Path, wheel: &Path, folder: &Path) -> Result<PathBuf, String> {
    let made = said(
        Command::new(python)
            .arg(root().join("blender/pack.py"))
            .arg(wheel)
            .arg(folder),
    )?;
    Ok(PathBuf::from(made.trim()))
}

/// The Python of a virtual environment, which is made if it is not there.
fn environment(python: &Path, folder: &Path) -> Result<PathBuf, String> {
    let own = match cfg!(windows) {
        true => folder.join("Scripts/python.exe"),
        false => folder.join("bin/python"),
    };
    if !own.is_file() {
        succeed(Command::new(python).args(["-m", "venv"]).arg(folder))?;
    }
    Ok(own)
}

fn install(python: &Path, packages: &[&str]) -> Result<(), String> {
    let mut pip = Command::new(python);
    pip.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--upgrade",
    ]);
    succeed(pip.args(packages))
}

fn tests(python: &Path, folder: &str, extension: &Path) -> Result<(), String> {
    let mut pytest = Command::new(python);
    pytest.args(["-m", "pytest", "--quiet", folder]).current_dir(root());
    succeed(pytest.env("PLIANT_EXTENSION", extension))
}
