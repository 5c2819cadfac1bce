//! Bisection of a graph: few cut edges, and halves of about the same size.
//!
//! Multilevel [KK98]: vertices are matched in pairs along their heaviest edges until few are left, the coarsest graph
//! is divided by growing one half from several seeds, and at every finer level the cut is improved by moving vertices
//! across [FM82]. With cuts by planes or level sets of distances at the finest level instead, the factorisation needed
//! twice the work.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Graphs of at most this many vertices are divided without being coarsened.
const COARSE: usize = 60;

/// The number of seeds from which a half is grown.
const SEEDS: usize = 4;

/// Rounds of moves at each level.
const ROUNDS: usize = 4;

/// The number of moves without a better cut after which a round ends.
const CLIMB: usize = 60;

/// The least share of all weight in a half.
const LEAST_SHARE: f64 = 0.3;

/// An undirected graph as compressed rows, each edge in both ends' rows.
#[derive(Default)]
pub(crate) struct WeightedGraph {
    /// The start of each row, and the end.
    pub starts: Vec<u32>,
    /// The other end of each edge, and its weight.
    pub edges: Vec<(u32, u32)>,
    /// The number of original vertices behind each vertex.
    pub weights: Vec<u32>,
}

impl WeightedGraph {
    fn row(&self, v: usize) -> &[(u32, u32)] {
        &self.edges[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// Divides the vertices: `true` for one half, `false` for the other.
    pub fn bisect(&self) -> Vec<bool> {
        let count = self.weights.len();
        if count > COARSE {
            let (coarse, coarse_of) = self.coarsened();
            // Few pairs match, for example around one vertex that all others neighbour.
            if coarse.weights.len() * 20 < count * 19 {
                let sides = coarse.bisect();
                let rim: Vec<bool> = (0..sides.len()).map(|c| coarse.is_rim(&sides, c)).collect();
                let near = (0..count as u32)
                    .filter(|&v| rim[coarse_of[v as usize] as usize])
                    .collect();
                let mut sides = coarse_of.iter().map(|&c| sides[c as usize]).collect::<Vec<bool>>();
                self.improve(&mut sides, near, ROUNDS);
                return sides;
            }
        }
        let mut best: Option<(f64, Vec<bool>)> = None;
        for seed in 0..SEEDS.min(count) {
            let mut sides = self.grown(seed * count / SEEDS.min(count));
            let cost = self.improve(&mut sides, (0..count as u32).collect(), 2);
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, sides));
            }
        }
        best.map_or_else(Vec::new, |(_, sides)| sides)
    }

    fn is_rim(&self, sides: &[bool], v: usize) -> bool {
        self.row(v).iter().any(|&(u, _)| sides[u as usize] != sides[v])
    }

    /// The graph with vertices joined in pairs, and the vertex there of each vertex here.
    fn coarsened(&self) -> (Self, Vec<u32>) {
        const FREE: u32 = u32::MAX;
        let count = self.weights.len();
        let most = 1 + 3 * self.total() / COARSE as u64;
        let mut coarse_of = vec![FREE; count];
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(count / 2 + 1);
        for v in 0..count {
            if coarse_of[v] != FREE {
                continue;
            }
            let fits = |u: u32| u64::from(self.weights[v] + self.weights[u as usize]) <= most;
            let free = self
                .row(v)
                .iter()
                .filter(|&&(u, _)| coarse_of[u as usize] == FREE && fits(u));
            // The heaviest edge, to the lightest end.
            let mate = free.max_by_key(|&&(u, weight)| (weight, Reverse(self.weights[u as usize]), Reverse(u)));
            let mate = mate.map_or(v as u32, |&(u, _)| u);
            coarse_of[v] = pairs.len() as u32;
            coarse_of[mate as usize] = pairs.len() as u32;
            pairs.push((v as u32, mate));
        }
        let mut coarse = Self {
            starts: vec![0],
            edges: Vec::with_capacity(self.edges.len() / 2),
            weights: Vec::with_capacity(pairs.len()),
        };
        let mut place = vec![FREE; pairs.len()];
        for (c, &(one, two)) in pairs.iter().enumerate() {
            let first = coarse.edges.len();
            let members = if one == two { &[one][..] } else { &[one, two][..] };
            for &member in members {
                for &(u, weight) in self.row(member as usize) {
                    let other = coarse_of[u as usize];
                    if other as usize == c {
                        continue;
                    }
                    let at = place[other as usize];
                    if at != FREE && at as usize >= first {
                        coarse.edges[at as usize].1 += weight;
                    } else {
                        place[other as usize] = coarse.edges.len() as u32;
                        coarse.edges.push((other, weight));
                    }
                }
            }
            coarse.starts.push(coarse.edges.len() as u32);
            coarse
                .weights
                .push(members.iter().map(|&m| self.weights[m as usize]).sum());
        }
        (coarse, coarse_of)
    }

    fn total(&self) -> u64 {
        self.weights.iter().map(|&weight| u64::from(weight)).sum()
    }

    /// Half of all weight around a seed, ring by ring.
    fn grown(&self, seed: usize) -> Vec<bool> {
        let half = self.total() / 2;
        let mut sides = vec![false; self.weights.len()];
        let mut queue = Vec::with_capacity(self.weights.len());
        let (mut next, mut weight) = (0, 0);
        let mut seeds = std::iter::once(seed).chain(0..self.weights.len());
        while weight < half {
            if next == queue.len() {
                // A separate part.
                match seeds.find(|&v| !sides[v]) {
                    Some(v) => {
                        sides[v] = true;
                        queue.push(v);
                    }
                    None => break,
                }
            }
            let v = queue[next];
            next += 1;
            weight += u64::from(self.weights[v]);
            for &(u, _) in self.row(v) {
                if !std::mem::replace(&mut sides[u as usize], true) {
                    queue.push(u as usize);
                }
            }
        }
        for &v in &queue[next..] {
            sides[v] = false;
        }
        sides
    }

    /// Moves vertices across while that improves the cut; returns its cost. `near` are the vertices that may be at the
    /// cut, each once.
    fn improve(&self, sides: &mut [bool], mut near: Vec<u32>, rounds: usize) -> f64 {
        let total = self.total();
        let balance = |inside: u64| inside.min(total - inside) as f64 / total as f64;
        let after_move = |inside: u64, sides: &[bool], v: usize| {
            let weight = u64::from(self.weights[v]);
            if sides[v] { inside - weight } else { inside + weight }
        };
        let mut inside: u64 = sides
            .iter()
            .zip(&self.weights)
            .filter(|(side, _)| **side)
            .map(|(_, &w)| u64::from(w))
            .sum();
        let mut heap = BinaryHeap::new();
        let mut round_of_move = vec![0_u8; self.weights.len()];
        let mut moves: Vec<u32> = Vec::new();
        for round in 1.. {
            let mut cut = self.gather_at_cut(sides, &near, &mut heap);
            let before = cost_of(cut, balance(inside), total as f64);
            let (mut best, mut best_moves) = (before, 0);
            moves.clear();
            while let Some((gain, Reverse(v))) = heap.pop() {
                let vertex = v as usize;
                if round_of_move[vertex] == round || gain != self.gain(sides, vertex) {
                    continue;
                }
                let then = after_move(inside, sides, vertex);
                if balance(then) < LEAST_SHARE && balance(then) <= balance(inside) {
                    continue;
                }
                inside = then;
                cut -= gain;
                sides[vertex] = !sides[vertex];
                round_of_move[vertex] = round;
                moves.push(v);
                let cost = cost_of(cut, balance(inside), total as f64);
                if cost < best {
                    (best, best_moves) = (cost, moves.len());
                } else if moves.len() > best_moves + CLIMB {
                    break;
                }
                for &(u, _) in self.row(vertex) {
                    if round_of_move[u as usize] != round {
                        heap.push((self.gain(sides, u as usize), Reverse(u)));
                    }
                }
            }
            for &v in &moves[best_moves..] {
                inside = after_move(inside, sides, v as usize);
                sides[v as usize] = !sides[v as usize];
            }
            if best >= before || usize::from(round) >= rounds {
                return best;
            }
            // The vertices to which the cut can have moved.
            let beside = moves[..best_moves]
                .iter()
                .flat_map(|&v| self.row(v as usize))
                .map(|&(u, _)| u);
            near.extend(beside);
            near.extend(&moves[..best_moves]);
            near.sort_unstable();
            near.dedup();
        }
        f64::INFINITY
    }

    /// Fills `heap` with the vertices among `near` that are at the cut, each with the gain of its move across. Returns
    /// the cut's weight.
    fn gather_at_cut(&self, sides: &[bool], near: &[u32], heap: &mut BinaryHeap<(i64, Reverse<u32>)>) -> i64 {
        heap.clear();
        let mut cut = 0;
        for &v in near {
            let (mut same, mut across) = (0, 0);
            for &(u, weight) in self.row(v as usize) {
                let same_side = sides[u as usize] == sides[v as usize];
                *(if same_side { &mut same } else { &mut across }) += i64::from(weight);
            }
            cut += across;
            if across > 0 {
                heap.push((across - same, Reverse(v)));
            }
        }
        // Both ends of an edge count it.
        cut / 2
    }

    /// The decrease of the cut by a vertex's move across.
    fn gain(&self, sides: &[bool], v: usize) -> i64 {
        let row = self.row(v).iter();
        row.map(|&(u, weight)| {
            if sides[u as usize] == sides[v] {
                -i64::from(weight)
            } else {
                i64::from(weight)
            }
        })
        .sum()
    }
}

