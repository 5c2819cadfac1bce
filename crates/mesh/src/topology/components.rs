//! Connected components of a surface, largest first.

use rayon::prelude::*;

use crate::{FileVertex, SurfaceVertex};

/// A connected part of the surface: vertices joined by edges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Component {
    /// The number of surface vertices.
    pub vertex_count: usize,
    /// The number of triangles.
    pub face_count: usize,
    /// The lowest file vertex that was welded into it (for a bare surface: its lowest surface vertex's number).
    pub first_file_vertex: FileVertex,
}

/// The components of a surface and their vertices. Most scans have only one, for which nothing is listed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Components {
    /// By falling vertex count, then by rising first file vertex.
    pub(crate) all: Vec<Component>,
    /// The component of each vertex; empty if there is only one.
    of_vertex: Vec<u32>,
    /// Component after component, ascending in each; empty if there is only one.
    vertices: Vec<SurfaceVertex>,
    /// The start of each component's vertices.
    starts: Vec<u32>,
}

impl Components {
    pub(crate) fn of(triangles: &[[SurfaceVertex; 3]], first_file_vertex: &[FileVertex]) -> Self {
        let edges = triangles.iter().flat_map(|[a, b, c]| [[a.0, b.0], [a.0, c.0]]);
        let mut of_vertex = roots(first_file_vertex.len(), edges);
        let mut all: Vec<Component> = Vec::new();
        // A root is its component's lowest vertex, so it comes before all others; roots turn into labels on the way.
        for v in 0..of_vertex.len() {
            let root = of_vertex[v] as usize;
            of_vertex[v] = if root == v { all.len() as u32 } else { of_vertex[root] };
            if root == v {
                all.push(Component {
                    vertex_count: 0,
                    face_count: 0,
                    first_file_vertex: first_file_vertex[v],
                });
            }
            let component = &mut all[of_vertex[v] as usize];
            component.vertex_count += 1;
            component.first_file_vertex = component.first_file_vertex.min(first_file_vertex[v]);
        }
        for [v, ..] in triangles {
            all[of_vertex[v.index()] as usize].face_count += 1;
        }
        if all.len() < 2 {
            return Self {
                starts: vec![0; all.len()],
                all,
                ..Self::default()
            };
        }
        let all = sort(&mut of_vertex, all);
        let starts = all.iter().scan(0, |start, component| {
            *start += component.vertex_count as u32;
            Some(*start - component.vertex_count as u32)
        });
        let starts: Vec<u32> = starts.collect();
        let mut next = starts.clone();
        let mut vertices = vec![SurfaceVertex(0); of_vertex.len()];
        for (v, &component) in (0..).zip(&of_vertex) {
            let place = &mut next[component as usize];
            vertices[*place as usize] = SurfaceVertex(v);
            *place += 1;
        }
        Self {
            all,
            of_vertex,
            vertices,
            starts,
        }
    }

    /// The component of a vertex.
    #[inline]
    pub(crate) fn of_vertex(&self, v: SurfaceVertex) -> u32 {
        self.of_vertex.get(v.index()).copied().unwrap_or(0)
    }

    /// The vertices of a component, ascending.
    pub(crate) fn vertices(&self, component: usize) -> impl ExactSizeIterator<Item = SurfaceVertex> + Clone + '_ {
        let start = self.starts[component] as usize;
        let vertex = |place: usize| self.vertices.get(place).copied();
        (start..start + self.all[component].vertex_count)
            .map(move |place| vertex(place).unwrap_or(SurfaceVertex(place as u32)))
    }
}

/// The lowest vertex of each vertex's component; each of the `edges` joins two vertices.
pub(crate) fn roots(vertex_count: usize, edges: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..vertex_count as u32).collect();
    edges.for_each(|[a, b]| join(&mut parent, a, b));
    // Parents are never higher than their children, so one ascending sweep flattens the trees.
    for v in 0..vertex_count {
        parent[v] = parent[parent[v] as usize];
    }
    parent
}

fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

fn find(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        let above = parent[parent[v as usize] as usize];
        parent[v as usize] = above;
        v = above;
    }
    v
}

/// Puts components into their order and renames the labels.
fn sort(labels: &mut [u32], found: Vec<Component>) -> Vec<Component> {
    let mut order: Vec<(u32, Component)> = (0..).zip(found).collect();
    order.par_sort_unstable_by_key(|(label, component)| {
        (
            std::cmp::Reverse(component.vertex_count),
            component.first_file_vertex,
            *label,
        )
    });
    let mut place = vec![0u32; order.len()];
    for (new, (old, _)) in (0..).zip(&order) {
        place[*old as usize] = new;
    }
    for label in labels {
        *label = place[*label as usize];
    }
    order.into_iter().map(|(_, component)| component).collect()
}
