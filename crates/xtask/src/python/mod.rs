//! `cargo xtask python`: the Python package as a wheel and the Blender add-on around it, and the tests of both, each in
//! a separate environment.

pub mod unpacked;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::files;
use crate::package::release::Release;
use crate::package::{glibc, inventory, program};
use crate::process::{said, succeed, target_folder};
use crate::root::root;
use crate::tool::Tool;

const PYTHON: Tool = Tool {
    program: "python3",
    install: "apt install python3 python3-venv",
};

const MANIFEST: &str = "crates/python/Cargo.toml";

/// The versions of Blender for the add-on's tests: the oldest, the one with long support and the newest. Each is built
/// for one version of Python alone. Blender 5 has left Macs with Intel's processors, and there is none for Linux on ARM.
const BLENDERS: &[&str] = match (
    cfg!(target_os = "linux"),
    cfg!(target_os = "macos"),
    cfg!(target_arch = "x86_64"),
) {
    (true, _, false) => &[],
    (_, true, true) => &["bpy==4.2.0", "bpy==4.5.15"],
    _ => &["bpy==4.2.0", "bpy==4.5.15", "bpy==5.0.1"],
};
const BLENDER_PYTHON: Tool = Tool {
    program: "python3.11",
    install: "apt install python3.11-venv, or pyenv install 3.11",
};

/// Builds the wheel and the add-on into `target/python`, installs the wheel into a clean environment, and runs its
/// tests and the notebook there; then runs the add-on's tests in one with Blender.
///
/// # Errors
/// One sentence naming the missing tool or the failure.
pub fn python() -> Result<(), String> {
    let python = PYTHON.find()?;
    let release = Release::read()?;
    let folder = target_folder().join("python");
    let program = program::compile(&[])?;
    let wheel = wheel(&release, &python, &folder)?;
    println!("made: {}", wheel.display());
    let extension = extension(&python, &wheel, &folder)?;
    println!("made: {}", extension.display());

    let clean = folder.join("clean");
    files::remove_folder(&clean)?;
    let clean = environment(&python, &clean)?;
    let with_tests = format!("{}[test]", wheel.display());
    install(&clean, &[&with_tests])?;
    tests(&clean, "crates/python/tests", &extension, &program)?;

    let python = match BLENDER_PYTHON.find() {
        Ok(python) => python,
        Err(sentence) if unpacked::are_required() => return Err(format!("The add-on can't be tested: {sentence}.")),
        Err(sentence) => {
            println!("skipped: the add-on's tests ({sentence})");
            return Ok(());
        }
    };
    for version in BLENDERS {
        let blender = environment(&python, &folder.join(version.replace("==", "-")))?;
        install(&blender, &["pytest", version])?;
        // The wheel is equally new, independent of its version.
        install(
            &blender,
            &["--force-reinstall", "--no-deps", &wheel.display().to_string()],
        )?;
        tests(&blender, "blender/tests", &extension, &program)?;
    }
    Ok(())
}

/// The wheel, built by maturin: from the commit and the tools alone, like packages, and with the same licences.
fn wheel(release: &Release, python: &Path, folder: &Path) -> Result<PathBuf, String> {
    let tools = environment(python, &folder.join("tools"))?;
    // Zig's linker makes a wheel for older systems than this one.
    let maturin = match cfg!(target_os = "linux") {
        true => "maturin[zig]==1.16.0",
        false => "maturin==1.16.0",
    };
    install(&tools, &[maturin])?;
    let wheels = folder.join("wheels");
    files::fresh_folder(&wheels)?;
    licences(&root().join("crates/python/licenses"))?;
    let bill = bill_of_materials(release, folder)?;
    let mut maturin = Command::new(&tools);
    maturin.args(["-m", "maturin", "build", "--profile", "dist", "--locked"]);
    if let Some(bill) = bill {
        maturin.arg("--sbom-include").arg(bill);
    }
    if cfg!(target_os = "linux") {
        let oldest = glibc::OLDEST.replace('.', "_");
        maturin.args(["--zig", "--compatibility", &format!("manylinux_{oldest}")]);
    }
    maturin.args(["--manifest-path", MANIFEST, "--out"]);
    maturin.arg(&wheels).current_dir(root());
    maturin.env("SOURCE_DATE_EPOCH", release.epoch.to_string());
    succeed(maturin.env("RUSTFLAGS", program::neutral_paths()))?;
    let made = files::all_files(&wheels)?;
    let made = made
        .into_iter()
        .find(|file| file.extension().is_some_and(|extension| extension == "whl"));
    made.map(|file| wheels.join(file))
        .ok_or_else(|| format!("maturin left no wheel in {}.", wheels.display()))
}

/// Puts the wheel's documents into a folder: our licences, and those of all its components.
fn licences(folder: &Path) -> Result<(), String> {
    files::fresh_folder(folder)?;
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        files::copy(&root().join(name), &folder.join(name))?;
    }
    match inventory::CARGO_ABOUT.find() {
        Ok(_) => files::write(
            &folder.join("licences-of-dependencies.txt"),
            inventory::licences(MANIFEST)?,
        ),
        Err(sentence) => {
            println!("left out of the wheel, so it is not to be passed on: the dependencies' licences ({sentence})");
            Ok(())
        }
    }
}

/// The wheel's components, in the packages' format: maturin's own list would name the folders of this machine and the
/// time.
fn bill_of_materials(release: &Release, folder: &Path) -> Result<Option<PathBuf>, String> {
    if let Err(sentence) = inventory::CARGO_CYCLONEDX.find() {
        println!("left out of the wheel: its bill of materials ({sentence})");
        return Ok(None);
    }
    let file = folder.join("pliant.cdx.json");
    let bill = inventory::bill_of_materials(release, "crates/python", "pliant_native_cdylib")?;
    files::write(&file, bill)?;
    Ok(Some(file))
}

/// The add-on with the wheel in it, in Blender's format.
fn extension(python: &Path, wheel: &Path, folder: &Path) -> Result<PathBuf, String> {
    let made = said(
        Command::new(python)
            .arg(root().join("blender/pack.py"))
            .arg(wheel)
            .arg(folder),
    )?;
    Ok(PathBuf::from(made.trim()))
}

/// The Python of a virtual environment, which is made if it does not exist.
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

/// Runs a folder's tests, which compare shapes with those of `program`.
fn tests(python: &Path, folder: &str, extension: &Path, program: &Path) -> Result<(), String> {
    let mut pytest = Command::new(python);
    pytest.args(["-m", "pytest", "--quiet", folder]).current_dir(root());
    succeed(pytest.env("PLIANT_EXTENSION", extension).env("PLIANT", program))
}
