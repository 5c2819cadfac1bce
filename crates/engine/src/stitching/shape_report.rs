//! The numbers by which a report describes a surface and what a change of topology did to it.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_mesh::{Bvh, Drawn, DrawnVertex, Model, SelfIntersection, SurfaceVertex, WeldOptions};
use pliant_stitch::NewShape;
use serde::Serialize;

use crate::EngineError;
use crate::watch::Watch;

/// A surface in numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct ShapeCounts {
    /// Welded vertices that triangles use.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Connected parts.
    pub components: usize,
    /// Borders.
    pub borders: usize,
    /// Handles, in sum over the parts; `None` if the surface is not manifold.
    pub genus: Option<i64>,
    /// Edges that more than two triangles share.
    pub non_manifold_edges: usize,
    /// Edges between two triangles that disagree about the outside.
    pub misoriented_edges: usize,
}

impl ShapeCounts {
    /// Those of a model.
    pub fn of(model: &Model) -> Self {
        let topology = &model.topology;
        let vertices = topology.bare_points().start;
        let components = topology.components().len() - topology.bare_points().len();
        let borders = topology.boundary_loops().len();
        let is_manifold =
            topology.non_manifold_edges() + topology.non_manifold_vertices() + topology.misoriented_edges() == 0;
        let euler = vertices as i64 - topology.edge_count() as i64 + model.surface.triangles.len() as i64;
        Self {
            vertices,
            triangles: model.surface.triangles.len(),
            components,
            borders,
            genus: is_manifold.then_some(components as i64 - (euler + borders as i64) / 2),
            non_manifold_edges: topology.non_manifold_edges(),
            misoriented_edges: topology.misoriented_edges(),
        }
    }
}

/// The most crossings to count.
const MOST_CROSSINGS: usize = 20_000;

/// What became of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Change {
    /// It has the shape that it had, among the others of its part.
    OfPart(u8),
    /// It is new, or bent.
    Changed,
}

/// The numbers of a new shape, and how many pairs of triangles pass through each other of which one changed, or which
/// are of two parts. The triangles are the shape's, in the order of `triangles`.
pub(super) fn judged(
    shape: &NewShape,
    triangles: &[[DrawnVertex; 3]],
    change: impl Fn(usize) -> Change,
    watch: &Watch,
) -> Result<(ShapeCounts, usize), EngineError> {
    let progress = watch.begin("checking the new shape");
    let drawn = Drawn {
        positions: shape.positions.clone(),
        triangles: triangles.to_vec(),
        file_vertex: shape.file_vertices.clone(),
        file_vertex_count: shape.file_vertex_count,
        ..Drawn::default()
    };
    let stopped = |_| EngineError::Interrupted;
    let model = Model::weld(drawn, &WeldOptions::default(), &progress, &watch.cancel).map_err(stopped)?;
    let of_surface = model.surface.triangles.iter().zip(model.drawn.triangle_of_surface());
    let changes: BTreeMap<[SurfaceVertex; 3], Change> = of_surface
        .map(|(corners, drawn)| (*corners, change(*drawn as usize)))
        .filter(|(_, change)| *change != Change::OfPart(0))
        .collect();
    let change_of = |corners: [SurfaceVertex; 3]| changes.get(&corners).copied().unwrap_or(Change::OfPart(0));
    let bvh = Bvh::build(&model.surface.positions as &[DVec3], &model.surface.triangles);
    let is_chosen = |corners: [SurfaceVertex; 3]| change_of(corners) != Change::OfPart(0);
    let found = bvh.self_intersections_of(is_chosen, MOST_CROSSINGS, &progress, &watch.cancel);
    let pairs = found.map_err(stopped)?.pairs;
    let is_added = |pair: &&SelfIntersection| {
        let [one, other] = pair.triangles.map(change_of);
        one != other || one == Change::Changed
    };
    Ok((ShapeCounts::of(&model), pairs.iter().filter(is_added).count()))
}
