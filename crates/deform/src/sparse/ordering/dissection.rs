//! Nested dissection of a surface's graph: cut it in two, eliminate both halves first and the separator last [Geo73].
//!
//! `bisection` finds the cut, in the graph of L; its rim grows to a *separator* of the graph of Lᵏ: every walk of at
//! most k edges from one half to the other goes through it. So the graph of Lᵏ, several times larger, is never formed.
//! Parts of some hundred vertices are left to `leaf`.
//!
//! A bad cut costs only time: the fill is found exactly by `symbolic`.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use pliant_mesh::{Cancel, Cancelled, SurfaceVertex};
use rayon::prelude::*;

use crate::numerical::graph::Graph;
use crate::sparse::ordering::bisection::WeightedGraph;
use crate::sparse::ordering::crumbs::{Crumbs, crumbs};
use crate::sparse::ordering::elimination::Elimination;
use crate::sparse::ordering::hubs::{WithoutHubs, hubs};
use crate::sparse::ordering::labels::{CUT_OUT, Labelled};
use crate::sparse::ordering::leaf;

/// Parts of at most this many vertices are not cut.
const LEAF: usize = 250;

/// Parts of more vertices are cut in parallel.
const APART: usize = 2048;

/// Orders a graph's `count` vertices for the graph of the `power`-th power of the Laplacian, its hubs last.
pub(crate) fn dissect<G: Graph>(
    graph: &G,
    count: usize,
    power: u32,
    cancel: &Cancel,
) -> Result<Elimination, Cancelled> {
    let hubs = hubs(graph, count);
    if hubs.is_empty() {
        return dissect_all(graph, count, (0..count as u32).collect(), power, cancel);
    }
    let rest = WithoutHubs::of(graph, count, &hubs);
    let vertices = (0..count as u32).filter(|v| hubs.binary_search(v).is_err()).collect();
    let mut piece = dissect_all(&rest, count, vertices, power, cancel)?;
    piece.append(Elimination {
        ends: vec![hubs.len() as u32],
        order: hubs,
    });
    Ok(piece)
}

/// Orders some of a graph's `count` vertices; the other vertices have no neighbours.
fn dissect_all<G: Graph>(
    graph: &G,
    count: usize,
    vertices: Vec<u32>,
    power: u32,
    cancel: &Cancel,
) -> Result<Elimination, Cancelled> {
    let dissection = Dissection {
        parts: Labelled::whole(graph, count),
        power,
        places: (0..count).map(|_| AtomicU32::new(0)).collect(),
        cancel,
    };
    let Crumbs { packs, rest } = crumbs(graph, count, vertices, LEAF);
    let order = |pack: &Vec<u32>| leaf::order(&dissection.parts, power, pack, 1);
    let packs: Vec<Elimination> = packs.par_iter().map(order).collect();
    let mut piece = Elimination::default();
    packs.into_iter().for_each(|pack| piece.append(pack));
    piece.append(dissection.part(rest, 1));
    cancel.check()?;
    Ok(piece)
}

/// The common data of all parts.
struct Dissection<'a, G> {
    parts: Labelled<'a, G>,
    power: u32,
    /// The place of each vertex in its part.
    places: Vec<AtomicU32>,
    cancel: &'a Cancel,
}

