//! A file's neighbours are ordinary files by relative paths, read once each and within a budget.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use pliant_engine::files::Neighbours;
use pliant_io::Resolver as _;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    fs::write(folder.path().join("in/a.bin"), b"inside").unwrap();
    fs::write(folder.path().join("b.bin"), b"outside").unwrap();
    folder
}

fn neighbours(folder: &Path) -> Neighbours {
    Neighbours::of(&folder.join("in/scan.gltf"))
}

#[test]
fn every_spelling_of_a_path_gives_the_same_bytes_read_once() {
    let folder = folder();
    let neighbours = neighbours(folder.path());
    let first = neighbours.read("a.bin").unwrap();
    assert_eq!(*first, *b"inside");
    let mut spellings = vec!["./a.bin", "b/../a.bin", "../in/a.bin", ".//a.bin"];
    if cfg!(unix) {
        std::os::unix::fs::symlink("a.bin", folder.path().join("in/link.bin")).unwrap();
        spellings.push("link.bin");
    }
    // If it had been read again, it would be the new one.
    fs::write(folder.path().join("in/a.bin"), b"changed").unwrap();
    for spelling in spellings {
        assert_eq!(neighbours.read(spelling).unwrap().place(), first.place(), "{spelling}");
    }
    assert_eq!(*neighbours.read("../b.bin").unwrap(), *b"outside");
}

#[test]
fn absolute_paths_and_shares_are_refused_though_the_file_is_there() {
    let folder = folder();
    let neighbours = neighbours(folder.path());
    let there = folder.path().join("b.bin");
    for uri in [
        there.to_str().unwrap(),
        "//server/share/b.bin",
        "\\\\server\\share\\b.bin",
        "C:\\b.bin",
        "/dev/zero",
    ] {
        let refused = neighbours.read(uri).unwrap_err();
        assert!(refused.contains("absolute"), "{uri}: {refused}");
    }
}

#[test]
fn sizes_are_added_up_against_a_budget_that_is_told() {
    let folder = folder();
    let within = |bytes: u64| neighbours(folder.path()).within(bytes);
    let enough = within(13);
    assert!(enough.read("a.bin").is_ok() && enough.read("../b.bin").is_ok());
    let less = within(12);
    assert!(
        less.read("a.bin").is_ok() && less.read("./a.bin").is_ok(),
        "each counts once"
    );
    let refused = less.read("../b.bin").unwrap_err();
    assert!(refused.contains("GiB"), "{refused}");
    assert!(within(5).read("a.bin").is_err());
    // No memory is allocated for a file that is too large, even a sparse one larger than the memory.
    let huge = fs::File::create(folder.path().join("in/huge.bin")).unwrap();
    if huge.set_len(1 << 42).is_ok() {
        assert!(neighbours(folder.path()).read("huge.bin").is_err());
    }
}

#[cfg(unix)]
#[test]
fn what_would_wait_or_never_end_is_not_opened() {
    let folder = folder();
    let pipe = folder.path().join("in/pipe.bin");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
    assert!(made.success());
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("in/zero.bin")).unwrap();
    let neighbours = neighbours(folder.path());
    for uri in ["pipe.bin", "zero.bin", "../in"] {
        assert!(neighbours.read(uri).is_err(), "{uri}");
    }
    // A system file without a size has an end all the same: the budget's.
    std::os::unix::fs::symlink("/proc/self/maps", folder.path().join("in/maps.bin")).unwrap();
    assert!(self::neighbours(folder.path()).within(16).read("maps.bin").is_err());
}

/// A save through a link can be read through the link again.
#[cfg(unix)]
#[test]
fn behind_a_link_the_neighbours_of_its_target_count() {
    let folder = folder();
    fs::write(folder.path().join("a.bin"), b"beside the link").unwrap();
    fs::write(folder.path().join("c.bin"), b"beside the link alone").unwrap();
    fs::write(folder.path().join("in/scan.gltf"), b"{}").unwrap();
    std::os::unix::fs::symlink("in/scan.gltf", folder.path().join("link.gltf")).unwrap();
    let neighbours = Neighbours::of(&folder.path().join("link.gltf"));
    assert_eq!(*neighbours.read("a.bin").unwrap(), *b"inside");
    assert_eq!(*neighbours.read("c.bin").unwrap(), *b"beside the link alone");
}
