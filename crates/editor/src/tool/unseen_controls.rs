//! Selected control points that the chosen tool does not show.

use super::settings::ToolSettings;
use crate::workspace::Workspace;

/// Deselects them, so that nothing is moved that can't be seen.
pub(crate) fn drop_unseen(workspace: &mut Workspace, settings: &ToolSettings) {
    let is_seen = || {
        let shown = workspace.shown_controls();
        shown.is_some_and(|shown| settings.shows(&shown.source))
    };
    if !workspace.controls.is_empty() && !is_seen() {
        workspace.controls.put([]);
    }
}
