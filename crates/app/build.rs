//! Gives the program the commit that it was built from; "unknown" without git or a repository.

use std::path::Path;
use std::process::Command;

fn main() {
    let commit = git(&["rev-parse", "--short=10", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    println!("cargo::rustc-env=PLIANT_COMMIT={commit}");
    println!("cargo::rerun-if-changed=build.rs");
    // A new commit changes HEAD's log; a fresh clone has the log, and without it the commit stays that of the first
    // build.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        let log = Path::new(&log);
        if log.exists() {
            println!("cargo::rerun-if-changed={}", log.display());
        }
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    (output.status.success() && !text.trim().is_empty()).then(|| text.trim().to_owned())
}
