//! What a document holds, to be read by all and changed by the document alone.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Arap, Attachment, Loose, Method};

use super::access::Access;
use super::handle::{Handle, HandleId};
use super::kept_shape::KeptShape;
use super::pose::Pose;
use super::strength::Strength;

/// What was painted on a vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default, Hash)]
pub enum Paint {
    /// Nothing: free where a handle reaches, held still elsewhere.
    #[default]
    Bare,
    /// Held still, whatever reaches it.
    Fixed,
    /// Free to bend.
    Free,
    /// A part of a handle.
    Handle(HandleId),
}

/// What happens to the parts of a surface that a handle's reach cuts off from the body.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Tips {
    /// They are free, too.
    #[default]
    ComeAlong,
    /// They are held still, as everything beyond the reach.
    Held,
}

/// What a document holds. Every vector has one element per surface vertex.
#[derive(Clone, Debug)]
pub struct Content {
    pub(crate) paint: Arc<Vec<Paint>>,
    pub(crate) handles: Vec<Handle>,
    /// The next handle's number.
    pub(crate) next_handle: u16,
    /// Painted stiffness; `None` is 1 everywhere.
    pub(crate) stiffness: Option<Arc<Vec<f64>>>,
    /// With which continuity the surface joins what holds it; `None` is the highest everywhere.
    pub(crate) continuity: Option<Arc<Vec<f64>>>,
    pub(crate) method: Method,
    /// What methods take beside handles, by the names that they declare: that of other methods than the present one is
    /// kept for when they are chosen again.
    pub(crate) attachments: Arc<BTreeMap<&'static str, Attachment>>,
    pub(crate) tips: Tips,
    pub(crate) loose: Loose,
    /// What single parts do that nothing holds, by their component's number, in place of `loose`.
    pub(crate) loose_parts: Arc<BTreeMap<u32, Loose>>,
    /// The connected parts that are turned inside out when the file is shown and saved, by their numbers. What bends stays
    /// wound as in the file.
    pub(crate) inside_out: Arc<BTreeSet<u32>>,
    /// What is hidden and locked.
    pub(crate) access: Arc<Access>,
    /// The rest shape's displacements from the file's.
    pub(crate) rest: Arc<Vec<DVec3>>,
    /// Whether a shape was applied: without, `rest` is zero.
    pub(crate) applied: bool,
    /// The present shape's displacements from the rest shape.
    pub(crate) from_rest: Arc<Vec<DVec3>>,
    /// The sum of both, what is drawn: follows from them.
    pub(crate) from_file: Arc<Vec<DVec3>>,
    /// What was seen when what holds the surface changed last; `None` where the shape is the one that the handles mean.
    pub(crate) kept: Option<Arc<KeptShape>>,
    /// What of the present shape was corrected by hand, as far as that is still seen; `None` where nothing was.
    pub(crate) corrections: Option<Arc<Vec<DVec3>>>,
    /// Whether `from_rest` is final for the handles' transforms.
    pub(crate) settled: bool,
    /// What handles and attachments are a share of; `None` where they are shown in full.
    pub(crate) strength: Option<Arc<Strength>>,
    /// Poses that a person keeps.
    pub(crate) poses: Arc<Vec<Pose>>,
}

impl Content {
    /// What a fresh document holds: everything is held still. It bends by ARAP, which turns and moves at once.
    pub(crate) fn new(vertex_count: usize) -> Self {
        let zero = Arc::new(vec![DVec3::ZERO; vertex_count]);
        Self {
            paint: Arc::new(vec![Paint::Bare; vertex_count]),
            handles: Vec::new(),
            next_handle: 0,
            stiffness: None,
            continuity: None,
            method: Arap::first_choice().into(),
            attachments: Arc::default(),
            tips: Tips::default(),
            loose: Loose::default(),
            loose_parts: Arc::default(),
            inside_out: Arc::default(),
            access: Arc::default(),
            rest: Arc::clone(&zero),
            applied: false,
            from_rest: Arc::clone(&zero),
            kept: None,
            corrections: None,
            from_file: zero,
            settled: true,
            strength: None,
            poses: Arc::default(),
        }
    }

    /// Computes what is drawn from the rest shape and the displacements from it.
    pub(super) fn sum_shapes(&mut self) {
        self.from_file = sum_of_shapes(self.applied.then_some(&self.rest), &self.from_rest);
    }
}

/// What is drawn: the rest shape's displacements, if there are any, plus those from it.
///
/// Where nothing is added the bits of the rest shape stay, so that applying a shape moves nothing.
pub(crate) fn sum_of_shapes(rest: Option<&Arc<Vec<DVec3>>>, from_rest: &Arc<Vec<DVec3>>) -> Arc<Vec<DVec3>> {
    match rest {
        None => Arc::clone(from_rest),
        Some(rest) => Arc::new(
            rest.iter()
                .zip(from_rest.iter())
                .map(|(&rest, &more)| if more == DVec3::ZERO { rest } else { rest + more })
                .collect(),
        ),
    }
}
