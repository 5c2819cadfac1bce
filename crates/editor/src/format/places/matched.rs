//! The recorded place of each vertex of a mesh.

use glam::DVec3;
use pliant_mesh::{Model, NearPoint, OrientedPoints, SurfaceVertex, vertex_normals};
use rayon::prelude::*;

use super::blend::blended;
use super::recorded::Recorded;

/// A right angle between normals counts as this distance, as a share of the box's diagonal.
const TURN: f64 = 0.025;

/// A vertex is matched by itself if a place is as near as this share of the box's diagonal: the sample's distance where
/// it is coarse (a 40th of the longest side, in three directions), and the difference of two scans.
const NEAR: f64 = 0.05;

/// Vertices further from their place than this share of the box's diagonal are left out.
const FAR: f64 = 0.15;

/// The places between which a field is interpolated.
const BETWEEN: usize = 12;

/// Vertices that one thread takes at a time, at least.
const PIECE: usize = 1 << 10;

/// The vertices of a surface with their normals at rest.
pub(in crate::format) struct Oriented<'a> {
    pub model: &'a Model,
    /// Unit normals, or 0.
    pub normals: Vec<DVec3>,
    /// True if the normals point to the other side of the triangles.
    pub is_turned: bool,
}

impl<'a> Oriented<'a> {
    pub fn of(model: &'a Model) -> Self {
        let mut normals = Vec::new();
        let surface = &model.surface;
        vertex_normals(&surface.triangles, &model.topology, &surface.positions, &mut normals);
        Self {
            model,
            normals,
            is_turned: false,
        }
    }

    /// The same vertices as if each triangle had the opposite winding.
    pub fn turned(mut self) -> Self {
        self.normals.iter_mut().for_each(|normal| *normal = -*normal);
        self.is_turned = !self.is_turned;
        self
    }

    pub fn positions(&self) -> &'a [DVec3] {
        &self.model.surface.positions
    }
}

/// Recorded places in a search tree.
pub(in crate::format) struct PlaceTree<'a> {
    pub recorded: &'a Recorded,
    tree: OrientedPoints,
    diagonal: f64,
}

impl<'a> PlaceTree<'a> {
    pub fn of(recorded: &'a Recorded) -> Self {
        let diagonal = recorded.bounds.diagonal();
        Self {
            recorded,
            tree: OrientedPoints::new(&recorded.positions, &recorded.normals, TURN * diagonal),
            diagonal,
        }
    }

    /// For each surface vertex its place. A vertex that no place is near to, in a hole of the other scan or on a spike,
    /// has that of its nearest neighbour along edges.
    pub fn of_each(&self, mesh: &Oriented<'_>) -> Vec<Option<u32>> {
        let each = mesh.positions().par_iter().zip(&mesh.normals).with_min_len(PIECE);
        let mut of_each: Vec<Option<u32>> = each
            .map_init(Vec::new, |found, (&position, &normal)| {
                self.tree.nearest(position, normal, NEAR * self.diagonal, 1, found);
                found.first().map(|near| near.number)
            })
            .collect();
        self.continue_along_edges(mesh, &mut of_each);
        of_each
    }

    /// Gives vertices without a place that of a neighbour, ring by ring.
    fn continue_along_edges(&self, mesh: &Oriented<'_>, of_each: &mut [Option<u32>]) {
        let position = |v: SurfaceVertex| mesh.positions()[v.index()];
        let mut left: Vec<SurfaceVertex> = (0..)
            .map(SurfaceVertex)
            .zip(of_each.iter())
            .filter(|(_, place)| place.is_none())
            .map(|(v, _)| v)
            .collect();
        loop {
            let of_neighbour = |v: SurfaceVertex| {
                let neighbours = mesh.model.topology.neighbours(v).iter();
                let placed = neighbours.filter_map(|other| {
                    let place = of_each[other.index()]?;
                    Some((position(*other).distance(position(v)), other.index(), place))
                });
                let (_, _, place) = placed.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
                let distance = self.recorded.positions[place as usize].distance(position(v));
                (distance <= FAR * self.diagonal).then_some((v, place))
            };
            let ring: Vec<(SurfaceVertex, u32)> = left.iter().filter_map(|v| of_neighbour(*v)).collect();
            if ring.is_empty() {
                return;
            }
            ring.iter().for_each(|(v, place)| of_each[v.index()] = Some(*place));
            left.retain(|v| of_each[v.index()].is_none());
        }
    }

    /// For each surface vertex the value of a field that has these values at the places; `of_each` has the places by
    /// which the vertices without a place nearby are matched.
    pub fn field(&self, mesh: &Oriented<'_>, of_each: &[Option<u32>], values: &[DVec3]) -> Vec<Option<DVec3>> {
        let each = mesh.positions().par_iter().zip(&mesh.normals).zip(of_each);
        each.with_min_len(PIECE)
            .map_init(Vec::new, |found, ((&position, &normal), place)| {
                let place = (*place)?;
                self.tree
                    .nearest(position, normal, NEAR * self.diagonal, BETWEEN, found);
                Some(match found.is_empty() {
                    true => values[place as usize],
                    false => self.between(position, found, values),
                })
            })
            .collect()
    }

    fn between(&self, position: DVec3, found: &[NearPoint], values: &[DVec3]) -> DVec3 {
        let near = found.iter().map(|near| {
            let place = near.number as usize;
            (self.recorded.positions[place] - position, values[place])
        });
        blended(near, 2.0 * self.recorded.precision())
    }
}
