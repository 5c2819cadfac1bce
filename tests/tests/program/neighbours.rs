//! A `.gltf` with its buffers and images on disk: copied, kept apart, or refused.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit, bend, datum, diagonal, largest_distance, open};
use serde_json::{Value, json};

fn shift() -> Value {
    bend(&json!({ "translation": [0, 0, 1] }))
}

/// `scan.gltf` with its buffer, in the subfolder `source` of a new folder.
fn gltf_in_a_folder() -> (Folder, PathBuf) {
    let folder = Folder::new();
    fs::create_dir(folder.at("source")).unwrap();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let scan = folder.at("source/scan.gltf");
    folder.apply(&mesh, &bare_edit(), &scan, &[]).done();
    (folder, scan)
}

fn buffer_uri(gltf: &Path) -> String {
    let json: Value = serde_json::from_slice(&fs::read(gltf).unwrap()).unwrap();
    json["buffers"][0]["uri"].as_str().unwrap().to_owned()
}

/// Every file in a folder with its bytes.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            (
                path.file_name().unwrap().to_string_lossy().into_owned(),
                fs::read(path).unwrap(),
            )
        })
        .collect()
}

#[track_caller]
fn assert_was_bent(before: &Path, after: &Path) {
    let (before, after) = (open(before).model, open(after).model);
    let (before, after) = (before.rest_positions(), after.rest_positions());
    assert!(largest_distance(&before, &after) > 0.1 * diagonal(&before));
}

#[test]
fn in_another_folder_the_neighbours_come_along() {
    let (folder, scan) = gltf_in_a_folder();
    let before = contents(&folder.at("source"));
    for (name, edit) in [("same", bare_edit()), ("bent", shift())] {
        let target = folder.at(name);
        fs::create_dir(&target).unwrap();
        let out = target.join("scan.gltf");
        folder.apply(&scan, &edit, &out, &[]).done();
        assert_eq!(contents(&folder.at("source")), before);
        let after = contents(&target);
        assert_eq!(after.keys().collect::<Vec<_>>(), before.keys().collect::<Vec<_>>());
        if name == "same" {
            assert_eq!(after, before);
        } else {
            assert_was_bent(&scan, &out);
        }
    }
}

#[test]
fn in_the_same_folder_under_another_name_the_files_own_neighbours_stay() {
    let (folder, scan) = gltf_in_a_folder();
    let before = contents(&folder.at("source"));
    let out = folder.at("source/bent.gltf");
    folder.apply(&scan, &shift(), &out, &[]).done();
    let after = contents(&folder.at("source"));
    assert!(before.iter().all(|(name, bytes)| after.get(name) == Some(bytes)));
    assert_ne!(buffer_uri(&out), buffer_uri(&scan));
    assert_was_bent(&scan, &out);
}

#[test]
fn a_gltf_that_replaces_itself_keeps_its_names() {
    let (folder, scan) = gltf_in_a_folder();
    let kept = folder.at("kept.glb");
    folder.apply(&scan, &bare_edit(), &kept, &[]).done();
    let before = contents(&folder.at("source"));
    folder.apply(&scan, &shift(), &scan, &[]).done();
    let after = contents(&folder.at("source"));
    assert_eq!(after.keys().collect::<Vec<_>>(), before.keys().collect::<Vec<_>>());
    assert_was_bent(&kept, &scan);
}

#[test]
fn a_neighbour_outside_of_the_folder_is_read_and_never_written() {
    let (folder, scan) = gltf_in_a_folder();
    let uri = buffer_uri(&scan);
    fs::rename(folder.at("source").join(&uri), folder.at("outside.bin")).unwrap();
    let text = fs::read_to_string(&scan).unwrap().replace(&uri, "../outside.bin");
    fs::write(&scan, text).unwrap();
    let outside = fs::read(folder.at("outside.bin")).unwrap();
    let before = contents(&folder.at("source"));

    fs::create_dir(folder.at("target")).unwrap();
    folder
        .apply(&scan, &shift(), &folder.at("target/scan.gltf"), &[])
        .refused(1, &["../outside.bin", ".glb"]);
    folder
        .apply(&scan, &shift(), &scan, &[])
        .refused(1, &["../outside.bin", ".glb"]);
    assert!(contents(&folder.at("target")).is_empty());
    assert_eq!(contents(&folder.at("source")), before);
    assert_eq!(fs::read(folder.at("outside.bin")).unwrap(), outside);

    let packed = folder.at("target/scan.glb");
    folder.apply(&scan, &shift(), &packed, &[]).done();
    assert_was_bent(&scan, &packed);
}

#[test]
fn a_buffer_that_another_file_misses_is_left_to_it() {
    let (folder, gltf) = gltf_in_a_folder();
    let missed = buffer_uri(&gltf);
    // Another copy that has lost its buffer, in the result's folder.
    fs::create_dir(folder.at("other")).unwrap();
    let (lost, output) = (folder.at("other/lost.gltf"), folder.at("other/out.gltf"));
    fs::copy(&gltf, &lost).unwrap();
    folder.apply(&gltf, &shift(), &output, &[]).done();
    assert!(!folder.at("other").join(&missed).exists());
    assert_ne!(buffer_uri(&output), missed);
    assert_was_bent(&gltf, &output);
}

#[test]
fn a_missing_neighbour_is_named() {
    let (folder, scan) = gltf_in_a_folder();
    let uri = buffer_uri(&scan);
    fs::remove_file(folder.at("source").join(&uri)).unwrap();
    folder
        .apply(&scan, &shift(), &folder.at("out.gltf"), &[])
        .refused(1, &["scan.gltf", &uri]);
}

/// A file with many images is unchanged after packing and unpacking.
#[test]
fn a_real_gltf_is_packed_and_unpacked() {
    let Some(helmet) = datum("gltf/FlightHelmet/FlightHelmet.gltf") else {
        return;
    };
    let folder = Folder::new();
    let (glb, gltf) = (folder.at("helmet.glb"), folder.at("helmet.gltf"));
    folder.apply(&helmet, &bare_edit(), &glb, &[]).done();
    folder.apply(&glb, &bare_edit(), &gltf, &[]).done();
    let (first, last) = (open(&helmet), open(&gltf));
    assert_eq!(first.scene.summary(), last.scene.summary());
    assert_eq!(first.model.rest_positions(), last.model.rest_positions());
    assert_eq!(
        first.scene.appearance().images.len(),
        last.scene.appearance().images.len()
    );
}
