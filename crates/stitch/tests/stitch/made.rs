//! Surfaces with holes, made by leaving out triangles.

use glam::DVec3;
use pliant_mesh::{Drawn, DrawnVertex, Model, shapes};
use pliant_stitch::{Attributes, Part};

/// The shape without the triangles whose middle `is_out`.
pub fn without(shape: &Drawn, is_out: impl Fn(DVec3) -> bool) -> Drawn {
    let middle = |corners: &[DrawnVertex; 3]| corners.iter().map(|v| shape.positions[v.index()]).sum::<DVec3>() / 3.0;
    let mut rest = shape.clone();
    rest.triangles.retain(|corners| !is_out(middle(corners)));
    used(&rest)
}

/// The shape without the vertices that no triangle uses.
pub fn used(shape: &Drawn) -> Drawn {
    let mut number = vec![u32::MAX; shape.positions.len()];
    for corner in shape.triangles.iter().flatten() {
        number[corner.index()] = 0;
    }
    let mut positions = Vec::new();
    for (vertex, number) in number.iter_mut().enumerate().filter(|(_, number)| **number == 0) {
        *number = positions.len() as u32;
        positions.push(shape.positions[vertex]);
    }
    let renumber = |corners: &[DrawnVertex; 3]| corners.map(|v| DrawnVertex(number[v.index()]));
    Drawn::once(positions, shape.triangles.iter().map(renumber).collect())
}

/// Does something with the part of a model whose vertices have their coordinates as colours.
pub fn with_coloured<T>(model: &Model, work: impl FnOnce(&Part<'_>) -> T) -> T {
    let drawn = model.rest();
    let value = |vertex: DrawnVertex, channel: usize| drawn.positions[vertex.index()][channel];
    work(&Part {
        model,
        drawn: &drawn,
        group: &|_| 0,
        attributes: Attributes {
            charted: 0,
            blended: 3,
            value: &value,
        },
        normals: None,
    })
}

/// The model of a shape.
pub fn model(shape: Drawn) -> Model {
    shapes::model(shape)
}

/// The number of handles of a closed surface's components in sum: V − E + F = 2 (components − genus).
pub fn genus(model: &Model) -> i64 {
    let loops = model.topology.boundary_loops().len() as i64;
    let components = model.topology.components().len() as i64;
    let euler = model.surface.positions.len() as i64 - model.topology.edge_count() as i64
        + model.surface.triangles.len() as i64;
    components - (euler + loops) / 2
}

/// A deterministic number from −1 to 1 for a place.
pub fn noise(seed: u64, index: u64) -> f64 {
    let mut x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index.wrapping_mul(0xd1b5_4a32_d192_ed03);
    x ^= x >> 31;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^= x >> 29;
    (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
