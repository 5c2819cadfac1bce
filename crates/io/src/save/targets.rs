//! Few shapes whose sums reproduce many: the morph targets of an animation.
//!
//! The shapes come one after the other and are not kept. Each is projected onto an orthonormal basis of those before it;
//! if some vertex is off by more than half of the bound, the rest of the shape becomes one more direction (Gram–Schmidt
//! with the largest error as its measure, the greedy choice of reduced bases). A turn of a handle by a linear method
//! takes a handful of directions, however many frames it has: its matrices span no more.
//!
//! In the end the directions are turned so that the shapes' coordinates in them are uncorrelated (the singular value
//! decomposition of the coordinates), and those are left out whose loss keeps within the bound.

use glam::DVec3;
use rayon::prelude::*;

/// The number of vertices whose products are summed by one task: the sum does not depend on the threads.
const CHUNK: usize = 1 << 12;

/// The share of the bound that a projection may take.
const OF_PROJECTION: f64 = 0.5;

/// The directions that shapes need, found while they come one after the other, and the coordinates of each shape.
///
/// ```
/// use glam::DVec3;
/// use pliant_io::ShapeDirections;
///
/// // Two vertices on straight ways: one target, however many shapes.
/// let mut directions = ShapeDirections::within(1e-6);
/// for step in 0..10 {
///     directions.push(&[DVec3::X * f64::from(step), DVec3::ZERO]);
/// }
/// let found = directions.targets();
/// assert_eq!((found.targets.len(), found.weights.len()), (1, 10));
/// assert!((found.targets[0][0] * found.weights[3][0]).distance(DVec3::X * 3.0) < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct ShapeDirections {
    /// The largest distance of a vertex from its place, in world units.
    bound: f64,
    /// They have length 1 over all vertices, and they are at right angles to each other.
    directions: Vec<Vec<DVec3>>,
    shapes: Vec<Shape>,
}

#[derive(Clone, Debug)]
struct Shape {
    /// Its coordinates in the directions that were known then; 0 in later ones.
    coordinates: Vec<f64>,
    /// The largest distance of a vertex from its place.
    error: f64,
}

/// Few targets whose sums are many shapes.
#[derive(Clone, PartialEq, Debug)]
pub struct FewTargets {
    /// For each target the displacement of each vertex.
    pub targets: Vec<Vec<DVec3>>,
    /// For each shape the targets' weights, from -1 to 1. As columns of a matrix they are orthogonal, and none is zero.
    pub weights: Vec<Vec<f64>>,
    /// The largest distance of a vertex from its place, in world units.
    pub error: f64,
}

impl ShapeDirections {
    /// None yet. `bound` is in world units.
    pub fn within(bound: f64) -> Self {
        Self {
            bound,
            directions: Vec::new(),
            shapes: Vec::new(),
        }
    }

    /// Takes the next shape: the displacement of each vertex.
    pub fn push(&mut self, shape: &[DVec3]) {
        let mut rest = shape.to_vec();
        let mut coordinates = vec![0.0; self.directions.len()];
        // The second pass takes off what rounding has left of the first.
        for _ in 0..2 {
            for (direction, coordinate) in self.directions.iter().zip(&mut coordinates) {
                let share = product(direction, &rest);
                add(&mut rest, direction, -share);
                *coordinate += share;
            }
        }
        let mut error = largest(&rest);
        if error > OF_PROJECTION * self.bound {
            let length = product(&rest, &rest).sqrt();
            rest.par_iter_mut().for_each(|way| *way /= length);
            self.directions.push(rest);
            coordinates.push(length);
            error = 0.0;
        }
        self.shapes.push(Shape { coordinates, error });
    }

