//! Points with normals in a k-d tree: the nearest ones on the same side of a sheet.
//!
//! A point's distance from a query is d² + t² (1 − n·m), with d the distance of their places, n and m their unit normals,
//! and t a length: a palm that is near a hip, but faces it, is farther from it than the hip's own surroundings. Points
//! whose normal is at a right angle or more are not found at all, so that the two sides of a thin sheet stay apart. A
//! normal of 0 agrees with every other.

use glam::DVec3;

/// Ranges of this many points are searched one by one.
const LEAF: usize = 8;

/// Points with normals, which never change.
#[derive(Clone, Debug)]
pub struct OrientedPoints {
    /// In the order of the tree: the middle of a range divides it across `axis`.
    points: Vec<Oriented>,
    turn: f64,
}

#[derive(Clone, Copy, Debug)]
struct Oriented {
    position: DVec3,
    normal: DVec3,
    number: u32,
    axis: u8,
}

/// A point that was found.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct NearPoint {
    /// Its distance as this module defines it, squared.
    cost: f64,
    /// Its number among the points.
    pub number: u32,
    /// The distance of its place from the query's.
    pub distance: f64,
}

impl OrientedPoints {
    /// The points with these positions and unit normals, as many of each. `turn` is the length t by which a right angle
    /// between two normals separates them, in the positions' unit.
    pub fn new(positions: &[DVec3], normals: &[DVec3], turn: f64) -> Self {
        let each = positions.iter().zip(normals).zip(0..);
        let mut points: Vec<Oriented> = each
            .map(|((&position, &normal), number)| Oriented {
                position,
                normal,
                number,
                axis: 0,
            })
            .collect();
        divide(&mut points);
        Self { points, turn }
    }

    /// The nearest `count` points whose places are within `limit`, the nearest first and of equal ones the lowest, into
    /// `found`.
    pub fn nearest(&self, position: DVec3, normal: DVec3, limit: f64, count: usize, found: &mut Vec<NearPoint>) {
        found.clear();
        let mut search = Search {
            position,
            normal,
            turn_squared: self.turn * self.turn,
            limit_squared: limit * limit,
            count,
            found,
        };
        if count > 0 {
            search.among(&self.points);
        }
    }
}

/// Puts the middle of a range, along the axis on which it is longest, in its middle, and so on in both halves.
fn divide(points: &mut [Oriented]) {
    if points.len() <= LEAF {
        return;
    }
    let least = points.iter().fold(DVec3::INFINITY, |least, p| least.min(p.position));
    let most = points.iter().fold(DVec3::NEG_INFINITY, |most, p| most.max(p.position));
    let axis = (most - least).max_position();
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| {
        let along = a.position[axis].total_cmp(&b.position[axis]);
        along.then(a.number.cmp(&b.number))
    });
    points[middle].axis = axis as u8;
    let (below, above) = points.split_at_mut(middle);
    divide(below);
    divide(&mut above[1..]);
}

struct Search<'a> {
    position: DVec3,
    normal: DVec3,
    turn_squared: f64,
    limit_squared: f64,
    count: usize,
    /// The nearest so far, the nearest first.
    found: &'a mut Vec<NearPoint>,
}

impl Search<'_> {
    fn among(&mut self, points: &[Oriented]) {
        if points.len() <= LEAF {
            points.iter().for_each(|point| self.visit(point));
            return;
        }
        let middle = points.len() / 2;
        let axis = usize::from(points[middle].axis);
        let beyond = self.position[axis] - points[middle].position[axis];
        let (below, above) = (&points[..middle], &points[middle + 1..]);
        let (near, far) = if beyond < 0.0 { (below, above) } else { (above, below) };
        self.among(near);
        self.visit(&points[middle]);
        if beyond * beyond <= self.farthest() {
            self.among(far);
        }
    }

    /// No point with a larger squared distance is of use.
    fn farthest(&self) -> f64 {
        match self.found.last() {
            Some(last) if self.found.len() == self.count => last.cost.min(self.limit_squared),
            _ => self.limit_squared,
        }
    }

    fn visit(&mut self, point: &Oriented) {
        let squared = point.position.distance_squared(self.position);
        let are_known = point.normal != DVec3::ZERO && self.normal != DVec3::ZERO;
        let agreement = if are_known { point.normal.dot(self.normal) } else { 1.0 };
        // Written so that NaN fails.
        if !(squared <= self.limit_squared && agreement > 0.0) {
            return;
        }
        let near = NearPoint {
            cost: squared + self.turn_squared * (1.0 - agreement),
            number: point.number,
            distance: squared.sqrt(),
        };
        let is_nearer = |other: &NearPoint| (other.cost, other.number) < (near.cost, near.number);
        let place = self.found.partition_point(is_nearer);
        if place < self.count {
            self.found.truncate(self.count - 1);
            self.found.insert(place, near);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between 0 and 1 that look random.
    fn scattered(count: usize) -> Vec<DVec3> {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1 << 24) as f64
        };
        (0..count).map(|_| DVec3::new(next(), next(), next())).collect()
    }

    #[test]
    fn the_tree_finds_what_a_search_through_all_points_finds() {
        let positions = scattered(600);
        let normals: Vec<DVec3> = positions.iter().rev().map(|p| (*p - 0.5).normalize()).collect();
        let turn = 0.3;
        let tree = OrientedPoints::new(&positions, &normals, turn);
        let mut found = Vec::new();
        for (query, normal) in scattered(50).into_iter().zip(&normals) {
            for limit in [0.2, 5.0] {
                let mut all: Vec<(f64, u32)> = (0..)
                    .zip(positions.iter().zip(&normals))
                    .filter(|(_, (p, n))| p.distance(query) <= limit && n.dot(*normal) > 0.0)
                    .map(|(number, (p, n))| (p.distance_squared(query) + turn * turn * (1.0 - n.dot(*normal)), number))
                    .collect();
                all.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
                tree.nearest(query, *normal, limit, 5, &mut found);
                let numbers: Vec<u32> = found.iter().map(|near| near.number).collect();
                let expected: Vec<u32> = all.iter().take(5).map(|(_, number)| *number).collect();
                assert_eq!(numbers, expected);
            }
        }
    }

    #[test]
    fn the_other_side_of_a_sheet_is_not_found() {
        let positions = [DVec3::ZERO, DVec3::X];
        let tree = OrientedPoints::new(&positions, &[DVec3::Z, -DVec3::Z], 0.1);
        let mut found = Vec::new();
        tree.nearest(DVec3::X, DVec3::Z, 5.0, 3, &mut found);
        assert_eq!(found.iter().map(|near| near.number).collect::<Vec<_>>(), [0]);
        tree.nearest(DVec3::X, DVec3::ZERO, 5.0, 3, &mut found);
        assert_eq!(found.iter().map(|near| near.number).collect::<Vec<_>>(), [1, 0]);
    }
}
