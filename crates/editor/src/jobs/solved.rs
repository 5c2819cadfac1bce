//! The result of a solve: a shape, or the control points alone.

use std::sync::Arc;

use glam::{DVec3, Mat3};
use pliant_deform::Bound;

use crate::bending::Carried;
use crate::document::HandleId;
use crate::warning::HandleWarning;

/// The result of the job that bends.
#[derive(Clone, Debug)]
pub enum SolveResult {
    /// A new shape.
    Shape(Solved),
    /// The positions of the control points; the shape is known.
    Controls(ControlPlaces),
}

/// A solve's result, after as many steps as a frame has time for: displacements per surface vertex.
#[derive(Clone, Debug)]
pub struct Solved {
    /// Displacements from the present rest shape.
    pub from_rest: Arc<Vec<DVec3>>,
    /// Displacements from the file's shape, which are drawn. This is the same allocation if no shape was applied.
    pub from_file: Arc<Vec<DVec3>>,
    /// The Jacobian of the displacements at each surface vertex, if the method knows it and has made `from_file`:
    /// normals turn by it, independent of the triangles.
    pub jacobians: Option<Vec<Mat3>>,
    /// The positions of the method's control points; `None` if it has none.
    pub(crate) controls: Option<ControlPlaces>,
    /// The solution behind it, if it continues a kept shape.
    pub(crate) carried: Option<Carried>,
    /// The distances by which free handles slid along their directions, at the end of a solve.
    pub(crate) slides: Vec<(HandleId, f64)>,
    /// The lengths by which the free points of handles' curves slid.
    pub(crate) point_slides: Vec<(HandleId, f64)>,
    /// The motions in these targets that the method can't follow.
    pub(crate) blind_to: Vec<HandleWarning>,
    /// The examples' weights that were used or found.
    pub(crate) example_weights: Vec<f64>,
    /// Whether further steps would not change it.
    pub finished: bool,
    /// The progress of an iterative method's descent; `None` for a method with a single step.
    pub descent: Option<Descent>,
}

/// The positions of control points.
#[derive(Clone, Debug)]
pub struct ControlPlaces {
    /// Moved by handles and by hand.
    pub(super) positions: Arc<Vec<DVec3>>,
    /// Moved by hand alone.
    pub(super) moved: Arc<Vec<DVec3>>,
}

impl ControlPlaces {
    /// The positions for the present targets of a binding; `None` for a method without control points.
    pub(super) fn of(bound: &Bound) -> Option<Self> {
        let (_, attachment) = bound.attachment()?;
        Some(Self {
            positions: Arc::new(bound.control_positions()),
            moved: Arc::clone(attachment.moved()?),
        })
    }
}

/// The progress of a descent.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Descent {
    /// The present shape's energy, without unit (see [`pliant_deform::Step::energy`]).
    pub energy: f64,
    /// Whether that is the minimum, to the method's tolerance.
    pub converged: bool,
    /// Whether no further step follows: it converged, or met the method's limit.
    pub finished: bool,
}
