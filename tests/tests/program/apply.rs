//! The effect of an edit on a surface, for every kind of file: handles arrive, fixed vertices stay, and the rest
//! follows.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use glam::{DAffine3, DQuat, DVec3};
use pliant_engine::Loaded;
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, bare_edit, bend, data, datum, diagonal, extension, largest_distance, open};
use serde_json::{Value, json};

/// The world positions of an edited mesh, one per drawn vertex.
fn bent(drawn: &Drawn, edit: &Value) -> Vec<DVec3> {
    bent_with(drawn, edit, &[])
}

#[track_caller]
fn bent_with(drawn: &Drawn, edit: &Value, more: &[&str]) -> Vec<DVec3> {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", drawn), folder.at("out.off"));
    folder.apply(&file, edit, &out, more).done();
    open(&out).model.rest_positions()
}

fn handle(select: &Value, transform: &Value) -> Value {
    json!({ "select": select, "transform": transform })
}

/// The file vertices in the lowest and highest 5% of the used vertices along the longest axis.
fn ends(loaded: &Loaded) -> [Vec<usize>; 2] {
    let drawn = loaded.model.rest();
    let used = || {
        drawn
            .triangles
            .iter()
            .flatten()
            .map(|v| drawn.positions[v.index()])
            .filter(|p| p.is_finite())
    };
    let (min, max) = (used().reduce(DVec3::min).unwrap(), used().reduce(DVec3::max).unwrap());
    let extent = max - min;
    let axis = (0..3)
        .find(|&axis| extent[axis] >= extent.max_element() * (1.0 - 1e-6))
        .unwrap();
    let part = |from: f64, to: f64| {
        let inside = |p: DVec3| (from..=to).contains(&((p[axis] - min[axis]) / extent[axis]));
        let behind = loaded.model.drawn.surface_vertices();
        let inside = behind.zip(&drawn.positions).map(|(v, &p)| v.is_some() && inside(p));
        (0..)
            .zip(inside)
            .filter(|&(_, inside)| inside)
            .map(|(v, _)| v)
            .collect()
    };
    [part(0.0, 0.05), part(0.95, 1.0)]
}

#[test]
fn a_scan_that_is_inside_out_bends_the_same_and_is_saved_facing_outwards() {
    let mut drawn = shapes::icosphere(3);
    for triangle in &mut drawn.triangles {
        triangle.swap(1, 2);
    }
    let folder = Folder::new();
    let file = folder.write_mesh("in.off", &drawn);
    assert_eq!(open(&file).model.findings.inside_out_components.count, 1);
    let mut edit = bend(&json!({ "translation": [0.0, 0.3, 0.1] }));
    let out = folder.at("out.off");
    folder.apply(&file, &edit, &out, &[]).done();
    let as_read = open(&out);
    assert_eq!(as_read.model.findings.inside_out_components.count, 1);
    edit["inside_out"] = json!({ "component": 0 });
    folder.apply(&file, &edit, &out, &[]).done();
    let turned = open(&out);
    assert_eq!(turned.model.rest_positions(), as_read.model.rest_positions());
    assert!(turned.model.findings.inside_out_components.is_empty());
    let wound_back = as_read.model.drawn_triangles().into_iter().map(|[a, b, c]| [a, c, b]);
    assert!(turned.model.drawn_triangles().into_iter().eq(wound_back));
    // It is also an edit alone.
    edit = bare_edit();
    edit["inside_out"] = json!("all");
    folder.apply(&file, &edit, &out, &[]).done();
    assert!(open(&out).model.findings.inside_out_components.is_empty());
    assert_eq!(open(&out).model.rest_positions(), open(&file).model.rest_positions());
}

