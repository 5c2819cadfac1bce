//! One fill-reducing ordering per mesh and operator power.
//!
//! Ordering costs as much as factoring, yet depends on nothing but the graph: it is made once a mesh and *restricted*
//! to whatever is solved for, which costs about a tenth of fill and next to no time. The graph must be that of the
//! system, Lᵏ: an ordering made for L costs seven times the fill when used for L².
//!
//! The type keeps ranks and not how they came about, so another way of ordering (nested dissection) fits in.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use pliant_mesh::{Cancel, Cancelled, Progress, Topology};
use rayon::prelude::*;

use crate::operators::CHUNK;
use crate::operators::net::Graph;
use crate::sparse::etree::{elimination_tree, postorder};
use crate::sparse::reach::Reach;

/// An elimination order of all surface vertices for systems with the graph of Lᵏ.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Ordering {
    power: u32,
    /// The place of each surface vertex in the order.
    rank: Vec<u32>,
}

impl Ordering {
    /// Orders the graph of the `power`-th power of the Laplacian by approximate minimum degree (Amestoy et al. 1996).
    ///
    /// `power` is [`crate::Method::operator_power`]. Where faer refuses (a graph beyond its index type), the order is
    /// the surface's own, which is right but slow to factor.
    pub fn of(topology: &Topology, power: u32, progress: &Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let count = topology.vertex_count();
        let (offsets, rows) = upper_graph(topology, power, cancel)?;
        progress.set(0.3);
        cancel.check()?;
        let rank = minimum_degree(count, &offsets, &rows).unwrap_or_else(|| (0..count as u32).collect());
        progress.set(1.0);
        cancel.check()?;
        Ok(Self { power, rank })
    }

    /// The operator power that the order was made for.
    pub fn power(&self) -> u32 {
        self.power
    }

    /// How many vertices are ordered.
    pub fn vertex_count(&self) -> usize {
        self.rank.len()
    }

    /// The vertices `solved` (ascending) in an order to eliminate them: this order restricted to them and put into
    /// postorder, which leaves the fill as it is.
    pub fn restricted(&self, topology: &Topology, solved: &[u32]) -> Vec<u32> {
        self.restricted_on(topology, solved)
    }

    /// As [`Ordering::restricted`], for a system on another graph over the same vertices, whose elimination it is put
    /// into postorder for. Near the mesh's own graph it saves nearly as much fill.
    pub(crate) fn restricted_on(&self, graph: &impl Graph, solved: &[u32]) -> Vec<u32> {
        let mut order = solved.to_vec();
        order.sort_unstable_by_key(|&vertex| self.rank[vertex as usize]);
        let mut column_of = vec![u32::MAX; self.rank.len()];
        for (column, &vertex) in order.iter().enumerate() {
            column_of[vertex as usize] = column as u32;
        }
        let mut reach = Reach::new(self.rank.len(), self.power);
        let parent = elimination_tree(order.len(), |column, sink| {
            for &vertex in reach.around(graph, order[column as usize]) {
                sink(column_of[vertex as usize]);
            }
        });
        postorder(&parent)
            .into_iter()
            .map(|column| order[column as usize])
            .collect()
    }
}

/// The upper triangle of the graph of Lᵏ as compressed columns: `rows` above the diagonal of each.
fn upper_graph(topology: &Topology, power: u32, cancel: &Cancel) -> Result<(Vec<u32>, Vec<u32>), Cancelled> {
    let count = topology.vertex_count();
    let chunks: Vec<(Vec<u32>, Vec<u32>)> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map_init(
            || Reach::new(count, power),
            |reach, chunk| {
                cancel.check()?;
                let (mut counts, mut rows) = (Vec::with_capacity(CHUNK), Vec::new());
                for vertex in chunk * CHUNK..((chunk + 1) * CHUNK).min(count) {
                    let before = rows.len();
                    rows.extend(
                        reach
                            .around(topology, vertex as u32)
                            .iter()
                            .filter(|&&other| (other as usize) < vertex),
                    );
                    counts.push((rows.len() - before) as u32);
                }
                Ok((counts, rows))
            },
        )
        .collect::<Result<_, Cancelled>>()?;
    let mut offsets = Vec::with_capacity(count + 1);
    offsets.push(0);
    let mut rows = Vec::with_capacity(chunks.iter().map(|(_, rows)| rows.len()).sum());
    let mut end = 0;
    for (counts, chunk) in chunks {
        for count in counts {
            end += count;
            offsets.push(end);
        }
        rows.extend(chunk);
    }
    Ok((offsets, rows))
}

pub(super) fn minimum_degree(count: usize, offsets: &[u32], rows: &[u32]) -> Option<Vec<u32>> {
    let graph = SymbolicSparseColMatRef::new_unsorted_checked(count, count, offsets, None, rows);
    let (mut order, mut rank) = (vec![0_u32; count], vec![0_u32; count]);
    let mut memory = MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<u32>(count, rows.len())).ok()?;
    let control = amd::Control::default();
    amd::order_maybe_unsorted(&mut order, &mut rank, graph, control, MemStack::new(&mut memory)).ok()?;
    Some(rank)
}
