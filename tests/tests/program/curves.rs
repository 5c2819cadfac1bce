//! Handles that follow curves: what an edit with one does to a surface, by the command line.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::TAU;
use std::fs;

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3Swizzles};
use pliant_deform::{HandleFit, METHODS, Method};
use pliant_mesh::{Curve, Drawn, shapes};
use pliant_tests::{Folder, bend, largest_distance, open};
use serde_json::{Value, json};

const LENGTH: f64 = 24.0;

fn bar() -> Drawn {
    shapes::bar(LENGTH as usize, 2, 2)
}

/// Control points through the middle of the bar, from end to end.
fn middle(count: usize) -> Vec<DVec3> {
    let x = |i: usize| LENGTH * i as f64 / (count - 1) as f64;
    (0..count).map(|i| DVec3::new(x(i), 1.0, 1.0)).collect()
}

/// The place and the turn of a point of the middle line that is bent into a circular arc, its length kept.
fn on_arc(x: f64, angle: f64) -> (DVec3, DQuat) {
    let radius = LENGTH / angle;
    let (sine, cosine) = (x / radius).sin_cos();
    let place = DVec3::new(radius * sine, 1.0 + radius * (1.0 - cosine), 1.0);
    (place, DQuat::from_rotation_z(x / radius))
}

fn list(points: &[DVec3]) -> Value {
    points.iter().map(|point| point.to_array()).collect()
}

/// An edit with one handle that follows a curve.
fn edit(method: &str, select: &Value, curve: &Value) -> Value {
    json!({
        "version": 1, "method": { "name": method },
        "handles": [{ "name": "spine", "select": select, "curve": curve }],
    })
}

/// The world positions after an edit, one per drawn vertex.
#[track_caller]
fn bent(drawn: &Drawn, edit: &Value, more: &[&str]) -> Vec<DVec3> {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", drawn), folder.at("out.off"));
    folder.apply(&file, edit, &out, more).done();
    open(&out).model.rest_positions()
}

#[test]
fn every_method_puts_the_sections_of_a_bar_onto_the_arc_of_its_middle_line() {
    let drawn = bar();
    for declaration in METHODS.iter().filter(|declaration| declaration.name != "identity") {
        for degrees in [90.0_f64, 300.0] {
            let angle = degrees.to_radians();
            let points = middle(25);
            let moved: Vec<DVec3> = points.iter().map(|point| on_arc(point.x, angle).0).collect();
            let curve = json!({ "points": list(&points), "moved": list(&moved) });
            let wanted = drawn.positions.iter().map(|p| {
                let (place, turn) = on_arc(p.x, angle);
                place + turn * DVec3::new(0.0, p.y - 1.0, p.z - 1.0)
            });
            let wanted: Vec<DVec3> = wanted.collect();
            let found = bent(&drawn, &edit(declaration.name, &json!("all"), &curve), &[]);
            let apart = largest_distance(&found, &wanted);
            let limit = match Method::from_name(declaration.name).unwrap().handle_fit() {
                HandleFit::Exact => 1e-3,
                HandleFit::LeastSquares => 3e-3,
            };
            assert!(apart < limit * LENGTH, "{} {degrees}: {apart:e}", declaration.name);
        }
    }
}

#[test]
fn a_curve_that_moves_rigidly_moves_its_vertices_rigidly_however_fine_it_is() {
    let drawn = shapes::torus(24, 12);
    let map = DAffine3::from_rotation_translation(DQuat::from_rotation_y(2.5), DVec3::new(3.0, -1.0, 0.5));
    let points: Vec<DVec3> = (0..9)
        .map(|i| TAU * f64::from(i) / 9.0)
        .map(|a| DVec3::new(2.0 * a.cos(), 2.0 * a.sin(), 0.3 * (2.0 * a).sin()))
        .collect();
    let coarse = Curve::new(points, true).unwrap();
    let places = coarse.point_places();
    let fine: Vec<DVec3> = places
        .windows(2)
        .flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])])
        .map(|place| coarse.position(place))
        .collect();
    for points in [coarse.points(), &fine] {
        let moved: Vec<DVec3> = points.iter().map(|point| map.transform_point3(*point)).collect();
        let curve = json!({ "points": list(points), "moved": list(&moved), "closed": true });
        let found = bent(&drawn, &edit("arap", &json!("all"), &curve), &[]);
        let wanted: Vec<DVec3> = drawn.positions.iter().map(|p| map.transform_point3(*p)).collect();
        // OFF files have every digit.
        assert!(
            largest_distance(&found, &wanted) < 1e-12 * 10.0,
            "{:e}",
            largest_distance(&found, &wanted)
        );
    }
}

