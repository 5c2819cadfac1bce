//! The bent path of the body of a sequence: the frames at which the whole body is moved.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::ground_axis::GroundAxis;

/// The ways by which a whole body is moved at some frames of a sequence.
#[derive(Clone, PartialEq, Debug)]
pub struct BodyPath {
    /// By frame, two at least, in world units.
    shifts: BTreeMap<usize, DVec3>,
    up: GroundAxis,
}

impl BodyPath {
    /// `None` with fewer than two frames.
    pub(crate) fn of(shifts: BTreeMap<usize, DVec3>, up: GroundAxis) -> Option<Self> {
        (shifts.len() >= 2).then_some(Self { shifts, up })
    }

    /// The frames at which the body is moved, ascending, and its way there, in world units.
    pub fn shifts(&self) -> impl Iterator<Item = (usize, DVec3)> {
        self.shifts.iter().map(|(frame, shift)| (*frame, *shift))
    }

    /// The axis about which the body turns with its path.
    pub fn up(&self) -> GroundAxis {
        self.up
    }

    /// Returns true if the body is moved at this very frame.
    pub fn has(&self, frame: usize) -> bool {
        self.shifts.contains_key(&frame)
    }

    /// The same with another way at one frame.
    pub(super) fn with(&self, frame: usize, shift: DVec3) -> Self {
        let mut path = self.clone();
        path.shifts.insert(frame, shift);
        path
    }

    /// The same without some frames; `None` if fewer than two are left.
    pub(super) fn only(&self, is_kept: impl Fn(usize) -> bool) -> Option<Self> {
        let kept = self.shifts().filter(|(frame, _)| is_kept(*frame));
        Self::of(kept.collect(), self.up)
    }

    /// The memory of the frames.
    pub(super) fn bytes(&self) -> usize {
        self.shifts.len() * size_of::<(usize, DVec3)>()
    }
}
