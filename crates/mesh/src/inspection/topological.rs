//! Findings about a surface's topology: its rims, its non-manifold places, and its connected components, some of which
//! face inwards or are loose bits beside a large one.

use glam::DVec3;

use crate::inspection::nearly_joined::nearly_joined;
use crate::topology::boundary::trace_loops;
use crate::topology::components::Components;
use crate::topology::rings::TopologyFindings;
use crate::{Bounds, Component, DrawnSet, Finding, Findings, Surface, SurfaceVertex};

/// A part with less than this share of the largest one's vertices is a loose bit.
const BIT: f64 = 0.01;

/// The number of the largest closed parts that are searched for the one around a cavity.
const HOLLOW_CANDIDATES: usize = 64;

/// A surface and its connected parts.
pub(crate) struct Parts<'a> {
    pub(crate) surface: &'a Surface,
    pub(crate) drawn: &'a DrawnSet,
    pub(crate) components: &'a Components,
}

impl Parts<'_> {
    /// Reports the faults at surface vertices in terms of file vertices. Returns the components that are inside out,
    /// ascending.
    pub(crate) fn report(&self, found: &TopologyFindings, findings: &mut Findings) -> Vec<u32> {
        let range = found.range();
        let first_file_vertices = self.drawn.first_file_vertices(range.clone());
        let file_vertex = |v: &SurfaceVertex| first_file_vertices[v.index() - range.start].0;
        let at = |found: &[SurfaceVertex]| Finding::at_vertices(found.iter().map(file_vertex));
        findings.non_manifold_edges = at(&found.non_manifold_edges);
        findings.non_manifold_vertices = at(&found.non_manifold_vertices);
        findings.misoriented_edges = at(&found.misoriented_edges);
        findings.boundary_edges = Finding::at_vertices(found.boundary.iter().map(|[v, _]| file_vertex(v)));
        let rims = trace_loops(&found.boundary);
        findings.boundary_loops = Finding::at_vertices(rims.iter().filter_map(|rim| rim.iter().map(file_vertex).min()));
        findings.nearly_joined_vertices = at(&nearly_joined(self.surface, found));
        let of_triangles = of_triangles(&self.components.all);
        let firsts: Vec<u32> = of_triangles.iter().map(|part| part.first_file_vertex.0).collect();
        findings.components = Finding::of(&firsts);
        findings.loose_bits = loose_bits(of_triangles);
        let inside_out = self.inside_out(found);
        let firsts = inside_out
            .iter()
            .map(|&component| self.components.all[component as usize].first_file_vertex.0);
        findings.inside_out_components = Finding::at_vertices(firsts);
        inside_out
    }

    fn component(&self, v: SurfaceVertex) -> usize {
        self.components.of_vertex(v) as usize
    }

    /// Closed, consistently wound parts that enclose a negative volume and are not within another closed part's box.
    fn inside_out(&self, found: &TopologyFindings) -> Vec<u32> {
        let surface = self.surface;
        let count = of_triangles(&self.components.all).len();
        let mut is_closed = vec![true; count];
        let TopologyFindings {
            boundary,
            non_manifold_edges,
            misoriented_edges,
            non_manifold_vertices,
        } = found;
        let odd = [non_manifold_edges, non_manifold_vertices, misoriented_edges];
        for &v in boundary.iter().flatten().chain(odd.into_iter().flatten()) {
            is_closed[self.component(v)] = false;
        }
        // Each part's volume is measured from one of its own vertices, so that it loses no digits far from the origin.
        let first = |component: usize| self.components.vertices(component).next();
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let origin: Vec<DVec3> = (0..count)
            .map(|component| first(component).map_or(DVec3::ZERO, position))
            .collect();
        let mut six_volumes = vec![0.0; count];
        for corners in &surface.triangles {
            let component = self.component(corners[0]);
            if is_closed[component] {
                let [a, b, c] = corners.map(|v| surface.positions[v.index()] - origin[component]);
                six_volumes[component] += a.cross(b).dot(c);
            }
        }
        let bounds = |component: usize| {
            let mut out = Bounds {
                min: DVec3::INFINITY,
                max: DVec3::NEG_INFINITY,
            };
            for p in self.components.vertices(component).map(position) {
                out.min = out.min.min(p);
                out.max = out.max.max(p);
            }
            out
        };
        let hollow: Vec<(usize, Bounds)> = (0..count)
            .filter(|&component| is_closed[component] && six_volumes[component] > 0.0)
            .take(HOLLOW_CANDIDATES)
            .map(|component| (component, bounds(component)))
            .collect();
        let is_cavity = |component: usize| {
            let own = bounds(component);
            let holds = |outer: &Bounds| outer.min.cmple(own.min).all() && outer.max.cmpge(own.max).all();
            hollow.iter().any(|(_, outer)| holds(outer))
        };
        (0..count)
            .filter(|&component| is_closed[component] && six_volumes[component] < 0.0 && !is_cavity(component))
            .map(|component| component as u32)
            .collect()
    }
}

/// The components that have triangles. Bare points come last, because each is a component of one vertex.
pub(crate) fn of_triangles(components: &[Component]) -> &[Component] {
    &components[..components.partition_point(|component| component.face_count > 0)]
}

/// Parts that are loose bits, by their first vertices.
pub(crate) fn loose_bits(components: &[Component]) -> Finding {
    let size = |component: &Component| component.vertex_count as f64;
    let largest = components.first().map_or(0.0, size);
    let bits = components
        .iter()
        .filter(|component| size(component) < BIT * largest)
        .map(|component| component.first_file_vertex.0);
    Finding::at_vertices(bits)
}
