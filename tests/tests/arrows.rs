//! The dependencies between the crates are those that `crates/README.md` draws, and its "Invariant:" lines hold.
//! `cargo tree` shows a crate's linked crates; its sources show its use of the standard library.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::collections::BTreeSet;
use std::path::Path;

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand};
use pliant_tests::sources::{self, Source};

/// The crates on which each crate may depend; `tests` and `xtask` are exempt.
const ARROWS: &[(&str, &[&str])] = &[
    ("pliant-assets", &[]),
    ("pliant-shaders", &[]),
    ("pliant-mesh", &[]),
    ("pliant-io", &["pliant-mesh"]),
    ("pliant-deform", &["pliant-mesh"]),
    ("pliant-stitch", &["pliant-deform", "pliant-mesh"]),
    ("pliant-flow", &["pliant-deform", "pliant-mesh"]),
    ("pliant-render", &["pliant-shaders"]),
    ("pliant-editor", &["pliant-deform", "pliant-flow", "pliant-mesh"]),
    (
        "pliant-engine",
        &[
            "pliant-deform",
            "pliant-editor",
            "pliant-flow",
            "pliant-io",
            "pliant-mesh",
            "pliant-stitch",
        ],
    ),
    (
        "pliant-picture",
        &[
            "pliant-deform",
            "pliant-editor",
            "pliant-engine",
            "pliant-io",
            "pliant-mesh",
            "pliant-render",
        ],
    ),
    (
        "pliant-python",
        &[
            "pliant-deform",
            "pliant-editor",
            "pliant-engine",
            "pliant-mesh",
            "pliant-picture",
        ],
    ),
    (
        "pliant-app",
        &[
            "pliant-assets",
            "pliant-deform",
            "pliant-editor",
            "pliant-engine",
            "pliant-io",
            "pliant-mesh",
            "pliant-picture",
            "pliant-render",
        ],
    ),
];

/// The crates with which a crate must not be linked, even indirectly (names that begin with these).
const NEVER_LINKED: &[(&str, &[&str])] = &[
    ("pliant-mesh", &["wgpu", "naga", "egui", "eframe", "winit", "serde"]),
    ("pliant-deform", &["wgpu", "naga", "egui", "eframe", "winit", "serde"]),
    (
        "pliant-stitch",
        &["wgpu", "naga", "egui", "eframe", "winit", "serde", "gltf"],
    ),
    (
        "pliant-flow",
        &["wgpu", "naga", "egui", "eframe", "winit", "serde", "gltf"],
    ),
    ("pliant-io", &["wgpu", "naga", "egui", "eframe", "winit", "faer"]),
    ("pliant-render", &["egui", "eframe", "winit", "faer", "obvhs", "gltf"]),
    ("pliant-editor", &["wgpu", "naga", "egui", "eframe", "winit", "gltf"]),
    ("pliant-engine", &["wgpu", "naga", "egui", "eframe", "winit"]),
    ("pliant-picture", &["eframe", "winit"]),
    ("pliant-python", &["eframe", "winit"]),
];

/// The crates on which a crate must not depend directly.
const NEVER_NAMED: &[(&str, &[&str])] = &[
    ("pliant-mesh", &["log", "tracing"]),
    ("pliant-deform", &["log", "tracing"]),
];

/// Paths that the sources of a crate must not name outside unit tests (those that begin with these).
const NEVER_WRITTEN: &[(&str, &[&str])] = &[
    ("mesh", OUTSIDE_WORLD),
    ("deform", OUTSIDE_WORLD),
    ("stitch", OUTSIDE_WORLD),
    ("flow", OUTSIDE_WORLD),
    ("io", OUTSIDE_WORLD),
    (
        "render",
        &["std::time::Instant", "std::fs", "std::net", "std::process", "egui"],
    ),
    (
        "editor",
        &[
            "std::time",
            "std::thread",
            "std::fs",
            "std::env",
            "std::net",
            "std::process",
        ],
    ),
    (
        "picture",
        &[
            "std::time",
            "std::thread",
            "std::fs",
            "std::env",
            "std::net",
            "std::process",
        ],
    ),
    (
        "engine",
        &["std::thread::spawn", "std::thread::scope", "std::net", "std::env"],
    ),
];

/// The clock, threads, files, and all other sources of results that depend on more than their inputs.
const OUTSIDE_WORLD: &[&str] = &[
    "std::time",
    "std::thread",
    "std::fs",
    "std::path",
    "std::env",
    "std::net",
    "std::process",
];

/// Keywords that declare a global, which two crates must not have.
const GLOBALS: &[&str] = &["static", "thread_local"];

