//! Cuts the triangles along a border at the points of the other border.

use std::collections::BTreeMap;

use pliant_mesh::DrawnVertex;

use super::line::Line;
use super::seam::{Node, Place};
use crate::part::{Part, face_beyond};

/// A new vertex on an edge of a drawn triangle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct CutVertex {
    /// The node that it shows.
    pub node: usize,
    /// The ends of the edge, and the share of it before the vertex.
    pub ends: [DrawnVertex; 2],
    pub share: f64,
}

/// The cuts of a part's triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Splits {
    /// The new vertices, numbered from `first`.
    pub vertices: Vec<CutVertex>,
    /// For each cut drawn triangle its pieces.
    pub triangles: BTreeMap<u32, Vec<[DrawnVertex; 3]>>,
}

impl Splits {
    /// Adds the cuts along a line. The line is side 0 (the part is A) or 1. `first` is the number of the part's first
    /// new vertex; `first_node` numbers the nodes.
    pub fn add(
        &mut self,
        part: &Part<'_>,
        line: &Line,
        nodes: &[Node],
        side: usize,
        (first, first_node): (u32, usize),
    ) {
        let mut of_edge: BTreeMap<usize, Vec<(f64, usize)>> = BTreeMap::new();
        for (number, node) in nodes.iter().enumerate() {
            if let Place::Edge(edge, share) = node.on[side] {
                of_edge.entry(edge).or_default().push((share, first_node + number));
            }
        }
        for (edge, mut cuts) in of_edge {
            cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (from, to) = (line.vertices[edge], line.vertices[(edge + 1) % line.count()]);
            // A's line has the hole on its left; B's has the opposite direction.
            let (back, fore) = if side == 0 { (to, from) } else { (from, to) };
            let Some(face) = face_beyond(part.model, fore, back) else {
                continue;
            };
            let (own, drawn) = (part.model.surface.triangles[face], part.model.drawn_corners(face));
            let corner = |vertex| (0..3).find(|&k| own[k] == vertex).map_or(drawn[0], |k| drawn[k]);
            let (start, end) = (corner(back), corner(fore));
            // The triangle has the edge from `start` to `end`, and the cuts follow its direction.
            if side == 0 {
                cuts.reverse();
            }
            let number = part.model.drawn.triangle_of_surface()[face];
            let pieces = self.triangles.entry(number).or_insert_with(|| vec![drawn]);
            let mut before = start;
            for (share, node) in cuts {
                let vertex = DrawnVertex(first + self.vertices.len() as u32);
                let share = if side == 0 { 1.0 - share } else { share };
                self.vertices.push(CutVertex {
                    node,
                    ends: [start, end],
                    share,
                });
                cut_edge(pieces, [before, end], vertex);
                before = vertex;
            }
        }
    }
}

/// Cuts the piece with this edge at a new vertex on it.
fn cut_edge(pieces: &mut Vec<[DrawnVertex; 3]>, [from, to]: [DrawnVertex; 2], at: DrawnVertex) {
    let found = pieces
        .iter()
        .position(|&[a, b, c]| [[a, b], [b, c], [c, a]].contains(&[from, to]));
    let Some(found) = found else { return };
    let third = pieces[found]
        .into_iter()
        .find(|v| *v != from && *v != to)
        .unwrap_or(from);
    pieces[found] = [from, at, third];
    pieces.push([at, to, third]);
}