impl<G: Graph> Dissection<'_, G> {
    /// Orders the vertices with the label `id`.
    fn part(&self, vertices: Vec<u32>, id: u32) -> Elimination {
        if vertices.len() <= LEAF || id >= 1 << 30 || self.cancel.is_cancelled() {
            return leaf::order(&self.parts, self.power, &vertices, id);
        }
        let halves = [2 * id, 2 * id + 1];
        self.cut(&vertices, id, halves);
        let separator = self.separator(&vertices, halves);
        let of = |label: u32| {
            vertices
                .iter()
                .copied()
                .filter(|&v| self.parts.label(v) == label)
                .collect::<Vec<u32>>()
        };
        let parts = halves.map(of);
        // A graph that can't be cut, such as a vertex that all others neighbour, is eliminated as one dense block.
        if parts.iter().any(Vec::is_empty) {
            vertices.iter().for_each(|&v| self.parts.set_label(v, id));
            return leaf::order(&self.parts, self.power, &vertices, id);
        }
        let apart = vertices.len() > APART;
        drop(vertices);
        let [left, right] = parts;
        let (mut piece, other) = if apart {
            rayon::join(|| self.part(left, halves[0]), || self.part(right, halves[1]))
        } else {
            (self.part(left, halves[0]), self.part(right, halves[1]))
        };
        piece.append(other);
        if !separator.is_empty() {
            piece.append(Elimination {
                ends: vec![separator.len() as u32],
                order: separator,
            });
        }
        piece
    }

    /// Labels the vertices by their half.
    fn cut(&self, vertices: &[u32], id: u32, halves: [u32; 2]) {
        for (place, &v) in vertices.iter().enumerate() {
            self.places[v as usize].store(place as u32, Relaxed);
        }
        let mut graph = WeightedGraph {
            starts: Vec::with_capacity(vertices.len() + 1),
            edges: Vec::with_capacity(6 * vertices.len()),
            weights: vec![1; vertices.len()],
        };
        graph.starts.push(0);
        for &v in vertices {
            let own = self.parts.ring(v).iter().filter(|n| self.parts.label(n.0) == id);
            graph
                .edges
                .extend(own.map(|n| (self.places[n.index()].load(Relaxed), 1)));
            graph.starts.push(graph.edges.len() as u32);
        }
        for (&v, side) in vertices.iter().zip(graph.bisect()) {
            self.parts.set_label(v, halves[usize::from(side)]);
        }
    }

    /// Removes a separator from the halves; returns it, ascending.
    fn separator(&self, vertices: &[u32], halves: [u32; 2]) -> Vec<u32> {
        let is = |n: &SurfaceVertex, label: u32| self.parts.label(n.0) == label;
        // If L itself is factored, one side's rim is enough; each further power needs one more ring.
        let rim = |own: u32, other: u32| {
            let touches = |v: &u32| self.parts.label(*v) == own && self.parts.ring(*v).iter().any(|n| is(n, other));
            vertices.iter().copied().filter(touches).collect::<Vec<u32>>()
        };
        let mut rims = [rim(halves[0], halves[1]), rim(halves[1], halves[0])];
        let mut separator = Vec::new();
        for ring in 0..self.power {
            let smaller = usize::from(rims[1].len() < rims[0].len());
            let side = if self.power == 2 { ring as usize } else { smaller };
            let taken = std::mem::take(&mut rims[side]);
            taken.iter().for_each(|&v| self.parts.set_label(v, CUT_OUT));
            let mut beyond: Vec<u32> = taken
                .iter()
                .flat_map(|&v| self.parts.ring(v))
                .filter(|n| is(n, halves[side]))
                .map(|n| n.0)
                .collect();
            beyond.sort_unstable();
            beyond.dedup();
            rims[side] = beyond;
            separator.extend(taken);
        }
        // This walks around the end of the cut, through vertices that are no longer in a part.
        if self.power > 1 {
            for &v in vertices {
                let own = self.parts.label(v);
                if own != CUT_OUT
                    && self
                        .parts
                        .ring(v)
                        .iter()
                        .any(|n| self.parts.label(n.0) >> 1 != own >> 1)
                    && self.parts.reaches(v, self.power, own ^ 1)
                {
                    self.parts.set_label(v, CUT_OUT);
                    separator.push(v);
                }
            }
        }
        separator.sort_unstable();
        separator.retain(|&v| {
            let reached = halves.map(|half| self.parts.reaches(v, self.power, half));
            match reached {
                [true, true] => true,
                [_, to_right] => {
                    self.parts.set_label(v, halves[usize::from(to_right)]);
                    false
                }
            }
        });
        separator
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    use pliant_mesh::{Cancel, Drawn, DrawnVertex, SurfaceVertex, Topology, shapes};

    use super::dissect;
    use crate::numerical::graph::Graph;

    /// A graph that counts the requests for neighbours.
    struct Counted {
        topology: Topology,
        asked: AtomicUsize,
    }

    impl Graph for Counted {
        fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
            let ring = self.topology.neighbours(vertex);
            self.asked.fetch_add(ring.len(), Relaxed);
            ring
        }
    }

    /// The number of requests for neighbours during the ordering of a shape.
    fn asked(drawn: Drawn, power: u32) -> usize {
        let topology = Topology::of(&shapes::model(drawn).surface);
        let count = topology.vertex_count();
        let graph = Counted {
            topology,
            asked: AtomicUsize::new(0),
        };
        let piece = dissect(&graph, count, power, &Cancel::new()).unwrap();
        let mut all = piece.order;
        all.sort_unstable();
        assert!(all.into_iter().eq(0..count as u32));
        assert_eq!(piece.ends.last().copied(), Some(count as u32));
        graph.asked.into_inner()
    }

    fn soup(count: usize) -> Drawn {
        let corner = |v: usize| glam::DVec3::new((v % 3 % 2) as f64 * 0.1, (v % 3 / 2) as f64 * 0.1, (v / 3) as f64);
        let triangles = (0..count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(DrawnVertex));
        Drawn::once((0..3 * count).map(corner).collect(), triangles.collect())
    }

    #[test]
    fn ordering_looks_at_a_crowded_edge_or_a_soup_as_often_as_it_is_large() {
        for power in 1..=3 {
            let [once, twice] = [1000, 2000].map(|pages| asked(shapes::non_manifold_fan(pages), power));
            assert!(twice < 3 * once, "{power}: {once} {twice}");
            let [once, twice] = [11_000, 22_000].map(|crumbs| asked(soup(crumbs), power));
            assert!(
                twice < 2 * once + once / 10 && once < 60 * 11_000,
                "{power}: {once} {twice}"
            );
        }
    }
}
