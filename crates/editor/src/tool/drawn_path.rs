//! The way of the pointer while it draws an open line over the view.

use glam::DVec2;

use super::polyline::length_px;
use crate::input::Pointer;

/// The distance between two samples of a stroke along the surface, in points.
pub(super) const STEP_PX: f64 = 3.0;

/// Ends that are so near, in points, close a line that is this long at least.
pub(super) const CLOSING_PX: f64 = 16.0;
const SHORTEST_CLOSED_PX: f64 = 120.0;

/// The way between two control points of a curve along the surface, in points, and their possible numbers.
const SPACING_PX: f64 = 60.0;
const POINTS: std::ops::RangeInclusive<usize> = 3..=12;

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

    /// Points along it, at most so far apart.
    pub(super) fn evenly_px(&self, step_px: f64) -> impl Iterator<Item = DVec2> + '_ {
        let between = move |pair: &[DVec2]| {
            let [from, to] = [pair[0], pair[1]];
            let steps = (from.distance(to) / step_px).ceil().max(1.0);
            (0..steps as usize).map(move |step| from.lerp(to, step as f64 / steps))
        };
        let inner = self.points_px.windows(2).flat_map(between);
        inner.chain(self.points_px.last().copied())
    }

    /// Returns true if it ends where it began.
    pub(super) fn is_closed(&self) -> bool {
        let ends = self.points_px.first().zip(self.points_px.last());
        let are_near = ends.is_some_and(|(first, last)| first.distance(*last) <= CLOSING_PX);
        are_near && length_px(&self.points_px) >= SHORTEST_CLOSED_PX
    }

    /// The number of the control points of a curve along it.
    pub(super) fn point_count(&self) -> usize {
        ((length_px(&self.points_px) / SPACING_PX) as usize + 1).clamp(*POINTS.start(), *POINTS.end())
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
