//! The numbers by which a report describes a surface and what a change of topology did to it.

use std::collections::BTreeSet;

use glam::DVec3;
use pliant_mesh::{Bvh, Drawn, DrawnVertex, Model, SurfaceVertex, WeldOptions};
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

/// The numbers of a new shape, and how many pairs of triangles pass through each other of which at least one `is_new`.
/// The triangles are the shape's, in the order of `triangles`.
pub(super) fn judged(
    shape: &NewShape,
    triangles: &[[DrawnVertex; 3]],
    is_new: impl Fn(usize) -> bool,
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
    let chosen: BTreeSet<[SurfaceVertex; 3]> = of_surface
        .filter(|(_, drawn)| is_new(**drawn as usize))
        .map(|(corners, _)| *corners)
        .collect();
    let bvh = Bvh::build(&model.surface.positions as &[DVec3], &model.surface.triangles);
    let is_chosen = |corners: [SurfaceVertex; 3]| chosen.contains(&corners);
    let found = bvh.self_intersections_of(is_chosen, MOST_CROSSINGS, &progress, &watch.cancel);
    let crossings = found.map_err(stopped)?.pairs.len();
    Ok((ShapeCounts::of(&model), crossings))
}
