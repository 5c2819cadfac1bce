//! The checks of the packages, by the tools of their distributors.

use std::path::Path;
use std::process::Command;

use super::release::ID;
use crate::process::succeed;
use crate::tool::Tool;

/// Runs every check whose tool is installed. Returns a sentence for each check without its tool.
///
/// # Errors
/// One sentence naming the check that found an error.
pub fn validate(tree: &Path, package: Option<&Path>) -> Result<Vec<String>, String> {
    let share = tree.join("share");
    let (entry, description) = (
        share.join("applications/pliant.desktop"),
        share.join(format!("metainfo/{ID}.metainfo.xml")),
    );
    let size = std::fs::metadata(tree.join("bin/pliant")).map_or(0, |about| about.len());
    if size > LARGEST_PROGRAM {
        return Err(format!(
            "The program takes {size} bytes; at most {LARGEST_PROGRAM} are allowed."
        ));
    }
    let mut left = Vec::new();
    let mut check = |program, install, arguments: &[&Path]| {
        let tool = Tool { program, install };
        match tool.find() {
            Ok(path) => succeed(Command::new(path).args(arguments)),
            Err(sentence) => {
                left.push(format!("a check: {sentence}"));
                Ok(())
            }
        }
    };
    check("desktop-file-validate", "apt install desktop-file-utils", &[&entry])?;
    check(
        "appstreamcli",
        "apt install appstream",
        &[Path::new("validate"), Path::new("--no-net"), &description],
    )?;
    if let Some(package) = package {
        check(
            "lintian",
            "apt install lintian",
            &[Path::new("--fail-on=error"), package],
        )?;
    }
    Ok(left)
}

/// The largest size of the stripped program in bytes.
const LARGEST_PROGRAM: u64 = 40_000_000;
