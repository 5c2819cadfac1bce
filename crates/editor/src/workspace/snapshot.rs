//! The present document, for code that writes it elsewhere or follows it while the person continues to work.

use std::sync::Arc;

use pliant_mesh::Model;

use super::selection::HandleSelection;
use super::state::Workspace;
use crate::document::{Document, Versions};
use crate::revision::Revision;

/// A workspace that no longer changes. Making one is almost free: its long vectors are shared.
#[derive(Clone, Debug)]
pub(crate) struct WorkspaceSnapshot {
    pub(crate) document: Document,
    pub(crate) model: Arc<Model>,
    pub(super) model_revision: Revision,
    pub(super) file_name: String,
    pub(super) selection: HandleSelection,
}

impl WorkspaceSnapshot {
    /// The state of a workspace; `None` before the first file.
    pub(crate) fn of(workspace: &Workspace) -> Option<Self> {
        Some(Self {
            document: workspace.document.clone(),
            model: Arc::clone(workspace.model()?),
            model_revision: workspace.jobs.model_revision(),
            file_name: workspace.file_name.clone(),
            selection: workspace.selection.clone(),
        })
    }
}

/// The identity of a snapshot: equal states have equal ones within a session.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct SnapshotKey {
    steps: u64,
    versions: Versions,
    settled: bool,
}

impl SnapshotKey {
    /// A value that differs for every other state of the document.
    pub(crate) fn of(workspace: &Workspace) -> Self {
        Self {
            steps: workspace.history.revision(),
            versions: *workspace.document.versions(),
            settled: workspace.document.is_settled(),
        }
    }
}
