//! The program's components: the licences of its dependencies, and a bill of materials (SBOM).

use std::path::{Path, PathBuf};

use super::release::Release;
use crate::files;
use crate::process::{cargo, said, succeed};
use crate::tool::Tool;

/// The tool that lists licences.
pub const CARGO_ABOUT: Tool = Tool {
    program: "cargo-about",
    install: "cargo install cargo-about --features cli",
};

/// The tool that lists dependencies.
pub const CARGO_CYCLONEDX: Tool = Tool {
    program: "cargo-cyclonedx",
    install: "cargo install cargo-cyclonedx",
};

/// The tools for both.
pub const TOOLS: &[Tool] = &[CARGO_ABOUT, CARGO_CYCLONEDX];

/// The documents that come with the program.
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
    let bill = bill_of_materials(release, "crates/app", "pliant_bin")?;
    files::write(&papers.bill_of_materials, bill)?;
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

/// The components of a crate's program or module, in CycloneDX's format: the crate in this folder (`crates/app`), with
/// the tool's name for it (`pliant_bin`).
///
/// # Errors
/// One sentence if the tool fails.
pub fn bill_of_materials(release: &Release, folder: &str, name: &str) -> Result<String, String> {
    let manifest = format!("{folder}/Cargo.toml");
    let mut cyclonedx = cargo(&["cyclonedx", "--quiet", "--format", "json", "--describe", "binaries"]);
    cyclonedx.args(["--no-build-deps", "--manifest-path", &manifest, "--target", &target()?]);
    let made = succeed(cyclonedx.env("SOURCE_DATE_EPOCH", release.epoch.to_string()));
    // The tool writes beside every manifest of the workspace. One is read, and all are removed.
    let bill = made.and_then(|()| files::text(&format!("{folder}/{name}.cdx.json")));
    let crates = crate::root::root().join("crates");
    for left in files::all_files(&crates)? {
        if left.to_string_lossy().ends_with(".cdx.json") {
            files::remove_file(&crates.join(left))?;
        }
    }
    without_this_machine(&bill?, folder)
}

/// A bill of materials without this machine's paths of our crates.
fn without_this_machine(bill: &str, folder: &str) -> Result<String, String> {
    let first = bill.split_once("\"bom-ref\": \"path+");
    let root = first.and_then(|(_, after)| Some(after.split_once(&format!("/{folder}#"))?.0));
    let root = root.ok_or_else(|| format!("The bill of materials does not say first that it is of {folder}."))?;
    Ok(bill.replace(root, "file:///pliant"))
}

/// The target of the compiler.
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

    /// The names in quotes between a mark and the closing bracket of the list.
    fn list(text: &str, mark: &str) -> Vec<String> {
        let (_, after) = text.split_once(mark).unwrap_or_default();
        let (inside, _) = after.split_once(']').unwrap_or_default();
        inside.split('"').skip(1).step_by(2).map(str::to_owned).collect()
    }

    #[test]
    fn a_bill_of_materials_names_no_folder_of_this_machine() {
        let bill = r#"{ "bom-ref": "path+file:///home/an%20owner/pliant/crates/app#1.0.0",
            "ref": "path+file:///home/an%20owner/pliant/crates/mesh#1.0.0" }"#;
        let neutral = bill.replace("/home/an%20owner/pliant", "/pliant");
        assert_eq!(without_this_machine(bill, "crates/app"), Ok(neutral));
        assert!(without_this_machine(bill, "crates/python").is_err());
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
