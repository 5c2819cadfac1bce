//! A workspace that follows another: the same document, solved by another method, for a comparison on the same drag.
//!
//! It has its own jobs and its own shape; everything else comes from the one that it follows. Nothing is sent back, and
//! it is neither undone nor saved.

use std::sync::Arc;

use pliant_deform::Method;

use super::snapshot::WorkspaceSnapshot;
use super::state::{Followed, Workspace};
use crate::document::{Aspect, Document};

impl Workspace {
    /// Takes over another workspace's state, except the method.
    pub(crate) fn follow(&mut self, leader: &WorkspaceSnapshot, method: &Method) {
        let theirs = *leader.document.versions();
        if self.followed.is_none_or(|known| known.model != leader.model_revision) {
            let count = leader.model.surface.positions.len();
            self.open(
                Arc::clone(&leader.model),
                leader.file_name.clone(),
                Document::new(count),
            );
        }
        let known = self.followed.map(|known| known.versions);
        let is_known = self.document.method() == method
            && known.is_some_and(|known| {
                let same = |aspect| !theirs.differ(&known, aspect);
                !theirs.are_other_problem(&known)
                    && same(Aspect::Handles)
                    && same(Aspect::Targets)
                    && same(Aspect::Access)
            });
        if !is_known {
            self.document.follow(&leader.document, known.as_ref(), method);
        }
        self.followed = Some(Followed {
            model: leader.model_revision,
            versions: theirs,
        });
        self.selection = leader.selection.clone();
    }
}
