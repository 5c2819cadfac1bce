//! The archive, which runs from any folder.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::release::Release;
use super::tree::plain_permissions;
use crate::files;
use crate::process::succeed;
use crate::tool::{Tool, all_there};

const TOOLS: &[Tool] = &[
    Tool {
        program: "tar",
        install: "apt install tar",
    },
    Tool {
        program: "xz",
        install: "apt install xz-utils",
    },
];

/// Makes `pliant-VERSION-ARCHITECTURE-linux.tar.xz` of the tree, with a script that installs it for one person.
///
/// # Errors
/// One sentence naming the missing tool or the failure.
pub fn archive(release: &Release, tree: &Path, folder: &Path) -> Result<Vec<PathBuf>, String> {
    all_there(TOOLS)?;
    let name = release.name();
    let unpacked = folder.join(&name);
    files::fresh_folder(&unpacked)?;
    files::copy_folder(tree, &unpacked)?;
    for (from, to) in [
        ("packaging/linux/install.sh", "install.sh"),
        ("LICENSE-APACHE", "LICENSE-APACHE"),
        ("LICENSE-MIT", "LICENSE-MIT"),
    ] {
        files::copy(&crate::root::root().join(from), &unpacked.join(to))?;
    }
    plain_permissions(&unpacked)?;
    let packed = folder.join(format!("{name}.tar"));
    let mut tar = Command::new("tar");
    tar.current_dir(folder).args([
        "--sort=name",
        "--owner=0",
        "--group=0",
        "--numeric-owner",
        "--format=gnu",
    ]);
    tar.arg(format!("--mtime=@{}", release.epoch))
        .arg("-cf")
        .arg(&packed)
        .arg(&name);
    succeed(&mut tar)?;
    // One thread, because the output of xz depends on the number of threads.
    succeed(Command::new("xz").args(["-9", "--threads=1", "--force"]).arg(&packed))?;
    files::remove_folder(&unpacked)?;
    Ok(vec![folder.join(format!("{name}.tar.xz"))])
}
