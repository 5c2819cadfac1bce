//! Cages and lattices that an edit brings: their numbers, or a cage's file.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::fs;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_editor::{
    AttachmentEntry, Beginning, EditFile, Editor, Event, InlineExecutor, MeshReference, Project, geometry_hash,
};
use pliant_mesh::{Drawn, DrawnVertex, shapes};
use pliant_tests::{Folder, largest_distance, open, run};
use serde_json::{Value, json};

/// A box around the unit sphere: its vertices and triangles, facing outward.
fn boxed() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) * 3.0 - 1.5;
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    ((0..8).map(corner).collect(), triangles.collect())
}

fn affine() -> DAffine3 {
    DAffine3::from_cols(
        DVec3::new(1.2, 0.3, -0.1),
        DVec3::new(-0.4, 0.9, 0.2),
        DVec3::new(0.5, 0.1, 1.4),
        DVec3::new(0.3, -2.0, 1.0),
    )
}

fn numbers(points: &[DVec3]) -> Value {
    points.iter().map(|p| json!(p.to_array())).collect()
}

fn moved(points: &[DVec3], map: DAffine3) -> Vec<DVec3> {
    points.iter().map(|p| map.transform_point3(*p)).collect()
}

fn edit(method: Value) -> Value {
    json!({ "version": 1, "method": method })
}

/// Asserts that an edit without handles moves the unit sphere by a map.
#[track_caller]
fn moves_by(folder: &Folder, edit: &Value, map: DAffine3) {
    let file = folder.write_mesh("sphere.off", &shapes::icosphere(3));
    let out = folder.at("out.off");
    folder.apply(&file, edit, &out, &[]).done();
    let expected = moved(&open(&file).model.rest_positions(), map);
    let error = largest_distance(&open(&out).model.rest_positions(), &expected);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn a_cage_of_numbers_moves_what_is_in_it_without_handles() {
    let (vertices, triangles) = boxed();
    for coordinates in ["mean-value", "harmonic"] {
        let cage = json!({
            "vertices": numbers(&vertices), "triangles": triangles, "moved": numbers(&moved(&vertices, affine())),
        });
        let method = json!({ "name": "cage", "coordinates": coordinates, "cage": cage });
        moves_by(&Folder::new(), &edit(method), affine());
    }
}

#[test]
fn a_cage_of_a_file_is_read_beside_the_edit_whatever_its_format() {
    let folder = Folder::new();
    let (vertices, triangles) = boxed();
    let corners = triangles.iter().map(|t| t.map(DrawnVertex)).collect();
    folder.write_mesh("cage.off", &Drawn::once(vertices.clone(), corners));
    let mut text = "v 9 9 9\n".to_owned();
    for p in &vertices {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for [a, b, c] in &triangles {
        text += &format!("f {} {} {}\n", a + 2, b + 2, c + 2);
    }
    folder.write("cage.obj", text);
    for name in ["cage.glb", "cage.ply"] {
        let (from, to) = (folder.at("cage.off"), folder.at(name));
        folder.apply(&from, &edit(json!({ "name": "arap" })), &to, &[]).done();
    }
    for name in ["cage.off", "cage.obj", "cage.glb", "cage.ply"] {
        let cage = json!({ "file": name, "moved": numbers(&moved(&vertices, affine())) });
        moves_by(&folder, &edit(json!({ "name": "cage", "cage": cage })), affine());
    }
    // Without handles and moves nothing changes, to the byte.
    let file = folder.at("sphere.off");
    let still = edit(json!({ "name": "cage", "cage": { "file": "cage.obj" } }));
    folder.apply(&file, &still, &folder.at("same.off"), &[]).done();
    assert_eq!(fs::read(&file).unwrap(), fs::read(folder.at("same.off")).unwrap());
    // Inputs are not overwritten.
    let edit_path = folder.write("named.json", still.to_string());
    let arguments = [
        "apply".into(),
        file.clone().into_os_string(),
        "--edit".into(),
        edit_path.into(),
    ];
    let over = arguments
        .into_iter()
        .chain(["--output".into(), folder.at("cage.obj").into()]);
    run(over).refused(2, &["--output", "cage.obj", "--edit"]);
}

#[test]
fn a_lattice_of_numbers_moves_what_is_in_it_and_handles_are_met_beside_it() {
    let rest: Vec<DVec3> = (0..27)
        .map(|k| DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)) * 1.5 - 1.5)
        .collect();
    let lattice = |moved: &[DVec3]| {
        json!({
            "counts": [3, 3, 3], "box": { "min": [-1.5, -1.5, -1.5], "max": [1.5, 1.5, 1.5] }, "moved": numbers(moved),
        })
    };
    let method = json!({ "name": "lattice", "basis": "bernstein", "lattice": lattice(&moved(&rest, affine())) });
    let folder = Folder::new();
    moves_by(&folder, &edit(method.clone()), affine());
    // In a drag, the hand's moves are complete at the end.
    let file = folder.at("sphere.off");
    let (once, drag) = (folder.at("once.off"), folder.at("drag.off"));
    folder.apply(&file, &edit(method.clone()), &once, &[]).done();
    folder.apply(&file, &edit(method), &drag, &["--frames", "3"]).done();
    assert_eq!(fs::read(once).unwrap(), fs::read(drag).unwrap());
    // A fine enough lattice meets a resting handle.
    let counts = 7;
    let fine: Vec<DVec3> = (0..counts * counts * counts)
        .map(|k| DVec3::new(f64::from(k % 7), f64::from(k / 7 % 7), f64::from(k / 49)) * 0.75 - 2.25)
        .collect();
    let bumped: Vec<DVec3> = fine.iter().map(|p| *p + DVec3::X * 0.2 * (p.z + 2.25)).collect();
    let lattice = json!({
        "counts": [7, 7, 7], "box": { "min": [-1.5, -1.5, -1.5], "max": [1.5, 1.5, 1.5] }, "moved": numbers(&bumped),
    });
    let mut held = edit(json!({ "name": "lattice", "lattice": lattice }));
    held["handles"] = json!([{ "select": { "slab": { "axis": "z", "from": 0.9, "to": 1.0 } } }]);
    let (out, report) = (folder.at("held.off"), folder.at("held.json"));
    folder
        .apply(&file, &held, &out, &["--report", report.to_str().unwrap()])
        .done();
    let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
    let missed = report["handle_residual"].as_f64().unwrap();
    assert!(missed < 0.02, "{report}");
    let before = open(&file).model.rest_positions();
    assert!(largest_distance(&open(&out).model.rest_positions(), &before) > 0.1);
}