/// The factorisation work after a cut: that of a part of n vertices grows as n to the power 1.5, that of the separator
/// with the third power of the cut. If a round plane part is halved, the separator's share is three tenths.
fn cost_of(cut: i64, share: f64, total: f64) -> f64 {
    let part = |share: f64| share * share.max(0.0).sqrt();
    let relative = cut as f64 / (1.6 * total.sqrt());
    0.3 * relative * relative * relative + part(share) + part(1.0 - share)
}

#[cfg(test)]
mod tests {
    use super::WeightedGraph;

    fn grid(width: usize, height: usize) -> WeightedGraph {
        let mut graph = WeightedGraph {
            starts: vec![0],
            weights: vec![1; width * height],
            ..WeightedGraph::default()
        };
        for v in 0..width * height {
            let (x, y) = (v % width, v / width);
            for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                let (x, y) = (x as i64 + dx, y as i64 + dy);
                if (0..width as i64).contains(&x) && (0..height as i64).contains(&y) {
                    graph.edges.push((y as u32 * width as u32 + x as u32, 1));
                }
            }
            graph.starts.push(graph.edges.len() as u32);
        }
        graph
    }

    #[test]
    fn a_long_grid_is_cut_across() {
        let graph = grid(60, 15);
        let sides = graph.bisect();
        let cut: i64 = (0..900)
            .map(|v| (graph.gain(&sides, v) + graph.row(v).len() as i64) / 2)
            .sum::<i64>()
            / 2;
        assert!(cut <= 20, "{cut}");
        let share = sides.iter().filter(|&&side| side).count();
        assert!((270..=630).contains(&share), "{share}");
    }

    #[test]
    fn parts_of_their_own_and_single_vertices_are_divided() {
        let none = WeightedGraph {
            starts: vec![0; 301],
            edges: Vec::new(),
            weights: vec![1; 300],
        };
        assert_eq!(none.bisect().iter().filter(|&&side| side).count(), 150);
        assert!(
            WeightedGraph {
                starts: vec![0],
                ..WeightedGraph::default()
            }
            .bisect()
            .is_empty()
        );
    }
}