#[test]
fn on_every_file_the_handle_arrives_and_the_fixed_part_stays() {
    for path in data(&["scans", "survey", "gltf"]) {
        let before = open(&path);
        if before.model.surface.triangles.is_empty() {
            continue;
        }
        let folder = Folder::new();
        let (out, report) = (
            folder.at(&format!("out.{}", extension(&path))),
            folder.at("report.json"),
        );
        let size = diagonal(&before.model.surface.positions);
        let turn = DQuat::from_rotation_x(0.4);
        let shift = DVec3::new(0.0, 0.1, 0.05) * size;
        let edit = bend(&json!({ "translation": shift.to_array(), "rotation": turn.to_array(), "pivot": [0, 0, 0] }));
        folder
            .apply(
                &path,
                &edit,
                &out,
                &["--frames", "6", "--report", report.to_str().unwrap()],
            )
            .done();

        let after = open(&out);
        let name = path.display();
        assert_eq!(
            before.model.drawn.vertex_count(),
            after.model.drawn.vertex_count(),
            "{name}"
        );
        assert!(after.model.surface.positions.iter().all(|p| p.is_finite()), "{name}");
        let [fixed, moved] = ends(&before);
        let (rest, bent) = (before.model.rest_positions(), after.model.rest_positions());
        let motion = DAffine3::from_rotation_translation(turn, shift);
        for (part, motion) in [(fixed, DAffine3::IDENTITY), (moved, motion)] {
            for v in part {
                let wanted = motion.transform_point3(rest[v]);
                let error = bent[v].distance(wanted);
                assert!(error <= 1e-6 * size, "{name}: vertex {v} is off by {error} of {size}");
            }
        }
        let report: Value = serde_json::from_str(&fs::read_to_string(report).unwrap()).unwrap();
        assert_eq!(report["frames"]["count"], 6, "{name}");
    }
}

#[test]
fn the_surveys_scenes_meet_their_constraints() {
    for name in ["plane", "cylinder", "bar", "cactus"] {
        let (Some(mesh), Some(edit)) = (
            datum(&format!("survey/{name}.off")),
            datum(&format!("survey/{name}.edit.json")),
        ) else {
            continue;
        };
        let edit: Value = serde_json::from_str(&fs::read_to_string(edit).unwrap()).unwrap();
        let folder = Folder::new();
        let out = folder.at("out.off");
        folder.apply(&mesh, &edit, &out, &["--frames", "4"]).done();
        let (before, after) = (open(&mesh).model.rest(), open(&out).model.rest());
        let matrix: Vec<f64> = serde_json::from_value(edit["handles"][0]["transform"]["matrix"].clone()).unwrap();
        let motion = DAffine3::from_mat4(glam::DMat4::from_cols_slice(&matrix));
        let size = diagonal(&before.positions);
        let numbers = |value: &Value| -> Vec<usize> { serde_json::from_value(value["vertices"].clone()).unwrap() };
        for v in numbers(&edit["fixed"]) {
            assert_eq!(before.positions[v], after.positions[v], "{name}: fixed vertex {v}");
        }
        for v in numbers(&edit["handles"][0]["select"]) {
            let error = after.positions[v].distance(motion.transform_point3(before.positions[v]));
            assert!(error <= 1e-6 * size, "{name}: handle vertex {v} is off by {error}");
        }
    }
}

/// Loose parts follow their contacts: no triangle edge of a translated helmet is torn.
#[test]
fn loose_parts_of_real_models_travel_with_the_surface() {
    for name in ["gltf/DamagedHelmet.glb", "gltf/FlightHelmet/FlightHelmet.gltf"] {
        let Some(path) = datum(name) else { continue };
        let before = open(&path);
        let size = diagonal(&before.model.surface.positions);
        let shift = DVec3::new(0.0, 0.5 * size, 0.0);
        let mut edit = bare_edit();
        edit["handles"] = json!([handle(
            &json!({ "component": 0 }),
            &json!({ "translation": shift.to_array() })
        )]);
        let folder = Folder::new();
        let out = folder.at(&format!("out.{}", extension(&path)));
        folder.apply(&path, &edit, &out, &[]).done();
        let after = open(&out).model.rest_positions();
        let rest = before.model.rest_positions();
        let behind = before.model.drawn.surface_vertices();
        for ((v, (a, b)), surface_vertex) in rest.iter().zip(&after).enumerate().zip(behind) {
            if surface_vertex.is_some() {
                assert!(
                    (*b - *a).distance(shift) <= 1e-5 * size,
                    "{name}: vertex {v} went {}",
                    *b - *a
                );
            }
        }
    }
}

