//! `cargo xtask check`: the part of the tests that answers while one works.

use std::time::Instant;

use crate::install::prepare_toolchain;
use crate::process;
use crate::verdict::{Skips, Verdict};

/// Formatting, clippy and the unit tests of every crate.
///
/// # Errors
/// One sentence when something fails.
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

/// Every file stands as rustfmt would write it.
pub fn formatting(verdict: &mut Verdict) {
    verdict.step("formatting", &mut process::cargo(&["fmt", "--all", "--", "--check"]));
}

/// No lint warns, in code and in tests.
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
