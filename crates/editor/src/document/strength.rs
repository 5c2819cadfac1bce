//! The shown share of an edit: everything that a person has moved, at a share of its displacement from rest.
//!
//! The *input* is scaled (handles, control points, weights of examples), and the method solves for it again. Blending
//! the displacements instead would be cheaper, but a vertex that turns by 90 degrees would move along the chord, and
//! the surface would shrink in between: half of a bent arm would be a thin arm. A share of each handle's turn is a
//! turn, so every share is a pose at which a drag could have stopped: the one that `--frames` passes there.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, Method};

use super::handle::{Handle, HandleId};
use super::handle_transform::HandleTransform;
use super::turn::{followed, is_short, part_of};

/// The stance of a handle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Stance {
    pub(crate) transform: HandleTransform,
    /// Its counted turn.
    pub(crate) turn_deg: DVec3,
}

impl Stance {
    pub(crate) fn of(handle: &Handle) -> Self {
        Self {
            transform: handle.transform,
            turn_deg: handle.turn_deg,
        }
    }

    /// The stance at the share `t` of the displacement from rest. Full turns count.
    pub(crate) fn part(&self, t: f64, pivot: DVec3) -> Self {
        if t == 1.0 {
            return *self;
        }
        let counted = |rotation| part_of(rotation, self.turn_deg, t);
        let transform = self.transform.part_turned(t, pivot, counted);
        Self {
            transform,
            turn_deg: match transform {
                HandleTransform::Trs { rotation, .. } => followed(self.turn_deg * t, rotation),
                HandleTransform::Matrix(_) => DVec3::ZERO,
            },
        }
    }

    /// Returns true if its path is that of the transform alone, which has no full turns.
    pub(crate) fn goes_the_short_way(&self) -> bool {
        match self.transform {
            HandleTransform::Trs { rotation, .. } => is_short(rotation, self.turn_deg),
            HandleTransform::Matrix(_) => true,
        }
    }
}

/// The full values; the shown ones are a share of them.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Strength {
    /// The shown share, from 0 to below 1.
    pub(crate) share: f64,
    /// The handles' full transforms.
    pub(crate) handles: BTreeMap<HandleId, Stance>,
    /// The attachments with full control points and weights.
    pub(crate) attachments: Arc<BTreeMap<&'static str, Attachment>>,
}

impl Strength {
    /// The present values, as the full ones.
    pub(crate) fn whole(handles: &[Handle], attachments: &Arc<BTreeMap<&'static str, Attachment>>) -> Self {
        Self {
            share: 1.0,
            handles: handles.iter().map(|handle| (handle.id, Stance::of(handle))).collect(),
            attachments: Arc::clone(attachments),
        }
    }

    /// The attachments with the points and weights for a share.
    pub(crate) fn attachments_at(&self, share: f64, method: &Method) -> Arc<BTreeMap<&'static str, Attachment>> {
        let mut attachments = Arc::clone(&self.attachments);
        for declared in method.declaration().attachments {
            if let Some(own) = self.attachments.get(declared.name) {
                let part = attachment_part(method, own, share);
                Arc::make_mut(&mut attachments).insert(declared.name, part);
            }
        }
        attachments
    }
}

/// An attachment of the method at the share `t` of the displacement from rest: its control points move on straight
/// lines, and weights that bend the surface are multiplied by `t`. Weights that only add to the handles' effect stay,
/// because that effect already grows with the handles.
pub(crate) fn attachment_part(method: &Method, attachment: &Attachment, t: f64) -> Attachment {
    if t == 1.0 {
        return attachment.clone();
    }
    match attachment {
        Attachment::Shapes(examples) if method.examples_bend() => {
            let mut examples = examples.clone();
            examples.weights.iter_mut().flatten().for_each(|weight| *weight *= t);
            Attachment::Shapes(examples)
        }
        Attachment::Shapes(_) => attachment.clone(),
        Attachment::Mesh(_) | Attachment::Lattice(_) => {
            let rest = method.control_rest(attachment);
            let moved = attachment.moved().map_or(&[][..], |moved| moved);
            let places = rest.iter().zip(moved).map(|(rest, moved)| *rest + (*moved - *rest) * t);
            attachment.with_moved(Arc::new(places.collect()))
        }
    }
}