    /// The fewest targets within the bound among those of the decomposition.
    pub fn targets(self) -> FewTargets {
        let count = self.directions.len();
        let padded = |shape: &Shape| {
            let known = shape.coordinates.iter().copied();
            known.chain(std::iter::repeat(0.0)).take(count).collect::<Vec<f64>>()
        };
        let mut weights: Vec<Vec<f64>> = self.shapes.iter().map(padded).collect();
        let turn = decorrelate(&mut weights, count);
        let mut targets: Vec<Vec<DVec3>> = turn
            .iter()
            .map(|shares| {
                let mut target = vec![DVec3::ZERO; self.directions.first().map_or(0, Vec::len)];
                let parts = self.directions.iter().zip(shares);
                parts.for_each(|(direction, share)| add(&mut target, direction, *share));
                target
            })
            .collect();
        let error = |kept: usize| {
            let of_shapes = self.shapes.iter().zip(&weights);
            let of_shapes = of_shapes.map(|(shape, weights)| shape.error + lost(&targets[kept..], &weights[kept..]));
            of_shapes.fold(0.0, f64::max)
        };
        // Each further target lessens the error of the squares, so the largest one nearly always.
        let (mut low, mut kept) = (0, count);
        while low < kept {
            let middle = (low + kept) / 2;
            match error(middle) <= self.bound {
                true => kept = middle,
                false => low = middle + 1,
            }
        }
        let error = error(kept);
        targets.truncate(kept);
        weights.iter_mut().for_each(|row| row.truncate(kept));
        scale(&mut targets, &mut weights);
        FewTargets {
            targets,
            weights,
            error,
        }
    }
}

/// Gives each target the length at which its largest weight is 1 or -1.
fn scale(targets: &mut [Vec<DVec3>], weights: &mut [Vec<f64>]) {
    for (number, target) in targets.iter_mut().enumerate() {
        let most = weights.iter().fold(0.0, |most: f64, row| most.max(row[number].abs()));
        target.par_iter_mut().for_each(|way| *way *= most);
        weights.iter_mut().for_each(|row| row[number] /= most);
    }
}

/// Turns coordinates, one row for each shape, until their columns are orthogonal, by plane rotations of two columns
/// (one-sided Jacobi), and sorts the columns by falling length. Returns the rotation: for each new column its shares of
/// the old ones.
fn decorrelate(rows: &mut [Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    /// The most sweeps over all pairs of columns; a few are enough.
    const MOST_SWEEPS: usize = 60;
    /// The cosine below which two columns are orthogonal.
    const ORTHOGONAL: f64 = 1e-14;
    let mut turn: Vec<Vec<f64>> = (0..count)
        .map(|own| (0..count).map(|other| f64::from(u8::from(own == other))).collect())
        .collect();
    for _ in 0..MOST_SWEEPS {
        let mut is_done = true;
        for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
            let sum = |of: &dyn Fn(&Vec<f64>) -> f64| rows.iter().map(of).sum::<f64>();
            let [aa, bb, ab] = [
                sum(&|row| row[a] * row[a]),
                sum(&|row| row[b] * row[b]),
                sum(&|row| row[a] * row[b]),
            ];
            if ab.abs() <= ORTHOGONAL * (aa * bb).sqrt() {
                continue;
            }
            is_done = false;
            let ratio = (bb - aa) / (2.0 * ab);
            let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
            let cosine = tangent.hypot(1.0).recip();
            let sine = cosine * tangent;
            let rotated = |x: f64, y: f64| (cosine * x - sine * y, sine * x + cosine * y);
            for row in rows.iter_mut() {
                (row[a], row[b]) = rotated(row[a], row[b]);
            }
            let (head, tail) = turn.split_at_mut(b);
            for (x, y) in head[a].iter_mut().zip(&mut tail[0]) {
                (*x, *y) = rotated(*x, *y);
            }
        }
        if is_done {
            break;
        }
    }
    let length = |column: usize| rows.iter().map(|row| row[column] * row[column]).sum::<f64>();
    let lengths: Vec<f64> = (0..count).map(length).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| lengths[*b].total_cmp(&lengths[*a]).then(a.cmp(b)));
    for row in rows.iter_mut() {
        *row = order.iter().map(|&column| row[column]).collect();
    }
    order.iter().map(|&column| turn[column].clone()).collect()
}

