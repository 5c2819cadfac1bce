//! Rims of holes, traced from the edges that have one triangle.

use rayon::prelude::*;

use crate::SurfaceVertex;

/// Strings `edges` into loops, each vertex once in each loop.
///
/// At a vertex the walk leaves by the first unused edge that starts there, or else (if triangles disagree about the
/// outside) by one that ends there. If it meets its own track, the cycle is cut off as a loop. The remainder of a walk
/// that can't go on is an open chain, which counts as a loop; chains are walked first, from their ends.
pub(crate) fn trace_loops(edges: &[[SurfaceVertex; 2]]) -> Vec<Vec<SurfaceVertex>> {
    let mut rim = Rim::of(edges);
    let mut place_on_path = vec![None; rim.vertices.len()];
    let mut loops = Vec::new();
    let mut path: Vec<u32> = Vec::new();
    let (chains, rings): (Vec<u32>, Vec<u32>) =
        (0..rim.vertices.len() as u32).partition(|&local| rim.is_chain_start(local));
    for start in chains.into_iter().chain(rings) {
        path.push(start);
        place_on_path[start as usize] = Some(0);
        while let Some(next) = rim.take_edge(path[path.len() - 1]) {
            if let Some(place) = place_on_path[next as usize] {
                loops.push(rim.named(&path[place as usize..]));
                for local in path.drain(place as usize + 1..) {
                    place_on_path[local as usize] = None;
                }
            } else {
                place_on_path[next as usize] = Some(path.len() as u32);
                path.push(next);
            }
        }
        if path.len() > 1 {
            loops.push(rim.named(&path));
        }
        for local in path.drain(..) {
            place_on_path[local as usize] = None;
        }
    }
    loops
}

/// The vertices on rims, numbered among themselves, and their edges.
struct Rim {
    /// Ascending.
    vertices: Vec<SurfaceVertex>,
    /// Both ends of each edge, by local number.
    edges: Vec<[u32; 2]>,
    /// The edges at each vertex: first those that start there, then those that end there, each by rising number.
    edges_at: Vec<u32>,
    /// The place where each vertex's edges begin, and the end of the last one's.
    starts: Vec<u32>,
    /// The number of each vertex's edges that are known to be used up.
    next: Vec<u32>,
    used: Vec<bool>,
}

impl Rim {
    fn of(edges: &[[SurfaceVertex; 2]]) -> Self {
        let mut vertices: Vec<SurfaceVertex> = edges.iter().flatten().copied().collect();
        vertices.par_sort_unstable();
        vertices.dedup();
        let local = |vertex: SurfaceVertex| vertices.partition_point(|&v| v < vertex) as u32;
        let edges: Vec<[u32; 2]> = edges.par_iter().map(|ends| ends.map(local)).collect();
        // A counting sort. Shifted by one, each start moves on to the next vertex's start while its row fills.
        let mut starts = vec![0; vertices.len() + 2];
        for &end in edges.iter().flatten() {
            starts[end as usize + 2] += 1;
        }
        for place in 2..starts.len() {
            starts[place] += starts[place - 1];
        }
        let mut edges_at = vec![0; 2 * edges.len()];
        for end in 0..2 {
            for (number, ends) in (0..).zip(&edges) {
                let place = &mut starts[ends[end] as usize + 1];
                edges_at[*place as usize] = number;
                *place += 1;
            }
        }
        starts.pop();
        Self {
            next: starts.clone(),
            used: vec![false; edges.len()],
            vertices,
            edges,
            edges_at,
            starts,
        }
    }

    /// Returns true if more edges start than end here, so that some walk must start here.
    fn is_chain_start(&self, local: u32) -> bool {
        let [start, end] = [0, 1].map(|next| self.starts[local as usize + next] as usize);
        let own = &self.edges_at[start..end];
        2 * own.partition_point(|&edge| self.edges[edge as usize][0] == local) > own.len()
    }

    /// Uses up the first unused edge at a vertex and gives its other end.
    fn take_edge(&mut self, local: u32) -> Option<u32> {
        let (next, end) = (&mut self.next[local as usize], self.starts[local as usize + 1]);
        while *next < end {
            let edge = self.edges_at[*next as usize] as usize;
            *next += 1;
            if !std::mem::replace(&mut self.used[edge], true) {
                let [from, to] = self.edges[edge];
                return Some(if from == local { to } else { from });
            }
        }
        None
    }

    fn named(&self, path: &[u32]) -> Vec<SurfaceVertex> {
        path.iter().map(|&local| self.vertices[local as usize]).collect()
    }
}
