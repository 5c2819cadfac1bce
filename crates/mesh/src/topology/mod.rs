//! Adjacency: one-rings, triangles around vertices, components and rims, as compressed rows.

pub(crate) mod boundary;
pub(crate) mod components;
mod contours;
mod faces;
pub(crate) mod rings;

pub use components::Component;
pub use contours::{ContourLine, Crossing, contours};
pub use faces::Faces;
pub use rings::FanKind;

use std::ops::Range;

use boundary::trace_loops;
use components::Components;
use faces::{are_in_order, runs};
use rings::{TopologyFindings, rings};

use glam::DVec3;

use crate::{Cancel, Cancelled, FileVertex, Surface, SurfaceVertex};

/// The connectivity of a [`Surface`].
///
/// Rows are compressed: row `v` of a list is `list[offsets[v]..offsets[v + 1]]`. Offsets are `u32`, so a surface has
/// at most 2³² / 3 triangles.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    neighbour_offsets: Vec<u32>,
    neighbour_list: Vec<SurfaceVertex>,
    /// Places in the rows of `neighbour_list`.
    fans: Vec<u8>,
    fan_kinds: Vec<FanKind>,
    /// The start of the triangles in which each vertex is the lowest, and the number of triangles.
    runs: Vec<u32>,
    findings: TopologyFindings,
    components: Components,
}

impl Topology {
    /// The connectivity of `surface`, whose triangles are in order of their lowest, then their middle, then their
    /// highest vertex; components of equal size are in order of their lowest surface vertex.
    pub fn of(surface: &Surface) -> Self {
        let own: Vec<FileVertex> = (0..surface.positions.len() as u32).map(FileVertex).collect();
        let components = Components::of(&surface.triangles, &own);
        drop(own);
        // No one else has the cancel flag, so the default is never used.
        Self::with_components(surface, components, &Cancel::new()).unwrap_or_default()
    }

    /// The connectivity of `surface`, whose components are known.
    pub(crate) fn with_components(
        surface: &Surface,
        components: Components,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let vertex_count = surface.positions.len();
        debug_assert!(are_in_order(&surface.triangles), "triangles stand by their vertices");
        let (neighbour_offsets, rings) = rings(vertex_count, &surface.triangles, cancel)?;
        Ok(Self {
            neighbour_offsets,
            neighbour_list: rings.neighbours,
            fans: rings.fans,
            fan_kinds: rings.fan_kinds,
            runs: runs(vertex_count, &surface.triangles),
            findings: rings.findings,
            components,
        })
    }

    /// The number of the surface's vertices.
    pub fn vertex_count(&self) -> usize {
        self.fan_kinds.len()
    }

    /// The vertices after the last one that a triangle uses: the bare points of a welded surface.
    pub fn bare_points(&self) -> Range<usize> {
        let count = self.vertex_count();
        let end = self.neighbour_list.len() as u32;
        let starts = self.neighbour_offsets.get(..count).unwrap_or_default();
        starts.partition_point(|&start| start < end)..count
    }

