//! The choice between a quad's diagonals of equal length: one that a mirror keeps.
//!
//! The order of a face's corners says nothing of the shape, so a cut by it leans the same way on both sides of a figure
//! that is its own mirror image, and a symmetric edit bends it lopsided. This module finds a plane across which most
//! vertices have their image. It takes, of equal diagonals, the one whose ends have the lesser value of a function that
//! depends only on a vertex's distance from that plane and its place along it. The images of a quad's corners have the
//! same values, so that its image is cut by the image of its cut. A quad that is its own image has no such cut.
//!
//! The function also ignores the sides of the other two axes, as long as it distinguishes the diagonals, so that
//! figures with several planes keep them all.

use std::cell::OnceCell;

use glam::DVec3;
use pliant_mesh::mirror_planes;

/// Diagonals that differ by less than this share of their squares are equal.
const EQUAL: f64 = 1e-3;

/// Values that differ by less than this share of a diagonal's square don't distinguish diagonals.
const ALIKE: f64 = 1e-4;

/// The number of roundings to f32 of a coordinate that may be between a vertex and its image.
const ROUNDINGS: f64 = 16.0;

/// Normals whose cosine is below this are perpendicular to each other.
const SQUARE: f64 = 1e-4;

/// The choice of one of two equal diagonals of a shape.
pub(crate) struct Diagonals<'a> {
    positions: &'a [DVec3],
    frame: OnceCell<Frame>,
}

impl<'a> Diagonals<'a> {
    /// The rule for faces over these vertices.
    pub fn of(positions: &'a [DVec3]) -> Self {
        Self {
            positions,
            frame: OnceCell::new(),
        }
    }

    /// Returns true if the quad a, b, c, d takes b–d, if either diagonal would do.
    pub fn takes_bd(&self, [a, b, c, d]: [DVec3; 4]) -> bool {
        let (ac, bd) = (a.distance_squared(c), b.distance_squared(d));
        let frame = || self.frame.get_or_init(|| Frame::of(self.positions));
        let furthest = [a, b, c, d]
            .into_iter()
            .fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let rounding = ROUNDINGS * f64::from(f32::EPSILON) * furthest * ac.max(bd).sqrt();
        if (ac - bd).abs() > EQUAL * ac.max(bd) + rounding {
            return bd < ac;
        }
        let frame = frame();
        let [a, b, c, d] = [a, b, c, d].map(|corner| frame.seen(corner));
        let least = ALIKE * ac.max(bd) + rounding;
        let functions = [Frame::value_of_all_sides, Frame::value_of_one_side];
        let mut differences = functions
            .map(|value| value(a) + value(c) - value(b) - value(d))
            .into_iter();
        differences
            .find(|difference| difference.abs() > least)
            .is_some_and(|difference| difference > 0.0)
    }
}

/// The plane across which most vertices have their image: its normal first, then two axes along it.
struct Frame {
    axes: [DVec3; 3],
    centre: DVec3,
}

impl Frame {
    fn of(positions: &[DVec3]) -> Self {
        let finite: Vec<DVec3> = positions.iter().copied().filter(|p| p.is_finite()).collect();
        let centre = finite.iter().sum::<DVec3>() / finite.len().max(1) as f64;
        let judged = mirror_planes(&finite);
        let most = judged.iter().map(|(share, _)| *share).fold(0.0, f64::max);
        let best = judged.iter().find(|(share, _)| *share >= most);
        let (normal, height) = best.map_or((DVec3::X, 0.0), |(_, plane)| (plane.normal(), plane.height(centre)));
        // A second plane, perpendicular to the first, is kept as long as the sides of both distinguish diagonals.
        let mut square = judged.iter().map(|(_, other)| other.normal());
        let second = square.find(|other| other.dot(normal).abs() < SQUARE);
        let second = second.unwrap_or_else(|| normal.any_orthonormal_vector());
        Self {
            axes: [normal, second, normal.cross(second)],
            centre: centre - normal * height,
        }
    }

    /// A corner's distance from the plane, and its place along it from the centre.
    fn seen(&self, corner: DVec3) -> DVec3 {
        let from = corner - self.centre;
        DVec3::from_array(self.axes.map(|axis| axis.dot(from)))
    }

    fn value_of_all_sides(seen: DVec3) -> f64 {
        Self::value_of_one_side(seen.abs())
    }

    /// A sum of products, because sums of functions of single axes are equal over both diagonals of a rectangle.
    fn value_of_one_side(seen: DVec3) -> f64 {
        let side = seen.x.abs();
        side * seen.y + 0.754_877_666 * seen.y * seen.z + 0.569_840_291 * seen.z * side
    }
}
