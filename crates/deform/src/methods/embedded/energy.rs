//! The terms of the energy, all in the unit of the mean distance of joined nodes.

use glam::{DMat3, DVec3};
use pliant_mesh::SurfaceVertex;

use super::graph::Graph;
use crate::Role;
use crate::handles::Motion;
use crate::method::BindInput;
use crate::numerical::nearest::NearestPoints;
use crate::numerical::samples::{EQUAL, farthest, thinned};
use crate::space::shaping::shaping;
use rayon::prelude::*;

/// The weights of the terms. [SSP07, section 5] has 1 for the rigidity, but ‖AᵀA − I‖² is at most 3 even for a flat
/// map: inside an elbow of 120° edges shrank to a fourteenth of their length.
const RIGIDITY: f64 = 30.0;
pub(super) const REGULARITY: f64 = 10.0;
const HARD: f64 = 100.0;
/// The weight of a soft handle of weight 1.
const SOFT: f64 = 10.0;

/// The reach of the cross at a constraint.
const CROSS: f64 = 0.3;

/// The most constraints of a handle, and of the fixed vertices.
const MOST: usize = 400;

/// Sets with more vertices than these are thinned on a grid before constraints are spread.
const CANDIDATES: usize = 8192;

/// A node's unknowns: X by its rows, each followed by the shift's entry.
pub(super) const DOF: usize = 12;

/// A node's map: it displaces a point at `arm` from the node by `linear arm + shift`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct NodeMap {
    /// X.
    pub linear: DMat3,
    /// t.
    pub shift: DVec3,
}

/// All terms.
#[derive(Debug)]
pub(super) struct Energy {
    /// ρ of each node.
    pub rigidity: Vec<f64>,
    pub edges: Vec<Joint>,
    pub constraints: Vec<Constraint>,
    /// Each handle's unit of length.
    pub world_radii: Vec<f64>,
    pub world_unit: f64,
}

/// An edge of the graph.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub nodes: [u32; 2],
    /// [`REGULARITY`] times α.
    pub weight: f64,
    /// From the first node to the second.
    pub along: DVec3,
}

/// A constrained vertex.
#[derive(Clone, Debug)]
pub(super) struct Constraint {
    /// The nodes with their weights, and the vertex's position relative to each.
    pub nodes: Vec<(u32, f64, DVec3)>,
    /// Its handle and the coordinates there; `None` if it is fixed.
    pub handle: Option<(usize, [f64; 4])>,
    pub weight: f64,
}

/// Vertices that are constrained together.
pub(super) struct ConstrainedSet {
    vertices: Vec<u32>,
    handle: Option<usize>,
    weight: f64,
}

/// Samples of the handles, and of the fixed vertices that are within `reach` of the vertices `moving` or share a
/// triangle with one.
pub(super) fn constrained(input: &BindInput<'_>, moving: &[u32], world_reach: f64) -> Vec<ConstrainedSet> {
    let positions = &input.problem.surface.positions;
    let samples = |vertices: &[u32]| farthest(&thinned(vertices, positions, CANDIDATES), positions, MOST);
    let handles = input.handles.iter().zip(&input.partition.soft).enumerate();
    let mut sets: Vec<ConstrainedSet> = handles
        .map(|(number, (handle, soft))| ConstrainedSet {
            vertices: samples(&shaping(input.problem, handle.vertices.iter().copied())),
            handle: Some(number),
            weight: soft.map_or(HARD, |weight| (SOFT * weight).min(HARD)),
        })
        .collect();
    let nearest = NearestPoints::of(positions, moving.iter().copied());
    let roles = input.problem.roles;
    let is_beside = |vertex: u32| {
        let mut around = input.problem.topology.neighbours(SurfaceVertex(vertex)).iter();
        around.any(|other| roles[other.index()] != Role::Fixed)
    };
    let fixed = (0..positions.len() as u32).filter(|&vertex| roles[vertex as usize] == Role::Fixed);
    let fixed: Vec<u32> = shaping(input.problem, fixed)
        .into_par_iter()
        .filter(|&vertex| {
            let near = nearest.nearest(positions[vertex as usize]);
            near.is_some_and(|(_, distance)| distance <= world_reach * (1.0 + EQUAL)) || is_beside(vertex)
        })
        .collect();
    sets.push(ConstrainedSet {
        vertices: samples(&fixed),
        handle: None,
        weight: HARD,
    });
    sets
}

impl ConstrainedSet {
    /// The positions of its vertices.
    pub fn places<'a>(&'a self, positions: &'a [DVec3]) -> impl Iterator<Item = DVec3> + 'a {
        self.vertices.iter().map(|&vertex| positions[vertex as usize])
    }
}

