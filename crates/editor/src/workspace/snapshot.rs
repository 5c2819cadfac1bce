//! The identity of a state.

use super::state::Workspace;
use crate::document::Versions;

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
