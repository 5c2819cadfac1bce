//! Cuts edges that both parts have between the same two points of the common border: four triangles would share such an
//! edge, so B's edge gets a vertex in its middle.
//!
//! A part has such an edge if one of its triangles has two edges on the border, like a tooth of a saw.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use pliant_mesh::{DrawnVertex, FileVertex};

use crate::shape::{Age, NewShape, VertexSource};

/// Cuts B's copies of edges that more than two triangles share. `on_border` are the numbers of the common border's
/// vertices in a file without attributes, `width` is the count of numbers at a vertex, and `value` gives those of old
/// ones.
pub(super) fn cut_doubled(
    shape: &mut NewShape,
    on_border: &BTreeSet<FileVertex>,
    width: usize,
    value: impl Fn(VertexSource, usize) -> f64,
) {
    let file = |shape: &NewShape, v: DrawnVertex| shape.file_vertices[v.index()];
    let count = |corners: &[DrawnVertex; 3]| corners.iter().filter(|v| on_border.contains(&file(shape, **v))).count();
    let mut near: Vec<usize> = (0..shape.triangles.len())
        .filter(|&t| count(&shape.triangles[t]) > 1)
        .collect();
    let mut sharing: BTreeMap<[FileVertex; 2], usize> = BTreeMap::new();
    for &t in &near {
        for edge in edges(shape, t) {
            if edge.iter().all(|end| on_border.contains(end)) {
                *sharing.entry(edge).or_default() += 1;
            }
        }
    }
    for edge in sharing
        .into_iter()
        .filter(|(_, count)| *count > 2)
        .map(|(edge, _)| edge)
    {
        let own: Vec<usize> = near
            .iter()
            .copied()
            .filter(|&t| shape.triangle_sources[t].part == 1 && edges(shape, t).contains(&edge))
            .collect();
        let number = FileVertex(shape.file_vertex_count as u32);
        shape.file_vertex_count += 1;
        // The drawn edge, and the vertex in its middle.
        let mut middles: Vec<([DrawnVertex; 2], DrawnVertex)> = Vec::new();
        for t in own {
            let [a, b, c] = shape.triangles[t];
            let found = [[a, b, c], [b, c, a], [c, a, b]].into_iter().find(|&[from, to, _]| {
                let ends = [file(shape, from), file(shape, to)];
                ends == edge || ends == [edge[1], edge[0]]
            });
            let Some([from, to, third]) = found else { continue };
            let ends = [from.min(to), from.max(to)];
            let known = middles.iter().find(|(own, _)| *own == ends).map(|(_, middle)| *middle);
            let middle = known.unwrap_or_else(|| add_middle(shape, ends, number, width, &value));
            middles.push((ends, middle));
            shape.triangles[t] = [from, middle, third];
            shape.triangles.push([middle, to, third]);
            shape.triangle_sources[t].age = Age::New;
            shape.triangle_sources.push(shape.triangle_sources[t]);
            near.push(shape.triangles.len() - 1);
        }
    }
}

/// A triangle's edges, lower end first.
fn edges(shape: &NewShape, triangle: usize) -> [[FileVertex; 2]; 3] {
    let [a, b, c] = shape.triangles[triangle].map(|v| shape.file_vertices[v.index()]);
    [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
}

fn add_middle(
    shape: &mut NewShape,
    ends: [DrawnVertex; 2],
    number: FileVertex,
    width: usize,
    value: &impl Fn(VertexSource, usize) -> f64,
) -> DrawnVertex {
    let middle = DrawnVertex(shape.positions.len() as u32);
    let [from, to] = ends.map(DrawnVertex::index);
    let row = shape.values.len().checked_div(width).unwrap_or(0) as u32;
    let of = |end: usize, channel: usize| match shape.vertices[end] {
        VertexSource::New { row, .. } => shape.values[row as usize * width + channel],
        old @ VertexSource::Old { .. } => value(old, channel),
    };
    let values: Vec<f64> = (0..width)
        .map(|channel| 0.5 * (of(from, channel) + of(to, channel)))
        .collect();
    shape.values.extend(values);
    let like = match shape.vertices[from] {
        VertexSource::Old { vertex, .. } => vertex,
        VertexSource::New { like, .. } => like,
    };
    shape.vertices.push(VertexSource::New { part: 1, like, row });
    shape
        .positions
        .push(shape.positions[from].midpoint(shape.positions[to]));
    shape.file_vertices.push(number);
    let normal = |end: DrawnVertex| {
        let found = shape.normals.binary_search_by_key(&end, |(vertex, _)| *vertex);
        found.map_or(DVec3::ZERO, |found| shape.normals[found].1)
    };
    let normal = (normal(ends[0]) + normal(ends[1])).normalize_or_zero();
    if normal != DVec3::ZERO {
        shape.normals.push((middle, normal));
    }
    middle
}
