//! The same input gives the same bytes on any number of threads.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use pliant_tests::{Folder, assets, bend, datum, extension};
use serde_json::json;

#[track_caller]
fn assert_same_on_every_number_of_threads(file: &Path) {
    let folder = Folder::new();
    let edit = bend(&json!({ "translation": [0, 0.2, 0.1], "rotation": [0, 0.1, 0.3, 0.9] }));
    let written: Vec<Vec<u8>> = ["1", "2", "3", "7"]
        .map(|threads| {
            let out = folder.at(&format!("out.{}", extension(file)));
            folder
                .apply(file, &edit, &out, &["--threads", threads, "--frames", "3"])
                .done();
            fs::read(out).unwrap()
        })
        .into();
    assert!(
        written.iter().all(|bytes| *bytes == written[0]),
        "{} differs",
        file.display()
    );
    assert!(written[0] != fs::read(file).unwrap(), "{} was bent", file.display());
}

#[test]
fn shapes_of_every_class_come_out_the_same() {
    let folder = Folder::new();
    for (name, drawn) in pliant_mesh::shapes::classes() {
        let file = folder.write_mesh(&format!("{}.off", name.replace(' ', "-")), &drawn);
        assert_same_on_every_number_of_threads(&file);
    }
}

#[test]
fn samples_and_scans_come_out_the_same() {
    for sample in ["creature", "plane", "cylinder", "bar", "cactus"] {
        assert_same_on_every_number_of_threads(&assets().join(format!("{sample}.glb")));
    }
    for name in [
        "scans/armadillo.obj",
        "gltf/DamagedHelmet.glb",
        "scans/horse.ply",
        "scans/unit_sphere.stl",
    ] {
        if let Some(file) = datum(name) {
            assert_same_on_every_number_of_threads(&file);
        }
    }
}
