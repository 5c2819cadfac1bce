//! Sketched outlines: a line over a picture, and the outline that goes there.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::PI;
use std::fs;

use glam::camera::rh::proj::opengl::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{DMat4, DVec2, DVec3, Vec3};
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, open};
use serde_json::{Value, json};

/// Two pixels of a picture of 1000 pixels, in normalised device coordinates.
const TWO_PIXELS: f64 = 2.0 * 2.0 / 1000.0;

/// A view along −z in parallel, and one in perspective from above.
fn views() -> [DMat4; 2] {
    let parallel = DMat4::from_cols_array(&[
        0.4, 0.0, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0, -0.1, 0.0, 0.0, 0.0, 0.0, 1.0,
    ]);
    let camera = look_at_mat4(Vec3::new(1.0, 2.5, 5.0), Vec3::ZERO, Vec3::Y);
    let perspective = (perspective(0.6, 1.0, 1.0, 20.0) * camera).as_dmat4();
    [parallel, perspective]
}

fn seen(view: &DMat4, world: DVec3) -> DVec2 {
    let clip = *view * world.extend(1.0);
    clip.truncate().truncate() / clip.w
}

/// The edges of the outline in a picture.
fn outline(view: &DMat4, drawn: &Drawn, positions: &[DVec3]) -> Vec<[DVec2; 2]> {
    let places: Vec<DVec2> = positions.iter().map(|p| seen(view, *p)).collect();
    let mut sides = Vec::new();
    for corners in &drawn.triangles {
        let [a, b, c] = corners.map(|corner| places[corner.index()]);
        let is_front = (b - a).perp_dot(c - a) > 0.0;
        for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|side: [usize; 2]| side.map(|corner| corners[corner].0)) {
            sides.push(([from.min(to), from.max(to)], is_front));
        }
    }
    sides.sort_unstable();
    let pairs = sides
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|same| same[0].1 != same[same.len() - 1].1);
    pairs
        .map(|same| same[0].0.map(|vertex| places[vertex as usize]))
        .collect()
}

