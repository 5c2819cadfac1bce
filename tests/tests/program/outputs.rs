//! A command's output is never one of its input files, under any name, and replaces no file that has changed since;
//! warnings are printed without a report.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DAffine3, DQuat, DVec3};
use pliant_editor::Beginning;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;
use pliant_engine::{Apply, EditJob, apply, memory};
use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit, bend, run};
use serde_json::json;

/// A folder in which a bar is bent by an example that is a glTF with a buffer beside it, and by a cage. Returns all of
/// its files.
fn folder() -> (Folder, Vec<PathBuf>) {
    let folder = Folder::new();
    let bar = folder.write_mesh("bar.off", &shapes::bar(12, 2, 2));
    for name in ["rest.gltf", "pose.gltf"] {
        folder.apply(&bar, &bare_edit(), &folder.at(name), &[]).done();
    }
    let around =
        DAffine3::from_scale_rotation_translation(DVec3::new(20.0, 10.0, 10.0), DQuat::IDENTITY, DVec3::splat(-4.0));
    folder.write_mesh("cage.off", &shapes::moved(&shapes::bar(1, 1, 1), around));
    let edits = [
        (
            "examples.json",
            json!({ "version": 1,
                "method": { "name": "shells", "examples": [{ "file": "pose.gltf", "weight": 1.0 }] } }),
        ),
        (
            "cage.json",
            json!({ "version": 1, "method": { "name": "cage", "cage": { "file": "cage.off" } } }),
        ),
    ];
    for (name, edit) in edits {
        folder.write(name, edit.to_string());
    }
    let files = folder.names().iter().map(|name| folder.at(name)).collect();
    (folder, files)
}

fn contents(files: &[PathBuf]) -> Vec<Vec<u8>> {
    files.iter().map(|file| fs::read(file).unwrap()).collect()
}

fn arguments(words: &[&str], folder: &Folder) -> Vec<OsString> {
    let is_file = |word: &str| word.contains('.') && !word.starts_with("--");
    let argument = |word: &&str| match is_file(word) {
        true => folder.at(word).into_os_string(),
        false => word.into(),
    };
    words.iter().map(argument).collect()
}

#[test]
fn no_output_of_any_command_is_a_file_that_it_reads() {
    let (folder, files) = folder();
    let before = contents(&files);
    let buffers: Vec<String> = folder
        .names()
        .into_iter()
        .filter(|name| name.ends_with(".bin"))
        .collect();
    assert_eq!(buffers.len(), 2, "{buffers:?}");
    let of_examples = ["rest.gltf", "--edit", "examples.json"];
    let of_cage = ["bar.off", "--edit", "cage.json"];
    let mut asked = 0;
    for (edited, read) in [
        (
            of_examples,
            ["pose.gltf", &buffers[0], &buffers[1], "examples.json", "rest.gltf"],
        ),
        (of_cage, ["cage.off", "./cage.off", "cage.json", "bar.off", "./bar.off"]),
    ] {
        for read in read {
            for words in [
                [&["apply"], &edited[..], &["--output", "out.glb", "--report", read]].concat(),
                [
                    &["compare"],
                    &edited[..],
                    &["--methods", "bilaplacian", "--output", "sheet.png", "--report", read],
                ]
                .concat(),
            ] {
                run(arguments(&words, &folder)).refused(2, &["--report", "is also"]);
                assert_eq!(contents(&files), before, "{words:?}");
                assert!(!folder.at("out.glb").exists() && !folder.at("sheet.png").exists());
                asked += 1;
            }
        }
    }
    // An output in an input's format: the example itself, and a transferred pose.
    for words in [
        &["apply", "rest.gltf", "--edit", "examples.json", "--output", "pose.gltf"][..],
        &["apply", "bar.off", "--edit", "cage.json", "--output", "cage.off"],
        &["transfer", "bar.off", "bar.off", "rest.gltf", "--output", "bar.off"],
    ] {
        run(arguments(words, &folder)).refused(2, &["--output", "is also"]);
        assert_eq!(contents(&files), before, "{words:?}");
        asked += 1;
    }
    assert_eq!(asked, 23);
}

