//! Rims of holes, traced from the edges that have one triangle.

use crate::SurfaceVertex;

/// Strings `edges` into loops, each vertex once in each loop.
///
/// At a vertex the walk leaves by the first unused edge that starts there, else (triangles disagree about the outside)
/// by one that ends there. Where it meets its own track, the cycle is cut off as a loop. What is left when it can't go
/// on is an open chain, which counts as a loop; chains are walked first, from their ends.
pub(crate) fn trace_loops(edges: &[[SurfaceVertex; 2]]) -> Vec<Vec<SurfaceVertex>> {
    let mut rim = Rim::of(edges);
    let mut place_on_path = vec![None; rim.vertices.len()];
    let mut loops = Vec::new();
    let (chains, rings): (Vec<usize>, Vec<usize>) =
        (0..rim.vertices.len()).partition(|&local| rim.is_chain_start(local));
    for start in chains.into_iter().chain(rings) {
        let mut path = vec![start];
        place_on_path[start] = Some(0);
        while let Some(next) = rim.take_edge(path[path.len() - 1]) {
            if let Some(place) = place_on_path[next] {
                loops.push(rim.named(&path[place..]));
                for local in path.drain(place + 1..) {
                    place_on_path[local] = None;
                }
            } else {
                place_on_path[next] = Some(path.len());
                path.push(next);
            }
        }
        if path.len() > 1 {
            loops.push(rim.named(&path));
        }
        for local in path {
            place_on_path[local] = None;
        }
    }
    loops
}

/// One end of an edge, as a vertex of the rim sees it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct End {
    at: usize,
    /// Whether the edge ends at this vertex rather than starts.
    is_head: bool,
    edge: usize,
    other: usize,
}

/// The vertices on rims, numbered among themselves, and their edges.
struct Rim {
    vertices: Vec<SurfaceVertex>,
    /// Sorted: at each vertex the edges that start there come first.
    ends: Vec<End>,
    starts: Vec<usize>,
    /// How far each vertex's ends are known to be used up.
    next: Vec<usize>,
    used: Vec<bool>,
}

impl Rim {
    fn of(edges: &[[SurfaceVertex; 2]]) -> Self {
        let mut vertices: Vec<SurfaceVertex> = edges.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut ends = Vec::with_capacity(2 * edges.len());
        for (edge, ends_of_edge) in edges.iter().enumerate() {
            let [from, to] = ends_of_edge.map(|vertex| vertices.partition_point(|&v| v < vertex));
            ends.push(End {
                at: from,
                is_head: false,
                edge,
                other: to,
            });
            ends.push(End {
                at: to,
                is_head: true,
                edge,
                other: from,
            });
        }
        ends.sort_unstable();
        let starts: Vec<usize> = (0..=vertices.len())
            .map(|v| ends.partition_point(|end| end.at < v))
            .collect();
        Self {
            vertices,
            ends,
            next: starts.clone(),
            starts,
            used: vec![false; edges.len()],
        }
    }

    /// Whether more edges start than end here, so that some walk must start here.
    fn is_chain_start(&self, local: usize) -> bool {
        let ends = &self.ends[self.starts[local]..self.starts[local + 1]];
        2 * ends.iter().filter(|end| !end.is_head).count() > ends.len()
    }

    /// Uses up the first unused edge at a vertex and gives its other end.
    fn take_edge(&mut self, local: usize) -> Option<usize> {
        while self.next[local] < self.starts[local + 1] {
            let end = self.ends[self.next[local]];
            self.next[local] += 1;
            if !self.used[end.edge] {
                self.used[end.edge] = true;
                return Some(end.other);
            }
        }
        None
    }

    fn named(&self, path: &[usize]) -> Vec<SurfaceVertex> {
        path.iter().map(|&local| self.vertices[local]).collect()
    }
}