#[test]
fn control_points_at_rest_keep_the_files_bytes() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &bar()), folder.at("out.off"));
    let points = list(&middle(4));
    for curve in [
        json!({ "points": points }),
        json!({ "points": points, "moved": points, "twist": [0, 0, 0, 0], "scale": [1, 1, 1, 1] }),
    ] {
        folder
            .apply(&file, &edit("arap", &json!("all"), &curve), &out, &[])
            .done();
        assert_eq!(fs::read(&file).unwrap(), fs::read(&out).unwrap());
    }
    // Beside another handle, which moves, too.
    let mut both = bend(&json!({ "translation": [0, 3, 0] }));
    let still = json!({ "select": { "slab": { "axis": "x", "from": 0.4, "to": 0.5 } }, "curve": { "points": points } });
    both["handles"].as_array_mut().unwrap().push(still);
    let found = bent(&bar(), &both, &[]);
    let rest = bar().positions;
    let is_held = |p: &DVec3| (0.4..=0.5).contains(&(p.x / LENGTH));
    let held = rest.iter().zip(&found).filter(|(p, _)| is_held(p));
    assert!(held.clone().count() > 0 && held.into_iter().all(|(p, q)| p == q));
}

#[test]
fn a_twist_by_a_full_turn_winds_the_bar_once() {
    let drawn = bar();
    let points = middle(5);
    let curve = json!({ "points": list(&points), "twist": [0, 90, 180, 270, 360] });
    // Every fourth ring follows the curve; the others are free.
    let rings: Vec<usize> = (0..drawn.positions.len())
        .filter(|v| drawn.positions[*v].x % 3.0 == 0.0)
        .collect();
    for method in ["arap", "primo", "shells", "frames"] {
        let found = bent(&drawn, &edit(method, &json!({ "vertices": rings }), &curve), &[]);
        for (p, q) in drawn.positions.iter().zip(&found) {
            let turn = DQuat::from_rotation_x(TAU * p.x / LENGTH);
            let wanted = DVec3::new(p.x, 1.0, 1.0) + turn * DVec3::new(0.0, p.y - 1.0, p.z - 1.0);
            let limit = if p.x % 3.0 == 0.0 { 1e-9 } else { 0.4 };
            assert!(wanted.distance(*q) < limit, "{method} at {p}: {}", wanted.distance(*q));
        }
    }
}

#[test]
fn a_full_turn_winds_the_bar_once_where_only_its_ends_follow_the_curve() {
    let drawn = bar();
    let curve = json!({ "points": list(&middle(2)), "twist": [0, 360] });
    let ends: Vec<usize> = (0..drawn.positions.len())
        .filter(|v| !(3.0..=LENGTH - 3.0).contains(&drawn.positions[*v].x))
        .collect();
    // A drag of which each frame turns the end by 72 degrees ends as one solve does.
    for (method, more) in [
        ("arap", &[][..]),
        ("arap", &["--frames", "5"]),
        ("primo", &[]),
        ("shells", &[]),
    ] {
        let found = bent(&drawn, &edit(method, &json!({ "vertices": ends }), &curve), more);
        for tenth in 0..=10_u32 {
            let x = (LENGTH * f64::from(tenth) / 10.0).round();
            let section = drawn.positions.iter().zip(&found).filter(|(p, _)| p.x == x);
            // The sum of the arms' products as complex numbers, in which the section's own way falls out.
            let turn = section.fold(DVec2::ZERO, |sum, (p, q)| {
                sum + DVec2::new(p.y - 1.0, 1.0 - p.z).rotate(q.yz())
            });
            let off = turn.angle_to(DVec2::from_angle(TAU * x / LENGTH)).to_degrees().abs();
            let limit = if tenth == 5 { 2.0 } else { 15.0 };
            assert!(off < limit, "{method} {more:?} at {x}: {off}");
        }
    }
}

#[test]
fn without_a_selection_the_triangles_under_the_curve_follow_it() {
    let drawn = shapes::icosphere(4);
    let line = [
        DVec3::new(-0.6, 0.1, 0.9),
        DVec3::new(0.0, 0.2, 1.1),
        DVec3::new(0.6, 0.1, 0.9),
    ];
    let moved = line.map(|point| point + DVec3::Z * 0.2);
    let curve = json!({ "points": list(&line), "moved": list(&moved) });
    let edit = json!({
        "version": 1, "method": { "name": "arap" },
        "fixed": { "slab": { "axis": "z", "from": 0.0, "to": 0.3 } },
        "handles": [{ "name": "ridge", "curve": curve }],
    });
    let found = bent(&drawn, &edit, &[]);
    let is_lifted = |(p, q): &(&DVec3, &DVec3)| (**q - **p).distance(DVec3::Z * 0.2) < 1e-9;
    let pairs: Vec<(&DVec3, &DVec3)> = drawn.positions.iter().zip(&found).collect();
    let lifted: Vec<&(&DVec3, &DVec3)> = pairs.iter().filter(|pair| is_lifted(pair)).collect();
    assert!((20..120).contains(&lifted.len()), "{}", lifted.len());
    assert!(lifted.iter().all(|(p, _)| p.z > 0.7 && (p.y - 0.13).abs() < 0.2));
    assert!(pairs.iter().all(|(p, q)| p.z > -0.45 || p == q));
}

