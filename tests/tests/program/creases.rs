//! Creases along curves, made sharper and flatter, by the command line.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, largest_distance, open, run};
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
fn a_border_stays_where_a_crease_runs_across_it_or_along_it() {
    let drawn = roof(0.5);
    for points in [
        [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        [[-0.6, 1.0, -0.3], [0.6, 1.0, -0.3]],
    ] {
        let mut across = edit("bilaplacian", 2.0);
        across["handles"][0]["curve"]["points"] = json!(points);
        let found = bent(&drawn, &across, &[]);
        let is_border = |p: &DVec3| p.x.abs() < 0.9 * WIDTH && p.y > 0.999;
        let pairs = drawn.positions.iter().zip(&found);
        assert!(pairs.clone().filter(|(p, _)| is_border(p)).all(|(p, q)| p == q));
        assert!(pairs.into_iter().any(|(p, q)| p.distance(*q) > 1e-3));
    }
}

#[test]
fn keys_hold_the_sharpness_and_refuse_one_out_of_its_range() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &roof(0.5)), folder.at("out.off"));
    let mut keyed = edit("bilaplacian", 0.0);
    let key = |time: f64, sharpen: f64| json!({ "time": time, "curves": { "ridge": { "sharpen": sharpen } } });
    keyed["keys"] = json!([key(0.0, 0.0), key(0.5, 2.0)]);
    let animate = |edit: &Value| {
        let (edit, frames) = (folder.write("edit.json", edit.to_string()), folder.at("f-#.off"));
        let paths = [&file, &edit, &frames].map(|path| path.to_string_lossy().into_owned());
        let [file, edit, frames] = &paths;
        run(["animate", file, "--edit", edit, "--output", frames, "--fps", "2"])
    };
    animate(&keyed).done();
    folder.apply(&file, &edit("bilaplacian", 2.0), &out, &[]).done();
    let positions = |path: &Path| open(path).model.rest_positions();
    assert!(largest_distance(&positions(&folder.at("f-1.off")), &positions(&out)) < 1e-9);
    assert!(largest_distance(&positions(&folder.at("f-0.off")), &roof(0.5).positions) < 1e-9);
    keyed["keys"] = json!([key(0.0, 9.0)]);
    animate(&keyed).refused(1, &["keys[0].curves", "`sharpen` 9"]);
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
    let ball = folder.write_mesh("ball.off", &shapes::icosphere(2));
    let mut whole = edit("arap", 1.0);
    whole["handles"][0]["curve"]["crease"] = json!({ "width": 30, "sharpen": 1 });
    folder
        .apply(&ball, &whole, &out, &[])
        .refused(1, &[place, "covers a whole part"]);
}

/// An edit with a rough line beside the ridge.
fn rough(distance: f64) -> Value {
    let mut edit = edit("bilaplacian", 1.0);
    let curve = &mut edit["handles"][0]["curve"];
    curve["points"] = json!([[0.12, -0.6, 0.2], [0.15, 0, -0.1], [0.1, 0.6, 0]]);
    curve["snap"] = json!(distance);
    edit
}

#[test]
fn a_rough_line_with_snap_is_the_crease_that_it_means() {
    for slope in [0.5, -0.5] {
        let drawn = roof(slope);
        let mut on_it = edit("bilaplacian", 1.0);
        on_it["handles"][0]["curve"]["points"] = json!([[0, -0.6, 0], [0, 0, 0], [0, 0.6, 0]]);
        let exact = turn_rad(&drawn, &bent(&drawn, &on_it, &[]));
        let [one, two] = ["1", "2"].map(|threads| bent(&drawn, &rough(0.25), &["--threads", threads]));
        assert_eq!(one, two);
        let found = turn_rad(&drawn, &one);
        assert!((found / exact - 1.0).abs() < 1e-3, "{slope}: {found} {exact}");
        let beside = edit("bilaplacian", 1.0);
        let mut not_snapped = rough(0.25);
        not_snapped["handles"][0]["curve"]
            .as_object_mut()
            .unwrap()
            .remove("snap");
        assert_ne!(bent(&drawn, &not_snapped, &[]), bent(&drawn, &beside, &[]));
    }
    // A key says how sharp it is.
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &roof(0.5)), folder.at("f-#.off"));
    let mut keyed = rough(0.25);
    keyed["keys"] = json!([{ "time": 0.0, "curves": { "ridge": { "sharpen": 1.0 } } }]);
    let edit = folder.write("edit.json", keyed.to_string());
    let paths = [&file, &edit, &out].map(|path| path.to_string_lossy().into_owned());
    let [file, edit, frames] = &paths;
    run(["animate", file, "--edit", edit, "--output", frames]).done();
    let whole = bent(&roof(0.5), &rough(0.25), &[]);
    assert!(largest_distance(&open(&folder.at("f-0.off")).model.rest_positions(), &whole) < 1e-12);
}

#[test]
fn a_rough_line_that_means_no_crease_is_refused_in_one_sentence() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &roof(0.5)), folder.at("out.off"));
    let refused = |edit: &Value, words: &[&str]| {
        folder.apply(&file, edit, &out, &[]).refused(1, words);
        assert!(!out.exists());
    };
    refused(
        &rough(0.02),
        &["handles[0].curve.snap", "no crease and no border within 0.02"],
    );
    refused(&rough(0.0), &["handles[0].curve", "`snap` is 0", "above 0"]);
    let mut moved = rough(0.25);
    moved["handles"][0]["curve"]["moved"] = json!([[0, 0, 0], [0, 1, 0], [0, 2, 0]]);
    refused(&moved, &["handles[0].curve", "`moved`", "`transform`"]);
}
