//! A file's geometry inspected: its counts and findings, without the tables that an edit needs.

mod located;
mod nearly_joined;
pub(crate) mod topological;

pub use located::{Example, LocatedFinding};

use crate::inspection::topological::{Parts, of_triangles};
use crate::topology::components::Component;
use crate::topology::main_positions;
use crate::topology::rings::topology_findings;
use crate::weld::{Welded, weld};
use crate::{Bounds, Cancel, Cancelled, Drawn, Findings, Progress, WeldOptions, bounding_box};

/// The counts and findings of [`Model::weld`](crate::Model::weld), in less memory and time, for callers that don't
/// edit.
#[derive(Clone, Debug, Default)]
pub struct Inspection {
    /// The number of the file's vertices, drawn or not.
    pub file_vertices: usize,
    /// The number of drawn vertices: a file vertex through two nodes counts twice.
    pub drawn_vertices: usize,
    /// The number of drawn triangles.
    pub drawn_triangles: usize,
    /// The number of the welded surface's vertices, bare points included.
    pub surface_vertices: usize,
    /// The number of bare points among these, which no kept triangle uses.
    pub bare_points: usize,
    /// The number of its triangles.
    pub surface_triangles: usize,
    /// The bounding box of the vertices that kept triangles use, or of all bare points if there is no triangle; `None`
    /// for an empty surface.
    pub bounds: Option<Bounds>,
    /// The surface's connected parts by falling vertex count, equal ones by their first file vertex. Bare points, which
    /// would come last, are left out.
    pub components: Vec<Component>,
    /// The faults of the mesh.
    pub findings: Findings,
    /// The same faults with the places of examples.
    pub located_findings: Vec<LocatedFinding>,
}

impl Inspection {
    /// Welds `drawn`, inspects the surface and drops it.
    pub fn of(drawn: Drawn, options: &WeldOptions, progress: &Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let Welded {
            surface,
            first_bare,
            drawn,
            components,
            mut findings,
        } = weld(drawn, options, progress, cancel)?;
        cancel.check()?;
        let vertex_count = surface.positions.len();
        let found = topology_findings(vertex_count, &surface.triangles, cancel)?;
        cancel.check()?;
        progress.set(0.9);
        let parts = Parts {
            surface: &surface,
            drawn: &drawn,
            components: &components,
        };
        parts.report(&found, &mut findings);
        progress.set(1.0);
        Ok(Self {
            file_vertices: drawn.file_vertex_count(),
            drawn_vertices: drawn.vertex_count(),
            drawn_triangles: drawn.triangle_count(),
            surface_vertices: vertex_count,
            surface_triangles: surface.triangles.len(),
            bare_points: vertex_count - first_bare,
            bounds: bounding_box(main_positions(&surface.positions, first_bare)),
            components: of_triangles(&components.all).to_vec(),
            located_findings: findings.located_findings(&drawn, &surface),
            findings,
        })
    }
}
