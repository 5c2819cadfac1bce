//! Triangles joined side to side, and the flips that make them Delaunay.

use pliant_mesh::{SurfaceVertex, area_of_lengths, cotangents};

/// Triangles by corners and lengths. Side 3 f + i is opposite corner i of triangle f and runs from corner i + 1 to
/// corner i + 2; two joined sides run in opposite directions unless they are *turned*.
#[derive(Clone, Debug)]
pub(crate) struct Sides {
    corners: Vec<[SurfaceVertex; 3]>,
    lengths: Vec<[f64; 3]>,
    /// The side to which a side is joined, or [`ALONE`].
    twins: Vec<Twin>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Twin {
    side: u32,
    turned: bool,
}

const ALONE: Twin = Twin {
    side: u32::MAX,
    turned: false,
};

/// An edge is flipped if the cotangents opposite it add up to less than this, so that rounding does not flip it back
/// and forth.
const LEAST_SUM: f64 = -1e-9;

/// The search ends after this many flips per side; on consistent lengths it takes far fewer.
const FLIPS_PER_SIDE: usize = 64;

impl Sides {
    /// Triangles that are not joined.
    pub fn new(corners: Vec<[SurfaceVertex; 3]>, lengths: Vec<[f64; 3]>) -> Self {
        let twins = vec![ALONE; 3 * corners.len()];
        Self {
            corners,
            lengths,
            twins,
        }
    }

    pub fn face_count(&self) -> usize {
        self.corners.len()
    }

    pub fn corners(&self, face: u32) -> [SurfaceVertex; 3] {
        self.corners[face as usize]
    }

    /// Entry `i` is the side opposite corner `i`.
    pub fn lengths(&self, face: u32) -> [f64; 3] {
        self.lengths[face as usize]
    }

    /// Joins two sides on the same two different vertices.
    pub fn join(&mut self, one: u32, other: u32) {
        let turned = self.start(one) == self.start(other);
        self.twins[one as usize] = Twin { side: other, turned };
        self.twins[other as usize] = Twin { side: one, turned };
    }

    fn start(&self, side: u32) -> SurfaceVertex {
        self.corners[side as usize / 3][(side as usize + 1 - side as usize / 3 * 3) % 3]
    }

    /// The sum of the two cotangents opposite a joined edge.
    fn sum(&self, side: u32, twin: u32) -> f64 {
        let cotangent = |side: u32| cotangents(self.lengths[side as usize / 3])[side as usize % 3];
        cotangent(side) + cotangent(twin)
    }

    /// Turns a triangle over: its sides run the other way.
    fn turn(&mut self, face: usize) {
        let [a, b, c] = self.corners[face];
        self.corners[face] = [a, c, b];
        let [x, y, z] = self.lengths[face];
        self.lengths[face] = [x, z, y];
        let first = 3 * face as u32;
        let renamed = |side: u32| match side.wrapping_sub(first) {
            1 => first + 2,
            2 => first + 1,
            _ => side,
        };
        let own = [first, first + 2, first + 1].map(|side| self.twins[side as usize]);
        for (side, twin) in (first..).zip(own) {
            if twin == ALONE {
                self.twins[side as usize] = ALONE;
                continue;
            }
            // A triangle joined to itself turns both ends of the joint.
            let is_own = twin.side / 3 == face as u32;
            let turned = twin.turned ^ !is_own;
            self.twins[side as usize] = Twin {
                side: renamed(twin.side),
                turned,
            };
            if !is_own {
                self.twins[twin.side as usize] = Twin { side, turned };
            }
        }
    }

