//! The order within a small part: minimum degree, exactly, on rows of bits.
//!
//! The graph is Lᵏ's on the part's vertices and on those around it that are eliminated later (its *halo*, Pellegrini et
//! al. 2000): they count for the degrees, which avoids the fill along the rim of a part that is ordered alone. Vertices
//! with one pattern are eliminated at once, and supernodes that hardly differ are amalgamated, so that the supernodes
//! are worth a dense factorisation.

use crate::numerical::graph::Graph;
use crate::sparse::ordering::elimination::Elimination;
use crate::sparse::ordering::labels::Labelled;

/// A part with more vertices than this keeps its order: such a part is not like a surface.
const MOST: usize = 1024;

/// The number of columns of a supernode if nothing is known about their patterns.
const PLAIN: usize = 32;

/// Orders the vertices with the label `id` for the graph of the `power`-th power of the Laplacian.
pub(crate) fn order<G: Graph>(parts: &Labelled<G>, power: u32, vertices: &[u32], id: u32) -> Elimination {
    let plain = || Elimination {
        order: vertices.to_vec(),
        ends: (0..vertices.len().div_ceil(PLAIN))
            .map(|supernode| (PLAIN * (supernode + 1)).min(vertices.len()) as u32)
            .collect(),
    };
    if vertices.len() > MOST {
        return plain();
    }
    let near = nearby(parts, power, vertices);
    if near.len() > 2 * MOST {
        return plain();
    }
    let graph = Rows::of(parts, power, vertices, &near, id);
    let supernodes = amalgamate(graph.eliminate());
    let mut piece = Elimination::default();
    for supernode in supernodes {
        piece
            .order
            .extend(supernode.columns.iter().map(|&column| vertices[column]));
        piece.ends.push(piece.order.len() as u32);
    }
    piece
}

/// The vertices within reach of the part, ascending, the part's own among them.
fn nearby<G: Graph>(parts: &Labelled<G>, power: u32, vertices: &[u32]) -> Vec<u32> {
    let mut near = vertices.to_vec();
    for _ in 0..power {
        let before = near.len();
        for i in 0..before {
            near.extend(parts.ring(near[i]).iter().map(|n| n.0));
        }
        near.sort_unstable();
        near.dedup();
    }
    near
}

/// Rows of bits over the part's vertices, then the halo.
struct Rows {
    words: usize,
    rows: Vec<u64>,
    count: usize,
}

/// Columns that are eliminated at once, and the number of rows below them.
#[derive(Debug)]
struct Supernode {
    columns: Vec<usize>,
    below: usize,
    /// The supernode with the first of these rows, if that row is in the part.
    parent: Option<usize>,
}

impl Rows {
    fn of<G: Graph>(parts: &Labelled<G>, power: u32, vertices: &[u32], near: &[u32], id: u32) -> Self {
        // The part's vertices keep their numbers; the halo's come after them.
        let mut number = Vec::with_capacity(near.len());
        let (mut own, mut halo) = (0, vertices.len());
        for &v in near {
            if parts.label(v) == id {
                number.push(own);
                own += 1;
            } else {
                number.push(halo);
                halo += 1;
            }
        }
        let words = halo.div_ceil(64);
        let place = |v: u32| near.binary_search(&v).ok();
        // Each vertex's ring as bits, then the union of its neighbours' rings, repeated by the power.
        let mut rings = vec![0_u64; near.len() * words];
        for (i, &v) in near.iter().enumerate() {
            let row = &mut rings[i * words..(i + 1) * words];
            row[number[i] / 64] |= 1 << (number[i] % 64);
            for n in parts.ring(v) {
                if let Some(j) = place(n.0) {
                    row[number[j] / 64] |= 1 << (number[j] % 64);
                }
            }
        }
        let mut rows = vec![0_u64; vertices.len() * words];
        for (i, &v) in vertices.iter().enumerate() {
            let row = &mut rows[i * words..(i + 1) * words];
            gather(parts, &rings, words, &place, v, power, row);
            row[i / 64] &= !(1 << (i % 64));
        }
        Self {
            words,
            rows,
            count: vertices.len(),
        }
    }

    fn row(&self, v: usize) -> &[u64] {
        &self.rows[v * self.words..(v + 1) * self.words]
    }

