//! `cargo xtask check`: the checks that are fast enough to run while working.

use std::time::Instant;

use crate::install::prepare_toolchain;
use crate::process;
use crate::verdict::{Skips, Verdict};

/// Runs formatting, clippy and the unit tests of every crate.
///
/// # Errors
/// One sentence if something fails.
pub fn check() -> Result<(), String> {
    let started = Instant::now();
    prepare_toolchain()?;
    let mut verdict = Verdict::default();
    formatting(&mut verdict);
    clippy(&mut verdict);
    let units = [
        "test",
        "--locked",
        "--workspace",
        "--exclude",
        "pliant-tests",
        "--lib",
        "--bins",
        "--no-fail-fast",
    ];
    verdict.tests("units", &mut process::cargo(&units));
    verdict.conclude(started, Skips::Named)
}

/// Checks that every file is formatted.
pub fn formatting(verdict: &mut Verdict) {
    verdict.step("formatting", &mut process::cargo(&["fmt", "--all", "--", "--check"]));
}

/// Checks that clippy has no warnings, in code and in tests.
pub fn clippy(verdict: &mut Verdict) {
    let arguments = [
        "clippy",
        "--locked",
        "--workspace",
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ];
    verdict.step("clippy", &mut process::cargo(&arguments));
}