/// Each of these methods is refused with status 1 and one line that contains the words.
#[test]
fn what_is_no_cage_and_no_lattice_is_refused_by_its_place() {
    let folder = Folder::new();
    let file = folder.write_mesh("sphere.off", &shapes::icosphere(2));
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    let (vertices, triangles) = boxed();
    let small: Vec<DVec3> = vertices.iter().map(|p| *p * 0.5).collect();
    let (vertices, small) = (numbers(&vertices), numbers(&small));
    let lattice = |counts: Value, more: Value| {
        let mut lattice = json!({ "counts": counts, "box": { "min": [-2, -2, -2], "max": [2, 2, 2] } });
        for (name, value) in more.as_object().unwrap() {
            lattice[name] = value.clone();
        }
        json!({ "name": "lattice", "lattice": lattice })
    };
    let cage = |cage: Value| json!({ "name": "cage", "coordinates": "harmonic", "cage": cage });
    let cases: Vec<(Value, &[&str])> = vec![
        (cage(json!({})), &["method.cage", "neither a `file` nor `vertices`"]),
        (cage(json!({ "file": "no.obj" })), &["no.obj"]),
        (
            cage(json!({ "file": "flat.obj" })),
            &["method.cage", "open at the edge"],
        ),
        (cage(json!({ "file": 3 })), &["method.cage.file", "a string"]),
        (
            cage(json!({ "file": "flat.obj", "vertices": vertices })),
            &["method.cage", "both `file` and `vertices`"],
        ),
        (cage(json!({ "vertices": vertices })), &["method.cage", "`triangles`"]),
        (cage(json!({ "triangles": triangles })), &["method.cage", "`vertices`"]),
        (
            cage(json!({ "vertices": vertices, "triangles": triangles, "moves": [] })),
            &["`moves`", "method.cage", "did you mean `moved`?"],
        ),
        (
            cage(json!({ "vertices": vertices, "triangles": triangles, "moved": [[0, 0, 0]] })),
            &["method.cage", "1 moved points, but 8 points"],
        ),
        (
            cage(json!({ "vertices": vertices, "triangles": [[0, 1, 9], [0, 1, 2]] })),
            &["method.cage", "vertex 9"],
        ),
        (
            cage(json!({ "vertices": [[0, 0]], "triangles": triangles })),
            &["method.cage.vertices[0]", "3 numbers"],
        ),
        (
            cage(json!({ "vertices": small, "triangles": triangles, "moved": vertices })),
            &["the cage leaves", "outside", "mean-value"],
        ),
        (lattice(json!([4, 4]), json!({})), &["method.lattice.counts", "3"]),
        (
            lattice(json!([4, 4, 3]), json!({})),
            &["method.lattice", "3 control points along z", "give 4 to"],
        ),
        (
            lattice(
                json!([4, 4, 4]),
                json!({ "box": { "min": [0, 0, 0], "max": [1, 0, 1] } }),
            ),
            &["method.lattice", "without extent along y"],
        ),
        (
            lattice(json!([4, 4, 4]), json!({ "moved": [[0, 0, 0]] })),
            &["method.lattice", "1 moved points, but 64 points"],
        ),
        (
            lattice(json!([4, 4, 4]), json!({ "cells": 3 })),
            &["`cells`", "method.lattice"],
        ),
        (
            json!({ "name": "arap", "cage": { "file": "flat.obj" } }),
            &["`cage`", "method"],
        ),
        (json!({ "name": "cage", "lattice": {} }), &["`lattice`", "method"]),
    ];
    for (method, words) in cases {
        let out = folder.write("out.off", "kept");
        folder.apply(&file, &edit(method), &out, &[]).refused(1, words);
        assert_eq!(fs::read_to_string(out).unwrap(), "kept");
    }
}