impl Energy {
    pub fn of(input: &BindInput<'_>, graph: &Graph, sets: &[ConstrainedSet]) -> Self {
        let positions = &input.problem.surface.positions;
        let unit = graph.world_unit;
        let at = |node: u32| graph.world_nodes[node as usize];
        let joint = |edge: &super::graph::Edge| Joint {
            nodes: edge.nodes,
            weight: REGULARITY * edge.weight,
            along: (at(edge.nodes[1]) - at(edge.nodes[0])) / unit,
        };
        let mut constraints = Vec::new();
        for set in sets {
            let first = constraints.len();
            let mut met = vec![false; graph.world_nodes.len()];
            for &vertex in &set.vertices {
                let place = positions[vertex as usize];
                let shares = graph.influence(place);
                shares.iter().for_each(|share| met[share.source as usize] = true);
                constraints.push(Constraint {
                    nodes: shares
                        .iter()
                        .map(|share| (share.source, share.weight, (place - at(share.source)) / unit))
                        .collect(),
                    handle: set
                        .handle
                        .map(|handle| (handle, input.handles[handle].coordinates(place))),
                    weight: 0.0,
                });
            }
            // Each node that the set holds has the same weight, for any number of vertices.
            let own = &mut constraints[first..];
            let each = set.weight * met.iter().filter(|met| **met).count() as f64 / own.len().max(1) as f64;
            own.iter_mut().for_each(|constraint| constraint.weight = each);
        }
        Self {
            rigidity: graph.rigidity.iter().map(|own| RIGIDITY * own).collect(),
            edges: graph.edges.iter().map(joint).collect(),
            constraints,
            world_radii: input.handles.iter().map(|handle| handle.radius).collect(),
            world_unit: unit,
        }
    }

    /// The number of nodes.
    pub fn count(&self) -> usize {
        self.rigidity.len()
    }

    /// E, and half its gradient if a buffer is given.
    pub fn evaluate(&self, maps: &[NodeMap], motions: &[Motion], mut gradient: Option<&mut [[f64; DOF]]>) -> f64 {
        let mut energy = 0.0;
        let mut add = |node: u32, linear: DMat3, shift: DVec3| {
            if let Some(gradient) = &mut gradient {
                let own = &mut gradient[node as usize];
                for row in 0..3 {
                    for column in 0..3 {
                        own[4 * row + column] += linear.col(column)[row];
                    }
                    own[4 * row + 3] += shift[row];
                }
            }
        };
        for ((node, map), &rigidity) in (0..).zip(maps).zip(&self.rigidity) {
            let strain = strain(&map.linear);
            energy += rigidity * square(&strain);
            // ½ d‖G‖² = tr(Gᵀ dG) with dG = dAᵀ A + Aᵀ dA.
            add(
                node,
                (map.linear + DMat3::IDENTITY) * strain * (2.0 * rigidity),
                DVec3::ZERO,
            );
        }
        for joint in &self.edges {
            let [one, other] = joint.nodes.map(|node| maps[node as usize]);
            let ahead = one.linear * joint.along + one.shift - other.shift;
            let behind = other.shift - other.linear * joint.along - one.shift;
            energy += joint.weight * (ahead.length_squared() + behind.length_squared());
            let pull = (ahead - behind) * joint.weight;
            add(joint.nodes[0], outer(ahead, joint.along) * joint.weight, pull);
            add(joint.nodes[1], outer(behind, -joint.along) * joint.weight, -pull);
        }
        for constraint in &self.constraints {
            let (miss, turned) = self.missed(constraint, maps, motions);
            energy += constraint.weight * (miss.length_squared() + CROSS * CROSS * square(&turned));
            for &(node, weight, arm) in &constraint.nodes {
                let pull = miss * (constraint.weight * weight);
                let turn = turned * (CROSS * CROSS * constraint.weight * weight);
                add(node, outer(pull, arm) + turn, pull);
            }
        }
        energy
    }

    /// The error of a constraint, and that of its linear map.
    fn missed(&self, constraint: &Constraint, maps: &[NodeMap], motions: &[Motion]) -> (DVec3, DMat3) {
        let (mut miss, mut turned) = (DVec3::ZERO, DMat3::ZERO);
        for &(node, weight, arm) in &constraint.nodes {
            let map = &maps[node as usize];
            miss += (map.linear * arm + map.shift) * weight;
            turned += map.linear * weight;
        }
        if let Some((handle, coordinates)) = constraint.handle {
            miss -= motions[handle].displace(coordinates) / self.world_unit;
            turned -= motions[handle].linear * self.world_radii[handle].recip();
        }
        (miss, turned)
    }

    /// The equations of each edge and constraint for one row of the maps: factors of the nodes' four unknowns, and the
    /// equation's weight.
    pub fn equations(&self, mut visit: impl FnMut(&[(u32, [f64; 4])], f64)) {
        for joint in &self.edges {
            let [x, y, z] = joint.along.to_array();
            let [one, other] = joint.nodes;
            visit(&[(one, [x, y, z, 1.0]), (other, [0.0, 0.0, 0.0, -1.0])], joint.weight);
            visit(
                &[(one, [0.0, 0.0, 0.0, -1.0]), (other, [-x, -y, -z, 1.0])],
                joint.weight,
            );
        }
        let mut row = Vec::new();
        for constraint in &self.constraints {
            row.clear();
            let point = |&(node, weight, arm): &(u32, f64, DVec3)| {
                (node, [arm.x, arm.y, arm.z, 1.0].map(|value| value * weight))
            };
            row.extend(constraint.nodes.iter().map(point));
            visit(&row, constraint.weight);
            for axis in 0..3 {
                row.clear();
                let along = |&(node, weight, _): &(u32, f64, DVec3)| {
                    let mut factors = [0.0; 4];
                    factors[axis] = CROSS * weight;
                    (node, factors)
                };
                row.extend(constraint.nodes.iter().map(along));
                visit(&row, constraint.weight);
            }
        }
    }
}

/// AᵀA − I.
pub(super) fn strain(linear: &DMat3) -> DMat3 {
    *linear + linear.transpose() + linear.transpose() * *linear
}

/// ‖M‖².
fn square(m: &DMat3) -> f64 {
    m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()
}

/// a bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