#[test]
fn a_translation_of_the_only_handle_moves_every_shape_as_a_whole() {
    for (name, drawn) in shapes::classes() {
        let size = diagonal(&drawn.positions);
        let shift = DVec3::new(0.3, -0.2, 0.5) * size;
        let model = shapes::model(drawn.clone());
        let mut edit = bare_edit();
        edit["handles"] = json!([handle(
            &json!({ "slab": { "axis": "longest", "from": 0.7, "to": 1.0 } }),
            &json!({ "translation": shift.to_array() })
        )]);
        let after = bent(&drawn, &edit);
        let behind = model.drawn.surface_vertices();
        for ((v, (a, b)), surface_vertex) in drawn.positions.iter().zip(&after).enumerate().zip(behind) {
            match surface_vertex {
                Some(_) => assert!(
                    (*b - *a).distance(shift) <= 2e-6 * size,
                    "{name}: vertex {v} went {}",
                    *b - *a
                ),
                // Vertices that are not finite stay as in the file.
                None => assert_eq!(
                    a.to_array().map(f64::to_bits),
                    b.to_array().map(f64::to_bits),
                    "{name}: {v}"
                ),
            }
        }
    }
}

#[test]
fn a_drag_in_frames_ends_where_one_solve_goes() {
    let tube = shapes::tube(12, 20, 6.0);
    for transform in [
        json!({ "translation": [0.1, 0.7, 0], "rotation": [0.5, 0, 0, 0.866] }),
        json!({ "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1.2, 0, 0.5, 0, 0, 1] }),
    ] {
        let edit = bend(&transform);
        assert_eq!(bent(&tube, &edit), bent_with(&tube, &edit, &["--frames", "7"]));
    }
}

#[test]
fn a_handle_wins_over_fixed_and_fixed_over_the_region() {
    let bar = shapes::bar(12, 2, 2);
    let slab = |from: f64, to: f64| json!({ "slab": { "axis": "longest", "from": from, "to": to } });
    let mut edit = bare_edit();
    edit["region"] = slab(0.3, 1.0);
    edit["fixed"] = slab(0.0, 1.0);
    edit["handles"] = json!([handle(&slab(0.8, 1.0), &json!({ "translation": [0, 0, 2] }))]);
    let after = bent(&bar, &edit);
    let moved: Vec<bool> = bar.positions.iter().zip(&after).map(|(a, b)| a != b).collect();
    let (min, max) = bar
        .positions
        .iter()
        .fold((f64::MAX, f64::MIN), |(lo, hi), p| (lo.min(p.x), hi.max(p.x)));
    for (p, moved) in bar.positions.iter().zip(&moved) {
        assert_eq!(*moved, (p.x - min) / (max - min) >= 0.8, "{p}");
    }
    // Without `fixed`, everything outside the region stays, and the rest of the region follows.
    edit["fixed"] = json!("none");
    let after = bent(&bar, &edit);
    for (p, q) in bar.positions.iter().zip(&after) {
        assert_eq!(p != q, (p.x - min) / (max - min) >= 0.3, "{p}");
    }
}

#[test]
fn a_component_that_nothing_holds_follows_or_rests() {
    let nearby = shapes::moved(
        &shapes::icosphere(1),
        DAffine3::from_translation(DVec3::new(0.0, 3.0, 0.0)),
    );
    let both = shapes::together(&[shapes::icosphere(2), nearby]);
    let first_of_second = shapes::icosphere(2).positions.len();
    let turn = DQuat::from_rotation_z(0.5);
    let mut edit = bare_edit();
    edit["handles"] = json!([handle(
        &json!({ "component": 0 }),
        &json!({ "rotation": turn.to_array(), "translation": [0, 0, 1], "pivot": [0, 0, 0] })
    )]);
    let followed = bent(&both, &edit);
    let motion = DAffine3::from_rotation_translation(turn, DVec3::Z);
    let wanted: Vec<DVec3> = both.positions.iter().map(|&p| motion.transform_point3(p)).collect();
    assert!(largest_distance(&followed, &wanted) < 1e-6);
    edit["loose"] = json!("rest");
    assert_eq!(bent(&both, &edit)[first_of_second..], both.positions[first_of_second..]);
}

#[test]
fn welded_twins_go_together_whichever_of_them_is_named() {
    let soup = shapes::soup(&shapes::grid(3, 3));
    let corner = soup.positions[0];
    let twins: Vec<usize> = (0..soup.positions.len())
        .filter(|&v| soup.positions[v] == corner)
        .collect();
    for &named in &twins {
        let mut edit = bare_edit();
        edit["region"] = json!("none");
        edit["handles"] = json!([handle(
            &json!({ "vertices": [named] }),
            &json!({ "translation": [0, 0, 1] })
        )]);
        let after = bent(&soup, &edit);
        let moved: Vec<usize> = (0..after.len()).filter(|&v| after[v] != soup.positions[v]).collect();
        assert_eq!(moved, twins);
    }
}

/// Whether a selector should select the file vertex with this number.
type Test = Box<dyn Fn(usize) -> bool>;

/// Every kind of selector moves the vertices that it describes and, because the region is empty, no others.
#[test]
fn selectors_select_what_they_say() {
    let sheet = shapes::grid(4, 6);
    let p = sheet.positions.clone();
    let extent = diagonal(&p);
    let one = shapes::together(&[
        sheet.clone(),
        shapes::moved(&shapes::grid(2, 2), DAffine3::from_translation(DVec3::Z)),
    ]);
    let center = p[8];
    let cases: Vec<(Value, Test)> = vec![
        (json!("all"), Box::new(|_| true)),
        (json!({ "vertices": [3, 5] }), Box::new(|v| v == 3 || v == 5)),
        (
            json!({ "ranges": [[2, 4], [7, 7]] }),
            Box::new(|v| (2..=4).contains(&v) || v == 7),
        ),
        (
            json!({ "component": 0 }),
            Box::new({
                let n = p.len();
                move |v| v < n
            }),
        ),
        (
            json!({ "component": 1 }),
            Box::new({
                let n = p.len();
                move |v| v >= n
            }),
        ),
        (
            json!({ "not": { "component": 0 } }),
            Box::new({
                let n = p.len();
                move |v| v >= n
            }),
        ),
        (
            json!({ "sphere": { "center": center.to_array(), "radius": 0.2 * extent } }),
            Box::new({
                let all = one.positions.clone();
                move |v| all[v].distance(center) <= 0.2 * extent
            }),
        ),
        (
            json!({ "box": { "min": center.to_array(), "max": center.to_array() } }),
            Box::new({
                let all = one.positions.clone();
                move |v| all[v] == center
            }),
        ),
        (
            json!({ "union": [{ "vertices": [1] }, { "vertices": [2] }] }),
            Box::new(|v| v == 1 || v == 2),
        ),
        (
            json!({ "intersection": [{ "ranges": [[0, 5]] }, { "not": { "ranges": [[0, 3]] } }] }),
            Box::new(|v| v == 4 || v == 5),
        ),
    ];
    for (selector, wanted) in cases {
        let mut edit = bare_edit();
        edit["region"] = json!("none");
        edit["handles"] = json!([handle(&selector, &json!({ "translation": [0, 0, 9] }))]);
        let after = bent(&one, &edit);
        for v in 0..after.len() {
            assert_eq!(after[v] != one.positions[v], wanted(v), "{selector}: vertex {v}");
        }
    }
}

#[test]
fn a_stiff_part_bends_less_and_later_entries_win() {
    let tube = shapes::tube(12, 24, 6.0);
    let mut edit = bend(&json!({ "translation": [2, 0, 0] }));
    let soft = bent(&tube, &edit);
    let middle = json!({ "slab": { "axis": "longest", "from": 0.3, "to": 0.7 } });
    edit["stiffness"] = json!([{ "select": middle, "value": 100.0 }]);
    let stiff = bent(&tube, &edit);
    assert!(largest_distance(&soft, &stiff) > 0.01);
    edit["stiffness"] = json!([{ "select": "all", "value": 0.5 }, { "select": "all", "value": 1.0 }, { "select": middle, "value": 100.0 }]);
    assert_eq!(bent(&tube, &edit), stiff);
    edit["stiffness"] = json!([{ "select": "all", "value": 7.0 }, { "per_vertex": vec![1.0; tube.positions.len()] }]);
    assert_eq!(bent(&tube, &edit), soft);
}

#[test]
fn without_a_free_vertex_the_handles_still_move() {
    let sphere = shapes::icosphere(2);
    let mut edit = bend(&json!({ "translation": [0, 0, 1] }));
    edit["region"] = json!("none");
    let after = bent(&sphere, &edit);
    assert!(after.iter().zip(&sphere.positions).any(|(a, b)| a != b));
    assert!(
        after
            .iter()
            .zip(&sphere.positions)
            .all(|(a, b)| a == b || (*a - *b).distance(DVec3::Z) < 1e-12)
    );
}

#[test]
fn the_report_has_every_member_and_only_finite_numbers() {
    let folder = Folder::new();
    let file = folder.write_mesh("in.off", &shapes::torus(20, 10));
    let report = folder.at("report.json");
    let edit = bend(&json!({ "translation": [0, 0, 1] }));
    folder
        .apply(
            &file,
            &edit,
            &folder.at("out.off"),
            &["--frames", "5", "--report", report.to_str().unwrap()],
        )
        .done();
    let report = read_json(&report);
    for member in [
        "/method",
        "/vertices",
        "/welded_vertices",
        "/free_vertices",
        "/load_ms",
        "/order_ms",
        "/bind_ms",
        "/save_ms",
        "/frames/count",
        "/frames/median_ms",
        "/frames/p95_ms",
        "/frames/max_ms",
        "/frames/normals_ms",
        "/iterations",
        "/converged",
        "/energy/rest",
        "/energy/final",
        "/distortion/edge_stretch_mean",
        "/distortion/edge_stretch_max",
        "/distortion/flipped_faces",
        "/distortion/volume_ratio",
        "/warnings",
    ] {
        let value = report.pointer(member).unwrap_or_else(|| panic!("{member} is missing"));
        assert!(!value.is_null(), "{member} is not finite");
    }
    assert_eq!(report["method"], "bilaplacian");
    assert_eq!(
        (&report["vertices"], &report["frames"]["count"]),
        (&json!(200), &json!(5))
    );
    assert!(report["energy"]["final"].as_f64().unwrap() > 0.0);
    assert_eq!(report["energy"]["rest"].as_f64().unwrap(), 0.0);
}

fn read_json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn soft_handles_and_hinges_come_from_the_edit_and_other_methods_say_that_they_have_none() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::tube(16, 24, 6.0));
    let out = folder.at("out.off");
    let hard = bend(&json!({ "translation": [2, 0, 0] }));
    let bent = |edit: &Value, more: &[&str]| {
        folder.apply(&file, edit, &out, more).done();
        open(&out).model.rest_positions()
    };
    let plain = bent(&hard, &[]);
    let mut soft = hard.clone();
    soft["handles"][0]["soft"] = json!(0.5);
    let mut hinged = hard.clone();
    hinged["continuity"] = json!(0);
    let mut one_hinge = hard.clone();
    one_hinge["handles"][0]["continuity"] = json!(0);
    let shapes = [bent(&soft, &[]), bent(&hinged, &[]), bent(&one_hinge, &[])];
    for (i, shape) in shapes.iter().enumerate() {
        assert!(largest_distance(shape, &plain) > 0.05, "{i}");
        assert!(
            shapes
                .iter()
                .skip(i + 1)
                .all(|other| largest_distance(shape, other) > 0.05),
            "{i}"
        );
    }
    let report = folder.at("report.json");
    let arguments = ["--method", "primo", "--report", report.to_str().unwrap()];
    let prisms = bent(&soft, &arguments);
    let said: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    let said = said["warnings"].as_array().unwrap();
    assert!(
        said.iter()
            .any(|w| w.as_str().unwrap().contains("\"head\" is soft, but primo treats")),
        "{said:?}"
    );
    assert_eq!(prisms, bent(&hard, &["--method", "primo"]));
    let rigid = ["--method", "arap"];
    assert!(largest_distance(&bent(&soft, &rigid), &bent(&hard, &rigid)) > 0.05);
}