#[test]
fn the_help_lists_what_methods_take_beside_options() {
    let help = run(["apply", "--help"]).done().out;
    for words in ["cage: a cage of your own", "lattice: a lattice of your own"] {
        assert!(help.contains(words), "{help}");
    }
}

#[test]
fn an_edit_and_a_project_hold_what_was_brought_and_moved_and_the_other_methods_too() {
    let folder = Folder::new();
    let file = folder.write_mesh("sphere.off", &shapes::icosphere(2));
    let loaded = open(&file);
    let (vertices, triangles) = boxed();
    let places = moved(&vertices, DAffine3::from_translation(DVec3::new(0.1, 1.0 / 3.0, 0.0)));
    let brought = edit(json!({
        "name": "cage",
        "cage": { "vertices": numbers(&vertices), "triangles": triangles, "moved": numbers(&places) },
    }));
    let parsed = EditFile::from_value(&brought).unwrap();
    assert_eq!(EditFile::from_value(&parsed.to_value()).unwrap(), parsed);
    assert!(!parsed.changes_nothing());
    let named = edit(json!({ "name": "cage", "cage": { "file": "cage.obj" } }));
    let named = EditFile::from_value(&named).unwrap();
    assert_eq!(EditFile::from_value(&named.to_value()).unwrap(), named);
    assert!(matches!(named.attachments["cage"], AttachmentEntry::File { .. }));
    assert!(named.changes_nothing() && named.resolve(&loaded.model).is_err());

    let jobs = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(jobs.clone()));
    let mut open_with = |beginning: Beginning| {
        editor.handle(Event::Opened {
            model: Arc::clone(&loaded.model),
            name: "sphere".to_owned(),
            beginning: Some(beginning),
        });
        while let Some(done) = jobs.run_next() {
            editor.handle(Event::JobDone(done));
        }
        assert_eq!(editor.view().problem, None);
        assert!(editor.document().is_settled());
        let mesh = MeshReference {
            path: None,
            name: None,
            geometry: geometry_hash(&loaded.model),
        };
        let project = editor.snapshot().unwrap().project(mesh).to_json();
        (
            editor.edit_file().unwrap(),
            project,
            Arc::clone(editor.document().from_file()),
        )
    };
    let (exported, project, shape) = open_with(parsed.clone().into());
    assert_eq!(exported.attachments, parsed.attachments);
    let way = DVec3::new(0.1, 1.0 / 3.0, 0.0);
    assert!(shape.iter().all(|d| d.distance(way) < 1e-9));
    let again = Project::parse(&project).unwrap();
    assert!(!Beginning::from(again.clone()).changes_nothing());
    let (exported, same, reopened) = open_with(again.into());
    assert_eq!(exported.attachments, parsed.attachments);
    assert_eq!(same, project);
    assert_eq!(reopened, shape);
    // Under another method the cage stays in the project and moves nothing.
    let mut other = Beginning::from(Project::parse(&project).unwrap());
    other.set_method(pliant_deform::Method::from_name("arap").unwrap());
    assert!(other.changes_nothing());
    let (exported, kept, rest) = open_with(other);
    assert!(exported.attachments.is_empty() && rest.iter().all(|d| *d == DVec3::ZERO));
    let kept: Value = serde_json::from_str(&kept).unwrap();
    let project: Value = serde_json::from_str(&project).unwrap();
    assert_eq!(kept["attachments"], project["attachments"]);
}
