//! The state of the solver: the present shape, and the descent to the best one.

use super::fitting::Frame;
use crate::SolveError;
use crate::numerical::lbfgs::Memory;
use crate::numerical::sums::Field;

/// The frames and displacements of the local vertices.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) frames: Vec<Frame>,
    pub(super) field: Vec<[f64; 3]>,
    pub(super) energy: f64,
}

/// The state of the descent. Fields have a row for each solved vertex.
#[derive(Debug, Default)]
pub(super) struct Descent {
    pub(super) memory: Memory,
    pub(super) gradient: Field,
    pub(super) direction: Field,
    pub(super) trial: Option<Shape>,
    pub(super) failed: Option<SolveError>,
    /// True once the shape has the frames that fit it best.
    pub(super) is_begun: bool,
}

impl Descent {
    /// The next step begins at a new linear shape.
    pub fn restart(&mut self) {
        self.memory.clear();
        self.is_begun = false;
    }
}
