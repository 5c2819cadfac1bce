//! `apply` of an exported edit to another mesh of the same object.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::fs;

use glam::{DAffine3, DVec3};
use pliant_editor::EditFile;
use pliant_mesh::shapes;
use pliant_tests::{Folder, open};
use serde_json::{Value, json};

/// An edit of the ball in `file` as the window exports it: its top goes up, its lower half stays.
fn exported(file: &std::path::Path) -> Value {
    let loaded = open(file);
    let above = |height: f64| -> Vec<usize> {
        let positions = loaded.model.rest_positions();
        let numbered = positions.iter().enumerate().filter(|(_, p)| p.z > height);
        numbered.map(|(vertex, _)| vertex).collect()
    };
    let edit = json!({
        "version": 1,
        "method": { "name": "bilaplacian" },
        "region": { "vertices": above(0.0) },
        "handles": [
            { "name": "top", "select": { "vertices": above(0.8) }, "transform": { "translation": [0, 0, 0.5] } },
        ],
    });
    let edit = EditFile::parse(&edit.to_string()).unwrap();
    edit.with_places(&loaded.model).unwrap().to_value()
}

#[test]
fn an_exported_edit_bends_another_scan_and_reports_what_it_found() {
    let folder = Folder::new();
    let edit = exported(&folder.write_mesh("ball.off", &shapes::icosphere(4)));
    let (out, report) = (folder.at("out.off"), folder.at("report.json"));
    let fine = shapes::uv_sphere(33, 50);
    for (name, drawn) in [("soup.off", shapes::soup(&fine)), ("fine.off", fine)] {
        let other = folder.write_mesh(name, &drawn);
        let more = ["--report", report.to_str().unwrap()];
        folder.apply(&other, &edit, &out, &more).done();
        let report: Value = serde_json::from_slice(&fs::read(&report).unwrap()).unwrap();
        let found = report["matched_by_place"]["found"].as_array().unwrap();
        assert_eq!(
            (&found[0]["set"], &found[0]["share"]),
            (&json!("`top`"), &json!(1.0)),
            "{name}"
        );
        let warning = report["warnings"][0].as_str().unwrap();
        assert!(
            warning.contains("another mesh") && warning.contains("100% of `top`"),
            "{warning}"
        );
        let highest = |path| {
            let positions = open(path).model.rest_positions();
            positions.iter().map(|p| p.z).fold(f64::MIN, f64::max)
        };
        assert!((highest(&out) - 1.5).abs() < 1e-6, "{name}");
    }
}

#[test]
fn a_scan_that_lies_elsewhere_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let edit = exported(&folder.write_mesh("ball.off", &shapes::icosphere(4)));
    let beside = DAffine3::from_translation(DVec3::X * 3.0);
    let other = folder.write_mesh("other.off", &shapes::moved(&shapes::uv_sphere(33, 50), beside));
    let out = folder.at("out.off");
    let words = ["another mesh", "only 0% of `top`", "move, turn and scale"];
    folder.apply(&other, &edit, &out, &[]).refused(1, &words);
    assert!(!out.exists());
}
