//! One fill-reducing ordering per mesh and operator power.
//!
//! Ordering costs as much as factoring, yet depends on nothing but the graph: it is made once a mesh and *restricted*
//! to whatever is free, which costs about a tenth of fill and no time. The graph must be that of the system, Lᵏ: an
//! ordering made for L costs seven times the fill when used for L².

use pliant_mesh::{Cancel, Cancelled, Progress, Topology};

/// An elimination order of all surface vertices for systems with the graph of Lᵏ.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Ordering {
    power: u32,
    /// The place of each surface vertex in the order.
    rank: Vec<u32>,
}

impl Ordering {
    /// Orders the graph of the `power`-th power of the Laplacian by approximate minimum degree (Amestoy et al. 1996).
    pub fn of(topology: &Topology, power: u32, progress: &Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let _ = (topology, power, progress, cancel);
        unimplemented!()
    }
    /// The operator power that the order was made for.
    pub fn power(&self) -> u32 {
        self.power
    }
    /// How many vertices are ordered.
    pub fn vertex_count(&self) -> usize {
        self.rank.len()
    }
}