fn distance(place: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let along = to - from;
    let share = ((place - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    place.distance(from + along * share)
}

/// A line that leaves the outline of the unit sphere's picture and comes back: the sphere grows a bump to the upper
/// right.
fn bump(view: &DMat4, height: f64) -> Vec<DVec2> {
    // The outline of the sphere as a circle across the view.
    let back = view.inverse();
    let far = |z: f64| {
        let clip = back * DVec3::new(0.0, 0.0, z).extend(1.0);
        clip.truncate() / clip.w
    };
    let towards = (far(-1.0) - far(1.0)).normalize();
    let right = DVec3::Y.cross(towards).normalize();
    let up = towards.cross(right);
    let place = |i: i32| {
        let share = f64::from(i) / 40.0;
        let angle = PI / 6.0 + share * PI / 2.0;
        let radius = 1.0 + height * (PI * share).sin().powi(2);
        seen(view, radius * (right * angle.cos() + up * angle.sin()))
    };
    (0..=40).map(place).collect()
}

fn edit(method: &Value, view: &DMat4, line: &[DVec2], weight: f64) -> Value {
    let line: Vec<[f64; 2]> = line.iter().map(|point| point.to_array()).collect();
    json!({
        "version": 1, "method": method,
        "fixed": { "slab": { "axis": "y", "from": 0.0, "to": 0.2 } },
        "handles": [{
            "name": "profile",
            "sketch": { "view_projection": view.to_cols_array(), "line": line, "weight": weight },
        }],
    })
}

fn bent(drawn: &Drawn, edit: &Value) -> Vec<DVec3> {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", drawn), folder.at("out.off"));
    folder.apply(&file, edit, &out, &[]).done();
    open(&out).model.rest_positions()
}

/// The largest distance of the inner part of the line from the outline.
fn missed(view: &DMat4, line: &[DVec2], drawn: &Drawn, positions: &[DVec3]) -> f64 {
    let edges = outline(view, drawn, positions);
    let inner = &line[4..line.len() - 4];
    let nearest = inner.iter().map(|place| {
        let each = edges.iter().map(|edge| distance(*place, *edge));
        each.fold(f64::INFINITY, f64::min)
    });
    nearest.fold(0.0, f64::max)
}

#[test]
fn the_outline_goes_to_the_line_within_two_pixels_and_a_loose_one_less_far() {
    let drawn = shapes::icosphere(5);
    for view in views() {
        let line = bump(&view, 0.25);
        let before = missed(&view, &line, &drawn, &drawn.positions);
        assert!(before > 10.0 * TWO_PIXELS);
        for method in ["bilaplacian", "shells", "arap"].map(|name| match name {
            "arap" => json!({ "name": name, "energy": "smooth" }),
            _ => json!({ "name": name }),
        }) {
            let found = bent(&drawn, &edit(&method, &view, &line, 1.0));
            let exact = missed(&view, &line, &drawn, &found);
            assert!(exact < TWO_PIXELS, "{method}: {exact:e} of {before:e}");
            let found = bent(&drawn, &edit(&method, &view, &line, 0.2));
            let loose = missed(&view, &line, &drawn, &found);
            assert!(
                exact < loose && loose < before,
                "{method}: {exact:e} {loose:e} {before:e}"
            );
        }
    }
}

#[test]
fn matched_vertices_keep_their_distance_from_the_viewer() {
    let drawn = shapes::icosphere(4);
    let [view, _] = views();
    let found = bent(
        &drawn,
        &edit(&json!({ "name": "arap" }), &view, &bump(&view, 0.25), 1.0),
    );
    let on_line = drawn
        .positions
        .iter()
        .zip(&found)
        .filter(|(p, q)| p.z.abs() < 0.1 && p.distance(**q) > 0.1);
    assert!(on_line.clone().any(|(p, q)| (p.z - q.z).abs() < 1e-9));
}

#[test]
fn a_sketch_that_cant_be_matched_is_refused_in_one_sentence() {
    let folder = Folder::new();
    let (file, out) = (folder.write_mesh("in.off", &shapes::icosphere(2)), folder.at("out.off"));
    let [view, _] = views();
    let view = view.to_cols_array();
    let line = json!([[0.4, 0.0], [0.0, 0.4]]);
    let refused = |sketch: Value, words: &[&str]| {
        let edit = json!({ "version": 1, "method": { "name": "arap" }, "handles": [{ "sketch": sketch }] });
        folder.apply(&file, &edit, &out, &[]).refused(1, words);
        assert!(!out.exists());
    };
    refused(json!({ "line": line }), &["handles[0].sketch", "`view_projection`"]);
    refused(
        json!({ "view_projection": [1, 2], "line": line }),
        &["view_projection", "16 numbers"],
    );
    refused(
        json!({ "view_projection": vec![0; 16], "line": line }),
        &["flattens space"],
    );
    refused(
        json!({ "view_projection": view, "line": [[0, 0]] }),
        &["1 points", "at least 2"],
    );
    refused(
        json!({ "view_projection": view, "line": [[0, 0], [0, 0]] }),
        &["points 0 and 1"],
    );
    refused(
        json!({ "view_projection": view, "line": [[0, 0], [0, 1], [0, 0]] }),
        &["ends where it begins"],
    );
    refused(
        json!({ "view_projection": view, "line": line, "weight": 0 }),
        &["`weight` 0"],
    );
    refused(
        json!({ "view_projection": view, "line": line, "weight": 2 }),
        &["`weight` 2"],
    );
    let edit = json!({
        "version": 1, "method": { "name": "arap" },
        "handles": [{ "select": "none", "sketch": { "view_projection": view, "line": line } }],
    });
    folder
        .apply(&file, &edit, &out, &[])
        .refused(1, &["handles[0].sketch", "no outline"]);
    let both = json!({
        "version": 1, "method": { "name": "arap" },
        "handles": [{ "sketch": { "view_projection": view, "line": line }, "curve": { "points": [[0, 0, 0], [1, 0, 0]] } }],
    });
    folder
        .apply(&file, &both, &out, &[])
        .refused(1, &["handles[0]", "`curve`", "`sketch`"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
