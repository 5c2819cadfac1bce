//! The same input gives the same bytes on any number of threads and with any vectors.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use pliant_mesh::Vectors;
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
fn narrow_vectors_give_the_bytes_of_wide_ones() {
    let folder = Folder::new();
    let file = assets().join("creature.glb");
    let edit = bend(&json!({ "translation": [0, 0.2, 0.1], "rotation": [0, 0.1, 0.3, 0.9] }));
    let written = |name: &str, further: &[&str]| {
        let out = folder.at(&format!("{name}.glb"));
        let mut arguments = vec!["--method", "arap"];
        arguments.extend(further);
        folder.apply(&file, &edit, &out, &arguments).done();
        fs::read(out).unwrap()
    };
    let widest = written("widest", &[]);
    for vectors in Vectors::ALL.into_iter().filter(|vectors| vectors.is_available()) {
        let name = vectors.name();
        assert!(written(name, &["--vectors", name]) == widest, "{name}");
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
