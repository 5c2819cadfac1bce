//! Examples that an edit names: files, morph targets, numbers.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::fs;

use glam::{DQuat, DVec3};
use pliant_editor::{Beginning, EditFile};
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, assets, largest_distance, open};
use serde_json::{Value, json};

/// A bar along x, and the same with its far part turned about an elbow in its middle.
fn bar() -> Drawn {
    shapes::bar(16, 3, 3)
}

fn bent(angle: f64) -> Drawn {
    let mut bent = bar();
    for p in &mut bent.positions {
        let elbow = DVec3::new(8.0, 1.5, 1.5);
        let share = ((p.x - 6.0) / 4.0).clamp(0.0, 1.0);
        *p = elbow + DQuat::from_rotation_y(-angle * share) * (*p - elbow);
    }
    bent
}

fn edit(examples: Value) -> Value {
    json!({
        "version": 1,
        "method": { "name": "shells", "tolerance": 1e-10, "examples": examples },
        "fixed": { "slab": { "axis": "x", "from": 0.0, "to": 0.2 } },
    })
}

fn positions(path: &std::path::Path) -> Vec<DVec3> {
    open(path).model.rest_positions()
}

#[test]
fn a_file_is_met_at_weight_1_and_its_numbers_say_the_same() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let pose = folder.write_mesh("pose.off", &bent(0.9));
    let (out, report) = (folder.at("out.off"), folder.at("report.json"));
    let whole = edit(json!([{ "file": "pose.off", "weight": 1.0 }]));
    let arguments = ["--report", report.to_str().unwrap()];
    folder.apply(&file, &whole, &out, &arguments).done();
    assert!(largest_distance(&positions(&out), &positions(&pose)) < 1e-3);
    let told: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    assert_eq!(told["examples"], json!([{ "name": "pose", "weight": 1.0 }]));

    let half = edit(json!([{ "file": "pose.off", "weight": 0.5 }]));
    folder.apply(&file, &half, &out, &[]).done();
    let by_file = positions(&out);
    let from = open(&file);
    let displacements: Vec<[f64; 3]> = positions(&pose)
        .iter()
        .zip(from.model.rest_positions())
        .map(|(to, from)| (*to - from).to_array())
        .collect();
    let numbers = edit(json!([{ "displacements": displacements, "weight": 0.5 }]));
    folder.apply(&file, &numbers, &out, &[]).done();
    assert!(largest_distance(&positions(&out), &by_file) < 1e-9);
    // Half of the displacement along the arc, at the same distance from the elbow.
    let tip = |places: &[DVec3]| *places.iter().max_by(|a, b| a.x.total_cmp(&b.x)).unwrap();
    let elbow = DVec3::new(8.0, 1.5, 1.5);
    let lengths = [tip(&by_file), tip(&from.model.rest_positions())].map(|tip| tip.distance(elbow));
    assert!((lengths[0] / lengths[1] - 1.0).abs() < 0.02, "{lengths:?}");
}

#[test]
fn weights_that_are_left_out_are_found_and_reported() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    folder.write_mesh("pose.off", &bent(0.9));
    let (out, report) = (folder.at("out.off"), folder.at("report.json"));
    let mut free = edit(json!([{ "name": "bow", "file": "pose.off" }]));
    free["handles"] = json!([{
        "select": { "slab": { "axis": "x", "from": 0.8, "to": 1.0 } },
        "transform": { "rotation": [0.0, -(0.45_f64.sin()), 0.0, 0.45_f64.cos()], "pivot": [8.0, 1.5, 1.5] },
    }]);
    let arguments = ["--report", report.to_str().unwrap()];
    folder.apply(&file, &free, &out, &arguments).done();
    let told: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    let weight = told["examples"][0]["weight"].as_f64().unwrap();
    assert!((weight - 1.0).abs() < 1e-2, "{weight}");
    assert_eq!(told["examples"][0]["name"], "bow");
}

#[test]
fn a_morph_target_of_the_file_is_an_example() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let pose = folder.write_mesh("pose.off", &bent(0.6));
    let bow = edit(json!([{ "file": "pose.off", "weight": 1.0 }]));
    let morphed = folder.at("morphed.glb");
    folder.apply(&file, &bow, &morphed, &["--as-morph", "Bow"]).done();
    let scene = open(&morphed);
    assert_eq!(scene.scene.morph_targets(), ["Bow"]);
    let out = folder.at("out.glb");
    let by_target = edit(json!([{ "morph_target": "Bow", "weight": 1.0 }]));
    folder.apply(&morphed, &by_target, &out, &[]).done();
    let expected: Vec<DVec3> = positions(&pose);
    let error = largest_distance(&positions(&out), &expected);
    assert!(error < 1e-3, "{error}");
    let unknown = edit(json!([{ "morph_target": "Smile", "weight": 1.0 }]));
    folder
        .apply(&morphed, &unknown, &out, &[])
        .refused(1, &["Smile", "Bow"]);
}

