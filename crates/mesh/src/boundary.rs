//! Rims of holes, traced from the edges that have one triangle.

use crate::SurfaceVertex;

/// Strings `edges` into loops, each vertex once in each loop.
///
/// At a vertex the walk leaves by the first unused edge that starts there, else (triangles disagree about the outside)
/// by one that ends there. Where it meets its own track, the cycle is cut off as a loop. What is left when it can't go
/// on is an open chain, which counts as a loop.
pub(crate) fn trace_loops(edges: &[[SurfaceVertex; 2]]) -> Vec<Vec<SurfaceVertex>> {
    let rim = Rim::of(edges);
    let mut used = vec![false; edges.len()];
    let mut place_on_path = vec![None; rim.vertices.len()];
    let mut loops = Vec::new();
    for first in 0..edges.len() {
        if used[first] {
            continue;
        }
        let start = rim.local(edges[first][0]);
        let mut path = vec![start];
        place_on_path[start] = Some(0);
        while let Some((edge, next)) = rim.unused_at(path[path.len() - 1], edges, &used) {
            used[edge] = true;
            if let Some(place) = place_on_path[next] {
                loops.push(path[place..].iter().map(|&local| rim.vertices[local]).collect());
                for local in path.drain(place + 1..) {
                    place_on_path[local] = None;
                }
            } else {
                place_on_path[next] = Some(path.len());
                path.push(next);
            }
        }
        if path.len() > 1 {
            loops.push(path.iter().map(|&local| rim.vertices[local]).collect());
        }
        for local in path {
            place_on_path[local] = None;
        }
    }
    loops
}

/// The vertices on rims, numbered among themselves, and their edges.
struct Rim {
    vertices: Vec<SurfaceVertex>,
    /// (vertex, whether the edge ends there, edge), sorted: edges that start at a vertex come first.
    ends: Vec<(usize, bool, usize)>,
    starts: Vec<usize>,
}

impl Rim {
    fn of(edges: &[[SurfaceVertex; 2]]) -> Self {
        let mut vertices: Vec<SurfaceVertex> = edges.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut rim = Self {
            vertices,
            ends: Vec::with_capacity(2 * edges.len()),
            starts: Vec::new(),
        };
        for (edge, &[from, to]) in edges.iter().enumerate() {
            rim.ends.push((rim.local(from), false, edge));
            rim.ends.push((rim.local(to), true, edge));
        }
        rim.ends.sort_unstable();
        rim.starts = (0..=rim.vertices.len())
            .map(|v| rim.ends.partition_point(|end| end.0 < v))
            .collect();
        rim
    }

    fn local(&self, vertex: SurfaceVertex) -> usize {
        self.vertices.partition_point(|&v| v < vertex)
    }

    /// The first unused edge at a vertex and its other end.
    fn unused_at(&self, local: usize, edges: &[[SurfaceVertex; 2]], used: &[bool]) -> Option<(usize, usize)> {
        let ends = &self.ends[self.starts[local]..self.starts[local + 1]];
        let &(_, is_end, edge) = ends.iter().find(|&&(_, _, edge)| !used[edge])?;
        Some((edge, self.local(edges[edge][usize::from(!is_end)])))
    }
}
