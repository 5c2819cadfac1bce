//! The lattice's box and the tensor products over it.

use glam::{DVec3, USizeVec3};

use super::basis::Axis;
use crate::space::hand_field::ControlMap;

/// A lattice of control points over a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    low: DVec3,
    extent: DVec3,
    axes: [Axis; 3],
}

impl Grid {
    /// The lattice of these functions over the box from `low` over `extent`.
    pub fn new(axes: [Axis; 3], low: DVec3, extent: DVec3) -> Self {
        Self { low, extent, axes }
    }

    /// The number of control points along each axis.
    pub fn counts(&self) -> USizeVec3 {
        let [x, y, z] = self.axes.map(|axis| axis.count());
        USizeVec3::new(x, y, z)
    }

    /// The number of control points.
    pub fn count(&self) -> usize {
        self.counts().element_product()
    }

    /// A control point's number for its place along each axis; x runs fastest.
    pub fn number(&self, place: USizeVec3) -> usize {
        let counts = self.counts();
        place.x + counts.x * (place.y + counts.y * place.z)
    }

    /// The control points' places, in the order of their numbers.
    pub fn places(&self) -> impl Iterator<Item = USizeVec3> + use<> {
        let counts = self.counts();
        let row = move |y, z| (0..counts.x).map(move |x| USizeVec3::new(x, y, z));
        (0..counts.z).flat_map(move |z| (0..counts.y).flat_map(move |y| row(y, z)))
    }

    /// The rest position of a control point.
    pub fn rest(&self, place: USizeVec3) -> DVec3 {
        let at: [f64; 3] = std::array::from_fn(|axis| self.axes[axis].greville(place[axis]));
        self.low + self.extent * DVec3::from_array(at)
    }

    /// Visits the control points with a weight at a point: number, weight, and the weight's gradient per world unit.
    pub fn weights(&self, world_point: DVec3, mut visit: impl FnMut(usize, f64, DVec3)) {
        let t = (world_point - self.low) / self.extent;
        let [x, y, z] = std::array::from_fn(|axis| self.axes[axis].at(t[axis]));
        for k in 0..z.count {
            for j in 0..y.count {
                let (yz, slope_y, slope_z) = (
                    y.values[j] * z.values[k],
                    y.slopes[j] * z.values[k],
                    y.values[j] * z.slopes[k],
                );
                let row = self.number(USizeVec3::new(x.first, y.first + j, z.first + k));
                for i in 0..x.count {
                    let gradient = DVec3::new(x.slopes[i] * yz, x.values[i] * slope_y, x.values[i] * slope_z);
                    visit(row + i, x.values[i] * yz, gradient / self.extent);
                }
            }
        }
    }
}

impl ControlMap for Grid {
    fn weights(&self, _: usize, world_point: DVec3, visit: impl FnMut(usize, f64, DVec3)) {
        Self::weights(self, world_point, visit);
    }
}