#[test]
fn a_file_that_changes_while_it_is_bent_is_not_replaced() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &shapes::bar(12, 2, 2));
    let edit = Beginning::parse(&bend(&json!({ "translation": [0.0, 0.5, 0.0] })).to_string()).unwrap();
    let job = |output: &Path| {
        let job = Apply {
            job: EditJob {
                file: &file,
                edit: &edit,
                edit_path: Path::new("edit.json"),
                output,
                report: None,
                budget: memory::budget(),
                weld: Default::default(),
            },
            frames: None,
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            morph: None,
        };
        apply(&job, &Watch::default(), &Staging::default())
    };
    let loaded = pliant_tests::open(&file);
    job(&file).unwrap();
    let bent = fs::read(&file).unwrap();
    // The earlier input is another file now; a file of another name is free.
    let staging = Staging::default();
    let staged = |name: &str| staging.stage([(folder.at(name), &b"new"[..])]).unwrap();
    let error = loaded.refuse_changed(&staged("bar.off")).unwrap_err().to_string();
    assert!(
        error.contains("bar.off") && error.contains("changed by another program"),
        "{error}"
    );
    loaded.refuse_changed(&staged("other.off")).unwrap();
    assert_eq!(fs::read(&file).unwrap(), bent);
    // Its own save is no change for a new reader.
    job(&file).unwrap();
}

#[test]
fn warnings_reach_standard_error_without_a_report() {
    let folder = Folder::new();
    // Two handles hold all of one part, which nothing holds back.
    let file = folder.write_mesh("bar.off", &shapes::bar(12, 2, 2));
    let mut edit = bend(&json!({ "translation": [0.0, 0.5, 0.0] }));
    edit["fixed"] = json!("none");
    let report = folder.at("report.json");
    let out = folder.at("out.off");
    let silent = folder.apply(&file, &edit, &out, &[]).done();
    folder
        .apply(&file, &edit, &out, &["--report", report.to_str().unwrap()])
        .done();
    let report: serde_json::Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    let warnings = report["warnings"].as_array().unwrap();
    assert!(!warnings.is_empty());
    let lines: Vec<String> = warnings
        .iter()
        .map(|warning| format!("pliant: warning: {}", warning.as_str().unwrap()))
        .collect();
    assert_eq!(silent.err.lines().collect::<Vec<_>>(), lines);
}

#[test]
fn a_second_morph_target_needs_a_name_of_its_own() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &shapes::bar(12, 2, 2));
    let edit = bend(&json!({ "translation": [0.0, 0.5, 0.0] }));
    let (first, second) = (folder.at("first.glb"), folder.at("second.glb"));
    folder.apply(&file, &edit, &first, &["--as-morph", "Lean"]).done();
    folder
        .apply(&first, &edit, &second, &["--as-morph", "Lean"])
        .refused(1, &["first.glb", "Lean", "another name"]);
    assert!(!second.exists());
    folder
        .apply(&first, &edit, &second, &["--as-morph", "Lean more"])
        .done();
    assert_eq!(pliant_tests::open(&second).scene.morph_targets(), ["Lean", "Lean more"]);
}

#[test]
fn a_part_that_is_inside_out_is_turned_under_a_morph_target_too() {
    let folder = Folder::new();
    let mut drawn = shapes::icosphere(3);
    drawn.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let file = folder.write_mesh("ball.off", &drawn);
    let mut edit = bend(&json!({ "translation": [0.0, 0.3, 0.1] }));
    edit["inside_out"] = json!("all");
    let (morphed, bent) = (folder.at("morphed.glb"), folder.at("bent.glb"));
    folder.apply(&file, &edit, &morphed, &["--as-morph", "Lean"]).done();
    folder.apply(&file, &edit, &bent, &[]).done();
    let [morphed, bent] = [morphed, bent].map(|path| pliant_tests::open(&path).model);
    assert!(morphed.inside_out.is_empty());
    assert_eq!(morphed.drawn_triangles(), bent.drawn_triangles());
    let apart = pliant_tests::largest_distance(&morphed.rest_positions(), &bent.rest_positions());
    assert!(apart < 1e-6, "{apart}");
}