    /// Eliminates a vertex of least degree, and all with the same pattern, until none remains.
    fn eliminate(mut self) -> Vec<Supernode> {
        let words = self.words;
        let mut degree: Vec<u32> = (0..self.count).map(|v| ones(self.row(v))).collect();
        let mut supernode_of = vec![usize::MAX; self.count];
        let mut supernodes: Vec<Supernode> = Vec::new();
        let mut patterns: Vec<Vec<u64>> = Vec::new();
        let mut left: Vec<usize> = (0..self.count).collect();
        while let Some(&next) = left.iter().min_by_key(|&&v| degree[v]) {
            let mut pattern = self.row(next).to_vec();
            let mut columns = vec![next];
            for u in members(&pattern, self.count) {
                let differs = |w: usize| {
                    let own = if w == u / 64 { 1_u64 << (u % 64) } else { 0 };
                    let other = if w == next / 64 { 1_u64 << (next % 64) } else { 0 };
                    (self.row(u)[w] | own) != (pattern[w] | other)
                };
                if degree[u] == degree[next] && !(0..words).any(differs) {
                    columns.push(u);
                }
            }
            for &v in &columns {
                pattern[v / 64] &= !(1 << (v % 64));
                supernode_of[v] = supernodes.len();
            }
            for u in members(&pattern, self.count) {
                let row = &mut self.rows[u * words..(u + 1) * words];
                for (own, other) in row.iter_mut().zip(&pattern) {
                    *own |= other;
                }
                for &v in &columns {
                    row[v / 64] &= !(1 << (v % 64));
                }
                row[u / 64] &= !(1 << (u % 64));
                degree[u] = ones(row);
            }
            left.retain(|v| !columns.contains(v));
            supernodes.push(Supernode {
                columns,
                below: ones(&pattern) as usize,
                parent: None,
            });
            patterns.push(pattern);
        }
        for (supernode, pattern) in supernodes.iter_mut().zip(&patterns) {
            supernode.parent = members(pattern, self.count).map(|v| supernode_of[v]).min();
        }
        supernodes
    }
}

/// row |= the vertices within `power` edges of `vertex`.
fn gather<G: Graph>(
    parts: &Labelled<G>,
    rings: &[u64],
    words: usize,
    place: &impl Fn(u32) -> Option<usize>,
    vertex: u32,
    power: u32,
    row: &mut [u64],
) {
    if power == 1 {
        if let Some(i) = place(vertex) {
            for (own, other) in row.iter_mut().zip(&rings[i * words..(i + 1) * words]) {
                *own |= other;
            }
        }
        return;
    }
    for n in parts.ring(vertex) {
        gather(parts, rings, words, place, n.0, power - 1, row);
    }
}

fn ones(row: &[u64]) -> u32 {
    row.iter().map(|word| word.count_ones()).sum()
}

/// The numbers below `count` whose bits are set, ascending.
fn members(row: &[u64], count: usize) -> impl Iterator<Item = usize> + '_ {
    let words = row.iter().enumerate().take(count.div_ceil(64));
    words
        .flat_map(|(w, &word)| {
            let mut rest = word;
            std::iter::from_fn(move || {
                let bit = (rest != 0).then(|| rest.trailing_zeros() as usize)?;
                rest &= rest - 1;
                Some(w * 64 + bit)
            })
        })
        .take_while(move |&v| v < count)
}

/// Amalgamation: merges supernodes with their parents if that stores few zeros, and puts children before parents.
fn amalgamate(mut supernodes: Vec<Supernode>) -> Vec<Supernode> {
    // The number of zeros that a supernode already stores.
    let mut zeros = vec![0_usize; supernodes.len()];
    let mut amalgamated: Vec<Option<usize>> = vec![None; supernodes.len()];
    for child in 0..supernodes.len() {
        let Some(parent) = supernodes[child].parent else {
            continue;
        };
        let (width, above) = (supernodes[child].columns.len(), supernodes[parent].columns.len());
        let padding = width * (above + supernodes[parent].below - supernodes[child].below);
        let all = zeros[child] + zeros[parent] + padding;
        let columns = width + above;
        let stored = columns * (columns + 1) / 2 + columns * supernodes[parent].below;
        let allowed = match columns {
            0..=4 => 1.0,
            5..=16 => 0.4,
            17..=48 => 0.1,
            _ => 0.05,
        };
        if all as f64 <= allowed * stored as f64 {
            let mut columns = std::mem::take(&mut supernodes[child].columns);
            columns.append(&mut supernodes[parent].columns);
            supernodes[parent].columns = columns;
            zeros[parent] = all;
            amalgamated[child] = Some(parent);
        }
    }
    // The supernodes are in postorder, so that a subtree stays in one piece.
    let target = |mut supernode: usize| {
        while let Some(into) = amalgamated[supernode] {
            supernode = into;
        }
        supernode
    };
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); supernodes.len()];
    let mut roots = Vec::new();
    for supernode in (0..supernodes.len()).filter(|&supernode| amalgamated[supernode].is_none()) {
        match supernodes[supernode].parent {
            Some(parent) => children[target(parent)].push(supernode),
            None => roots.push(supernode),
        }
    }
    let mut stack: Vec<(usize, bool)> = roots.into_iter().rev().map(|root| (root, false)).collect();
    let mut order = Vec::new();
    while let Some((supernode, seen)) = stack.pop() {
        if seen {
            order.push(supernode);
        } else {
            stack.push((supernode, true));
            stack.extend(children[supernode].iter().rev().map(|&child| (child, false)));
        }
    }
    let mut taken: Vec<Option<Supernode>> = supernodes.into_iter().map(Some).collect();
    order
        .into_iter()
        .filter_map(|supernode| taken[supernode].take())
        .collect()
}
