//! One fill-reducing ordering per mesh and operator power.
//!
//! Ordering costs as much as factoring but depends only on the surface: it is made once per mesh and *restricted* to
//! the vertices that are solved for, which takes next to no time. The graph must be that of the system, Lᵏ: an ordering
//! made for L gives seven times the fill when used for L².

mod bisection;
mod crumbs;
mod dissection;
pub(crate) mod elimination;
pub(crate) mod graph;
pub(crate) mod hubs;
mod labels;
mod leaf;

use pliant_mesh::{Cancel, Cancelled, Progress, Topology};

use crate::sparse::ordering::dissection::dissect;
use crate::sparse::ordering::elimination::Elimination;

/// An elimination order of all surface vertices for systems with the graph of Lᵏ.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Ordering {
    power: u32,
    /// The vertices in the order of elimination.
    order: Vec<u32>,
    /// The place of each vertex in it.
    rank: Vec<u32>,
    /// Where each block of it ends.
    ends: Vec<u32>,
}

impl Ordering {
    /// Orders the graph of the `power`-th power of the Laplacian by nested dissection of the surface.
    ///
    /// [`crate::Method::ordering_power`] gives the power. Uses rayon's current pool; the result doesn't depend on its
    /// size.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn of(topology: &Topology, power: u32, progress: &Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let Elimination { order, ends } = dissect(topology, topology.vertex_count(), power, cancel)?;
        let mut rank = vec![0; order.len()];
        for (place, &vertex) in order.iter().enumerate() {
            rank[vertex as usize] = place as u32;
        }
        progress.set(1.0);
        Ok(Self {
            power,
            order,
            rank,
            ends,
        })
    }

    /// The operator power that the order was made for.
    pub fn power(&self) -> u32 {
        self.power
    }

    /// How many vertices are ordered.
    pub fn vertex_count(&self) -> usize {
        self.order.len()
    }

    /// The vertices `solved` (each once) in the order to eliminate them.
    pub fn restricted(&self, solved: &[u32]) -> Vec<u32> {
        self.elimination(solved).order
    }

    /// As [`Ordering::restricted`], in blocks.
    pub(crate) fn elimination(&self, solved: &[u32]) -> Elimination {
        let mut wanted = vec![false; self.order.len()];
        for &vertex in solved {
            wanted[self.rank[vertex as usize] as usize] = true;
        }
        let mut elimination = Elimination {
            order: Vec::with_capacity(solved.len()),
            ends: Vec::new(),
        };
        let mut first = 0;
        for &end in &self.ends {
            let before = elimination.order.len();
            let block = first..end as usize;
            elimination.order.extend(
                block
                    .clone()
                    .filter(|&place| wanted[place])
                    .map(|place| self.order[place]),
            );
            if elimination.order.len() > before {
                elimination.ends.push(elimination.order.len() as u32);
            }
            first = block.end;
        }
        elimination
    }
}
