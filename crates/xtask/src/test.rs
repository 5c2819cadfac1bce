//! `cargo xtask test`: everything that must pass.

use std::process::Command;
use std::time::Instant;

use crate::check;
use crate::display::Display;
use crate::install::{Consent, Prepared, prepare, prepare_toolchain};
use crate::process;
use crate::requirement::{PICTURES, TESTS, WINDOW};
use crate::system;
use crate::verdict::{Skips, Verdict};

/// Formatting, clippy and every test; with `filters` only the tests that they name.
///
/// # Errors
/// One sentence when something fails, or when packages are missing that can't be installed from here.
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
    }
    let mut tests = process::cargo(&["test", "--locked", "--workspace", "--no-fail-fast"]);
    // Output of tests that pass is asked for, since it says what they skip.
    tests.args(["--", "--show-output"]).args(filters);
    let display = match &prepared {
        Prepared::Complete => Some(Display::start()?),
        Prepared::Without(_) => Display::start().ok(),
    };
    surround(&mut tests, display.as_ref());
    verdict.tests("workspace", &mut tests);
    if let Prepared::Without(sentence) = prepared {
        println!("\n{sentence}");
    }
    let skips = match std::env::var_os("CI") {
        Some(value) if !value.is_empty() && value != "false" => Skips::Failures,
        _ => Skips::Named,
    };
    verdict.conclude(started, skips)
}

/// Gives the tests a display of their own and the driver that pictures are compared on.
fn surround(tests: &mut Command, display: Option<&Display>) {
    tests.env_remove("WAYLAND_DISPLAY");
    match display {
        Some(display) => tests.env("DISPLAY", display.name()),
        None => tests.env_remove("DISPLAY"),
    };
    if let Some(driver) = system::software_vulkan_driver() {
        tests.env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
    }
}
