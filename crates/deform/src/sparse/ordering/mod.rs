//! One fill-reducing ordering per mesh and operator power.
//!
//! Ordering costs as much as factoring but depends only on the surface: it is made once per mesh and *restricted* to
//! the solved vertices, which takes almost no time. The graph must be that of the system, Lᵏ: an ordering made for L
//! gives seven times the fill when used for L².

mod bisection;
mod crumbs;
pub(crate) mod dissection;
pub(crate) mod elimination;
pub(crate) mod graph;
pub(crate) mod hubs;
mod labels;
mod leaf;

use std::sync::OnceLock;

use pliant_mesh::{Cancel, Cancelled, Progress, Topology};

use crate::sparse::ordering::dissection::dissect;
use crate::sparse::ordering::elimination::Elimination;

/// An elimination order of all surface vertices for systems with the graph of Lᵏ.
#[derive(Clone, Debug)]
pub struct Ordering {
    power: u32,
    /// The vertices in the order of elimination.
    order: Vec<u32>,
    /// The place of each vertex in it.
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
            of_laplacian: OnceLock::new(),
        })
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
        let made = Self::of(topology, 1, &Progress::new(), cancel)?;
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

    /// The number of ordered vertices.
    pub fn vertex_count(&self) -> usize {
        self.order.len()
    }

    /// The vertices `solved` (each once) in the order of elimination.
    pub fn restricted(&self, solved: &[u32]) -> Vec<u32> {
        self.elimination(solved).order
    }

    /// Like [`Ordering::restricted`], in blocks.
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
