//! Creases along curves, made sharper and flatter, by the command line.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use glam::DVec3;
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, largest_distance, open};
use serde_json::{Value, json};

const CELLS: usize = 40;

/// The surface reaches from −1 to 1 in x and y.
const CELL: f64 = 2.0 / CELLS as f64;

const WIDTH: f64 = 0.3;

/// A roof whose ridge is along y, with this slope on both sides; a valley if it is negative.
fn roof(slope: f64) -> Drawn {
    let mut drawn = shapes::grid(CELLS, CELLS);
    for p in &mut drawn.positions {
        let [x, y] = [p.x, p.y].map(|share| 2.0 * share - 1.0);
        *p = DVec3::new(x, y, -slope * x.abs());
    }
    drawn
}

fn edit(method: &str, sharpen: f64) -> Value {
    json!({
        "version": 1, "method": { "name": method },
        "fixed": { "slab": { "axis": "y", "from": 0.0, "to": 0.05 } },
        "handles": [{
            "name": "ridge",
            "curve": {
                "points": [[0.01, -0.6, 0.1], [-0.01, 0, 0.1], [0.01, 0.6, 0.1]],
                "crease": { "width": WIDTH, "sharpen": sharpen },
            },
        }],
    })
}

fn bent(drawn: &Drawn, edit: &Value, more: &[&str]) -> Vec<DVec3> {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", drawn), folder.at("out.off"));
    folder.apply(&file, edit, &out, more).done();
    open(&out).model.rest_positions()
}

/// The angle by which the surface turns at the ridge, in the middle of its length: positive at a ridge.
fn turn_rad(rest: &Drawn, found: &[DVec3]) -> f64 {
    let at = |x: f64| {
        let is_here = |p: &DVec3| (p.x - x).abs() < 1e-9 && p.y.abs() < 1e-9;
        found[rest.positions.iter().position(is_here).unwrap()]
    };
    let [before, here, after] = [-CELL, 0.0, CELL].map(at);
    let slope = |from: DVec3, to: DVec3| (to.z - from.z).atan2(to.x - from.x);
    slope(before, here) - slope(here, after)
}

#[test]
fn a_crease_gets_sharper_with_the_weight_and_flat_at_minus_one_by_every_method() {
    for slope in [0.3, 1.0, -0.5] {
        let drawn = roof(slope);
        let at_rest = turn_rad(&drawn, &drawn.positions);
        let mut last = 0.0;
        for sharpen in [-1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0] {
            let shapes = ["bilaplacian", "arap", "shells"].map(|method| {
                let found = bent(&drawn, &edit(method, sharpen), &[]);
                let turn = turn_rad(&drawn, &found) * slope.signum();
                // The curvature of a fold is spread over both sides, so a cell keeps its share of it.
                let share = CELL * slope.hypot(1.0) / (2.0 * WIDTH);
                if sharpen == -1.0 {
                    assert!((0.0..1.5 * share * at_rest.abs()).contains(&turn), "{method}: {turn}");
                } else {
                    assert!(turn > last, "{method} {sharpen}: {turn} {last}");
                }
                (turn, found)
            });
            let [(turn, one), (_, two), (_, three)] = shapes;
            last = turn;
            // The surface beside the crease is the handle's, and ends as it was.
            let apart = largest_distance(&one, &two).max(largest_distance(&one, &three));
            assert!(apart < 1e-6, "{slope} {sharpen}: {apart:e}");
            let lifted = one.iter().zip(&drawn.positions);
            let is_far = |p: &DVec3| p.x.abs() > 2.0 * WIDTH;
            let far = lifted.filter(|(_, p)| is_far(p)).map(|(q, p)| p.distance(*q));
            assert!(far.fold(0.0, f64::max) < 1e-6);
        }
        // Five times as sharp in slope, less what its sides take back.
        assert!(last > at_rest.abs());
    }
}

#[test]
fn a_crease_at_rest_keeps_the_files_bytes_and_threads_change_none() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &roof(0.5)), folder.at("out.off"));
    folder.apply(&file, &edit("arap", 0.0), &out, &[]).done();
    assert_eq!(fs::read(&file).unwrap(), fs::read(&out).unwrap());
    for method in ["bilaplacian", "arap"] {
        let [one, two, three] = ["1", "2", "3"].map(|threads| {
            let edit = edit(method, 1.5);
            folder.apply(&file, &edit, &out, &["--threads", threads]).done();
            fs::read(&out).unwrap()
        });
        assert!(one == two && two == three, "{method}");
    }
    // A share of the edit is a share of the weight.
    let mut half = edit("bilaplacian", 3.0);
    half["strength"] = json!(0.5);
    let drawn = roof(0.5);
    let [half, whole] = [half, edit("bilaplacian", 1.5)].map(|edit| bent(&drawn, &edit, &[]));
    assert!(largest_distance(&half, &whole) < 1e-12);
}

#[test]
fn a_moved_crease_is_sharpened_before_it_moves() {
    let drawn = roof(0.5);
    let sharper = bent(&drawn, &edit("bilaplacian", 1.0), &[]);
    let mut lifted = edit("bilaplacian", 1.0);
    let points = lifted["handles"][0]["curve"]["points"].as_array().unwrap().clone();
    let up = |point: &Value| json!([point[0], point[1], point[2].as_f64().unwrap() + 0.7]);
    lifted["handles"][0]["curve"]["moved"] = points.iter().map(up).collect();
    let found = bent(&drawn, &lifted, &[]);
    let near = |p: &DVec3| p.x.abs() < 0.5 * WIDTH && p.y.abs() < 0.5;
    for ((p, q), moved) in drawn
        .positions
        .iter()
        .zip(&sharper)
        .zip(&found)
        .filter(|((p, _), _)| near(p))
    {
        assert!(moved.distance(*q + 0.7 * DVec3::Z) < 1e-9, "{p}: {q} {moved}");
    }
}

#[test]
fn a_crease_that_cant_be_sharpened_is_refused_in_one_sentence() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &roof(0.5)), folder.at("out.off"));
    let refused = |crease: Value, words: &[&str]| {
        let mut edit = edit("arap", 1.0);
        edit["handles"][0]["curve"]["crease"] = crease;
        folder.apply(&file, &edit, &out, &[]).refused(1, words);
        assert!(!out.exists());
    };
    let place = "handles[0].curve";
    refused(json!({ "sharpen": 1 }), &[place, "`width`"]);
    refused(json!({ "width": 0, "sharpen": 1 }), &[place, "`crease`", "`width` 0"]);
    refused(
        json!({ "width": 0.3, "sharpen": -1.5 }),
        &[place, "`sharpen` -1.5", "-1 (flat)"],
    );
    refused(json!({ "width": 0.3, "sharpen": 9 }), &[place, "`sharpen` 9"]);
    refused(json!({ "width": 0.3, "angle": 9 }), &[place, "`angle`"]);
    refused(json!({ "width": 1e-3, "sharpen": 1 }), &[place, "two rings"]);
    refused(json!({ "width": 30, "sharpen": 1 }), &[place, "covers a whole part"]);
}
