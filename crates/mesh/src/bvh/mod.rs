//! A bounding-volume hierarchy over a surface's triangles: rays, nearest vertices and views, refitted while it moves.
//!
//! obvhs builds the tree (PLOC, [MB18]); this module walks it, because the traversal of obvhs works in f32 throughout.
//! Boxes are f32, relative to a centre and scaled to the unit cube, and rounded outward; positions and all tests on
//! them are f64. So a surface at geographic coordinates is hit as exactly as one at the origin.
//!
//! Boxes and positions are stored in [`Blocks`]: a copy is nearly free, and refitting it rewrites only the blocks that
//! moved, so that one copy can be refitted while the other still answers queries.

mod blocks;
mod boxes;
mod query;
mod self_intersections;

use std::sync::Arc;

use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use crate::SurfaceVertex;
use crate::surface::corners;

pub use self_intersections::{SelfIntersection, SelfIntersections};

use blocks::{BLOCK, Blocks};
use boxes::{BoxSpace, RUN, Span};

/// The point at which a ray met the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle, as an index into the triangles of the hierarchy.
    pub triangle: u32,
    /// The weights of its three corners: not negative, their sum 1.
    pub barycentric: [f64; 3],
    /// The ray's parameter: the point is `origin + distance * direction`, so this is a length if the direction is a
    /// unit vector.
    pub distance: f64,
}

/// A hierarchy of boxes over triangles. It keeps its own copy of the positions.
#[derive(Clone)]
pub struct Bvh {
    nodes: Blocks<Node>,
    positions: Blocks<DVec3>,
    /// Boxes of [`RUN`] consecutive vertices each.
    runs: Vec<Span>,
    leaves: Arc<Leaves>,
    space: BoxSpace,
}

/// The triangles in the order of the leaves; never changed.
struct Leaves {
    triangles: Vec<u32>,
    corners: Vec<[SurfaceVertex; 3]>,
}

/// A box, and below it two adjacent nodes or a leaf.
#[derive(Clone, Copy)]
struct Node {
    span: Span,
    /// The first child's number, or for a leaf the place of its first triangle.
    first: u32,
    /// The triangles of a leaf; 0 for other nodes.
    count: u32,
}

/// A box for building the tree: larger by a millionth or two of the whole, by different amounts for numbers nearby.
/// PLOC joins the boxes whose union has the least area; among triangles on one line or in one place all unions are
/// alike, so only two boxes were joined in a round, and the time was quadratic.
fn grown(own: Aabb, number: usize) -> Aabb {
    const LEAST: f32 = 2e-6;
    // The golden ratio's multiples are evenly distributed between 0 and 1.
    let share = (number as u32).wrapping_mul(0x9e37_79b9) as f32 / u32::MAX as f32;
    let by = LEAST * (1.0 + share);
    Aabb {
        min: own.min - by,
        max: own.max + by,
    }
}

