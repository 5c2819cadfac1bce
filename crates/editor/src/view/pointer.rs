//! The look of the pointer over the view, and the number beside a dragged object.

use glam::DVec3;

/// A number shown beside the dragged object.
#[derive(Clone, PartialEq, Debug)]
pub struct Readout {
    /// The place, in world space.
    pub at: DVec3,
    /// The number with its unit or sign.
    pub text: String,
}

/// The look of the pointer over the view.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Cursor {
    /// An arrow.
    #[default]
    Arrow,
    /// A crosshair: the brush is over the surface.
    Brush,
    /// A hand: the part under the pointer can be grabbed.
    Grab,
    /// A closed hand: a drag is active.
    Grabbing,
    /// Four arrows: a transform follows the pointer.
    Move,
}
