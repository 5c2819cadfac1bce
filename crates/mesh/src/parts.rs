//! What is odd about a surface's connected parts: some face inwards, some are bits beside a large one.

use glam::DVec3;

use crate::{Bounds, Component, Finding, Surface, Topology};

/// A part with less than this share of the largest one's vertices is a loose bit.
const BIT: f64 = 0.01;

/// Among how many of the largest parts the one is looked for that a cavity lies in.
const HOLLOW_CANDIDATES: usize = 64;

/// Parts that are loose bits, by their first vertices.
pub(crate) fn loose_bits(components: &[Component]) -> Finding {
    let size = |component: &Component| component.vertices.len() as f64;
    let largest = components.first().map_or(0.0, size);
    let bits = components
        .iter()
        .filter(|component| size(component) < BIT * largest)
        .map(|component| component.first_file_vertex.0);
    Finding::at_vertices(bits)
}

/// Closed, consistently wound parts that enclose a negative volume and lie within no other closed part's box.
pub(crate) fn inside_out(surface: &Surface, topology: &Topology) -> Finding {
    let components = topology.components();
    let count = components.len();
    let mut is_closed = vec![true; count];
    let [edges, vertices, misoriented] = topology.oddities();
    let rims = topology.boundary_edge_list().iter().flatten();
    for &v in rims.chain(edges).chain(vertices).chain(misoriented) {
        is_closed[topology.component(v) as usize] = false;
    }
    // Each part's volume is taken around one of its own vertices: far from the origin nothing of it is lost.
    let origin: Vec<DVec3> = components
        .iter()
        .map(|component| surface.positions[component.vertices[0].index()])
        .collect();
    let mut six_volumes = vec![0.0; count];
    for corners in &surface.triangles {
        let component = topology.component(corners[0]) as usize;
        if is_closed[component] {
            let [a, b, c] = corners.map(|v| surface.positions[v.index()] - origin[component]);
            six_volumes[component] += a.cross(b).dot(c);
        }
    }
    let bounds = |component: usize| {
        let positions = components[component].vertices.iter();
        let mut out = Bounds {
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
        };
        for v in positions {
            out.min = out.min.min(surface.positions[v.index()]);
            out.max = out.max.max(surface.positions[v.index()]);
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
    let found = (0..count)
        .filter(|&component| is_closed[component] && six_volumes[component] < 0.0 && !is_cavity(component))
        .map(|component| components[component].first_file_vertex.0);
    Finding::at_vertices(found)
}
