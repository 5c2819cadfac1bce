//! `cargo xtask package`: the packages that this system can make, in `target/package`.
//!
//! Everything is made from the commit alone: times are the commit's (or `SOURCE_DATE_EPOCH`), paths are made neutral and
//! files are sorted, so that the same commit and tools give the same bytes.

mod archive;
mod debian;
pub mod glibc;
mod icons;
pub mod inventory;
mod macos;
pub mod program;
pub mod release;
mod tree;
mod validation;
mod windows;

use std::path::PathBuf;

use crate::files;
use crate::process::target_folder;
use release::Release;

/// The results of packaging.
#[derive(Default)]
struct Outcome {
    made: Vec<PathBuf>,
    /// The systems on which they run.
    runs: Vec<String>,
    left: Vec<String>,
}

impl Outcome {
    /// Notes a package, or the reason why there is none.
    fn note(&mut self, name: &str, result: Result<Vec<PathBuf>, String>) {
        match result {
            Ok(files) => self.made.extend(files),
            Err(sentence) => self.left.push(format!("{name}: {sentence}")),
        }
    }
}

/// Makes the packages that this system can make and prints them, and the others with the reason.
///
/// # Errors
/// One sentence if the program can't be built, or if a package is faulty.
pub fn package() -> Result<(), String> {
    let release = Release::read()?;
    let folder = target_folder().join("package");
    files::fresh_folder(&folder)?;
    let mut outcome = Outcome::default();
    match std::env::consts::OS {
        "linux" => linux(&release, &folder, &mut outcome)?,
        "macos" => outcome.note("disk image (not tried by anybody yet)", macos::image(&release, &folder)),
        "windows" => outcome.note("zip (not tried by anybody yet)", windows::zip(&release, &folder)),
        other => outcome
            .left
            .push(format!("packages for {other}: nobody has written them yet")),
    }
    for other in [("macos", "disk image"), ("windows", "zip")] {
        if other.0 != std::env::consts::OS {
            outcome.left.push(format!("{}: it is made on {}", other.1, other.0));
        }
    }
    for file in &outcome.made {
        println!("made: {}", file.display());
    }
    for sentence in &outcome.runs {
        println!("runs: {sentence}");
    }
    for sentence in &outcome.left {
        println!("left: {sentence}");
    }
    Ok(())
}

/// The Debian package and the archive, from one tree, and the checks of both.
fn linux(release: &Release, folder: &std::path::Path, outcome: &mut Outcome) -> Result<(), String> {
    let needed = [program::TOOLS, inventory::TOOLS, tree::TOOLS].concat();
    if let Err(sentence) = crate::tool::all_there(&needed) {
        outcome.left.push(format!("deb and archive: {sentence}"));
        return Ok(());
    }
    let built = program::build(release, folder)?;
    outcome.runs.push(glibc::sentence(&built.program)?);
    let papers = inventory::write(release, folder)?;
    let tree = tree::grow(release, &built, &papers, folder)?;
    outcome.made.extend([built.debug_info, papers.bill_of_materials]);
    outcome.note("archive", archive::archive(release, &tree, folder));
    let debian = debian::package(release, &tree, folder);
    let package = debian.as_ref().ok().and_then(|files| files.first().cloned());
    outcome.note("deb", debian);
    outcome.left.extend(validation::validate(&tree, package.as_deref())?);
    files::remove_folder(&tree)
}
