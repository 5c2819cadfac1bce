//! The Python package from an ordinary build, without wheel, environment and network. If there is a suitable Python,
//! its tests are among all tests.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use crate::files;
use crate::process::{cargo, output, program, succeed, target_folder};
use crate::root::root;
use crate::verdict::Verdict;

/// If this variable is `required`, as in continuous integration, then skipped tests of the package, of the wheel and of
/// the add-on are failures.
const VARIABLE: &str = "PLIANT_PYTHON_TESTS";

/// Whether tests in Python must run.
pub fn are_required() -> bool {
    std::env::var_os(VARIABLE).is_some_and(|value| value == "required")
}

/// Builds the module in the development profile and runs the package's tests on it, except the notebook's, which
/// measure. If no Python has the needed packages, they are named as skipped.
pub fn tests(verdict: &mut Verdict) {
    let has_all = |name: &&str| output(name, &["-c", "import numpy, pytest"]).is_some();
    let Some(python) = ["python3", "python"].into_iter().find(has_all).and_then(program) else {
        let sentence = "Python's tests (there is no python3 with numpy and pytest: pip install numpy pytest, or cargo \
                        xtask python, which makes an environment of its own)";
        return match are_required() {
            true => verdict.record(
                "Python",
                Err(format!("{VARIABLE} requires {sentence}.")),
                Instant::now(),
            ),
            false => verdict.skip(sentence),
        };
    };
    println!("\n── Python: {} -m pytest crates/python/tests", python.display());
    let started = Instant::now();
    verdict.record("Python", run(&python), started);
}

fn run(python: &Path) -> Result<(), String> {
    // With the tests, because other features than theirs would build the dependencies a second time.
    succeed(&mut cargo(&[
        "build",
        "--locked",
        "--workspace",
        "--lib",
        "--bins",
        "--tests",
    ]))?;
    let built = target_folder().join("debug");
    let folder = lay_out(&built)?;
    let mut pytest = Command::new(python);
    pytest.args([
        "-m",
        "pytest",
        "--quiet",
        "-p",
        "no:cacheprovider",
        "crates/python/tests",
    ]);
    pytest
        .args(["--ignore", "crates/python/tests/test_notebook.py"])
        .current_dir(root());
    pytest.env("PYTHONPATH", folder).env("PYTHONDONTWRITEBYTECODE", "1");
    succeed(pytest.env("PLIANT", built.join(format!("pliant{EXE_SUFFIX}"))))
}

/// Puts the module and the package's own files into one folder in which Python finds them.
fn lay_out(built: &Path) -> Result<PathBuf, String> {
    let folder = target_folder().join("python/unpacked");
    let package = folder.join("pliant");
    files::fresh_folder(&package)?;
    files::copy_folder(&root().join("crates/python/python/pliant"), &package)?;
    let module = built.join(format!("{DLL_PREFIX}pliant_native{DLL_SUFFIX}"));
    let name = if cfg!(windows) {
        "_native.pyd"
    } else {
        "_native.abi3.so"
    };
    files::copy(&module, &package.join(name))?;
    Ok(folder)
}
