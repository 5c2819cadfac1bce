//! What the left button does on the surface, and how it takes vertices.

/// What the left button does on the surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum ToolMode {
    /// Paints the selected handle, or a new one.
    #[default]
    PaintHandle,
    /// Paints the free region.
    PaintFree,
    /// Paints the part that is held still.
    PaintFixed,
    /// Takes paint away.
    Erase,
    /// Paints how stiff the surface is.
    PaintStiffness,
    /// Selects a handle and drags it.
    Select,
    /// Turns a limb about its joint.
    Pose,
    /// Corrects the shape by hand.
    Correct,
}

impl ToolMode {
    /// Whether it paints with a brush.
    pub(crate) fn has_brush(self) -> bool {
        !matches!(self, Self::Select | Self::Pose)
    }

    /// Whether it paints what vertices do.
    pub(crate) fn paints_roles(self) -> bool {
        matches!(
            self,
            Self::PaintHandle | Self::PaintFree | Self::PaintFixed | Self::Erase
        )
    }
}

/// How the left button takes vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum StrokeShape {
    /// With the brush.
    #[default]
    Brush,
    /// Within a line drawn freely around them.
    Lasso,
    /// Within a box.
    Box,
    /// All that hang together with the one under the pointer.
    Component,
}

/// How deep a lasso or a box goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Depth {
    /// Only what is seen.
    #[default]
    Visible,
    /// Through the surface to its back.
    Through,
}
