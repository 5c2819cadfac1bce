//! One fill-reducing ordering per mesh and operator power.
//!
//! Ordering costs as much as factoring but depends only on the surface: it is made once per mesh and *restricted* to
//! the solved vertices, which takes almost no time. A batch job, which binds once, orders only the surroundings of what
//! it solves for. The graph must be that of the system, Lᵏ: an ordering made for L
//! gives seven times the fill when used for L².

mod bisection;
mod crumbs;
pub(crate) mod dissection;
pub(crate) mod elimination;
pub(crate) mod graph;
pub(crate) mod hubs;
mod labels;
mod leaf;
mod surroundings;

use std::sync::OnceLock;

use pliant_mesh::{Cancel, Cancelled, Progress, SurfaceVertex, Topology};

use crate::sparse::ordering::dissection::dissect;
use crate::sparse::ordering::elimination::Elimination;
use crate::sparse::ordering::surroundings::Surroundings;

/// The rank of a vertex that was not ordered.
const NONE: u32 = u32::MAX;

/// An elimination order of all surface vertices, or of those around a region, for systems with the graph of Lᵏ.
#[derive(Clone, Debug)]
pub struct Ordering {
    power: u32,
    /// The vertices in the order of elimination.
    order: Vec<u32>,
    /// The place of each surface vertex in it, or [`NONE`].
    rank: Vec<u32>,
    /// The end of each of its blocks.
    ends: Vec<u32>,
    /// The ordering of the Laplacian's own graph, once a binding with a factor that does not fit has asked for it.
    of_laplacian: OnceLock<Box<Ordering>>,
}

/// Two are equal if they give the same order, independent of the data kept beside them.
impl PartialEq for Ordering {
    fn eq(&self, other: &Self) -> bool {
        (self.power, &self.order, &self.ends) == (other.power, &other.order, &other.ends)
    }
}

impl Eq for Ordering {}

impl Ordering {
    /// Orders the graph of the `power`-th power of the Laplacian by nested dissection of the surface.
    ///
    /// [`crate::Method::ordering_power`] gives the power. Uses rayon's current pool; the result doesn't depend on its
    /// size.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn of(topology: &Topology, power: u32, progress: &Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let elimination = dissect(topology, topology.vertex_count(), power, cancel)?;
        progress.set(1.0);
        Ok(Self::new(power, topology.vertex_count(), elimination))
    }

    /// Like [`Ordering::of`], for systems that solve only for vertices marked in `solved`, one mark a surface vertex.
    /// The time is that of their surroundings.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn around(
        topology: &Topology,
        solved: &[bool],
        power: u32,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let near = Surroundings::of(topology, solved, power);
        let mut elimination = dissect(&near, near.vertices.len(), power, cancel)?;
        for vertex in &mut elimination.order {
            *vertex = near.vertices[*vertex as usize];
        }
        progress.set(1.0);
        Ok(Self::new(power, topology.vertex_count(), elimination))
    }

    fn new(power: u32, vertex_count: usize, Elimination { order, ends }: Elimination) -> Self {
        let mut rank = vec![NONE; vertex_count];
        for (place, &vertex) in order.iter().enumerate() {
            rank[vertex as usize] = place as u32;
        }
        Self {
            power,
            order,
            rank,
            ends,
            of_laplacian: OnceLock::new(),
        }
    }

    /// The ordering of power 1 of the same surface: this one, or one that is made on the first request and kept for the
    /// next binding.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub(crate) fn of_laplacian(&self, topology: &Topology, cancel: &Cancel) -> Result<&Self, Cancelled> {
        if let Some(known) = self.known_of_laplacian() {
            return Ok(known);
        }
        let made = if self.is_whole() {
            Self::of(topology, 1, &Progress::new(), cancel)?
        } else {
            let is_ordered: Vec<bool> = self.rank.iter().map(|&rank| rank != NONE).collect();
            Self::around(topology, &is_ordered, 1, &Progress::new(), cancel)?
        };
        Ok(self.of_laplacian.get_or_init(|| Box::new(made)))
    }

    /// Like [`Ordering::of_laplacian`], if it exists already.
    pub(crate) fn known_of_laplacian(&self) -> Option<&Self> {
        match self.power {
            1 => Some(self),
            _ => self.of_laplacian.get().map(Box::as_ref),
        }
    }

    /// The operator power that the order was made for.
    pub fn power(&self) -> u32 {
        self.power
    }

    /// The number of the surface's vertices.
    pub fn vertex_count(&self) -> usize {
        self.rank.len()
    }

    /// Returns true if every surface vertex is ordered.
    pub fn is_whole(&self) -> bool {
        self.order.len() == self.rank.len()
    }

    /// Returns true if this vertex is ordered.
    pub fn covers(&self, vertex: SurfaceVertex) -> bool {
        self.rank[vertex.index()] != NONE
    }

    /// The vertices `solved` (each once) in the order of elimination. Those that were not ordered come last, at the cost
    /// of more fill.
    pub fn restricted(&self, solved: &[u32]) -> Vec<u32> {
        self.elimination(solved).order
    }

    /// Like [`Ordering::restricted`], in blocks.
    pub(crate) fn elimination(&self, solved: &[u32]) -> Elimination {
        let mut wanted = vec![false; self.order.len()];
        let mut others = Vec::new();
        for &vertex in solved {
            match self.rank[vertex as usize] {
                NONE => others.push(vertex),
                rank => wanted[rank as usize] = true,
            }
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
        if !others.is_empty() {
            elimination.append(Elimination {
                ends: vec![others.len() as u32],
                order: others,
            });
        }
        elimination
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use pliant_mesh::{Model, WeldOptions, shapes};

    use super::*;

    #[test]
    fn the_laplacian_s_ordering_is_made_once_and_kept() {
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let model = Model::weld(shapes::icosphere(4), &WeldOptions::default(), &progress, &cancel).unwrap();
        let of_power = |power| Ordering::of(&model.topology, power, &progress, &Cancel::new()).unwrap();
        let (first, second) = (of_power(1), of_power(2));
        assert!(std::ptr::eq(
            first.of_laplacian(&model.topology, &cancel).unwrap(),
            &first
        ));
        assert!(second.known_of_laplacian().is_none());
        let made = second.of_laplacian(&model.topology, &cancel).unwrap();
        assert_eq!(*made, first);
        // Nothing is made again: a raised flag would stop that.
        cancel.cancel();
        assert!(std::ptr::eq(
            second.of_laplacian(&model.topology, &cancel).unwrap(),
            made
        ));
        assert_eq!(second, of_power(2), "what is kept beside it does not count");
    }
}
