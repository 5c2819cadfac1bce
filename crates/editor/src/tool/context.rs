//! The parts of the program that tools and commands may change.

use super::brush::Brush;
use super::overlay::Overlay;
use super::settings::ToolSettings;
use crate::input::Pointer;
use crate::view::{Pick, View};
use crate::workspace::Workspace;

/// The parts of the program, lent to a tool or a command for one call. They do not include the active gesture, waiting
/// events, keys or the overlay.
pub(crate) struct Context<'a> {
    /// The document and its consequences.
    pub(crate) workspace: &'a mut Workspace,
    /// The camera and the look.
    pub(crate) view: &'a mut View,
    /// The chosen tool and its settings.
    pub(crate) settings: &'a mut ToolSettings,
    /// The brush's memory between dabs.
    pub(crate) brush: &'a mut Brush,
    /// The last overlay over the surface.
    pub(crate) overlay: &'a Overlay,
    /// The position of the pointer, if it is over the view.
    pub(crate) pointer: Option<Pointer>,
    /// The position at which it left the view, or was covered by a menu or a list of commands.
    pub(crate) left_at: Option<Pointer>,
}

impl Context<'_> {
    /// The hit under the pointer, or under its last place over the view: a command may come from a menu over it.
    pub(crate) fn pointed_at(&self) -> Option<Pick> {
        self.workspace
            .pick(self.view, self.pointer.or(self.left_at)?.position_px)
    }
}
