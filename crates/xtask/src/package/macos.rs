//! The disk image for macOS: `Pliant.app` in it, and the debug information beside it.
//!
//! This is untested.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::release::Release;
use super::{icons, inventory, program};
use crate::files;
use crate::process::succeed;
use crate::tool::{Tool, all_there};

const TOOLS: &[Tool] = &[
    Tool {
        program: "dsymutil",
        install: "xcode-select --install",
    },
    Tool {
        program: "hdiutil",
        install: "it comes with macOS",
    },
];

/// Makes `pliant-VERSION-ARCHITECTURE-macos.dmg`.
///
/// # Errors
/// One sentence naming the missing tool or the failure.
pub fn image(release: &Release, folder: &Path) -> Result<Vec<PathBuf>, String> {
    all_there(&[TOOLS, inventory::TOOLS].concat())?;
    let built = program::compile(&[])?;
    let bundle = folder.join("pliant.dSYM");
    succeed(Command::new("dsymutil").arg(&built).arg("-o").arg(&bundle))?;
    let debug_info = folder.join(format!("{}.dSYM.zip", release.name()));
    succeed(
        Command::new("ditto")
            .args(["-c", "-k", "--keepParent"])
            .args([&bundle, &debug_info]),
    )?;
    files::remove_folder(&bundle)?;
    let papers = inventory::write(release, folder)?;
    let content = folder.join("image");
    let inside = content.join("Pliant.app/Contents");
    let program = inside.join("MacOS/pliant");
    files::copy(&built, &program)?;
    succeed(Command::new("strip").arg(&program))?;
    let about = release.filled(&files::text("packaging/macos/Info.plist")?);
    files::write(&inside.join("Info.plist"), about)?;
    files::write(&inside.join("Resources/pliant.icns"), icons::icns()?)?;
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        files::copy(&crate::root::root().join(name), &content.join(name))?;
    }
    files::copy(&papers.licences, &content.join("licences-of-dependencies.txt"))?;
    // Changing a program breaks its signature by the linker, and macOS starts no program without one.
    let bundle = content.join("Pliant.app");
    succeed(Command::new("codesign").args(["--force", "--sign", "-"]).arg(&bundle))?;
    let image = folder.join(format!("{}.dmg", release.name()));
    let mut create = Command::new("hdiutil");
    create.args(["create", "-volname", "Pliant", "-format", "UDZO", "-srcfolder"]);
    succeed(create.arg(&content).arg(&image))?;
    files::remove_folder(&content)?;
    Ok(vec![image, debug_info, papers.bill_of_materials])
}
