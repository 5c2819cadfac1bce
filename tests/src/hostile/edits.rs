//! Random edits, all sound: every method with its options, every kind of selector and transform.

use pliant_deform::{METHODS, OptionKind};
use serde_json::{Map, Value, json};

use crate::trials::Chance;

/// The edit of most meshes: one end is fixed, the other moved.
pub fn plain(chance: &mut Chance) -> Value {
    json!({
        "version": 1, "method": method(chance),
        "fixed": { "slab": { "axis": "longest", "from": 0.0, "to": 0.2 } },
        "handles": [{
            "name": "end", "select": { "slab": { "axis": "longest", "from": 0.9, "to": 1.0 } },
            "transform": { "translation": [0.1, 0.2, 0.3], "rotation": [0.0, 0.0, 0.2, 0.98] },
        }],
    })
}

/// The same with few iterations. On a large mesh the number of iterations is the person's choice, and the program is
/// responsible only for the time to bind.
pub fn short(chance: &mut Chance) -> Value {
    let mut edit = plain(chance);
    let declaration = METHODS.iter().find(|method| edit["method"]["name"] == method.name);
    let mut options = declaration.into_iter().flat_map(|method| method.options);
    if options.any(|option| option.name == "max_iterations") {
        edit["method"]["max_iterations"] = 20.into();
    }
    edit
}

/// An edit that uses all of the format, at random.
pub fn rich(vertices: usize, chance: &mut Chance) -> Value {
    let mut edit = plain(chance);
    if chance.one_in(2) {
        edit["region"] = selector(vertices, 3, chance);
    }
    if chance.one_in(3) {
        edit["fixed"] = selector(vertices, 3, chance);
    }
    if chance.one_in(2) {
        edit["handles"] = (0..1 + chance.below(3)).map(|_| handle(vertices, chance)).collect();
    }
    if chance.one_in(2) {
        edit["handles"][0]["transform"] = transform(chance);
    }
    if chance.one_in(3) {
        edit["stiffness"] = json!([entry(vertices, json!(10_f64.powf(chance.between(-3.0, 3.0))), chance)]);
        if chance.one_in(3) {
            edit["stiffness"] = json!([{ "per_vertex": vec![chance.between(0.001, 1000.0); vertices] }]);
        }
    }
    if chance.one_in(4) {
        edit["continuity"] = json!([entry(vertices, json!(chance.between(0.0, 2.0)), chance)]);
    }
    if chance.one_in(3) {
        edit["loose"] = (*chance.of(&["follow", "rest", "bend"])).into();
    }
    edit
}

/// A method with random options, each within its range.
pub fn method(chance: &mut Chance) -> Value {
    let method = *chance.of(METHODS);
    let mut members = Map::new();
    members.insert("name".to_owned(), method.name.into());
    for option in method.options {
        if !chance.one_in(3) {
            continue;
        }
        let value = match option.kind {
            OptionKind::Number { range: [low, high], .. } => {
                let even = chance.between(0.0, 1.0);
                // Most ranges cover several powers of ten.
                json!(*chance.of(&[
                    low,
                    high,
                    low + even * (high - low),
                    low.max(high * 10_f64.powf(-12.0 * even))
                ]))
            }
            OptionKind::Whole { range: [low, high] } => json!(*chance.of(&[low, low + 1, high.min(low + 20)])),
            OptionKind::Numbered { choices } => json!(chance.of(choices).0),
            OptionKind::Named { choices } => json!(chance.of(choices)),
            OptionKind::Switch => json!(chance.one_in(2)),
        };
        members.insert(option.name.to_owned(), value);
    }
    Value::Object(members)
}

fn handle(vertices: usize, chance: &mut Chance) -> Value {
    let mut handle = json!({ "select": selector(vertices, 2, chance), "transform": transform(chance) });
    if chance.one_in(4) {
        handle["soft"] = json!(10_f64.powf(chance.between(-6.0, 6.0)));
    }
    if chance.one_in(4) {
        handle["continuity"] = json!(chance.between(0.0, 2.0));
    }
    handle
}

fn entry(vertices: usize, value: Value, chance: &mut Chance) -> Value {
    json!({ "select": selector(vertices, 2, chance), "value": value })
}

fn transform(chance: &mut Chance) -> Value {
    let size = *chance.of(&[0.0, 1e-30, 1e-3, 1.0, 1.0, 100.0, 1e7, 1e20, 1e38, 1e160, 1e300]);
    let mut number = || size * chance.between(-1.0, 1.0);
    let [a, b, c] = [number(), number(), number()];
    match chance.below(6) {
        0 => json!({ "matrix": [a, b, c, 0, c, a, b, 0, b, c, a, 0, c, b, a, 1] }),
        1 => json!({ "matrix": [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, a, b, c, 1] }),
        2 => json!({ "scale": [a, b, c], "pivot": [c, b, a] }),
        3 => json!({ "rotation": [a, b, c, chance.between(-1.0, 1.0)] }),
        4 => json!({ "translation": [a, b, c], "rotation": [0, 0, 1, 0], "scale": [1, -1, 1] }),
        _ => json!({ "translation": [a, b, c] }),
    }
}

fn selector(vertices: usize, depth: usize, chance: &mut Chance) -> Value {
    let vertex = |chance: &mut Chance| chance.below(vertices.max(1));
    match chance.below(if depth > 0 { 11 } else { 8 }) {
        0 => json!("all"),
        1 => json!("none"),
        2 => json!({ "vertices": [vertex(chance), vertex(chance), vertex(chance)] }),
        3 => {
            let (a, b) = (vertex(chance), vertex(chance));
            json!({ "ranges": [[a.min(b), a.max(b)]] })
        }
        4 | 5 => {
            let from = chance.between(0.0, 0.9);
            json!({ "slab": { "axis": *chance.of(&["x", "y", "z", "longest"]), "from": from, "to": from + 0.2 } })
        }
        6 => json!({ "sphere": { "center": [chance.between(-1.0, 9.0), 1, 0], "radius": chance.between(0.0, 5.0) } }),
        7 => match chance.below(2) {
            0 => json!({ "component": chance.below(3) }),
            _ => json!({ "box": { "min": [-1, -1, -1], "max": [chance.between(0.0, 5.0), 2, 2] } }),
        },
        8 => json!({ "not": selector(vertices, depth - 1, chance) }),
        kind => {
            let inner: Vec<Value> = (0..chance.below(4))
                .map(|_| selector(vertices, depth - 1, chance))
                .collect();
            let name = if kind == 9 { "union" } else { "intersection" };
            json!({ name: inner })
        }
    }
}
