//! The parts of the program that tools and commands may change.

use super::brush::Brush;
use super::overlay::Overlay;
use super::settings::ToolSettings;
use crate::input::Pointer;
use crate::view::{Pick, View};
use crate::workspace::Workspace;

/// The parts of the program, lent to a tool or a command for one call. The active gesture is not among them, nor are
/// waiting events, keys or the overlay.
pub(crate) struct Context<'a> {
    /// The document and what follows from it.
    pub(crate) workspace: &'a mut Workspace,
    /// Camera and look.
    pub(crate) view: &'a mut View,
    /// Which tool, and how it is set.
    pub(crate) settings: &'a mut ToolSettings,
    /// What the brush remembers between dabs.
    pub(crate) brush: &'a mut Brush,
    /// What was drawn over the surface last.
    pub(crate) overlay: &'a Overlay,
    /// Where the pointer is, if it is over the view.
    pub(crate) pointer: Option<Pointer>,
}

impl Context<'_> {
    /// What lies under the pointer.
    pub(crate) fn pointed_at(&self) -> Option<Pick> {
        self.workspace.pick(self.view, self.pointer?.position_px)
    }
}
