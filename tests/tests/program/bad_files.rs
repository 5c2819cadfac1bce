//! Broken, empty and odd files: each is read, or refused in one line, and none crashes the program.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use pliant_tests::{Folder, bend, data, extension, open, run};
use serde_json::json;

/// `info` and `apply` of a file end with status 0, or with status 1 and one line; a refused file leaves no OUT.
#[track_caller]
fn assert_read_or_refused(path: &std::path::Path) {
    let folder = Folder::new();
    let info = run(["info".as_ref(), path.as_os_str()]);
    if info.status == 0 {
        info.done();
    } else {
        info.refused(1, &[]);
    }
    let out = folder.at(&format!("out.{}", extension(path)));
    let edit = bend(&json!({ "translation": [0.1, 0.2, 0.3] }));
    let applied = folder.apply(path, &edit, &out, &[]);
    if applied.status == 0 {
        applied.done();
        assert!(open(&out).model.surface.positions.iter().all(|p| p.is_finite()));
    } else {
        applied.refused(1, &[]);
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }
}

#[test]
fn every_bad_file_is_read_or_refused_by_one_line() {
    for path in data(&["bad"]) {
        assert_read_or_refused(&path);
    }
}

/// The shortest file of each kind, truncated and with single bytes changed, in a fixed sequence.
#[test]
fn damaged_files_are_read_or_refused_by_one_line() {
    let folder = Folder::new();
    let mut shortest = std::collections::BTreeMap::new();
    for path in data(&["scans", "survey", "gltf", "bad"]) {
        let size = fs::metadata(&path).unwrap().len();
        let best = shortest.entry(extension(&path)).or_insert((u64::MAX, path.clone()));
        if size > 100 && size < best.0 {
            *best = (size, path);
        }
    }
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    for (extension, (_, path)) in shortest {
        let whole = fs::read(&path).unwrap();
        for turn in 0..24 {
            let mut bytes = whole.clone();
            let mut next = |below: usize| {
                random = random
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (random >> 33) as usize % below.max(1)
            };
            if turn % 2 == 0 {
                bytes.truncate(next(whole.len()));
            } else {
                for _ in 0..=next(4) {
                    let at = next(bytes.len());
                    bytes[at] = next(256) as u8;
                }
            }
            assert_read_or_refused(&folder.write(&format!("damaged.{extension}"), bytes));
        }
    }
}

#[test]
fn an_empty_file_of_every_kind_is_read_or_refused_by_one_line() {
    let folder = Folder::new();
    for extension in ["glb", "gltf", "obj", "ply", "stl", "off"] {
        assert_read_or_refused(&folder.write(&format!("empty.{extension}"), ""));
    }
}

#[test]
fn a_file_without_a_triangle_is_told_and_not_edited() {
    let folder = Folder::new();
    let file = folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let info = run(["info".as_ref(), file.as_os_str()]).done();
    assert!(info.out.contains("none"), "{}", info.out);
    let out = folder.at("out.obj");
    folder
        .apply(&file, &pliant_tests::bare_edit(), &out, &[])
        .refused(1, &["points.obj", "no triangle"]);
    assert!(!out.exists());
}

#[test]
fn files_that_are_not_there_or_not_files_are_named() {
    let folder = Folder::new();
    run(["info".as_ref(), folder.at("nothing.ply").as_os_str()]).refused(1, &["nothing.ply", "no such file"]);
    fs::create_dir(folder.at("folder.ply")).unwrap();
    run(["info".as_ref(), folder.at("folder.ply").as_os_str()]).refused(1, &["folder.ply", "is a folder"]);
    let text = folder.write("scan.txt", "");
    run(["info".as_ref(), text.as_os_str()]).refused(1, &["scan.txt", ".glb"]);
}
