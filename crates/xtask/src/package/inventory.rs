//! What the program is made of: the licences of its dependencies, and a bill of materials (SBOM).

use std::path::{Path, PathBuf};

use super::release::Release;
use crate::files;
use crate::process::{cargo, said, succeed};
use crate::tool::Tool;

/// What both are made with.
pub const TOOLS: &[Tool] = &[
    Tool {
        program: "cargo-about",
        install: "cargo install cargo-about --features cli",
    },
    Tool {
        program: "cargo-cyclonedx",
        install: "cargo install cargo-cyclonedx",
    },
];

/// The papers that come with the program.
pub struct Papers {
    /// The licences of all dependencies, as text.
    pub licences: PathBuf,
    /// The dependencies in CycloneDX's format.
    pub bill_of_materials: PathBuf,
}

/// Writes both into `folder`.
///
/// # Errors
/// One sentence if a tool fails, for example because a dependency's licence is not among those accepted.
pub fn write(release: &Release, folder: &Path) -> Result<Papers, String> {
    let papers = Papers {
        licences: folder.join("licences-of-dependencies.txt"),
        bill_of_materials: folder.join(format!("{}.cdx.json", release.name())),
    };
    let target = target()?;
    let mut about = cargo(&["about", "generate", "--locked", "--offline", "--fail"]);
    about.args([
        "--config",
        "packaging/licences/about.toml",
        "--manifest-path",
        "crates/app/Cargo.toml",
    ]);
    about.args(["--target", &target, "packaging/licences/about.hbs"]);
    files::write(&papers.licences, said(&mut about)?)?;
    bill_of_materials(release, &target, &papers.bill_of_materials)?;
    Ok(papers)
}

/// The tool writes beside every manifest of the workspace. Ours is taken from there, and the others are removed.
fn bill_of_materials(release: &Release, target: &str, file: &Path) -> Result<(), String> {
    let mut cyclonedx = cargo(&["cyclonedx", "--quiet", "--format", "json", "--describe", "binaries"]);
    cyclonedx.args([
        "--no-build-deps",
        "--manifest-path",
        "crates/app/Cargo.toml",
        "--target",
        target,
    ]);
    let made = succeed(cyclonedx.env("SOURCE_DATE_EPOCH", release.epoch.to_string()));
    let crates = crate::root().join("crates");
    let copied = made.and_then(|()| files::copy(&crates.join("app/pliant_bin.cdx.json"), file));
    for left in files::all_files(&crates)? {
        if left.to_string_lossy().ends_with("_bin.cdx.json") {
            files::remove_file(&crates.join(left))?;
        }
    }
    copied
}

/// The target that the compiler builds for.
fn target() -> Result<String, String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let about = said(std::process::Command::new(rustc).arg("-vV"))?;
    let host = about.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned)
        .ok_or_else(|| "`rustc -vV` does not name its host.".to_owned())
}
