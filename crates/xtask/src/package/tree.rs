//! The installed files, in their layout below `/usr` or any other prefix.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::icons;
use super::inventory::Papers;
use super::program::Program;
use super::release::{ID, Release};
use crate::files;
use crate::process::succeed;
use crate::tool::Tool;

/// The tool that compresses the man pages.
pub const TOOLS: &[Tool] = &[Tool {
    program: "gzip",
    install: "apt install gzip",
}];

/// The folder of the documents below the prefix.
pub const DOCUMENTS: &str = "share/doc/pliant";

/// Puts `bin` and `share` into a folder `tree` and returns its path.
///
/// # Errors
/// One sentence naming the failed file or folder.
pub fn grow(release: &Release, built: &Program, papers: &Papers, folder: &Path) -> Result<PathBuf, String> {
    let tree = folder.join("tree");
    let share = tree.join("share");
    files::fresh_folder(&tree)?;
    files::copy(&built.program, &tree.join("bin/pliant"))?;
    files::remove_file(&built.program)?;
    desktop(release, &share)?;
    icons::put(&share.join("icons/hicolor"))?;
    from_the_command_line(&tree)?;
    let documents = tree.join(DOCUMENTS);
    for name in ["README.md", "LICENSE-MIT"] {
        files::copy(&crate::root::root().join(name), &documents.join(name))?;
    }
    files::copy(&crate::root::root().join("CHANGELOG.md"), &documents.join("changelog"))?;
    files::copy(
        &crate::root::root().join("packaging/linux/copyright"),
        &documents.join("copyright"),
    )?;
    files::copy(&papers.licences, &documents.join("licences-of-dependencies.txt"))?;
    files::remove_file(&papers.licences)?;
    files::copy(&papers.bill_of_materials, &documents.join("pliant.cdx.json"))?;
    for name in ["changelog", "licences-of-dependencies.txt", "pliant.cdx.json"] {
        compress(&documents.join(name))?;
    }
    plain_permissions(&tree)?;
    Ok(tree)
}

/// The files for desktops: the entry, the types of files, and the description.
fn desktop(release: &Release, share: &Path) -> Result<(), String> {
    files::write(
        &share.join("applications/pliant.desktop"),
        files::text("packaging/linux/pliant.desktop")?,
    )?;
    files::write(
        &share.join("mime/packages/pliant.xml"),
        files::text("packaging/linux/pliant-mime.xml")?,
    )?;
    let description = release.filled(&files::text("packaging/linux/pliant.metainfo.xml")?);
    let description = description.replace("@DATE@", &release.date("+%F")?);
    files::write(&share.join(format!("metainfo/{ID}.metainfo.xml")), description)
}

/// The files that the program writes from the definition of its command line.
fn from_the_command_line(tree: &Path) -> Result<(), String> {
    let written = tree.join("generated");
    succeed(Command::new(tree.join("bin/pliant")).arg("generate").arg(&written))?;
    for page in files::all_files(&written.join("man"))? {
        let to = tree.join("share/man/man1").join(&page);
        files::copy(&written.join("man").join(&page), &to)?;
        compress(&to)?;
    }
    for (name, to) in [
        ("pliant.bash", "bash-completion/completions/pliant"),
        ("_pliant", "zsh/vendor-completions/_pliant"),
        ("pliant.fish", "fish/vendor_completions.d/pliant.fish"),
    ] {
        files::copy(&written.join("completions").join(name), &tree.join("share").join(to))?;
    }
    files::remove_folder(&written)
}

/// Compresses a file in place, without the name and the time.
///
/// # Errors
/// One sentence naming the file.
pub fn compress(file: &Path) -> Result<(), String> {
    succeed(Command::new("gzip").args(["-n9", "--force"]).arg(file))
}

/// Gives every file and folder the permissions of installed ones, independent of this machine's mask.
///
/// # Errors
/// One sentence if they can't be changed.
pub fn plain_permissions(folder: &Path) -> Result<(), String> {
    succeed(Command::new("chmod").args(["-R", "u=rwX,go=rX"]).arg(folder))
}
