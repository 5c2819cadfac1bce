//! Begin, preview, commit or abort: the way in which the document changes.
//!
//! A transaction stores the document at its beginning (which is cheap, because the long vectors are shared until they
//! change). Abort restores that, commit writes the differences into the history as one named step. A transaction
//! without differences leaves nothing.

use std::sync::Arc;

use glam::DVec3;

use super::content::Paint;
use super::history::{Change, History};
use super::packed_fluid::PackedFluid;
use super::sparse::Sparse;
use super::state::Document;
use super::version::Aspect;

/// A change of the document in progress.
#[derive(Debug)]
pub(crate) struct Transaction {
    name: String,
    before: Document,
}

impl Transaction {
    /// Begins a step called `name`.
    pub(crate) fn begin(name: impl Into<String>, document: &Document, history: &mut History) -> Self {
        history.sync(document);
        Self {
            name: name.into(),
            before: document.clone(),
        }
    }

    /// The earlier document.
    pub(crate) fn before(&self) -> &Document {
        &self.before
    }

    /// Renames the step.
    pub(crate) fn rename(&mut self, name: impl Into<String>) {
        self.name = name.into();
    }

    /// Restores the earlier document.
    pub(crate) fn abort(&self, document: &mut Document) {
        document.go_back_to(self.before.clone());
    }

    /// Enters the differences into the history; false if there are none.
    pub(crate) fn commit(&self, document: &Document, history: &mut History) -> bool {
        let Self { name, before } = self;
        let changes = differences(before, document);
        let same_shape = !before.versions().differ(document.versions(), Aspect::Shape)
            || Sparse::difference(&document.from_rest, &before.from_rest).is_empty();
        if changes
            .iter()
            .all(|change| matches!(change, Change::Settled(_) | Change::Kept(_)))
            && same_shape
        {
            return false;
        }
        history.push(name.clone(), changes, before);
        true
    }
}

/// The values of `before` that differ in `after`.
fn differences(before: &Document, after: &Document) -> Vec<Change> {
    let differ = |aspect| before.versions().differ(after.versions(), aspect);
    let mut changes = Vec::new();
    if differ(Aspect::Paint) {
        let sparse = painted(&before.paint, &after.paint);
        if !sparse.is_empty() {
            changes.push(Change::Paint(sparse));
        }
    }
    if before.handles != after.handles {
        changes.push(Change::Handles(before.handles.clone(), before.next_handle));
    }
    if differ(Aspect::Stiffness) {
        let sparse = stiffened(before, after);
        if !sparse.is_empty() || before.stiffness.is_some() != after.stiffness.is_some() {
            changes.push(Change::Stiffness(sparse, before.stiffness.is_some()));
        }
    }
    if differ(Aspect::Continuity) {
        changes.push(Change::Continuity(before.continuity.clone()));
    }
    let loose = |document: &Document| (document.loose, Arc::clone(&document.loose_parts));
    if before.method != after.method || loose(before) != loose(after) {
        let (loose, parts) = loose(before);
        changes.push(Change::Options(before.method.clone(), loose, parts));
    }
    if !Arc::ptr_eq(&before.attachments, &after.attachments) && before.attachments != after.attachments {
        changes.push(Change::Attachments(Arc::clone(&before.attachments)));
    }
    if before.tips != after.tips {
        changes.push(Change::Tips(before.tips));
    }
    if before.inside_out != after.inside_out {
        changes.push(Change::InsideOut(Arc::clone(&before.inside_out)));
    }
    if before.access != after.access {
        changes.push(Change::Access(Arc::clone(&before.access)));
    }
    if differ(Aspect::Rest) {
        let sparse = Sparse::<DVec3>::difference(&after.rest, &before.rest);
        if before.applied != after.applied || !sparse.is_empty() {
            changes.push(Change::Rest(sparse, before.applied));
        }
    }
    let same_kept = match (&before.kept, &after.kept) {
        (Some(before), Some(after)) => Arc::ptr_eq(before, after) || before == after,
        (None, None) => true,
        _ => false,
    };
    if !same_kept {
        changes.push(Change::Kept(before.kept.clone()));
    }
    if before.settled != after.settled {
        changes.push(Change::Settled(before.settled));
    }
    if !Arc::ptr_eq(&before.poses, &after.poses) && before.poses != after.poses {
        changes.push(Change::Poses(Arc::clone(&before.poses)));
    }
    if before.animation != after.animation {
        changes.push(Change::Animation(before.animation.clone()));
    }
    let same_work_pose = match (&before.work_pose, &after.work_pose) {
        (Some(before), Some(after)) => Arc::ptr_eq(before, after),
        (None, None) => true,
        _ => false,
    };
    if !same_work_pose {
        changes.push(Change::WorkPose(before.work_pose.clone()));
    }
    if differ(Aspect::Fluid) && before.fluid != after.fluid {
        changes.push(Change::Fluid(PackedFluid::of(&before.fluid)));
    }
    if before.flow_options != after.flow_options {
        changes.push(Change::FlowOptions(before.flow_options));
    }
    if before.strength != after.strength {
        changes.push(Change::Strength(before.strength.clone()));
    }
    changes
}

/// The places with another stiffness before, and that stiffness; without a field it is 1 everywhere.
fn stiffened(before: &Document, after: &Document) -> Sparse<f64> {
    let at = |document: &Document, vertex: usize| document.stiffness.as_ref().map_or(1.0, |field| field[vertex]);
    let mut sparse = Sparse::default();
    for vertex in 0..before.paint.len() {
        let old = at(before, vertex);
        if old.to_bits() != at(after, vertex).to_bits() {
            sparse.push(vertex, old);
        }
    }
    sparse
}

fn painted(before: &[Paint], after: &[Paint]) -> Sparse<Paint> {
    let mut sparse = Sparse::default();
    for (index, (before, after)) in before.iter().zip(after).enumerate() {
        if before != after {
            sparse.push(index, *before);
        }
    }
    sparse
}