    /// The positions that determine where the surface is and how large: those of the vertices that triangles use, or of
    /// all bare points if there is no triangle. Stray points far away from a scan don't count.
    pub fn main_positions<'a>(&self, positions: &'a [DVec3]) -> &'a [DVec3] {
        main_positions(positions, self.bare_points().start)
    }

    /// The vertices that share an edge with `v`, ascending, without `v`.
    #[inline]
    pub fn neighbours(&self, v: SurfaceVertex) -> &[SurfaceVertex] {
        &self.neighbour_list[row(&self.neighbour_offsets, v)]
    }

    /// The neighbours of `v` counterclockwise seen from outside, and how they close; ascending if irregular. A closed
    /// fan starts at the lowest neighbour, an open one at its rim.
    #[inline]
    pub fn fan(&self, v: SurfaceVertex) -> (FanKind, impl ExactSizeIterator<Item = SurfaceVertex> + '_) {
        let (kind, ring, places) = self.ring_and_fan(v);
        let place = move |k: usize| match kind {
            FanKind::Irregular => k,
            _ => usize::from(places[k]),
        };
        (kind, (0..ring.len()).map(move |k| ring[place(k)]))
    }

    /// The neighbours of `v`, and the places among them in the order of the fan unless it is irregular.
    #[inline]
    pub(crate) fn ring_and_fan(&self, v: SurfaceVertex) -> (FanKind, &[SurfaceVertex], &[u8]) {
        let row = row(&self.neighbour_offsets, v);
        (
            self.fan_kinds[v.index()],
            &self.neighbour_list[row.clone()],
            &self.fans[row],
        )
    }

    /// The triangles around `v`, ascending; `triangles` are the surface's.
    #[inline]
    pub fn faces<'a>(&'a self, v: SurfaceVertex, triangles: &'a [[SurfaceVertex; 3]]) -> Faces<'a> {
        Faces::around(v, self.neighbours(v), triangles, &self.runs)
    }

    /// Row starts into [`Self::neighbour_list`]: one per vertex and the list's length (nothing for a default topology).
    pub fn neighbour_offsets(&self) -> &[u32] {
        &self.neighbour_offsets
    }

    /// Every vertex's one-ring, row after row: twice the edges.
    pub fn neighbour_list(&self) -> &[SurfaceVertex] {
        &self.neighbour_list
    }

    /// The component that `v` belongs to, as an index into [`Self::components`].
    #[inline]
    pub fn component(&self, v: SurfaceVertex) -> u32 {
        self.components.of_vertex(v)
    }

    /// The vertices of a component, ascending.
    pub fn vertices_of(&self, component: u32) -> impl ExactSizeIterator<Item = SurfaceVertex> + Clone + '_ {
        self.components.vertices(component as usize)
    }

    /// The components by falling vertex count, equal ones by their first file vertex.
    pub fn components(&self) -> &[Component] {
        &self.components.all
    }

    /// The components, and the component of each vertex.
    pub(crate) fn parts(&self) -> &Components {
        &self.components
    }

    /// Every edge once, as its lower and its higher vertex, in ascending order.
    pub fn edges(&self) -> impl Iterator<Item = [SurfaceVertex; 2]> + '_ {
        (0..self.vertex_count() as u32).map(SurfaceVertex).flat_map(move |v| {
            let ring = self.neighbours(v);
            let above = ring.partition_point(|&u| u < v);
            ring[above..].iter().map(move |&u| [v, u])
        })
    }

    /// The number of edges.
    pub fn edge_count(&self) -> usize {
        self.neighbour_list.len() / 2
    }

    /// The number of edges with one triangle.
    pub fn boundary_edges(&self) -> usize {
        self.findings.boundary.len()
    }

    /// The edges with one triangle, directed with the hole on the left, by their first vertex.
    pub fn boundary_edge_list(&self) -> &[[SurfaceVertex; 2]] {
        &self.findings.boundary
    }

    /// The number of edges with more than two triangles.
    pub fn non_manifold_edges(&self) -> usize {
        self.findings.non_manifold_edges.len()
    }

    /// The number of vertices whose triangles form more than one fan (triangles that share an edge are in one fan).
    pub fn non_manifold_vertices(&self) -> usize {
        self.findings.non_manifold_vertices.len()
    }

    /// The number of edges between two triangles that disagree about the outside.
    pub fn misoriented_edges(&self) -> usize {
        self.findings.misoriented_edges.len()
    }

    /// Returns true if no edge has only one triangle.
    pub fn is_closed(&self) -> bool {
        self.findings.boundary.is_empty()
    }

    /// Returns true if `v` is on an edge with one triangle.
    pub fn is_boundary_vertex(&self, v: SurfaceVertex) -> bool {
        let boundary = &self.findings.boundary;
        let has_rim_to = |[from, to]: [SurfaceVertex; 2]| {
            let first = boundary.partition_point(|edge| edge[0] < from);
            boundary[first..]
                .iter()
                .take_while(|edge| edge[0] == from)
                .any(|edge| edge[1] == to)
        };
        match self.fan_kinds[v.index()] {
            FanKind::Closed => false,
            FanKind::Open => true,
            FanKind::Irregular => {
                let mut ring = self.neighbours(v).iter();
                ring.any(|&u| has_rim_to([v, u]) || has_rim_to([u, v]))
            }
        }
    }

    /// The holes' rims, each vertex once in each loop, with the hole on the left; by rising first vertex found.
    ///
    /// A rim that passes a vertex twice is cut into loops there. A rim may end at an edge that more than two triangles
    /// share: such a chain counts as a loop too.
    pub fn boundary_loops(&self) -> Vec<Vec<SurfaceVertex>> {
        trace_loops(&self.findings.boundary)
    }

    /// Rims, and irregular places.
    pub(crate) fn findings(&self) -> &TopologyFindings {
        &self.findings
    }
}

#[inline]
fn row(offsets: &[u32], v: SurfaceVertex) -> Range<usize> {
    offsets[v.index()] as usize..offsets[v.index() + 1] as usize
}

/// As [`Topology::main_positions`], with bare points from `first_bare` on.
pub(crate) fn main_positions(positions: &[DVec3], first_bare: usize) -> &[DVec3] {
    if first_bare == 0 {
        positions
    } else {
        &positions[..first_bare]
    }
}
