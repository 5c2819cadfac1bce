//! The nearest few of some points.

use std::ops::Range;

use glam::DVec3;

/// Points in a balanced k-d tree: in each range the middle one splits the others along the axis of their largest
/// extent.
#[derive(Debug)]
pub(crate) struct Neighbours {
    /// Numbers of points, in the tree's order.
    order: Vec<u32>,
    points: Vec<DVec3>,
    /// The axis along which each place in the order splits.
    axes: Vec<u8>,
}

/// Ranges of this many points or fewer are not split.
const LEAF: usize = 8;

/// Ranges of more points are split in parallel.
const LARGE: usize = 1 << 12;

impl Neighbours {
    pub fn of(points: &[DVec3]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut axes = vec![0; points.len()];
        split(points, &mut order, &mut axes);
        Self {
            points: order.iter().map(|&number| points[number as usize]).collect(),
            order,
            axes,
        }
    }

    /// The nearest `count` points with their distances, nearest first, and by number among equally near ones; all if
    /// there are fewer.
    pub fn nearest(&self, to: DVec3, count: usize) -> Vec<(u32, f64)> {
        self.nearest_within(to, count, f64::INFINITY)
    }

    /// The same for points that are at most `limit` away.
    pub fn nearest_within(&self, to: DVec3, count: usize, limit: f64) -> Vec<(u32, f64)> {
        if count == 0 {
            return Vec::new();
        }
        let mut search = Search {
            tree: self,
            to,
            count,
            limit_square: limit * limit,
            found: Vec::with_capacity(count.min(self.order.len()) + 1),
        };
        search.range(0..self.order.len(), DVec3::ZERO);
        let found = search.found.into_iter();
        found.map(|(square, number)| (number, square.sqrt())).collect()
    }
}

/// One search through the tree.
struct Search<'a> {
    tree: &'a Neighbours,
    to: DVec3,
    count: usize,
    limit_square: f64,
    /// The results, with the squared distances.
    found: Vec<(f64, u32)>,
}

impl Search<'_> {
    /// Searches a range whose box is at least `away` from the point, axis by axis [AM93].
    fn range(&mut self, range: Range<usize>, away: DVec3) {
        if range.len() <= LEAF {
            range.for_each(|place| self.offer(place));
            return;
        }
        let middle = usize::midpoint(range.start, range.end);
        self.offer(middle);
        let axis = usize::from(self.tree.axes[middle]);
        let beyond = self.to[axis] - self.tree.points[middle][axis];
        let (below, above) = (range.start..middle, middle + 1..range.end);
        let (near, far) = if beyond < 0.0 { (below, above) } else { (above, below) };
        self.range(near, away);
        let mut away = away;
        away[axis] = beyond;
        if away.length_squared() <= self.reach_square() {
            self.range(far, away);
        }
    }

    /// The squared distance beyond which the search ends.
    fn reach_square(&self) -> f64 {
        let farthest = self.found.get(self.count - 1);
        farthest.map_or(self.limit_square, |(square, _)| *square)
    }

    fn offer(&mut self, place: usize) {
        let candidate = (
            self.tree.points[place].distance_squared(self.to),
            self.tree.order[place],
        );
        if candidate.0 > self.limit_square {
            return;
        }
        let at = self.found.partition_point(|other| *other < candidate);
        if at < self.count {
            self.found.insert(at, candidate);
            self.found.truncate(self.count);
        }
    }
}

fn split(points: &[DVec3], order: &mut [u32], axes: &mut [u8]) {
    if order.len() <= LEAF {
        return;
    }
    let (low, high) = order
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &number| {
            let point = points[number as usize];
            (low.min(point), high.max(point))
        });
    let axis = (high - low).max_position();
    let middle = order.len() / 2;
    let by_axis = |a: &u32, b: &u32| {
        let along = |number: u32| points[number as usize][axis];
        along(*a).total_cmp(&along(*b)).then(a.cmp(b))
    };
    order.select_nth_unstable_by(middle, by_axis);
    axes[middle] = axis as u8;
    let (before, rest) = order.split_at_mut(middle);
    let (axes_before, axes_rest) = axes.split_at_mut(middle);
    if middle > LARGE {
        rayon::join(
            || split(points, before, axes_before),
            || split(points, &mut rest[1..], &mut axes_rest[1..]),
        );
    } else {
        split(points, before, axes_before);
        split(points, &mut rest[1..], &mut axes_rest[1..]);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::Neighbours;

    #[test]
    fn they_are_those_of_a_plain_search() {
        let noise = |k: f64, i: u32| (f64::from(i) * k).sin();
        // Some of them coincide.
        let points: Vec<DVec3> = (0..700)
            .map(|i| DVec3::new(noise(1.3, i % 600), noise(2.1, i % 600), noise(7.9, i % 600)))
            .collect();
        let tree = Neighbours::of(&points);
        for i in 0..50 {
            let to = DVec3::new(noise(0.7, i), noise(3.1, i), 0.3);
            for count in [0, 1, 5, 1000] {
                let mut expected: Vec<(f64, u32)> =
                    (0..).zip(&points).map(|(n, p)| (p.distance_squared(to), n)).collect();
                expected.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                expected.truncate(count);
                let expected: Vec<(u32, f64)> = expected.into_iter().map(|(square, n)| (n, square.sqrt())).collect();
                assert_eq!(tree.nearest(to, count), expected);
                let limit = 0.4;
                let near = expected.into_iter().filter(|(_, distance)| *distance <= limit);
                assert_eq!(tree.nearest_within(to, count, limit), near.collect::<Vec<_>>());
            }
        }
        assert!(Neighbours::of(&[]).nearest(DVec3::ZERO, 3).is_empty());
    }
}