fn workspace() -> Metadata {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let about = std::process::Command::new(rustc)
        .arg("-vV")
        .output()
        .expect("rustc runs")
        .stdout;
    let about = String::from_utf8(about).unwrap();
    let host = about
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .expect("rustc names its host");
    // Offline, because the registry has this host's crates but perhaps not other systems'.
    MetadataCommand::new()
        .manifest_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml"))
        .other_options(["--locked", "--offline", "--filter-platform", host].map(str::to_owned))
        .exec()
        .expect("cargo metadata runs")
}

/// The direct dependencies of `name`, without those of its tests.
fn asked_for(metadata: &Metadata, name: &str) -> BTreeSet<String> {
    let package = metadata
        .packages
        .iter()
        .find(|p| p.name.as_str() == name)
        .unwrap_or_else(|| panic!("no crate {name}"));
    package
        .dependencies
        .iter()
        .filter(|d| d.kind != DependencyKind::Development)
        .map(|d| d.name.clone())
        .collect()
}

/// All crates with which `name` is linked if it is built by itself: its normal dependencies and theirs, recursively. The
/// metadata would add those that other crates of the workspace ask for, such as a window for egui's renderer.
fn linked_with(name: &str) -> BTreeSet<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let tree = std::process::Command::new(cargo)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .args([
            "tree",
            "--locked",
            "--offline",
            "--edges",
            "normal",
            "--prefix",
            "none",
            "--package",
            name,
        ])
        .output()
        .expect("cargo runs");
    let said = String::from_utf8_lossy(&tree.stderr);
    assert!(tree.status.success(), "cargo tree: {said}");
    let listed = String::from_utf8(tree.stdout).unwrap();
    let names = listed.lines().filter_map(|line| line.split_whitespace().next());
    names.filter(|found| *found != name).map(str::to_owned).collect()
}

#[test]
fn crates_name_each_other_along_the_arrows_and_nowhere_else() {
    let metadata = workspace();
    let ours: BTreeSet<String> = metadata
        .workspace_packages()
        .iter()
        .map(|package| package.name.to_string())
        .filter(|name| name != "xtask" && name != "pliant-tests")
        .collect();
    assert_eq!(
        ours,
        ARROWS.iter().map(|(name, _)| (*name).to_owned()).collect(),
        "every crate has its arrows"
    );
    for (name, arrows) in ARROWS {
        let named: BTreeSet<String> = asked_for(&metadata, name).intersection(&ours).cloned().collect();
        assert_eq!(
            named,
            arrows.iter().map(|arrow| (*arrow).to_owned()).collect(),
            "{name}"
        );
    }
}

#[test]
fn xtask_needs_nothing_so_that_it_builds_in_seconds() {
    assert_eq!(asked_for(&workspace(), "xtask"), BTreeSet::new());
}

#[test]
fn crates_are_not_linked_with_what_they_must_not_know() {
    let metadata = workspace();
    for (name, words) in NEVER_LINKED {
        let linked = linked_with(name);
        assert!(linked.len() > 3, "{name} is linked with {linked:?}");
        for word in *words {
            let found = linked.iter().find(|found| found.starts_with(word));
            assert_eq!(found, None, "{name} is linked with {word}");
        }
    }
    for (name, words) in NEVER_NAMED {
        let named = asked_for(&metadata, name);
        assert!(
            words.iter().all(|word| !named.contains(*word)),
            "{name} names one of {words:?}"
        );
    }
}

#[test]
fn sources_do_not_use_what_their_crate_must_not_know() {
    for (name, words) in NEVER_WRITTEN {
        let sources = sources::of_crate(name);
        assert!(sources.len() > 10, "{name} has sources");
        for Source { file, paths } in sources {
            for word in *words {
                let segments: Vec<&str> = word.split("::").collect();
                let found = paths.iter().find(|path| begins_with(path, &segments));
                assert_eq!(found, None, "{} names {word}", file.display());
            }
        }
    }
}

#[test]
fn mesh_and_deform_have_no_globals() {
    // The choice of loops' vectors holds for a process, like its processor's features, and changes no result.
    let vectors = Path::new("mesh/src/vectors.rs");
    for name in ["mesh", "deform"] {
        let sources = sources::of_crate(name);
        for Source { file, paths } in sources.into_iter().filter(|source| !source.file.ends_with(vectors)) {
            for word in GLOBALS {
                let found = paths.iter().find(|path| begins_with(path, &[word]));
                assert_eq!(found, None, "{}", file.display());
            }
        }
    }
}

fn begins_with(path: &[String], segments: &[&str]) -> bool {
    path.len() >= segments.len() && path.iter().zip(segments).all(|(a, b)| a == b)
}
