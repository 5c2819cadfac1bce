//! The shape at a change of the constraints, from which the next drag begins.
//!
//! Handles keep their transforms, relative to one rest shape, for the document's lifetime. A stroke that changes roles
//! or stiffness changes the solution S(T) for the handles' transforms T, but the visible shape must not jump. With x
//! the visible shape and T₀ the transforms at that moment, a solve for T shows
//!
//! x(T) = S(T) + f·(x − S(T₀)),
//!
//! which is x at T₀. The residual x − S(T₀) fades at each vertex (f falls from 1 to 0) as S moves the vertex away from
//! S(T₀): freely dragged vertices end at S(T) alone, and unmoved vertices keep their visible positions.
//!
//! Another method or other options make another S, from which x differs by more than a person's work. Then the residual
//! is only the correction by hand ([`Carries::Corrections`]).

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::handle::{Handle, HandleId};
use super::handle_curve::HandleCurve;

/// The residual of a vertex is gone when the vertex has moved this many times the residual's length. The fading itself
/// moves a vertex by at most a quarter of its displacement by the drag, so that no vertex visibly runs back.
const FADES_WITHIN: f64 = 6.0;

/// A visible shape, and the handles' maps with it.
#[derive(Clone, PartialEq, Debug)]
pub struct KeptShape {
    /// Each handle's map of rest positions.
    pub targets: BTreeMap<HandleId, DAffine3>,
    /// The curves that handles follow, and where they went.
    pub curves: BTreeMap<HandleId, HandleCurve>,
    /// The moved positions of the control points of the method's attachment; `None` if all rested.
    pub controls: Option<Arc<Vec<DVec3>>>,
    /// The weights of the method's examples, `None` for one that was found.
    pub weights: Vec<Option<f64>>,
    /// Displacements from the rest shape, per surface vertex.
    pub shape: Arc<Vec<DVec3>>,
    /// The part of these that was corrected by hand; `None` without any.
    pub corrections: Option<Arc<Vec<DVec3>>>,
    /// The residual that the next drags keep.
    pub carries: Carries,
}

/// The residual beside the solution.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Carries {
    /// All differences between the kept shape and the solution at its transforms.
    #[default]
    Difference,
    /// Only the corrections by hand.
    Corrections,
}

impl KeptShape {
    /// The visible shape with the present handles, control points and examples.
    pub(crate) fn of(
        handles: &[Handle],
        controls: Option<Arc<Vec<DVec3>>>,
        weights: &[Option<f64>],
        shape: &Arc<Vec<DVec3>>,
        corrections: Option<&Arc<Vec<DVec3>>>,
    ) -> Self {
        Self {
            corrections: corrections.cloned(),
            carries: Carries::Difference,
            controls,
            weights: weights.to_vec(),
            targets: handles.iter().map(|handle| (handle.id, handle.affine())).collect(),
            curves: curves(handles).map(|(id, curve)| (id, curve.clone())).collect(),
            shape: Arc::clone(shape),
        }
    }

    /// The rest of it when another method or other options make another solution; `None` if nothing was corrected by
    /// hand.
    pub(crate) fn for_another_solution(&self) -> Option<Self> {
        self.corrections.as_ref()?;
        Some(Self {
            carries: Carries::Corrections,
            ..self.clone()
        })
    }

    /// Returns true if both have the same shape with the same transforms and corrections.
    pub(crate) fn is_of(
        &self,
        handles: &[Handle],
        controls: Option<&Vec<DVec3>>,
        weights: &[Option<f64>],
        shape: &Arc<Vec<DVec3>>,
        corrections: Option<&Arc<Vec<DVec3>>>,
    ) -> bool {
        Arc::ptr_eq(&self.shape, shape)
            && self.carries == Carries::Difference
            && self.corrections.as_ref().map(Arc::as_ptr) == corrections.map(Arc::as_ptr)
            && self.weights == weights
            && self.controls.as_deref() == controls
            && self.targets.len() == handles.len()
            && curves(handles).all(|(id, curve)| self.curves.get(&id) == Some(curve))
            && handles
                .iter()
                .all(|handle| self.targets.get(&handle.id) == Some(&handle.affine()))
    }

    /// x(T), given S(T₀) and S(T), all as displacements from the rest shape.
    pub fn carried(&self, at_first: &[DVec3], now: &[DVec3]) -> Vec<DVec3> {
        let vertices = (0..self.shape.len()).into_par_iter();
        vertices
            .map(|vertex| {
                let (first, now) = (at_first[vertex], now[vertex]);
                let residual = self.residual(vertex, first);
                match fading(residual, now.distance(first)) {
                    0.0 => now,
                    // This is exact to the bit; a sum would be rounded.
                    1.0 if self.carries == Carries::Difference => self.shape[vertex],
                    share => now + residual * share,
                }
            })
            .collect()
    }

    /// The remaining corrections in x(T), given the same; `None` if nothing was corrected by hand.
    pub(crate) fn corrections_left(&self, at_first: &[DVec3], now: &[DVec3]) -> Option<Arc<Vec<DVec3>>> {
        let corrections = self.corrections.as_ref()?.par_iter().enumerate();
        let left = corrections.map(|(vertex, correction)| {
            let first = at_first[vertex];
            *correction * fading(self.residual(vertex, first), now[vertex].distance(first))
        });
        Some(Arc::new(left.collect()))
    }

    /// The residual at a vertex, given its S(T₀).
    fn residual(&self, vertex: usize, first: DVec3) -> DVec3 {
        match (&self.corrections, self.carries) {
            (Some(corrections), Carries::Corrections) => corrections[vertex],
            _ => self.shape[vertex] - first,
        }
    }
}

/// The curves of handles.
fn curves(handles: &[Handle]) -> impl Iterator<Item = (HandleId, &HandleCurve)> {
    let lines = handles
        .iter()
        .filter_map(|handle| Some((handle.id, handle.line.as_ref()?)));
    lines.filter_map(|(id, line)| Some((id, line.curve()?)))
}

/// The share f of a residual that remains when the solution has moved this far.
fn fading(residual: DVec3, way: f64) -> f64 {
    let length = FADES_WITHIN * residual.length();
    if residual == DVec3::ZERO || way >= length {
        0.0
    } else if way == 0.0 {
        1.0
    } else {
        (1.0 - (way / length).powi(2)).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_seen_goes_on_from_the_kept_shape_to_the_solution_without_a_jump_or_a_way_back() {
        let seen = DVec3::new(0.3, 1.0, -0.2);
        let first = DVec3::new(0.1, 0.8, 0.1);
        let kept = KeptShape {
            targets: BTreeMap::new(),
            curves: BTreeMap::new(),
            controls: None,
            weights: Vec::new(),
            shape: Arc::new(vec![seen]),
            corrections: None,
            carries: Carries::Difference,
        };
        let at = |way: f64| {
            let now = first + way * DVec3::Y;
            (now, kept.carried(&[first], &[now])[0])
        };
        assert_eq!(at(0.0).1, seen);
        let far = at(10.0);
        assert_eq!(far.0, far.1);
        let step = 1e-3;
        let mut before = at(0.0).1;
        for number in 1..4000 {
            let (_, after) = at(step * f64::from(number));
            assert!(after.distance(before) <= 1.3 * step, "{before} {after}");
            assert!(after.y >= before.y, "it goes where it is dragged");
            before = after;
        }
    }
}
