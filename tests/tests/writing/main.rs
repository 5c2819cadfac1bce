//! The files that a save may overwrite, its place, and the files that it keeps: nobody loses a file.

#![cfg(unix)]
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says what it skips"
)]

mod file_system;
mod neighbours;

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_mesh::shapes;
use pliant_tests::{Ended, Folder, bare_edit, bend, open, run};
use serde_json::{Value, json};

fn lift(by: f64) -> Value {
    bend(&json!({ "translation": [0, 0, by] }))
}

/// A glTF of a torus in its own folder, with a buffer named `scene.bin`, like downloads from one site.
fn download(folder: &Folder, name: &str, sides: usize) -> PathBuf {
    let gltf = saved(folder, name, sides);
    fs::rename(gltf.with_extension("bin"), gltf.with_file_name("scene.bin")).unwrap();
    replace_in(&gltf, &format!("{name}.bin"), "scene.bin");
    gltf
}

/// A glTF in a folder of its name, whose buffer also has that name.
fn saved(folder: &Folder, name: &str, sides: usize) -> PathBuf {
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, sides));
    fs::create_dir(folder.at(name)).unwrap();
    let gltf = folder.at(&format!("{name}/{name}.gltf"));
    folder.apply(&mesh, &bare_edit(), &gltf, &[]).done();
    fs::remove_file(mesh).unwrap();
    gltf
}

fn replace_in(path: &Path, old: &str, new: &str) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(old), "{old} is not in {text}");
    fs::write(path, text.replace(old, new)).unwrap();
}

fn shape(path: &Path) -> Vec<DVec3> {
    open(path).model.rest_positions()
}

/// Every file below a folder with its bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut out = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let metadata = fs::symlink_metadata(&path).unwrap();
        if metadata.is_dir() {
            out.extend(contents(&path));
        } else if metadata.is_file() {
            out.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    out
}

fn names(folder: &Path) -> Vec<OsString> {
    let mut names: Vec<OsString> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    names
}

fn warnings(report: &Path) -> String {
    let report: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    report["warnings"].to_string()
}

fn apply(file: &Path, edit: &Path, out: &Path, more: &[&OsStr]) -> Ended {
    let mut words: Vec<OsString> = ["apply".into(), file.into(), "--edit".into(), edit.into()].into();
    words.extend(["--output".into(), out.into()]);
    words.extend(more.iter().map(Into::into));
    run(words)
}
