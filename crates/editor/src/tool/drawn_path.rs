//! The way of the pointer while it draws an open line over the view.

use glam::DVec2;

use crate::input::Pointer;

/// Points of the view, at least `step_px` apart.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct DrawnPath {
    points_px: Vec<DVec2>,
    step_px: f64,
}

impl DrawnPath {
    pub(super) fn begin(pointer: Pointer, step_px: f64) -> Self {
        Self {
            points_px: vec![pointer.position_px],
            step_px,
        }
    }

    /// Goes on to the pointer if that is far enough.
    pub(super) fn follow(&mut self, pointer: Pointer) {
        let is_far = |last: &DVec2| last.distance(pointer.position_px) >= self.step_px;
        if self.points_px.last().is_none_or(is_far) {
            self.points_px.push(pointer.position_px);
        }
    }

    pub(super) fn points_px(&self) -> &[DVec2] {
        &self.points_px
    }

    /// The line as an outline, which is closed: the way back covers the line that would close it.
    pub(super) fn as_outline_px(&self) -> Vec<DVec2> {
        self.points_px
            .iter()
            .chain(self.points_px.iter().rev())
            .copied()
            .collect()
    }
}
