//! The zip for Windows: the program with its icon and version, and the debug information beside it.
//!
//! Windows decides by a mark in a program whether it gets a console. So the program is linked twice: `pliant.exe` for
//! the command line, and `pliantw.exe`, which opens the window without a console beside it.
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
        program: "rc",
        install: "install the Windows SDK and start from its command prompt",
    },
    Tool {
        program: "tar",
        install: "it comes with Windows 10",
    },
];

/// Makes `pliant-VERSION-ARCHITECTURE-windows.zip`.
///
/// # Errors
/// One sentence naming the missing tool or the failure.
pub fn zip(release: &Release, folder: &Path) -> Result<Vec<PathBuf>, String> {
    all_there(&[TOOLS, inventory::TOOLS].concat())?;
    let name = release.name();
    let resource = resource(release, folder)?;
    let resource = resource.display().to_string();
    let unpacked = folder.join(&name);
    let without_console = ["/SUBSYSTEM:WINDOWS", "/ENTRY:mainCRTStartup"].map(str::to_owned);
    let built = program::compile(&[[resource.clone()].as_slice(), &without_console].concat())?;
    files::copy(&built, &unpacked.join("pliantw.exe"))?;
    let built = program::compile(&[resource])?;
    let debug_info = folder.join(format!("{name}.pdb"));
    files::copy(&built.with_extension("pdb"), &debug_info)?;
    let papers = inventory::write(release, folder)?;
    files::copy(&built, &unpacked.join("pliant.exe"))?;
    for name in ["LICENSE-MIT", "LICENSE-APACHE", "README.md"] {
        files::copy(&crate::root::root().join(name), &unpacked.join(name))?;
    }
    files::copy(&papers.licences, &unpacked.join("licences-of-dependencies.txt"))?;
    let zip = folder.join(format!("{name}.zip"));
    let mut tar = Command::new("tar");
    succeed(tar.current_dir(folder).arg("-a").arg("-cf").arg(&zip).arg(&name))?;
    files::remove_folder(&unpacked)?;
    Ok(vec![zip, debug_info, papers.bill_of_materials])
}

/// Compiles the resource with icon and version.
fn resource(release: &Release, folder: &Path) -> Result<PathBuf, String> {
    let (script, compiled) = (folder.join("pliant.rc"), folder.join("pliant.res"));
    files::write(&folder.join("pliant.ico"), icons::ico()?)?;
    let numbers = format!("{},0", release.version.replace('.', ","));
    let text = release.filled(&files::text("packaging/windows/pliant.rc")?);
    files::write(&script, text.replace("@NUMBERS@", &numbers))?;
    let mut rc = Command::new("rc");
    succeed(
        rc.current_dir(folder)
            .arg("/nologo")
            .arg("/fo")
            .arg(&compiled)
            .arg(&script),
    )?;
    Ok(compiled)
}
