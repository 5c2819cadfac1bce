//! Connected components of a surface, largest first.

use crate::{FileVertex, SurfaceVertex};

/// A connected part of the surface: vertices joined by edges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Component {
    /// Its surface vertices, ascending.
    pub vertices: Vec<SurfaceVertex>,
    /// How many triangles it has.
    pub face_count: usize,
    /// The lowest file vertex that was welded into it (for a bare surface: its lowest surface vertex's number).
    pub first_file_vertex: FileVertex,
}

/// Each vertex's component and the components, by falling vertex count, then by rising first file vertex.
pub(crate) fn components(
    triangles: &[[SurfaceVertex; 3]],
    first_file_vertex: &[FileVertex],
) -> (Vec<u32>, Vec<Component>) {
    let mut root = roots(first_file_vertex.len(), triangles);
    let mut found: Vec<Component> = Vec::new();
    let mut sizes = vec![0u32; root.len()];
    for &r in &root {
        sizes[r as usize] += 1;
    }
    // A root is its component's lowest vertex, so it comes before all others; `root` turns into labels on the way.
    for v in 0..root.len() {
        let is_new = root[v] as usize == v;
        let label = if is_new {
            found.len() as u32
        } else {
            root[root[v] as usize]
        };
        if is_new {
            found.push(Component {
                vertices: Vec::with_capacity(sizes[v] as usize),
                face_count: 0,
                first_file_vertex: first_file_vertex[v],
            });
        }
        root[v] = label;
        let component = &mut found[label as usize];
        component.vertices.push(SurfaceVertex(v as u32));
        component.first_file_vertex = component.first_file_vertex.min(first_file_vertex[v]);
    }
    for [v, ..] in triangles {
        found[root[v.index()] as usize].face_count += 1;
    }
    sort(root, found)
}

/// The lowest vertex of each vertex's component.
fn roots(vertex_count: usize, triangles: &[[SurfaceVertex; 3]]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..vertex_count as u32).collect();
    for [a, b, c] in triangles {
        join(&mut parent, a.0, b.0);
        join(&mut parent, a.0, c.0);
    }
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
fn sort(mut labels: Vec<u32>, found: Vec<Component>) -> (Vec<u32>, Vec<Component>) {
    let mut order: Vec<(u32, Component)> = (0..).zip(found).collect();
    order.sort_by_key(|(label, component)| {
        (
            std::cmp::Reverse(component.vertices.len()),
            component.first_file_vertex,
            *label,
        )
    });
    let mut place = vec![0u32; order.len()];
    for (new, (old, _)) in (0..).zip(&order) {
        place[*old as usize] = new;
    }
    for label in &mut labels {
        *label = place[*label as usize];
    }
    (labels, order.into_iter().map(|(_, component)| component).collect())
}