/// The largest displacement by targets with weights.
fn lost(targets: &[Vec<DVec3>], weights: &[f64]) -> f64 {
    let count = targets.first().map_or(0, Vec::len);
    let chunks = (0..count.div_ceil(CHUNK)).into_par_iter();
    let of_chunk = |chunk: usize| {
        let vertices = chunk * CHUNK..count.min((chunk + 1) * CHUNK);
        let mut sums = vec![DVec3::ZERO; vertices.len()];
        for (target, &weight) in targets.iter().zip(weights) {
            let ways = sums.iter_mut().zip(&target[vertices.clone()]);
            ways.for_each(|(sum, way)| *sum += *way * weight);
        }
        sums.iter().map(|way| way.length()).fold(0.0, f64::max)
    };
    chunks.map(of_chunk).reduce(|| 0.0, f64::max)
}

fn largest(ways: &[DVec3]) -> f64 {
    ways.par_iter()
        .with_min_len(CHUNK)
        .map(|way| way.length())
        .reduce(|| 0.0, f64::max)
}

fn add(to: &mut [DVec3], ways: &[DVec3], share: f64) {
    let pairs = to.par_iter_mut().with_min_len(CHUNK).zip(ways);
    pairs.for_each(|(to, way)| *to += *way * share);
}

fn product(a: &[DVec3], b: &[DVec3]) -> f64 {
    let chunks = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    let sums: Vec<f64> = chunks
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>())
        .collect();
    sums.into_iter().sum()
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    /// Points of a helix that turn, and more the further up they are.
    fn shapes(twist: f64, count: usize) -> Vec<Vec<DVec3>> {
        let point = |k: usize| {
            let along = k as f64 / 99.0;
            DVec3::new((9.0 * along).cos(), (9.0 * along).sin(), 2.0 * along)
        };
        let shape = |frame: usize| {
            let turn = 2.0 * frame as f64 / (count - 1) as f64;
            let moved = |k: usize| {
                let rest = point(k);
                DQuat::from_rotation_x(turn * (1.0 + twist * rest.z)) * rest - rest
            };
            (0..100).map(moved).collect()
        };
        (0..count).map(shape).collect()
    }

    fn of(shapes: &[Vec<DVec3>], bound: f64) -> FewTargets {
        let mut directions = ShapeDirections::within(bound);
        shapes.iter().for_each(|shape| directions.push(shape));
        directions.targets()
    }

    #[test]
    fn sums_of_targets_are_the_shapes_within_the_bound() {
        for (twist, bound) in [(0.0, 1e-9), (1.0, 1e-2), (1.0, 1e-4), (1.0, 1e-7)] {
            let shapes = shapes(twist, 60);
            let FewTargets {
                targets,
                weights,
                error,
            } = of(&shapes, bound);
            let mut most = 0.0_f64;
            for (shape, weights) in shapes.iter().zip(&weights) {
                assert!(weights.iter().all(|weight| weight.abs() <= 1.0));
                for (vertex, wanted) in shape.iter().enumerate() {
                    let parts = targets.iter().zip(weights);
                    let sum = parts.fold(DVec3::ZERO, |sum, (target, weight)| sum + target[vertex] * *weight);
                    most = most.max(sum.distance(*wanted));
                }
            }
            assert!(
                most <= error + 1e-12 && error <= bound,
                "{twist}, {bound}: {most} {error}"
            );
            for (a, b) in (0..targets.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
                let product: f64 = weights.iter().map(|row| row[a] * row[b]).sum();
                assert!(product.abs() < 1e-9, "columns {a} and {b}: {product}");
            }
        }
    }

    #[test]
    fn a_turn_takes_two_targets_however_many_frames_it_has() {
        // The matrices of turns about an axis are sums of two, less the identity.
        for count in [3, 40, 400] {
            assert_eq!(of(&shapes(0.0, count), 1e-9).targets.len(), 2);
        }
        let counts = [1e-2, 1e-4, 1e-6].map(|bound| of(&shapes(1.0, 100), bound).targets.len());
        assert!(counts.is_sorted() && counts[2] < 15, "{counts:?}");
    }

    #[test]
    fn shapes_at_rest_take_none() {
        let rest = vec![vec![DVec3::ZERO; 7]; 5];
        let targets = of(&rest, 1e-5);
        assert!(targets.targets.is_empty() && targets.error == 0.0);
        assert_eq!(targets.weights, vec![Vec::<f64>::new(); 5]);
    }
}
