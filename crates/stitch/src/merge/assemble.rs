//! Assembles the two bent parts: A's vertices, A's cuts, B's vertices and B's cuts, then the triangles in the same
//! order. Vertices at one point of the common border have one position, to the bit, and one number.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DQuat, DVec3};
use pliant_mesh::{DrawnVertex, FileVertex, Surface, SurfaceVertex};

use super::choice::Join;
use super::chords::cut_doubled;
use super::seam::{Node, Place};
use super::split::Splits;
use crate::part::Part;
use crate::shape::{Age, NewShape, TriangleSource, VertexSource};

/// A part in its final place and shape.
pub(super) struct Bent<'a> {
    pub part: &'a Part<'a>,
    /// Its surface before bending.
    pub rest: &'a Surface,
    /// The positions of its surface's vertices after bending.
    pub positions: Vec<DVec3>,
    /// The positions of its drawn vertices before bending.
    pub drawn: Vec<DVec3>,
    /// The rotation that was applied to the whole part.
    pub turn: DQuat,
}

/// The joined shape.
pub(super) fn assemble(parts: [Bent<'_>; 2], joins: &[(Join, Vec<Node>)]) -> NewShape {
    let mut shape = NewShape::default();
    // The number, in a file without attributes, of each node.
    let nodes: Vec<&Node> = joins.iter().flat_map(|(_, nodes)| nodes).collect();
    let mut file_of_node: Vec<Option<FileVertex>> = vec![None; nodes.len()];
    let mut node_normals = vec![DVec3::ZERO; nodes.len()];
    let mut vertices_of_node: Vec<Vec<DrawnVertex>> = vec![Vec::new(); nodes.len()];
    for side in 0..2 {
        let bent = &parts[side];
        let mut node_of: BTreeMap<SurfaceVertex, usize> = BTreeMap::new();
        let mut splits = Splits::default();
        let first = shape.positions.len() as u32;
        let count = bent.part.drawn.positions.len() as u32;
        let mut first_node = 0;
        for (join, own) in joins {
            let line = [&join.a, &join.b][side];
            for (number, node) in own.iter().enumerate() {
                if let Place::Vertex(v) = node.on[side] {
                    node_of.insert(line.vertices[v], first_node + number);
                }
            }
            splits.add(bent.part, line, own, side, (count, first_node));
            first_node += own.len();
        }
        number_file_vertices(bent, &node_of, &mut file_of_node, &mut shape);
        add_vertices(bent, side, &node_of, &nodes, &mut vertices_of_node, &mut shape);
        for cut in &splits.vertices {
            let width = bent.part.attributes.width();
            let vertex = DrawnVertex(shape.positions.len() as u32);
            let row = shape.values.len().checked_div(width).unwrap_or(0) as u32;
            let value = |channel: usize| {
                let [from, to] = cut.ends.map(|end| (bent.part.attributes.value)(end, channel));
                from + (to - from) * cut.share
            };
            shape.values.extend((0..width).map(value));
            shape.vertices.push(VertexSource::New {
                part: side as u8,
                like: cut.ends[0],
                row,
            });
            shape.positions.push(nodes[cut.node].target);
            let number = *file_of_node[cut.node].get_or_insert_with(|| {
                shape.file_vertex_count += 1;
                FileVertex(shape.file_vertex_count as u32 - 1)
            });
            shape.file_vertices.push(number);
            vertices_of_node[cut.node].push(vertex);
        }
        for (number, corners) in (0..).zip(&bent.part.drawn.triangles) {
            let source = |age| TriangleSource {
                part: side as u8,
                triangle: number,
                age,
            };
            let here = |corner: DrawnVertex| DrawnVertex(corner.0 + first);
            match splits.triangles.get(&number) {
                None => {
                    shape.triangles.push(corners.map(here));
                    shape.triangle_sources.push(source(Age::Old));
                }
                Some(pieces) => {
                    shape.triangles.extend(pieces.iter().map(|piece| piece.map(here)));
                    shape.triangle_sources.extend(pieces.iter().map(|_| source(Age::New)));
                }
            }
        }
        add_rim_normals(bent, joins, side, &mut node_normals);
    }
    blend_borders(&parts, &mut shape, &vertices_of_node);
    turn_normals(&parts, &mut shape, &vertices_of_node, &node_normals);
    let on_border: BTreeSet<FileVertex> = file_of_node.into_iter().flatten().collect();
    let value = |source: VertexSource, channel: usize| match source {
        VertexSource::Old { part, vertex } => (parts[usize::from(part)].part.attributes.value)(vertex, channel),
        VertexSource::New { .. } => 0.0,
    };
    cut_doubled(&mut shape, &on_border, parts[0].part.attributes.width(), value);
    shape
}

/// Gives the vertices at one point of the common border the mean of both sides' colours: without texture coordinates
/// they are one vertex.
fn blend_borders(parts: &[Bent<'_>; 2], shape: &mut NewShape, vertices_of_node: &[Vec<DrawnVertex>]) {
    let (first, width) = (parts[0].part.attributes.charted, parts[0].part.attributes.blended);
    if width == 0 {
        return;
    }
    let value = |vertex: DrawnVertex, channel: usize| match shape.vertices[vertex.index()] {
        VertexSource::Old { part, vertex } => (parts[usize::from(part)].part.attributes.value)(vertex, first + channel),
        VertexSource::New { row, .. } => shape.values[row as usize * (first + width) + first + channel],
    };
    let mut blended = BTreeMap::new();
    for vertices in vertices_of_node {
        let mean = |channel: usize| {
            let of_side = |side: u8| {
                let own = vertices.iter().filter(|v| shape.vertices[v.index()].part() == side);
                let values: Vec<f64> = own.map(|&v| value(v, channel)).collect();
                values.iter().sum::<f64>() / values.len().max(1) as f64
            };
            0.5 * (of_side(0) + of_side(1))
        };
        let row: Vec<f64> = (0..width).map(mean).collect();
        blended.extend(vertices.iter().map(|&vertex| (vertex, row.clone())));
    }
    shape.blended = blended.into_iter().collect();
}

/// Numbers a part's vertices as in a file without attributes. Vertices at a numbered node take its number.
fn number_file_vertices(
    bent: &Bent<'_>,
    node_of: &BTreeMap<SurfaceVertex, usize>,
    file_of_node: &mut [Option<FileVertex>],
    shape: &mut NewShape,
) {
    let drawn = bent.part.drawn;
    let mut node_of_file: Vec<Option<usize>> = vec![None; drawn.file_vertex_count];
    for (v, file) in drawn.file_vertex.iter().enumerate() {
        let surface = bent.part.model.drawn.surface_vertex(DrawnVertex(v as u32));
        if let Some(&node) = surface.and_then(|surface| node_of.get(&surface)) {
            node_of_file[file.index()] = Some(node);
        }
    }
    let mut numbers = Vec::with_capacity(drawn.file_vertex_count);
    for node in &node_of_file {
        let known = node.and_then(|node| file_of_node[node]);
        numbers.push(known.unwrap_or_else(|| {
            shape.file_vertex_count += 1;
            FileVertex(shape.file_vertex_count as u32 - 1)
        }));
    }
    // Twins of one part keep numbers of their own; the other part takes that of the first.
    for (file, node) in node_of_file.iter().enumerate() {
        if let Some(node) = node {
            file_of_node[*node].get_or_insert(numbers[file]);
        }
    }
    shape
        .file_vertices
        .extend(drawn.file_vertex.iter().map(|file| numbers[file.index()]));
}

fn add_vertices(
    bent: &Bent<'_>,
    side: usize,
    node_of: &BTreeMap<SurfaceVertex, usize>,
    nodes: &[&Node],
    vertices_of_node: &mut [Vec<DrawnVertex>],
    shape: &mut NewShape,
) {
    for (v, &position) in bent.drawn.iter().enumerate() {
        let vertex = DrawnVertex(v as u32);
        let own = DrawnVertex(shape.positions.len() as u32);
        let surface = bent.part.model.drawn.surface_vertex(vertex);
        let position = match surface {
            None => position,
            Some(surface) => match node_of.get(&surface) {
                Some(&node) => {
                    vertices_of_node[node].push(own);
                    nodes[node].target
                }
                None => {
                    let way = bent.positions[surface.index()] - bent.rest.positions[surface.index()];
                    if way == DVec3::ZERO { position } else { position + way }
                }
            },
        };
        let part = side as u8;
        shape.vertices.push(VertexSource::Old { part, vertex });
        shape.positions.push(position);
    }
}

/// Adds the area vectors of a part's bent triangles around the nodes.
fn add_rim_normals(bent: &Bent<'_>, joins: &[(Join, Vec<Node>)], side: usize, out: &mut [DVec3]) {
    let (topology, triangles) = (&bent.part.model.topology, &bent.rest.triangles);
    let around = |vertex: SurfaceVertex| {
        let faces = topology.faces(vertex, triangles);
        let areas = faces.map(|face| {
            let [a, b, c] = triangles[face as usize].map(|corner| bent.positions[corner.index()]);
            (b - a).cross(c - a)
        });
        areas.sum::<DVec3>()
    };
    let mut number = 0;
    for (join, nodes) in joins {
        let line = [&join.a, &join.b][side];
        for node in nodes {
            out[number] += match node.on[side] {
                Place::Vertex(v) => around(line.vertices[v]),
                Place::Edge(v, _) => {
                    let ends = [v, (v + 1) % line.count()].map(|end| around(line.vertices[end]));
                    0.5 * (ends[0] + ends[1])
                }
            };
            number += 1;
        }
    }
}

/// Turns normals: with the surface where it bent, and on the border to the normal of the common surface.
fn turn_normals(
    parts: &[Bent<'_>; 2],
    shape: &mut NewShape,
    vertices_of_node: &[Vec<DrawnVertex>],
    node_normals: &[DVec3],
) {
    let mut turned: BTreeMap<DrawnVertex, DVec3> = BTreeMap::new();
    let mut first = 0;
    for (side, bent) in parts.iter().enumerate() {
        let Some(normal_of) = bent.part.normals else {
            first = shape.vertices.iter().filter(|source| source.part() == 0).count();
            continue;
        };
        let of_surface = surface_turns(bent);
        for v in 0..bent.drawn.len() {
            let surface = bent.part.model.drawn.surface_vertex(DrawnVertex(v as u32));
            let own = surface.and_then(|surface| of_surface.get(&surface));
            let normal = normal_of(DrawnVertex(v as u32));
            // A part may differ from its file as a whole, so every normal is written; those that do not turn keep their
            // digits.
            let normal = match own {
                None if bent.turn == DQuat::IDENTITY => normal,
                _ => (own.copied().unwrap_or(DQuat::IDENTITY) * (bent.turn * normal)).normalize_or_zero(),
            };
            turned.insert(DrawnVertex((first + v) as u32), normal);
        }
        if side == 0 {
            first = shape.vertices.iter().filter(|source| source.part() == 0).count();
        }
    }
    if parts.iter().any(|bent| bent.part.normals.is_some()) {
        for (vertices, normal) in vertices_of_node.iter().zip(node_normals) {
            let normal = normal.normalize_or_zero();
            for &vertex in vertices {
                turned.insert(vertex, normal);
            }
        }
    }
    shape.normals = turned.into_iter().collect();
}

/// The turn of the surface's normal at each vertex whose triangles changed.
fn surface_turns(bent: &Bent<'_>) -> BTreeMap<SurfaceVertex, DQuat> {
    let is_moved = |v: SurfaceVertex| bent.positions[v.index()] != bent.rest.positions[v.index()];
    let triangles = bent
        .rest
        .triangles
        .iter()
        .filter(|corners| corners.iter().any(|&v| is_moved(v)));
    let mut turns = BTreeMap::new();
    for &vertex in triangles.flatten() {
        turns.entry(vertex).or_insert_with(|| {
            let faces: Vec<u32> = bent.part.model.topology.faces(vertex, &bent.rest.triangles).collect();
            let normal = |positions: &[DVec3]| {
                let areas = faces.iter().map(|&face| {
                    let [a, b, c] = bent.rest.triangles[face as usize].map(|corner| positions[corner.index()]);
                    (b - a).cross(c - a)
                });
                areas.sum::<DVec3>().normalize_or_zero()
            };
            let (before, after) = (normal(&bent.rest.positions), normal(&bent.positions));
            match before == DVec3::ZERO || after == DVec3::ZERO {
                true => DQuat::IDENTITY,
                false => DQuat::from_rotation_arc(before, after),
            }
        });
    }
    turns
}
