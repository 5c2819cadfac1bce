//! The present shape, and the descent from it.

use super::fitting::Frame;
use crate::SolveError;
use crate::numerical::lbfgs::Memory;
use crate::numerical::sums::Field;

/// The frames and displacements of the local vertices.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub frames: Vec<Frame>,
    pub field: Vec<[f64; 3]>,
    pub energy: f64,
}

/// The state of the descent. Fields have a row for each solved vertex.
#[derive(Debug, Default)]
pub(super) struct Descent {
    pub memory: Memory,
    pub gradient: Field,
    pub direction: Field,
    pub trial: Option<Shape>,
    pub failed: Option<SolveError>,
    /// True once the shape has the frames that fit it best.
    pub is_begun: bool,
}

impl Descent {
    /// The next step begins at a new linear shape.
    pub fn restart(&mut self) {
        self.memory.clear();
        self.is_begun = false;
    }
}
