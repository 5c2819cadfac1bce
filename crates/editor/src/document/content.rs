//! The content of a document, which all may read and only the document changes.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, Loose, Method};

use super::access::Access;
use super::animation::Animation;
use super::fluid::{FlowOptions, Fluid};
use super::handle::{Handle, HandleId};
use super::kept_shape::KeptShape;
use super::pose::Pose;
use super::strength::Strength;
use super::version::Versions;

/// The paint of a vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default, Hash)]
pub enum Paint {
    /// None: free where a handle reaches, fixed elsewhere.
    #[default]
    Bare,
    /// Fixed, even in a handle's reach.
    Fixed,
    /// Free to bend.
    Free,
    /// A part of a handle.
    Handle(HandleId),
}

/// The treatment of the parts of a surface that a handle's reach cuts off from the body.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Tips {
    /// They are free too.
    #[default]
    ComeAlong,
    /// They are fixed, like everything beyond the reach.
    Held,
}

/// The content of a document. Every vector has one element per surface vertex.
#[derive(Clone, Debug)]
pub struct Content {
    pub(crate) paint: Arc<Vec<Paint>>,
    pub(crate) handles: Vec<Handle>,
    /// The next handle's number.
    pub(crate) next_handle: u16,
    /// Painted stiffness; `None` is 1 everywhere.
    pub(crate) stiffness: Option<Arc<Vec<f64>>>,
    /// The continuity with which the surface joins constrained vertices; `None` is the highest everywhere.
    pub(crate) continuity: Option<Arc<Vec<f64>>>,
    pub(crate) method: Method,
    /// The methods' inputs beside handles, by declared name: those of other methods than the present one are kept until
    /// these are chosen again.
    pub(crate) attachments: Arc<BTreeMap<&'static str, Attachment>>,
    pub(crate) tips: Tips,
    pub(crate) loose: Loose,
    /// The behaviour of single parts that nothing holds, by their component's number, instead of `loose`.
    pub(crate) loose_parts: Arc<BTreeMap<u32, Loose>>,
    /// The connected parts that are turned inside out when the file is shown and saved, by their numbers. The bending
    /// surface keeps the file's winding.
    pub(crate) inside_out: Arc<BTreeSet<u32>>,
    /// The hidden and locked parts.
    pub(crate) access: Arc<Access>,
    /// The rest shape's displacements from the file's.
    pub(crate) rest: Arc<Vec<DVec3>>,
    /// True if a shape was applied; if not, `rest` is zero.
    pub(crate) applied: bool,
    /// The present shape's displacements from the rest shape.
    pub(crate) from_rest: Arc<Vec<DVec3>>,
    /// The sum of both, which is drawn.
    pub(crate) from_file: Arc<Vec<DVec3>>,
    /// The shape at the last change of the constraints; `None` if the shape is the solution for the handles.
    pub(crate) kept: Option<Arc<KeptShape>>,
    /// The present shape's corrections by hand, as far as they are still visible; `None` without any.
    pub(crate) corrections: Option<Arc<Vec<DVec3>>>,
    /// True if `from_rest` is final for the handles' transforms.
    pub(crate) settled: bool,
    /// The full values of which handles and attachments are a share; `None` if they are shown in full.
    pub(crate) strength: Option<Arc<Strength>>,
    /// The kept poses.
    pub(crate) poses: Arc<Vec<Pose>>,
    /// The edit over time.
    pub(crate) animation: Animation,
    /// The state to which the document returns from a work pose; `None` outside one.
    pub(crate) work_pose: Option<Arc<WorkPose>>,
    /// The fluid on the surface, which bends nothing.
    pub(crate) fluid: Fluid,
    /// The forces in its flow.
    pub(crate) flow_options: FlowOptions,
}

/// The state to which a document returns from its work pose: a temporary pose, in which hidden places can be reached.
/// Legs are spread, the inside is painted and corrected, and everything then returns to its place to the bit.
///
/// Paint and stiffness belong to vertices, so they stay when the pose is left. A correction is a displacement in the
/// posed surface: it turns back with the surface around its vertex.
#[derive(Clone, Debug)]
pub(crate) struct WorkPose {
    /// The document at the beginning, without a work pose.
    pub(crate) before: Content,
    /// Its versions.
    pub(crate) versions: Versions,
    /// The corrections made since then, per surface vertex, as displacements of the shape at the beginning; `None`
    /// without any.
    pub(crate) corrected: Option<Arc<Vec<DVec3>>>,
}

impl Content {
    /// The content of a fresh document: everything is fixed. It bends by ARAP, which turns and moves at once.
    pub(crate) fn new(vertex_count: usize) -> Self {
        let zero = Arc::new(vec![DVec3::ZERO; vertex_count]);
        Self {
            paint: Arc::new(vec![Paint::Bare; vertex_count]),
            handles: Vec::new(),
            next_handle: 0,
            stiffness: None,
            continuity: None,
            method: Method::of_new_documents(),
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
            animation: Animation::default(),
            work_pose: None,
            fluid: Fluid::default(),
            flow_options: FlowOptions::default(),
        }
    }

    /// Computes the drawn shape from the rest shape and the displacements from it.
    pub(super) fn sum_shapes(&mut self) {
        self.from_file = sum_of_shapes(self.applied.then_some(&self.rest), &self.from_rest);
    }
}

/// The drawn shape: the rest shape's displacements, if there are any, plus those from it.
///
/// If nothing is added, the bits of the rest shape stay, so that applying a shape moves nothing.
pub fn sum_of_shapes(rest: Option<&Arc<Vec<DVec3>>>, from_rest: &Arc<Vec<DVec3>>) -> Arc<Vec<DVec3>> {
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