impl Bvh {
    /// A hierarchy over all or some `triangles` of a surface with these finite `positions`.
    pub fn build(positions: &[DVec3], triangles: &[[SurfaceVertex; 3]]) -> Self {
        // Bare points come after the last corner; one far away would leave no digits for the boxes of the triangles.
        let used = triangles.par_iter().flatten().map(|corner| corner.index() + 1).max();
        let space = BoxSpace::of(&positions[..used.unwrap_or(positions.len())]);
        let boxes: Vec<Aabb> = (0..triangles.len())
            .into_par_iter()
            .map(|number| grown(space.span(corners(triangles[number], positions)).aabb(), number))
            .collect();
        let every = (0..triangles.len() as u32).collect();
        let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
            PlocSearchDistance::Low,
            &boxes,
            every,
            SortPrecision::U64,
            2,
        );
        collapse(&mut tree, 4, 1.5);
        let positions = Blocks::of(positions);
        Self {
            runs: (0..positions.len().div_ceil(RUN))
                .map(|run| space.run(&positions, run))
                .collect(),
            leaves: Arc::new(Leaves {
                corners: tree
                    .primitive_indices
                    .iter()
                    .map(|&triangle| triangles[triangle as usize])
                    .collect(),
                triangles: std::mem::take(&mut tree.primitive_indices),
            }),
            nodes: nodes(&tree),
            positions,
            space,
        }
    }

    /// Takes the vertices' new positions, all finite, from `position`. The tree's shape stays, so answers stay correct
    /// but get slower the more the surface differs from the one that the tree was built for. After one pass over
    /// everything, the time depends on the number of moved vertices.
    pub fn refit(&mut self, position: impl Fn(SurfaceVertex) -> DVec3 + Sync) {
        let mut moved = vec![false; self.positions.len()];
        let blocks = self.positions.each_mut().par_iter_mut();
        blocks
            .zip(moved.par_chunks_mut(BLOCK))
            .enumerate()
            .for_each(|(number, (block, moved))| {
                let position = |place: usize| position(SurfaceVertex((number * BLOCK + place) as u32));
                let mut any = false;
                for (place, moved) in moved.iter_mut().enumerate() {
                    *moved = position(place) != block[place];
                    any |= *moved;
                }
                if any {
                    for (place, old) in Arc::make_mut(block).iter_mut().enumerate() {
                        *old = position(place);
                    }
                }
            });
        let (space, positions) = (self.space, &self.positions);
        let runs = self.runs.par_iter_mut().zip(moved.par_chunks(RUN)).enumerate();
        runs.filter(|(_, (_, moved))| moved.contains(&true))
            .for_each(|(number, (run, _))| *run = space.run(positions, number));
        self.refit_boxes(&moved);
    }

    /// The boxes of all nodes with a corner that moved.
    fn refit_boxes(&mut self, moved: &[bool]) {
        let (leaves, positions, space) = (&*self.leaves, &self.positions, self.space);
        let mut is_other = vec![false; self.nodes.len()];
        let blocks = self.nodes.each_mut().par_iter_mut();
        blocks
            .zip(is_other.par_chunks_mut(BLOCK))
            .for_each(|(block, is_other)| {
                for (node, is_other) in block.iter().zip(is_other.iter_mut()) {
                    *is_other = node.leaf().is_some_and(|leaf| {
                        leaves.corners[leaf]
                            .iter()
                            .flatten()
                            .any(|vertex| moved[vertex.index()])
                    });
                }
                if is_other.contains(&true) {
                    for (node, _) in Arc::make_mut(block).iter_mut().zip(&*is_other).filter(|(_, is)| **is) {
                        let corners = leaves.corners[node.leaf().unwrap_or_default()].iter();
                        let boxes = corners.map(|corners| space.span(corners.map(|v| positions.get(v.index()))));
                        node.span = boxes.reduce(|a, b| a.union(&b)).unwrap_or(node.span);
                    }
                }
            });
        // Children come after their parents.
        for number in (0..self.nodes.len().div_ceil(BLOCK)).rev() {
            let start = number * BLOCK;
            let mut any = false;
            for place in (start..(start + BLOCK).min(self.nodes.len())).rev() {
                let node = self.nodes.get(place);
                if node.count == 0 {
                    is_other[place] = is_other[node.first as usize] || is_other[node.first as usize + 1];
                    any |= is_other[place];
                }
            }
            if any {
                self.nodes.rewrite(number, |block, others| {
                    for place in (0..block.len()).rev() {
                        let Node { first, count, .. } = block[place];
                        if count == 0 && is_other[start + place] {
                            let [a, b] = [first, first + 1].map(|child| match (child as usize).checked_sub(start) {
                                Some(own) if own < block.len() => block[own].span,
                                _ => others.get(child as usize).span,
                            });
                            block[place].span = a.union(&b);
                        }
                    }
                });
            }
        }
    }
}

/// The nodes of a tree with children after their parents, as obvhs builds it.
fn nodes(tree: &Bvh2) -> Blocks<Node> {
    debug_assert!(tree.children_are_ordered_after_parents || tree.nodes.is_empty());
    let nodes: Vec<Node> = tree
        .nodes
        .iter()
        .map(|node| Node {
            span: Span {
                min: node.aabb().min.into(),
                max: node.aabb().max.into(),
            },
            first: node.first_index,
            count: node.prim_count,
        })
        .collect();
    Blocks::of(&nodes)
}

impl Node {
    /// The places of a leaf's triangles.
    fn leaf(&self) -> Option<std::ops::Range<usize>> {
        (self.count > 0).then(|| self.first as usize..(self.first + self.count) as usize)
    }
}
