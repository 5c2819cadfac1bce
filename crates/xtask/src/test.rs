//! `cargo xtask test`: all checks.

use std::process::Command;
use std::time::Instant;

use crate::check;
use crate::display::Display;
use crate::install::{Consent, Prepared, prepare, prepare_toolchain};
use crate::manual;
use crate::process;
use crate::python;
use crate::requirement::{PICTURES, TESTS, WINDOW};
use crate::root::root;
use crate::system;
use crate::test_programs::test_programs;
use crate::validation;
use crate::verdict::{Skips, Verdict};

/// Runs formatting, clippy and every test; with `filters`, only the tests that match.
///
/// # Errors
/// One sentence if something fails, or if missing packages can't be installed.
pub fn test(filters: &[String], consent: Consent) -> Result<(), String> {
    let started = Instant::now();
    prepare_toolchain()?;
    let prepared = prepare(
        &[PICTURES, WINDOW, TESTS],
        "the tests of pictures and of the window",
        consent,
    )?;
    let mut verdict = Verdict::default();
    if filters.is_empty() {
        check::formatting(&mut verdict);
        check::clippy(&mut verdict);
        check::documentation(&mut verdict);
    }
    let display = match &prepared {
        Prepared::Complete => Some(Display::start()?),
        Prepared::Without(_) => Display::start().ok(),
    };
    workspace(filters, display.as_ref(), &mut verdict)?;
    if filters.is_empty() {
        validation::pictures(&mut verdict);
        python::unpacked::tests(&mut verdict);
        manual::check(&mut verdict);
    }
    let in_ci = std::env::var_os("CI").is_some_and(|value| !value.is_empty() && value != "false");
    let skips = match prepared {
        Prepared::Complete if in_ci => Skips::Failures,
        Prepared::Complete => Skips::Named,
        Prepared::Without(sentence) => {
            println!("\n{sentence}");
            Skips::Named
        }
    };
    verdict.conclude(started, skips)
}

/// Builds and runs all tests of the workspace: a queue of test programs, and beside it those that drive the real window,
/// which wait most of the time.
fn workspace(filters: &[String], display: Option<&Display>, verdict: &mut Verdict) -> Result<(), String> {
    let programs = test_programs(&root())?;
    let tests = |name: &str, targets: &[&str]| {
        let mut tests = process::cargo(&["test", "--locked", "--workspace", "--no-fail-fast"]);
        // Show the output of passing tests, because it names skipped parts.
        tests.args(targets).args(["--", "--show-output"]).args(filters);
        set_environment(&mut tests, display);
        (name.to_owned(), tests)
    };
    let of_window = programs.of_window.iter().flat_map(|name| ["--test", name]);
    let mut queue = vec![
        // One after the other, because they share the display.
        tests("real window", &of_window.collect::<Vec<_>>()),
        tests("units", &["--lib", "--bins"]),
        tests("documentation's examples", &["--doc"]),
    ];
    queue.extend(programs.others.iter().map(|name| tests(name, &["--test", name])));
    // Two builds at once would wait for each other. Examples are left out: no test runs one, and clippy compiles them.
    let all = [
        "test",
        "--locked",
        "--workspace",
        "--lib",
        "--bins",
        "--tests",
        "--no-run",
    ];
    process::succeed(&mut process::cargo(&all))?;
    verdict.tests_at_once(queue, AT_ONCE);
    Ok(())
}

/// The commands that run at once: those of the real window, and one other, which already keeps two processors busy. In a
/// run beside two others and a build the window did not answer within its tests' patience.
const AT_ONCE: usize = 2;

/// Sets the virtual display and the driver for comparing pictures.
fn set_environment(tests: &mut Command, display: Option<&Display>) {
    tests.env_remove("WAYLAND_DISPLAY");
    match display {
        Some(display) => tests.env("DISPLAY", display.name()),
        None => tests.env_remove("DISPLAY"),
    };
    if let Some(driver) = system::software_vulkan_driver() {
        tests.env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
    }
}
