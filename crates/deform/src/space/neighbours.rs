//! The nearest few of some points.

use glam::DVec3;

/// Points in a balanced k-d tree: in each range the middle one splits the others along the axis in which they extend
/// most.
#[derive(Debug)]
pub(crate) struct Neighbours {
    /// Numbers of points, in the tree's order.
    order: Vec<u32>,
    points: Vec<DVec3>,
    /// Of each place in the order: the axis along which it splits.
    axes: Vec<u8>,
}

/// Ranges of so few points are not split.
const LEAF: usize = 8;

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

    /// The nearest `count` points with their distances, nearest first, of equally near ones the lowest number; fewer if
    /// there are not so many.
    pub fn nearest(&self, to: DVec3, count: usize) -> Vec<(u32, f64)> {
        let mut found = Vec::with_capacity(count + 1);
        if count > 0 {
            self.search(to, count, 0, self.order.len(), &mut found);
        }
        found
            .into_iter()
            .map(|(square, number): (f64, u32)| (number, square.sqrt()))
            .collect()
    }

    fn search(&self, to: DVec3, count: usize, start: usize, end: usize, found: &mut Vec<(f64, u32)>) {
        let mut offer = |place: usize| {
            let candidate = (self.points[place].distance_squared(to), self.order[place]);
            let at = found.partition_point(|other| *other < candidate);
            if at < count {
                found.insert(at, candidate);
                found.truncate(count);
            }
        };
        if end - start <= LEAF {
            (start..end).for_each(offer);
            return;
        }
        let middle = usize::midpoint(start, end);
        offer(middle);
        let axis = usize::from(self.axes[middle]);
        let beyond = to[axis] - self.points[middle][axis];
        let (near, far) = if beyond < 0.0 {
            ((start, middle), (middle + 1, end))
        } else {
            ((middle + 1, end), (start, middle))
        };
        self.search(to, count, near.0, near.1, found);
        let reach = found.get(count - 1).map_or(f64::INFINITY, |(square, _)| *square);
        if beyond * beyond <= reach {
            self.search(to, count, far.0, far.1, found);
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
    split(points, &mut order[..middle], &mut axes[..middle]);
    split(points, &mut order[middle + 1..], &mut axes[middle + 1..]);
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
            }
        }
        assert!(Neighbours::of(&[]).nearest(DVec3::ZERO, 3).is_empty());
    }
}
