//! The left button's tools on the surface, and the shapes in which they select vertices.

/// The left button's tool on the surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum ToolMode {
    /// Paints the selected handle, or a new one.
    #[default]
    PaintHandle,
    /// Paints the free region.
    PaintFree,
    /// Paints the fixed part.
    PaintFixed,
    /// Removes paint.
    Erase,
    /// Paints the surface's stiffness.
    PaintStiffness,
    /// Selects a handle and drags it.
    Select,
    /// Turns a limb about its joint.
    Pose,
    /// Corrects the shape by hand.
    Correct,
    /// Pours colour into the fluid on the surface, and moves it.
    Flow,
}

impl ToolMode {
    /// Returns true if it paints with a brush.
    pub(crate) fn has_brush(self) -> bool {
        !matches!(self, Self::Select | Self::Pose)
    }

    /// Returns true if its drags begin anywhere on the surface and act on that place, whatever handle is selected.
    pub(crate) fn drags_surface(self) -> bool {
        matches!(self, Self::Pose | Self::Correct | Self::Flow)
    }

    /// Returns true if it paints vertices' roles.
    pub(crate) fn paints_roles(self) -> bool {
        matches!(
            self,
            Self::PaintHandle | Self::PaintFree | Self::PaintFixed | Self::Erase
        )
    }
}

/// The shape in which the left button selects vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum StrokeShape {
    /// With the brush.
    #[default]
    Brush,
    /// Within a line drawn freely around them.
    Lasso,
    /// Within a box.
    Box,
    /// All vertices connected to the one under the pointer.
    Component,
    /// Those under a curve drawn on the surface, which they then follow.
    Curve,
    /// Those around a curve drawn through the middle of a limb, which they then follow.
    Spine,
    /// Those beside a curve along the crease or the border that a stroke means, which they then follow.
    Crease,
    /// Those of the outline beside a line that draws the outline anew.
    Sketch,
}

impl StrokeShape {
    /// Returns true if a stroke draws a line that a new handle follows.
    pub(crate) fn is_line(self) -> bool {
        matches!(self, Self::Curve | Self::Spine | Self::Crease | Self::Sketch)
    }
}

/// The depth of a lasso or a box.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Depth {
    /// Only the visible surface.
    #[default]
    Visible,
    /// Through the surface to its back.
    Through,
}
