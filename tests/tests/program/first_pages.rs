//! A stranger's first view of each crate: its description in lists of crates, and on its first page the smallest
//! program that uses it, which is run as a test.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use cargo_metadata::{MetadataCommand, Package};

/// Every crate that others can use.
fn crates() -> Vec<Package> {
    let metadata = MetadataCommand::new()
        .no_deps()
        .other_options(["--offline".into()])
        .exec()
        .unwrap();
    let for_others = |package: &Package| !["xtask", "pliant-tests"].contains(&package.name.as_str());
    metadata.packages.into_iter().filter(for_others).collect()
}

#[test]
fn every_crate_says_what_it_is() {
    for package in crates() {
        let name = &package.name;
        let description = package.description.as_deref().unwrap_or_default();
        assert!((20..=120).contains(&description.len()), "{name}: \"{description}\"");
        assert!(
            (1..=5).contains(&package.keywords.len()),
            "{name}: {:?}",
            package.keywords
        );
        assert!(
            (1..=5).contains(&package.categories.len()),
            "{name}: {:?}",
            package.categories
        );
        assert_eq!(package.license.as_deref(), Some("MIT OR Apache-2.0"), "{name}");
        let readme = package.readme().unwrap_or_default();
        assert!(readme.is_file(), "{name}: there is no {readme}");
        for dependency in package
            .dependencies
            .iter()
            .filter(|dependency| dependency.path.is_some())
        {
            assert_ne!(
                dependency.req.to_string(),
                "*",
                "{name}: no registry takes {} without a version",
                dependency.name
            );
        }
    }
}

#[test]
fn every_crate_carries_the_files_that_it_embeds() {
    for package in crates() {
        let listed = packaged(&package);
        let folder = package.manifest_path.parent().unwrap().as_std_path();
        let carried: BTreeSet<PathBuf> = listed
            .iter()
            .filter_map(|name| folder.join(name).canonicalize().ok())
            .collect();
        assert!(
            listed.iter().any(|name| name == "Cargo.toml"),
            "{}: {listed:?}",
            package.name
        );
        for source in carried
            .iter()
            .filter(|file| file.extension().is_some_and(|extension| extension == "rs"))
        {
            for name in embedded(&fs::read_to_string(source).unwrap()) {
                let file = source.parent().unwrap().join(name).canonicalize().unwrap();
                assert!(carried.contains(&file), "{} lacks {}", package.name, file.display());
            }
        }
    }
}

/// The files of a crate for a registry.
fn packaged(package: &Package) -> Vec<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut list = Command::new(cargo);
    list.args(["package", "--list", "--offline", "--allow-dirty", "--manifest-path"]);
    let said = list.arg(&package.manifest_path).output().unwrap();
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    String::from_utf8(said.stdout)
        .unwrap()
        .lines()
        .map(str::to_owned)
        .collect()
}

/// The names in `include_str!("NAME")` and `include_bytes!("NAME")`.
fn embedded(source: &str) -> impl Iterator<Item = &str> {
    let after = ["include_str!(", "include_bytes!("].map(|mark| source.split(mark).skip(1));
    let quoted = after
        .into_iter()
        .flatten()
        .filter_map(|rest| rest.trim_start().strip_prefix('"'));
    quoted.filter_map(|rest| Some(rest.split_once('"')?.0))
}

#[test]
fn every_crate_s_first_page_has_a_program_that_is_run() {
    for package in crates() {
        let library = package
            .targets
            .iter()
            .find(|target| target.is_lib() || target.is_cdylib())
            .unwrap();
        let source = fs::read_to_string(&library.src_path).unwrap();
        if package.name == "pliant-python" {
            // A Python program, which the Python tests run.
            assert!(source.starts_with("#![doc = include_str!(\"../README.md\")]"));
            let page = fs::read_to_string(package.readme().unwrap()).unwrap();
            assert!(page.contains("```python\n"), "there is no program in {page}");
            continue;
        }
        assert!(library.doctest, "{}: its examples are not run", package.name);
        let page = source.lines().take_while(|line| line.starts_with("//!"));
        let fences: Vec<&str> = page.filter(|line| line.starts_with("//! ```")).collect();
        // A fence without a word is a program that is compiled and run.
        assert!(
            fences.contains(&"//! ```"),
            "{}: there is no program on its first page",
            package.name
        );
        assert!(
            fences.iter().all(|fence| *fence == "//! ```"),
            "{}: {fences:?}",
            package.name
        );
    }
}
