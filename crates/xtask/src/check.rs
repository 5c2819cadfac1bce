//! `cargo xtask check`: the checks that are fast enough during work.

use std::time::Instant;

use crate::install::prepare_toolchain;
use crate::process;
use crate::tool::Tool;
use crate::verdict::{Skips, Verdict};

/// Runs formatting, clippy, the checks of dependencies and the unit tests of every crate.
///
/// # Errors
/// One sentence if something fails.
pub fn check() -> Result<(), String> {
    let started = Instant::now();
    prepare_toolchain()?;
    let mut verdict = Verdict::default();
    formatting(&mut verdict);
    clippy(&mut verdict);
    dependencies(&mut verdict);
    // This builds the whole workspace, because without some crates other features would build all of it a second time.
    let units = ["test", "--locked", "--workspace", "--lib", "--bins", "--no-fail-fast"];
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

/// Checks that rustdoc has no warnings, such as links that lead nowhere.
pub fn documentation(verdict: &mut Verdict) {
    let mut doc = process::cargo(&["doc", "--locked", "--workspace", "--no-deps"]);
    verdict.step("documentation", doc.env("RUSTDOCFLAGS", "-D warnings"));
}

/// The tool that checks dependencies.
const CARGO_DENY: Tool = Tool {
    program: "cargo-deny",
    install: "cargo install cargo-deny",
};

/// Checks the dependencies' licences and sources by `deny.toml`, and their known faults if the database is present.
fn dependencies(verdict: &mut Verdict) {
    if let Err(sentence) = CARGO_DENY.find() {
        return verdict.skip(&format!("the dependencies' licences and faults ({sentence})"));
    }
    let mut deny = process::cargo(&["deny", "--locked", "--offline", "check", "licenses", "bans", "sources"]);
    let database = process::cargo_home().join("advisory-dbs");
    if std::fs::read_dir(database).is_ok_and(|mut entries| entries.next().is_some()) {
        deny.args(["advisories", "--disable-fetch"]);
    } else {
        verdict.skip("the dependencies' known faults (their database is not here: cargo deny fetch db)");
    }
    verdict.step("dependencies", &mut deny);
}
