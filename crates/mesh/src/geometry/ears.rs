//! Triangles of a polygon in the plane, by cutting off ears [Mei75].

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

/// The cut where a polygon has no ear, because it crosses itself or its corners are too near to each other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WithoutEar {
    /// The corner that turns most is cut off, so that every polygon gives its number of triangles.
    CutSharpest,
    /// There are no triangles.
    GiveUp,
}

/// The triangles of a simple counterclockwise polygon, as numbers of its corners: two fewer than it has corners, and none
/// if it has fewer than three. Its corners may be on lines, and a hole may be joined to its outline by an edge there and
/// back.
///
/// The ear with the shortest cut goes first, as `length` measures between two corners: this keeps slivers away. A triangle whose doubled area is at most `flat` has no sure direction and is no ear. `None` if there is no ear
/// and `without_ear` gives up.
///
/// Only a corner that does not turn left can be in the triangle of another, so a convex polygon of n corners takes
/// n log n steps, and another one n times the number of those corners.
///
/// ```
/// use glam::DVec2;
/// use pliant_mesh::geometry::{WithoutEar, ears};
///
/// let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
/// let length = |a: usize, b: usize| square[a].distance(square[b]);
/// let triangles = ears(&square, 0.0, length, WithoutEar::GiveUp);
/// assert_eq!(triangles, Some(vec![[3, 0, 1], [1, 2, 3]]));
/// ```
pub fn ears(
    corners: &[DVec2],
    flat: f64,
    length: impl Fn(usize, usize) -> f64,
    without_ear: WithoutEar,
) -> Option<Vec<[usize; 3]>> {
    if corners.len() < 3 {
        return Some(Vec::new());
    }
    let mut triangles = Vec::with_capacity(corners.len() - 2);
    let mut ring = Ring::of(corners, flat, length);
    // A corner whose neighbours have changed is in the queue again, with another version.
    let mut queue = BinaryHeap::new();
    queue.extend(ring.all_ears());
    while ring.left > 3 {
        let cut = match ring.next(&mut queue) {
            Some(ear) => ear,
            None => {
                // A corner in another one's triangle may be gone by now.
                queue.extend(ring.all_ears());
                match (ring.next(&mut queue), without_ear) {
                    (Some(ear), _) => ear,
                    (None, WithoutEar::CutSharpest) => ring.sharpest(),
                    (None, WithoutEar::GiveUp) => return None,
                }
            }
        };
        triangles.push(ring.around(cut));
        // Only the two neighbours of a cut corner have new triangles.
        for neighbour in ring.remove(cut) {
            queue.extend(ring.ear(neighbour).map(Reverse));
        }
    }
    let first = ring.first();
    if without_ear == WithoutEar::GiveUp && !ring.turns_left(first) {
        return None;
    }
    let [last, _, second] = ring.around(first);
    triangles.push([first, second, last]);
    Some(triangles)
}

/// A corner that can be cut off, ordered by the length of the cut and then by its number.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Ear {
    /// The bits of a number that is not negative, which sort like the number.
    cut_length: u64,
    corner: usize,
    version: u32,
}

/// The corners that are not yet cut off.
struct Ring<'a, L> {
    corners: &'a [DVec2],
    flat: f64,
    length: L,
    before: Vec<usize>,
    behind: Vec<usize>,
    /// The number of changes of a corner's neighbours; the largest number once the corner is cut off.
    version: Vec<u32>,
    /// The corners that don't turn left; some of them may do so by now.
    reflex: Vec<usize>,
    left: usize,
}

const CUT_OFF: u32 = u32::MAX;

impl<'a, L: Fn(usize, usize) -> f64> Ring<'a, L> {
    fn of(corners: &'a [DVec2], flat: f64, length: L) -> Self {
        let count = corners.len();
        let mut ring = Self {
            corners,
            flat,
            length,
            before: (0..count).map(|corner| (corner + count - 1) % count).collect(),
            behind: (0..count).map(|corner| (corner + 1) % count).collect(),
            version: vec![0; count],
            reflex: Vec::new(),
            left: count,
        };
        ring.reflex = (0..count).filter(|&corner| !ring.turns_left(corner)).collect();
        ring
    }

    /// The corner between its neighbours.
    fn around(&self, corner: usize) -> [usize; 3] {
        [self.before[corner], corner, self.behind[corner]]
    }

    fn turn_at(&self, corner: usize) -> f64 {
        let [a, b, c] = self.around(corner).map(|corner| self.corners[corner]);
        turn(a, b, c)
    }

    fn turns_left(&self, corner: usize) -> bool {
        self.turn_at(corner) > self.flat
    }

    fn is_there(&self, corner: usize) -> bool {
        self.version[corner] != CUT_OFF
    }