    /// Replaces the edge of two joined sides of different triangles by the other diagonal of their quadrilateral.
    /// Returns false and does nothing if the lengths do not allow it. The triangles keep their numbers.
    fn flip(&mut self, side: u32) -> bool {
        let Twin { side: mut twin, turned } = self.twins[side as usize];
        if turned {
            let (face, corner) = (twin / 3, twin % 3);
            self.turn(face as usize);
            twin = 3 * face + (3 - corner) % 3;
        }
        let (f, i) = (side as usize / 3, side as usize % 3);
        let (g, j) = (twin as usize / 3, twin as usize % 3);
        // f is (a, p, q) and g is (b, q, p), with the edge from p to q.
        let at = |face: usize, corner: usize| self.corners[face][corner % 3];
        let (a, p, q, b) = (at(f, i), at(f, i + 1), at(f, i + 2), at(g, j));
        let length = |face: usize, corner: usize| self.lengths[face][corner % 3];
        let (pq, qa, ap) = (length(f, i), length(f, i + 1), length(f, i + 2));
        let (pb, bq) = (length(g, j + 1), length(g, j + 2));
        // Laid out with p at the origin and q on the axis; the apices are on either side of it.
        let apex = |from_p: f64, from_q: f64| {
            let along = ((from_p - from_q) * (from_p + from_q) / pq + pq) / 2.0;
            (along, 2.0 * area_of_lengths([pq, from_p, from_q]) / pq)
        };
        let ((x_a, y_a), (x_b, y_b)) = (apex(ap, qa), apex(pb, bq));
        let ab = (x_a - x_b).hypot(y_a + y_b);
        let sound =
            |lengths: [f64; 3]| area_of_lengths(lengths) > 0.0 && cotangents(lengths).iter().all(|c| c.is_finite());
        if !(sound([ab, bq, qa]) && sound([ab, ap, pb])) {
            return false;
        }
        let number = |face: usize, corner: usize| (3 * face + corner % 3) as u32;
        let before = [number(g, j + 2), number(f, i + 1), number(f, i + 2), number(g, j + 1)];
        let after = [number(f, 1), number(f, 2), number(g, 1), number(g, 2)];
        let twins = before.map(|side| self.twins[side as usize]);
        for (&now, twin) in after.iter().zip(twins) {
            let side = match before.iter().position(|&side| side == twin.side) {
                Some(place) => after[place],
                None => twin.side,
            };
            self.twins[now as usize] = Twin { side, ..twin };
            if twin != ALONE {
                self.twins[side as usize] = Twin { side: now, ..twin };
            }
        }
        self.corners[f] = [q, a, b];
        self.lengths[f] = [ab, bq, qa];
        self.corners[g] = [p, b, a];
        self.lengths[g] = [ab, ap, pb];
        let joined = |side: u32| Twin { side, turned: false };
        self.twins[3 * f] = joined(3 * g as u32);
        self.twins[3 * g] = joined(3 * f as u32);
        true
    }
}

/// Flips edges until the cotangents opposite every joined edge add up to at least 0. Returns false if some edges could
/// not be flipped.
pub(crate) fn flip_to_delaunay(sides: &mut Sides) -> bool {
    let count = sides.twins.len();
    let mut stack: Vec<u32> = (0..count as u32).rev().collect();
    let mut waits = vec![true; count];
    let (mut flips, mut is_delaunay) = (0, true);
    while let Some(side) = stack.pop() {
        waits[side as usize] = false;
        let twin = sides.twins[side as usize];
        if twin == ALONE || twin.side / 3 == side / 3 || sides.sum(side, twin.side) >= LEAST_SUM {
            continue;
        }
        if flips >= FLIPS_PER_SIDE * count || !sides.flip(side) {
            is_delaunay = false;
            continue;
        }
        flips += 1;
        for face in [side / 3, twin.side / 3] {
            for side in 3 * face..3 * face + 3 {
                if !std::mem::replace(&mut waits[side as usize], true) {
                    stack.push(side);
                }
            }
        }
    }
    is_delaunay
}

#[cfg(test)]
mod tests {
    use super::{ALONE, Sides, flip_to_delaunay};
    use pliant_mesh::{SurfaceVertex, area_of_lengths};

    fn area(sides: &Sides) -> f64 {
        (0..sides.face_count() as u32)
            .map(|face| area_of_lengths(sides.lengths(face)))
            .sum()
    }

    fn is_consistent(sides: &Sides) {
        for side in 0..sides.twins.len() as u32 {
            let twin = sides.twins[side as usize];
            if twin == ALONE {
                continue;
            }
            assert_eq!(
                (
                    sides.twins[twin.side as usize].side,
                    sides.twins[twin.side as usize].turned
                ),
                (side, twin.turned)
            );
            let end = |side: u32| sides.corners(side / 3)[(side as usize % 3 + 2) % 3];
            let ends = if twin.turned {
                (sides.start(twin.side), end(twin.side))
            } else {
                (end(twin.side), sides.start(twin.side))
            };
            assert_eq!((sides.start(side), end(side)), ends);
            let length = |side: u32| sides.lengths(side / 3)[side as usize % 3];
            assert!((length(side) - length(twin.side)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_long_diagonal_is_flipped_whichever_way_its_triangles_run() {
        // A rhombus of points (0, ±1) and (±3, 0) with the long diagonal.
        let root = 10.0_f64.sqrt();
        for turned in [false, true] {
            let [left, right, low, high] = [0, 1, 2, 3].map(SurfaceVertex);
            let other = if turned {
                [high, left, right]
            } else {
                [high, right, left]
            };
            let mut sides = Sides::new(vec![[low, left, right], other], vec![[6.0, root, root]; 2]);
            sides.join(0, 3);
            is_consistent(&sides);
            assert!(flip_to_delaunay(&mut sides));
            is_consistent(&sides);
            for face in 0..2 {
                let corners = sides.corners(face);
                assert!(corners.contains(&low) && corners.contains(&high), "{corners:?}");
                assert!((sides.lengths(face)[0] - 2.0).abs() < 1e-12);
            }
            assert!((area(&sides) - 6.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_tetrahedron_of_two_needles_keeps_its_area_and_its_joints() {
        // Two thin triangles front and back, glued all around: flips meet the same triangle from several sides.
        let [a, b, c] = [0, 1, 2].map(SurfaceVertex);
        for lengths in [[1.0, 1.0, 1.9], [1.0, 1.0, 0.01], [3.0, 4.0, 5.0]] {
            let turned = [lengths[0], lengths[2], lengths[1]];
            let mut sides = Sides::new(vec![[a, b, c], [a, c, b]], vec![lengths, turned]);
            sides.join(0, 3);
            sides.join(1, 5);
            sides.join(2, 4);
            let before = area(&sides);
            is_consistent(&sides);
            assert!(flip_to_delaunay(&mut sides));
            is_consistent(&sides);
            assert!((area(&sides) - before).abs() < 1e-9 * before, "{lengths:?}");
        }
    }
}
