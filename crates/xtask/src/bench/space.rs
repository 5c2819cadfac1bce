//! The methods that bend space, with the example `space` of `deform`, against Blender's modifiers of the same kind on
//! the same shape (`tests/peer/blender_space.py`).

use super::scale::Scale;
use super::table::{Row, measured};
use crate::process::output;

/// Each method with the options for its figures. A cage of `detail` 3 has 300 faces here.
#[rustfmt::skip]
const METHODS: [&[&str]; 12] = [
    &["rbf", "tolerance=1e-9", "centres=1000"],
    &["lattice", "resolution=8"],
    &["cage", "coordinates=mean-value"],
    &["cage", "coordinates=mean-value", "detail=3"],
    &["cage", "coordinates=harmonic", "detail=3"],
    &["cage", "coordinates=green", "detail=3"],
    &["mls", "transforms=rigid"],
    &["mls", "transforms=similarity"],
    &["mls", "transforms=affine"],
    &["embedded", "nodes=300"],
    &["space-primo", "cells=2000"],
    &["rbf"],
];

/// One row per size and method, then Blender's.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    let sizes: &[&str] = match scale {
        Scale::Usual => &["200000"],
        Scale::Full => &["200000", "1000000"],
    };
    let script = crate::root::root()
        .join("tests/peer/blender_space.py")
        .display()
        .to_string();
    let mut rows = Vec::new();
    for &vertices in sizes {
        for method in METHODS {
            let mut arguments = vec![vertices.to_owned(), all.clone()];
            arguments.extend(method.iter().map(|&word| word.to_owned()));
            let options = Row::default().text("options", &method[1..].join(" "));
            let measured = measured("pliant-deform", "space", &arguments)?;
            rows.extend(measured.into_iter().map(|row| row.and(options.clone())));
        }
        match output("python3", &[&script, vertices]) {
            Some(lines) => rows.extend(lines.lines().filter_map(Row::parse)),
            None => rows.push(Row::default().text("says", "not installed: pip install bpy numpy")),
        }
    }
    Ok(rows)
}
