//! Parents of handles: when a handle moves, its children ride along, as a shank does when the thigh turns.
//!
//! Transforms stay absolute, so that the solver, files and other programs need no tree: a parent's motion is applied to
//! its descendants when it moves.

use std::collections::BTreeSet;

use glam::{DAffine3, DMat3};

use super::handle::{Handle, HandleId};
use super::handle_transform::HandleTransform;
use super::polar::polar_decomposition;

/// A scale this close to 1 is rounding.
const SAME_SIZE: f64 = 1e-9;

impl HandleTransform {
    /// The transform after a further `motion` of all space; `pivot` is the handle's on the rest shape. A translation,
    /// rotation and scale takes the motion's rotation, its factor in volume, and its displacement of the pivot; a matrix
    /// takes all of it.
    pub(crate) fn carried(self, motion: &DAffine3, pivot: glam::DVec3) -> Self {
        match self {
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot: own,
            } => {
                let at = own.unwrap_or(pivot);
                let moved = motion.transform_point3(at + translation) - at;
                if motion.matrix3 == DMat3::IDENTITY {
                    return self.moved_by(motion.translation);
                }
                let (turn, _) = polar_decomposition(motion.matrix3);
                let factor = motion.matrix3.determinant().abs().cbrt();
                let factor = if (factor - 1.0).abs() < SAME_SIZE { 1.0 } else { factor };
                Self::Trs {
                    translation: moved,
                    rotation: (turn * rotation).normalize(),
                    scale: scale * factor,
                    pivot: own,
                }
            }
            Self::Matrix(matrix) => Self::Matrix(*motion * matrix),
        }
    }
}

/// Returns true if a handle is among the descendants of another, or is that one.
pub(crate) fn is_within(handles: &[Handle], id: HandleId, ancestor: HandleId) -> bool {
    let parent = |id: HandleId| handles.iter().find(|handle| handle.id == id)?.parent;
    let (mut next, mut seen) = (Some(id), BTreeSet::new());
    while let Some(id) = next.filter(|id| seen.insert(*id)) {
        if id == ancestor {
            return true;
        }
        next = parent(id);
    }
    false
}

/// Gives children of handles that are gone the nearest ancestor that is left; `former` has the handles before.
pub(crate) fn find_parents_anew(handles: &mut [Handle], former: &[Handle]) {
    let left: Vec<HandleId> = handles.iter().map(|handle| handle.id).collect();
    for handle in handles {
        let mut most = former.len();
        while let Some(parent) = handle.parent.filter(|parent| !left.contains(parent)) {
            let next = former.iter().find(|other| other.id == parent).filter(|_| most > 0);
            handle.parent = next.and_then(|parent| parent.parent);
            most = most.saturating_sub(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DQuat, DVec3};

    use super::*;

    #[test]
    fn a_carried_transform_is_the_motion_after_it() {
        let pivot = DVec3::new(0.3, -1.0, 2.0);
        let motion = DAffine3::from_scale_rotation_translation(
            DVec3::splat(1.3),
            DQuat::from_rotation_y(0.8),
            DVec3::new(1.0, 2.0, -0.5),
        );
        let start = HandleTransform::IDENTITY
            .moved_by(DVec3::Z)
            .turned_by(DQuat::from_rotation_x(0.4), pivot);
        for start in [start, HandleTransform::Matrix(start.affine(pivot))] {
            let carried = start.carried(&motion, pivot).affine(pivot);
            assert!(carried.abs_diff_eq(motion * start.affine(pivot), 1e-12));
        }
        let shift = DAffine3::from_translation(DVec3::X);
        assert_eq!(start.carried(&shift, pivot), start.moved_by(DVec3::X), "to the bit");
    }

    #[test]
    fn children_of_removed_handles_get_their_grandparent() {
        let mut chain: Vec<Handle> = (0..4).map(|id| Handle::new(HandleId(id), String::new())).collect();
        for id in 1..4 {
            chain[usize::from(id)].parent = Some(HandleId(id - 1));
        }
        assert!(is_within(&chain, HandleId(3), HandleId(0)) && !is_within(&chain, HandleId(0), HandleId(3)));
        let mut left: Vec<Handle> = [0, 3].map(|place: usize| chain[place].clone()).to_vec();
        find_parents_anew(&mut left, &chain);
        assert_eq!(left[1].parent, Some(HandleId(0)));
        // A circle, which only a damaged file has, ends.
        chain[0].parent = Some(HandleId(3));
        assert!(!is_within(&chain, HandleId(1), HandleId(9)));
        let mut left = vec![Handle {
            parent: Some(HandleId(2)),
            ..Handle::new(HandleId(7), String::new())
        }];
        find_parents_anew(&mut left, &chain);
        assert_eq!(left[0].parent, None);
    }
}