    /// The corners that are left, ascending.
    fn all(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.corners.len()).filter(|&corner| self.is_there(corner))
    }

    fn all_ears(&self) -> impl Iterator<Item = Reverse<Ear>> + '_ {
        self.all().filter_map(|corner| self.ear(corner)).map(Reverse)
    }

    /// The lowest corner that is left.
    fn first(&self) -> usize {
        self.all().next().unwrap_or(0)
    }

    /// The ear with the shortest cut, out of a queue that also has former ones.
    fn next(&self, queue: &mut BinaryHeap<Reverse<Ear>>) -> Option<usize> {
        let mut ears = std::iter::from_fn(|| queue.pop());
        let is_present = |Reverse(ear): &Reverse<Ear>| self.version[ear.corner] == ear.version;
        ears.find(is_present).map(|Reverse(ear)| ear.corner)
    }

    /// Cuts a corner off and gives its neighbours.
    fn remove(&mut self, corner: usize) -> [usize; 2] {
        let [a, _, c] = self.around(corner);
        self.behind[a] = c;
        self.before[c] = a;
        self.version[corner] = CUT_OFF;
        self.version[a] += 1;
        self.version[c] += 1;
        self.left -= 1;
        // A corner that turns left goes on doing so, except in a polygon that crosses itself.
        let mut reflex = std::mem::take(&mut self.reflex);
        reflex.retain(|&corner| self.is_there(corner) && !self.turns_left(corner));
        for neighbour in [a, c] {
            if !self.turns_left(neighbour) && !reflex.contains(&neighbour) {
                reflex.push(neighbour);
            }
        }
        self.reflex = reflex;
        [a, c]
    }

    /// The corner as an ear, if it can be cut off: it turns left and no other corner is in its triangle.
    fn ear(&self, corner: usize) -> Option<Ear> {
        let around = self.around(corner);
        let [a, b, c] = around.map(|corner| self.corners[corner]);
        let holds = |p: DVec2| {
            [turn(a, b, p), turn(b, c, p), turn(c, a, p)]
                .iter()
                .all(|side| *side >= -self.flat)
        };
        let blocks = |p: DVec2| p != a && p != b && p != c && holds(p);
        let is_ear = self.turns_left(corner) && !self.reflex.iter().any(|&other| blocks(self.corners[other]));
        is_ear.then(|| Ear {
            cut_length: (self.length)(around[0], around[2]).to_bits(),
            corner,
            version: self.version[corner],
        })
    }

    /// The corner that turns most; the last of equal ones.
    fn sharpest(&self) -> usize {
        let turns = |&a: &usize, &b: &usize| self.turn_at(a).total_cmp(&self.turn_at(b));
        self.all().max_by(turns).unwrap_or(0)
    }
}

/// Twice the signed area of a triangle, positive if it turns left.
pub fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    fn cut(corners: &[DVec2], without_ear: WithoutEar) -> Option<Vec<[usize; 3]>> {
        ears(corners, 1e-15, |a, b| corners[a].distance(corners[b]), without_ear)
    }

    fn area(corners: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
        let of = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|corner| corners[corner]);
            0.5 * turn(a, b, c)
        };
        assert!(triangles.iter().all(|triangle| of(triangle) > 0.0));
        triangles.iter().map(of).sum()
    }

    #[test]
    fn a_hole_that_is_joined_to_its_outline_stays_open() {
        let outline = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.]];
        let hole = [[1., 1.], [1., 2.], [2., 2.], [2., 1.], [1., 1.]];
        let corners: Vec<DVec2> = outline
            .iter()
            .chain(&hole)
            .map(|place| DVec2::from_array(*place))
            .collect();
        let triangles = cut(&corners, WithoutEar::GiveUp).unwrap();
        assert_eq!(triangles.len(), corners.len() - 2);
        assert!((area(&corners, &triangles) - 15.0).abs() < 1e-12);
    }

    #[test]
    fn corners_on_lines_are_cut_without_flat_triangles() {
        let corners: Vec<DVec2> = (0..20)
            .map(|k| match k / 5 {
                0 => DVec2::new(f64::from(k), 0.0),
                1 => DVec2::new(5.0, f64::from(k - 5)),
                2 => DVec2::new(5.0 - f64::from(k - 10), 5.0),
                _ => DVec2::new(0.0, 5.0 - f64::from(k - 15)),
            })
            .collect();
        let triangles = cut(&corners, WithoutEar::GiveUp).unwrap();
        assert!(triangles.len() == 18 && (area(&corners, &triangles) - 25.0).abs() < 1e-12);
    }

    #[test]
    fn a_polygon_without_ears_gives_nothing_or_all_of_its_triangles() {
        let points = [[0., 0.], [0., 2.], [1., 1.], [2., 2.], [2., 0.]].map(DVec2::from_array);
        assert_eq!(cut(&points, WithoutEar::GiveUp), None);
        assert_eq!(cut(&points, WithoutEar::CutSharpest).unwrap().len(), 3);
        assert_eq!(cut(&points[..2], WithoutEar::GiveUp), Some(Vec::new()));
        let in_one_place = [DVec2::ONE; 6];
        assert_eq!(cut(&in_one_place, WithoutEar::GiveUp), None);
        assert_eq!(cut(&in_one_place, WithoutEar::CutSharpest).unwrap().len(), 4);
    }
}
