//! The result of a comparison's job: a binding, a shape, and their costs.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, Bound};
use pliant_mesh::Bounds;

use crate::bending::Carried;
use crate::document::{Document, HandleId, KeptShape, Versions};
use crate::lines::Lines;

/// The result of a comparison's job.
#[derive(Debug)]
pub struct Compared {
    pub(super) binding: Binding,
    /// The shape, or the reason why there is none.
    pub(super) shape: Result<Arc<Vec<DVec3>>, String>,
    /// The figures, once the shape is solved to its end.
    pub(super) figures: Option<Figures>,
}

/// The costs of a method and the stretch of its shape.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Figures {
    /// The time of binding in milliseconds.
    pub bind_ms: f64,
    /// The time from new transforms to the shape in milliseconds.
    pub frame_ms: f64,
    /// The mean over the edges of the larger of new by old length and old by new.
    pub edge_stretch_mean: f64,
    /// The largest such ratio.
    pub edge_stretch_max: f64,
    /// The box around the shape; `None` for an empty surface.
    pub bounds: Option<Bounds>,
    /// The box around everything that has visibly moved, at rest and now; `None` if nothing has.
    pub moved: Option<Bounds>,
}

/// A bound method and the state of its steps.
#[derive(Clone, Debug)]
pub(super) struct Binding {
    pub(super) bound: Arc<Mutex<Bound>>,
    /// The lines that its handles follow.
    pub(super) lines: Lines,
    /// The edit for which it was last used.
    pub(super) of: Edit,
    pub(super) bind_ms: f64,
    /// The last shape, as displacements from the rest shape.
    pub(super) from_rest: Arc<Vec<DVec3>>,
    pub(super) carried: Option<Carried>,
    /// The time spent on the present transforms so far.
    pub(super) frame_ms: f64,
}

/// The edit behind a result, without its method.
#[derive(Clone, Debug)]
pub(super) struct Edit {
    versions: Versions,
    targets: Vec<(HandleId, DAffine3)>,
    attachments: Arc<BTreeMap<&'static str, Attachment>>,
    kept: Option<Arc<KeptShape>>,
}

impl Edit {
    pub(super) fn of(document: &Document) -> Self {
        let handles = document.handles().iter();
        Self {
            versions: *document.versions(),
            targets: handles.map(|handle| (handle.id, handle.affine())).collect(),
            attachments: Arc::clone(&document.attachments),
            kept: document.kept.clone(),
        }
    }

    /// Whether a binding for one is invalid for the other.
    pub(super) fn is_other_problem(&self, other: &Self) -> bool {
        self.versions.are_other_edit(&other.versions)
    }

    /// Whether both need the same solve.
    pub(super) fn has_targets_of(&self, other: &Self) -> bool {
        let addresses = [self, other].map(|edit| edit.kept.as_ref().map(Arc::as_ptr));
        let same_controls = Arc::ptr_eq(&self.attachments, &other.attachments) || self.attachments == other.attachments;
        same_controls && self.targets == other.targets && addresses[0] == addresses[1]
    }
}
