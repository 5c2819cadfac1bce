//! What the program is made of: the licences of its dependencies, and a bill of materials (SBOM).

use std::path::{Path, PathBuf};

use super::release::Release;
use crate::files;
use crate::process::{cargo, said, succeed};
use crate::tool::Tool;

/// What lists licences.
pub const CARGO_ABOUT: Tool = Tool {
    program: "cargo-about",
    install: "cargo install cargo-about --features cli",
};

/// What both are made with.
pub const TOOLS: &[Tool] = &[
    CARGO_ABOUT,
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
    files::write(&papers.licences, licences("crates/app/Cargo.toml")?)?;
    bill_of_materials(release, &papers.bill_of_materials)?;
    Ok(papers)
}

/// The licences of all dependencies of the crate with this manifest, as text.
///
/// # Errors
/// One sentence if the tool fails, for example because a dependency's licence is not among those accepted.
pub fn licences(manifest: &str) -> Result<String, String> {
    let mut about = cargo(&["about", "generate", "--locked", "--offline", "--fail"]);
    about.args(["--config", "packaging/licences/about.toml"]);
    about.args(["--manifest-path", manifest, "--target", &target()?]);
    said(about.arg("packaging/licences/about.hbs"))
}

/// The tool writes beside every manifest of the workspace. Ours is taken from there, and the others are removed.
fn bill_of_materials(release: &Release, file: &Path) -> Result<(), String> {
    let mut cyclonedx = cargo(&["cyclonedx", "--quiet", "--format", "json", "--describe", "binaries"]);
    cyclonedx.args([
        "--no-build-deps",
        "--manifest-path",
        "crates/app/Cargo.toml",
        "--target",
        &target()?,
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// The names in quotes between a mark and the bracket that closes the list.
    fn list(text: &str, mark: &str) -> Vec<String> {
        let (_, after) = text.split_once(mark).unwrap_or_default();
        let (inside, _) = after.split_once(']').unwrap_or_default();
        inside.split('"').skip(1).step_by(2).map(str::to_owned).collect()
    }

    #[test]
    fn what_may_be_depended_on_is_what_may_be_shipped() {
        let depended = files::text("deny.toml").unwrap_or_default();
        let shipped = files::text("packaging/licences/about.toml").unwrap_or_default();
        let everywhere = list(&depended, "\nallow = [");
        assert!(everywhere.contains(&"MIT".to_owned()));
        assert_eq!(everywhere, list(&shipped, "\naccepted = ["));

        let exceptions = depended
            .split("{ crate = \"")
            .skip(1)
            .filter(|entry| entry.contains("allow = ["));
        let exceptions: BTreeMap<_, _> = exceptions
            .filter_map(|entry| Some((entry.split_once('"')?.0, list(entry, "allow = ["))))
            .collect();
        let of_crates = shipped.split("\n[").skip(1);
        let of_crates: BTreeMap<_, _> = of_crates
            .filter_map(|entry| Some((entry.split_once(']')?.0, list(entry, "accepted = ["))))
            .collect();
        assert!(exceptions.len() > 1);
        assert_eq!(exceptions, of_crates);
    }
}