#[test]
fn weights_of_0_and_weights_to_be_found_without_handles_change_nothing() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    folder.write_mesh("pose.off", &bent(0.9));
    let out = folder.at("out.off");
    let rest = edit(json!([{ "file": "pose.off", "weight": 0.0 }, { "file": "pose.off" }]));
    folder.apply(&file, &rest, &out, &[]).done();
    assert_eq!(fs::read(&out).unwrap(), fs::read(&file).unwrap());
}

#[test]
fn what_does_not_fit_is_refused_in_a_sentence_and_nothing_is_written() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    folder.write_mesh("other.off", &shapes::bar(15, 3, 3));
    let count = open(&file).model.drawn.vertex_count().to_string();
    let other = open(&folder.at("other.off")).model.drawn.vertex_count().to_string();
    let cases: [(Value, Vec<&str>); 7] = [
        (
            json!([{ "file": "other.off" }]),
            vec!["other.off", &other, &count, "bar.off"],
        ),
        (json!([{ "file": "missing.off" }]), vec!["missing.off"]),
        (
            json!([{ "weight": 0.5 }]),
            vec!["method.examples[0]", "`file`", "`morph_target`"],
        ),
        (
            json!([{ "file": "a.off", "morph_target": "b" }]),
            vec!["method.examples[0]", "keep one"],
        ),
        (
            json!([{ "file": "other.off", "weight": 11.0 }]),
            vec!["method.examples[0].weight", "10"],
        ),
        (
            json!([{ "displacements": [[0, 0, 0]] }]),
            vec!["method.examples[0].displacements", &count],
        ),
        (json!([{ "morph_target": "Smile" }]), vec!["Smile", "bar.off"]),
    ];
    for (examples, words) in cases {
        let out = folder.write("out.off", "kept");
        folder.apply(&file, &edit(examples), &out, &[]).refused(1, &words);
        assert_eq!(fs::read_to_string(out).unwrap(), "kept");
    }
}

#[test]
fn an_edit_says_its_examples_again() {
    let text = edit(json!([
        { "name": "pose", "file": "pose.off", "weight": 0.5 },
        { "name": "Smile", "morph_target": "Smile" },
        { "name": "example 3", "displacements": [[0.1, 0.0, -2.5]], "weight": -1.0 },
    ]));
    let parsed = EditFile::from_value(&text).unwrap();
    assert_eq!(EditFile::from_value(&parsed.to_value()).unwrap(), parsed);
    assert!(!Beginning::from(parsed).changes_nothing());
}

/// The shipped face: its weights multiply the wrinkles, and without weights it is the thin plate.
#[test]
fn the_faces_edit_wrinkles_it_by_the_weights_of_its_examples() {
    let folder = Folder::new();
    let (out, report) = (folder.at("out.off"), folder.at("report.json"));
    let text = fs::read_to_string(assets().join("face.edit.json")).unwrap();
    let wrinkled: Value = serde_json::from_str(&text).unwrap();
    let bent = |weight: Option<f64>, method: Option<&str>| {
        let mut edit = wrinkled.clone();
        if let Some(weight) = weight {
            let examples = edit["method"]["examples"].as_array_mut().unwrap();
            examples.iter_mut().for_each(|own| own["weight"] = json!(weight));
        }
        if let Some(name) = method {
            edit["method"] = json!({ "name": name });
        }
        let arguments = ["--report", report.to_str().unwrap()];
        folder.apply(&assets().join("face.glb"), &edit, &out, &arguments).done();
        let told: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
        (positions(&out), told)
    };
    let (plain, _) = bent(None, Some("bilaplacian"));
    let (without, _) = bent(Some(0.0), None);
    let (half, _) = bent(Some(0.5), None);
    let (whole, told) = bent(None, None);
    for (example, name) in told["examples"]
        .as_array()
        .unwrap()
        .iter()
        .zip(["Brows raised", "Frown", "Smile"])
    {
        assert_eq!(*example, json!({ "name": name, "weight": 1.0 }));
    }
    assert!(largest_distance(&without, &plain) < 1e-5);
    let expected: Vec<DVec3> = plain.iter().zip(&whole).map(|(a, b)| a.midpoint(*b)).collect();
    assert!(largest_distance(&half, &expected) < 1e-5);
    assert!(largest_distance(&whole, &plain) > 0.01);
}
