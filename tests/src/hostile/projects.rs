//! Random projects for a mesh, all sound.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use super::edits;
use crate::trials::Chance;

/// A project for the mesh with this hash and number of drawn vertices.
pub fn project(hash: &str, path: &str, drawn: usize, chance: &mut Chance) -> Value {
    let last = drawn.saturating_sub(1);
    let (first, second) = (drawn / 4, drawn / 2);
    let handle = |id: usize, from: usize, to: usize, chance: &mut Chance| {
        let mut handle = json!({
            "id": id, "name": format!("handle {id}"), "colour": [200, 100, 50, 255], "vertices": [[from, to]],
            "turn_deg": [0, 0, chance.between(-720.0, 720.0)], "pivot": [0.5, 0.5, 0],
        });
        let reaches = [
            json!("found"),
            json!({ "bounded": 0.3 }),
            json!("feature"),
            json!({ "creased": 0.3 }),
            json!("part"),
            json!({ "radii": 2.0 }),
            json!({ "length": 0.3 }),
            json!({ "radii": 0.0 }),
        ];
        handle["reach"] = chance.of(&reaches).clone();
        if !chance.one_in(4) {
            handle["transform"] = json!({ "translation": [0.2, 0.1, chance.between(-1.0, 1.0)] });
        }
        if chance.one_in(4) {
            handle["soft"] = json!(2.0);
        }
        if chance.one_in(4) {
            handle["twin"] = json!({ "handle": 1 - id.min(1), "axis": chance.below(3), "at": 0.5 });
        }
        handle
    };
    let mut project = json!({
        "version": 1, "mesh": { "path": path, "geometry": hash }, "method": edits::method(chance), "loose": "follow",
        "region": [[0, last]], "fixed": [[0, first]],
        "handles": [handle(0, second, second, chance), handle(1, last, last, chance)],
        "next_handle": 2, "settled": chance.one_in(2),
    });
    if chance.one_in(3) {
        project["stiffness"] = field(first, second, 1, chance);
    }
    if chance.one_in(4) {
        project["continuity"] = field(first, second, 1, chance);
    }
    if chance.one_in(3) {
        project["rest"] = field(0, last, 3, chance);
        project["applied"] = true.into();
    }
    if chance.one_in(3) {
        project["shape"] = field(0, last, 3, chance);
    }
    if chance.one_in(3) {
        project["objects"] = json!([{ "object": 0, "name": "part", "hidden": chance.one_in(2), "locked": true }]);
    }
    if chance.one_in(4) {
        project["loose_parts"] = json!({ "0": "rest" });
    }
    if chance.one_in(4) {
        project["isolated"] = json!(0);
    }
    if chance.one_in(3) {
        project["camera"] = json!({
            "target": [0, 0, 0], "distance": chance.between(-1.0, 10.0), "yaw_rad": 1e300, "pitch_rad": 0.1,
            "fov_y_rad": 0.7, "up": "y", "scale": 1.0,
        });
    }
    project
}

/// A field of `numbers` numbers per vertex over a range of vertices, sometimes with a number that is not allowed.
fn field(first: usize, last: usize, numbers: usize, chance: &mut Chance) -> Value {
    let mut values: Vec<f64> = (first..=last).flat_map(|_| vec![0.25; numbers]).collect();
    if chance.one_in(4) {
        let at = chance.below(values.len());
        values[at] = *chance.of(&[f64::NAN, f64::INFINITY, -1.0, 1e300, 0.0, 5e-324]);
    }
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let mut text = STANDARD.encode(bytes);
    if chance.one_in(8) {
        text.truncate(text.len() / 2);
    }
    json!({ "vertices": [[first, last]], "f64_base64": text })
}
