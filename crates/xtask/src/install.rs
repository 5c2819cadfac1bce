//! Installing the packages that a command needs.

use std::io::{BufRead, IsTerminal, Write};
use std::process::{Command, Stdio};

use crate::process;
use crate::requirement::{Requirement, missing_packages};
use crate::system::{self, System};

/// The consent to installing packages without asking.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Consent {
    /// Ask first.
    Ask,
    /// Yes.
    Given,
}

/// The result of preparing.
#[derive(Clone, PartialEq, Debug)]
pub enum Prepared {
    /// Everything is installed.
    Complete,
    /// Something is missing, on a system with unknown packages: the sentence names the skipped part.
    Without(String),
}

/// Checks `requirements` and installs missing packages if allowed; `purpose` gives their purpose in messages.
///
/// # Errors
/// One sentence naming the packages, if the system has apt but they can't be installed.
pub fn prepare(requirements: &[&[Requirement]], purpose: &str, consent: Consent) -> Result<Prepared, String> {
    let system = System::here();
    if let System::Other { name } = &system {
        return Ok(Prepared::Without(format!(
            "The packages that {purpose} need on {name} are not known yet, so they may be skipped."
        )));
    }
    let packages = missing_packages(requirements);
    if packages.is_empty() {
        return Ok(Prepared::Complete);
    }
    if !matches!(system, System::Debian { .. }) || process::program("apt-get").is_none() {
        return Ok(Prepared::Without(format!(
            "{} has no apt, so {purpose} are skipped; they need Debian's packages {}.",
            system.name(),
            packages.join(" ")
        )));
    }
    let by_hand = format!(
        "sudo apt-get update && sudo apt-get install -y --no-install-recommends {}",
        packages.join(" ")
    );
    let prefix: &[&str] = if system::is_root() {
        println!("Installing for {purpose}: {}", packages.join(" "));
        &[]
    } else if process::program("sudo").is_some() && agreed(&by_hand, purpose, consent) {
        &["sudo"]
    } else {
        return Err(format!(
            "For {purpose} install these packages and start again: {by_hand}"
        ));
    };
    let failed = |sentence: String| format!("{sentence} For {purpose} install these packages: {by_hand}");
    process::succeed(&mut apt(prefix, &["update"])).map_err(failed)?;
    let install = [&["install", "-y", "--no-install-recommends"], packages.as_slice()].concat();
    process::succeed(&mut apt(prefix, &install)).map_err(failed)?;
    let missing = missing_packages(requirements);
    if missing.is_empty() {
        Ok(Prepared::Complete)
    } else {
        Err(format!(
            "The packages {} were installed, but {purpose} still don't find them.",
            missing.join(" ")
        ))
    }
}

/// A non-interactive apt-get command whose output goes to standard error.
fn apt(prefix: &[&str], arguments: &[&str]) -> Command {
    let words = [
        prefix,
        &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-q"],
        arguments,
    ]
    .concat();
    let mut command = Command::new(words[0]);
    command
        .args(&words[1..])
        .stdin(Stdio::inherit())
        .stdout(Stdio::from(std::io::stderr()));
    command
}

/// Shows the command and asks whether to run it; without a terminal the answer is no.
fn agreed(line: &str, purpose: &str, consent: Consent) -> bool {
    println!("For {purpose} some packages are missing:\n\n  {line}\n");
    if consent == Consent::Given {
        return true;
    }
    if !std::io::stdin().is_terminal() {
        return false;
    }
    print!("Run it now? [y/N] ");
    let mut answer = String::new();
    let heard = std::io::stdout()
        .flush()
        .and_then(|()| std::io::stdin().lock().read_line(&mut answer));
    heard.is_ok() && matches!(answer.trim(), "y" | "Y" | "yes" | "Yes")
}

/// Installs rustfmt and clippy, which a minimal toolchain does not have.
///
/// # Errors
/// One sentence naming the component, if it is missing and rustup can't add it.
pub fn prepare_toolchain() -> Result<(), String> {
    for (command, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        let mut probe = process::cargo(&[command, "--version"]);
        let there = probe
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if !there {
            let mut add = Command::new("rustup");
            add.args(["component", "add", component])
                .current_dir(crate::root::root());
            process::succeed(&mut add).map_err(|sentence| {
                format!("{sentence} Add {component} to the Rust toolchain by hand and start again.")
            })?;
        }
    }
    Ok(())
}
