//! An edit that moves nothing gives back the file's own bytes, and converting a file moves no vertex.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use pliant_tests::{Folder, bare_edit, bend, data, diagonal, extension, largest_distance, open, try_open};
use serde_json::json;

#[test]
fn an_edit_without_handles_gives_the_same_bytes_for_every_file_that_opens() {
    for path in data(&["scans", "survey", "gltf", "bad"]) {
        if try_open(&path).is_ok_and(|loaded| !loaded.model.surface.triangles.is_empty()) {
            let folder = Folder::new();
            let out = folder.at(&format!("out.{}", extension(&path)));
            folder.apply(&path, &bare_edit(), &out, &[]).done();
            assert!(
                fs::read(&out).unwrap() == fs::read(&path).unwrap(),
                "{} changed",
                path.display()
            );
        }
    }
}

#[test]
fn identity_transforms_give_the_same_bytes() {
    let folder = Folder::new();
    for (name, drawn) in pliant_mesh::shapes::classes() {
        let file = folder.write_mesh("in.off", &drawn);
        for transform in [
            json!({}),
            json!({ "pivot": [3, 4, 5] }),
            json!({ "translation": [0, 0, 0], "rotation": [0, 0, 0, 2], "scale": [1, 1, 1] }),
            json!({ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }),
        ] {
            let edit = json!({
                "version": 1, "method": { "name": "bilaplacian" },
                "handles": [{ "select": "all", "transform": transform }],
            });
            let out = folder.at("out.off");
            folder.apply(&file, &edit, &out, &["--frames", "3"]).done();
            assert!(
                fs::read(&out).unwrap() == fs::read(&file).unwrap(),
                "{name}, {transform}"
            );
        }
    }
}

#[test]
fn a_file_may_be_replaced_by_itself_edited() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &pliant_mesh::shapes::icosphere(2));
    let before = open(&file).model.rest_positions();
    folder
        .apply(&file, &bend(&json!({ "translation": [0, 0, 1] })), &file, &[])
        .done();
    assert!(largest_distance(&before, &open(&file).model.rest_positions()) > 0.9);
    assert_eq!(folder.names(), ["mesh.off"]);
}

/// Every format converted to every other: the same triangles at the same positions, to the precision of f32.
#[test]
fn every_kind_becomes_every_other_kind_in_place() {
    let kinds = ["glb", "gltf", "obj", "ply", "stl", "off"];
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &pliant_mesh::shapes::torus(12, 8));
    for from in kinds {
        let source = folder.at(&format!("source.{from}"));
        folder.apply(&mesh, &bare_edit(), &source, &[]).done();
        for to in kinds {
            let out = folder.at(&format!("out.{to}"));
            folder.apply(&source, &bare_edit(), &out, &[]).done();
            let (before, after) = (open(&source).model, open(&out).model);
            assert_eq!(
                before.surface.triangles.len(),
                after.surface.triangles.len(),
                "{from} to {to}"
            );
            let corners = |model: &pliant_mesh::Model| -> Vec<_> {
                let drawn = model.rest();
                let corners = drawn.triangles.as_flattened().iter();
                corners.map(|v| drawn.positions[v.index()]).collect()
            };
            let (before, after) = (corners(&before), corners(&after));
            assert!(
                largest_distance(&before, &after) <= 1e-6 * diagonal(&before),
                "{from} to {to}"
            );
        }
    }
}