#[test]
fn any_number_of_threads_and_a_drag_give_the_same() {
    let folder = Folder::new();
    let file = folder.write_mesh("in.off", &bar());
    let points = middle(9);
    let moved: Vec<DVec3> = points
        .iter()
        .map(|point| on_arc(point.x, 3.0).0 + DVec3::Z * point.x.sin())
        .collect();
    let curve = json!({ "points": list(&points), "moved": list(&moved), "twist": [0, 0, 10, 20, 40, 20, 0, 0, 0], "scale": [1, 1, 1, 2, 1, 1, 1, 0.5, 1] });
    let select = json!({ "slab": { "axis": "y", "from": 0.9, "to": 1.0 } });
    let bytes = |method: &str, more: &[&str]| {
        let out = folder.at("out.off");
        folder.apply(&file, &edit(method, &select, &curve), &out, more).done();
        fs::read(out).unwrap()
    };
    for method in ["arap", "primo", "shells", "bilaplacian"] {
        let one = bytes(method, &["--threads", "1"]);
        assert!(
            one == bytes(method, &["--threads", "2"]) && one == bytes(method, &["--threads", "3"]),
            "{method}"
        );
    }
    // A linear method does not depend on the way.
    assert!(bytes("bilaplacian", &[]) == bytes("bilaplacian", &["--frames", "7"]));
}

#[test]
fn a_share_of_the_edit_is_a_share_of_the_turn() {
    let drawn = bar();
    let points = middle(25);
    let moved: Vec<DVec3> = points.iter().map(|point| on_arc(point.x, TAU * 0.75).0).collect();
    let curve = json!({ "points": list(&points), "moved": list(&moved) });
    let mut half = edit("bilaplacian", &json!("all"), &curve);
    half["strength"] = json!(0.5);
    let found = bent(&drawn, &half, &[]);
    // The first control point stays, so the arc of half the turn begins there.
    for (p, q) in drawn.positions.iter().zip(&found) {
        let (place, turn) = on_arc(p.x, TAU * 0.375);
        let wanted = place + turn * DVec3::new(0.0, p.y - 1.0, p.z - 1.0);
        assert!(wanted.distance(*q) < 0.03, "{p} {q} {wanted}");
    }
}

#[test]
fn a_curve_that_cant_be_followed_is_refused_in_one_sentence() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &bar()), folder.at("out.off"));
    let points = list(&middle(3));
    let refused = |handle: Value, words: &[&str]| {
        let edit = json!({ "version": 1, "method": { "name": "arap" }, "handles": [handle] });
        folder.apply(&file, &edit, &out, &[]).refused(1, words);
        assert!(!out.exists());
    };
    let curve = |curve: Value| json!({ "select": "all", "curve": curve });
    refused(json!({ "name": "spine" }), &["handles[0]", "`select`"]);
    refused(curve(json!({})), &["handles[0].curve", "`points`"]);
    refused(
        curve(json!({ "points": [[0, 0, 0]] })),
        &["`points`", "1 points", "at least 2"],
    );
    refused(
        curve(json!({ "points": [[0, 0, 0], [1, 0, 0]], "closed": true })),
        &["at least 3"],
    );
    refused(
        curve(json!({ "points": [[0, 0, 0], [1, 0]] })),
        &["handles[0].curve.points[1]", "3 numbers"],
    );
    refused(
        curve(json!({ "points": [[0, 0, 0], [0, 0, 0], [1, 0, 0]] })),
        &["points 0 and 1", "same place"],
    );
    refused(
        curve(json!({ "points": points, "moved": [[0, 0, 0], [1, 1, 1]] })),
        &["`moved`", "2 entries", "3 points"],
    );
    refused(
        curve(json!({ "points": points, "moved": [[0, 0, 0], [1, 1, 1], [1, 1, 1]] })),
        &["`moved`", "points 1 and 2"],
    );
    refused(
        curve(json!({ "points": points, "twist": [0, 1] })),
        &["`twist`", "2 entries"],
    );
    refused(
        curve(json!({ "points": points, "twist": [0, 1, 1e9] })),
        &["`twist`", "point 2", "36000"],
    );
    refused(
        curve(json!({ "points": points, "scale": [1, 0, 1] })),
        &["`scale`", "is 0 at point 1"],
    );
    refused(
        curve(json!({ "points": points, "scale": [1, -2, 1] })),
        &["`scale`", "is -2 at point 1"],
    );
    refused(curve(json!({ "points": points, "speed": 1 })), &["`speed`"]);
}
