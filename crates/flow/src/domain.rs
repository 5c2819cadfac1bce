//! The surface as the flow sees it, and places on it.

use glam::DVec2;

use crate::chart::Chart;
use crate::crossings::Crossings;
use crate::fans::Fans;
use crate::plane::turned_back;

/// A way ends after this many edges. Only a velocity far above an edge a step, or a pile of needles, comes so far.
pub(crate) const MOST_EDGES: usize = 1024;

/// A point on the surface, and the rotation of vectors that were carried to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub triangle: u32,
    /// Barycentric coordinates: not negative, with the sum 1.
    pub weights: [f64; 3],
    /// From the tangent plane of the vertex at the way's beginning to the triangle's plane.
    pub rotation: DVec2,
}

impl Place {
    /// The place at these coordinates, from which rounding is taken off.
    #[inline]
    pub fn at(triangle: u32, weights: [f64; 3], rotation: DVec2) -> Self {
        let inside = weights.map(|weight| weight.max(0.0));
        let inverse = inside.iter().sum::<f64>().recip();
        Self {
            triangle,
            weights: inside.map(|weight| weight * inverse),
            rotation,
        }
    }
}

/// The surface as the flow sees it: triangles in planes of their own, and how planes fit together.
#[derive(Debug)]
pub(crate) struct Domain {
    pub charts: Vec<Chart>,
    pub crossings: Crossings,
    pub fans: Fans,
}

impl Domain {
    /// The rotation from the plane of the triangle of `edge` to that of `other`, the same edge beside.
    #[inline]
    pub fn turn(&self, edge: u32, other: u32) -> DVec2 {
        let vector = |edge: u32| self.charts[edge as usize / 3].edge(edge as usize % 3);
        // Both have the same length.
        let (from, to) = (vector(edge), -vector(other));
        turned_back(from, to) / from.length_squared()
    }
}
