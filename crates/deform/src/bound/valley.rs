//! The lowest point of an energy of few numbers, each of whose values costs a solve.
//!
//! Newton's method on the quadratic through the energies at the lowest point so far and at a span around it. The span is
//! not small, because energies that were solved for iteratively have an error, which the slope of near ones would be.
//! Where the energy is a quadratic, as for a linear method, its lowest point is found at once, to rounding.

/// The most steps.
const MOST_STEPS: usize = 8;

/// Energies that differ by less than this share are equal.
const EQUAL: f64 = 1e-12;

/// The span between compared energies, as a share of the motion.
const SPAN: f64 = 1.0 / 16.0;

/// The most length of a step of the search, in the same way.
const REACH: f64 = 0.5;

/// The tolerance of a distance, as a share of the handles' motion, for methods that solve at once ..
const DIRECT: f64 = 1e-6;

/// .. and for those that descend, whose energies have an error.
const ITERATIVE: f64 = 4e-3;

/// Energies below this, times the square of the motion relative to the distance, are rounding.
const NOTHING: f64 = 1e-14;

/// The accuracy of a search.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// The span around the lowest point.
    span: f64,
    /// The next step's span as a share of this one's: below 1 for exact energies.
    shrinking: f64,
    /// The most length of a step.
    reach: f64,
    /// A step by at most this length is the last one.
    tolerance: f64,
    /// Energies that differ by less than this are equal.
    nothing: f64,
}

impl Accuracy {
    /// That for lengths along which something slides that moves by `motion` and is at most `distance` from what holds
    /// it, in the same units, above 0. Energies are exact if the method solves at once.
    pub fn of(motion: f64, distance: f64, is_direct: bool) -> Self {
        let relative = motion / distance;
        Self {
            span: SPAN * motion,
            reach: REACH * motion,
            shrinking: if is_direct { SPAN } else { 1.0 },
            tolerance: motion * if is_direct { DIRECT } else { ITERATIVE },
            nothing: NOTHING * relative * relative,
        }
    }
}

/// A search for the lowest point.
#[derive(Debug)]
pub struct Valley {
    lowest: Vec<f64>,
    /// The energies there and around, as far as they are known.
    energies: Vec<f64>,
    accuracy: Accuracy,
    /// The step to try after all energies are known.
    step: Option<Step>,
    steps: usize,
    is_found: bool,
}

/// A step from the lowest point.
#[derive(Clone, Debug)]
struct Step {
    way: Vec<f64>,
    /// True if it leads to the quadratic's bottom, and not only towards it.
    is_whole: bool,
    /// The quadratic's energy at its end, and its second derivative along it.
    expected: f64,
    curvature: f64,
}

impl Valley {
    /// A search that begins at a point.
    pub fn new(from: Vec<f64>, accuracy: Accuracy) -> Self {
        Self {
            lowest: from,
            energies: Vec::new(),
            accuracy,
            step: None,
            steps: 0,
            is_found: false,
        }
    }

    /// The point whose energy is wanted next; the lowest one once that is found.
    pub fn point(&self) -> Vec<f64> {
        let mut point = self.lowest.clone();
        if self.is_found {
            return point;
        }
        match &self.step {
            Some(step) => point.iter_mut().zip(&step.way).for_each(|(own, way)| *own += way),
            None => {
                for (axis, sign) in probe(self.energies.len(), point.len()).into_iter().flatten() {
                    point[axis] += sign * self.accuracy.span;
                }
            }
        }
        point
    }

    /// Returns true if the lowest point is found, to the tolerance.
    pub fn is_found(&self) -> bool {
        self.is_found
    }

    /// Takes the energy at the point. Returns true if that point is the lowest one so far.
    pub fn take(&mut self, energy: f64) -> bool {
        let Some(step) = &mut self.step else {
            self.energies.push(energy);
            let count = self.lowest.len();
            if self.energies.len() == 1 + 2 * count + count * (count - 1) / 2 {
                self.step = Some(self.to_bottom());
            }
            return self.energies.len() == 1;
        };
        let tolerance = self.accuracy.tolerance;
        let is_small = norm(&step.way) <= tolerance;
        if energy > self.energies[0] && !is_small {
            step.is_whole = false;
            step.way.iter_mut().for_each(|way| *way *= 0.5);
            return false;
        }
        let error = (energy - step.expected).abs();
        let is_exact = error <= 0.5 * step.curvature * tolerance * tolerance || error <= EQUAL * self.energies[0];
        let is_at_bottom = step.is_whole && is_exact;
        self.lowest.iter_mut().zip(&step.way).for_each(|(own, way)| *own += way);
        self.steps += 1;
        self.is_found = is_small || is_at_bottom || self.steps >= MOST_STEPS;
        self.energies = vec![energy];
        self.accuracy.span *= self.accuracy.shrinking;
        self.step = None;
        true
    }

    /// The step to the bottom of the quadratic, or downhill where it has none.
    fn to_bottom(&self) -> Step {
        let (count, energies) = (self.lowest.len(), &self.energies);
        let Accuracy { span, reach, .. } = self.accuracy;
        let (above, below) = (&energies[1..=count], &energies[1 + count..=2 * count]);
        let mut slope: Vec<f64> = above.iter().zip(below).map(|(a, b)| (a - b) / (2.0 * span)).collect();
        let mut hessian = vec![vec![0.0; count]; count];
        for (axis, row) in hessian.iter_mut().enumerate() {
            row[axis] = (above[axis] - 2.0 * energies[0] + below[axis]) / (span * span);
        }
        for (place, energy) in energies.iter().enumerate().skip(1 + 2 * count) {
            let [a, b] = probe(place, count).map(|own| own.map_or(0, |(axis, _)| axis));
            let mixed = (energy - above[a] - above[b] + energies[0]) / (span * span);
            (hessian[a][b], hessian[b][a]) = (mixed, mixed);
        }
        for axis in 0..count {
            let three = [energies[0], above[axis], below[axis]];
            let largest = three.into_iter().fold(0.0, f64::max);
            let least = three.into_iter().fold(f64::INFINITY, f64::min);
            if largest - least <= self.accuracy.nothing + EQUAL * largest {
                slope[axis] = 0.0;
                (0..count).for_each(|other| (hessian[axis][other], hessian[other][axis]) = (0.0, 0.0));
                hessian[axis][axis] = 1.0;
            }
        }
        let bottom = solved(hessian.clone(), &slope);
        let length = bottom.as_ref().map_or(f64::INFINITY, |bottom| norm(bottom));
        let is_whole = length <= reach;
        let mut way = bottom.unwrap_or_else(|| downhill(&hessian, &slope, reach));
        if !is_whole && length.is_finite() {
            way.iter_mut().for_each(|way| *way *= reach / length);
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let bent: Vec<f64> = hessian.iter().map(|row| dot(row, &way)).collect();
        let bend = dot(&way, &bent);
        Step {
            expected: energies[0] + dot(&slope, &way) + 0.5 * bend,
            curvature: bend.max(0.0) / norm(&way).powi(2).max(f64::MIN_POSITIVE),
            is_whole,
            way,
        }
    }
}

/// The numbers that differ from the lowest point's in a probe, and the signs of the differences: first none, then each
/// above, each below, and each pair above.
fn probe(place: usize, count: usize) -> [Option<(usize, f64)>; 2] {
    match place {
        0 => [None; 2],
        _ if place <= count => [Some((place - 1, 1.0)), None],
        _ if place <= 2 * count => [Some((place - 1 - count, -1.0)), None],
        _ => {
            let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
            let pair = pairs.into_iter().nth(place - 1 - 2 * count);
            [pair.map(|(a, _)| (a, 1.0)), pair.map(|(_, b)| (b, 1.0))]
        }
    }
}

/// The solution of H x = −g by Cholesky factorisation; `None` if H is not positive definite.
fn solved(mut hessian: Vec<Vec<f64>>, slope: &[f64]) -> Option<Vec<f64>> {
    let count = slope.len();
    let mut x: Vec<f64> = slope.iter().map(|slope| -slope).collect();
    for k in 0..count {
        let known: f64 = (0..k).map(|j| hessian[k][j] * hessian[k][j]).sum();
        let pivot = hessian[k][k] - known;
        if pivot.is_nan() || pivot <= EQUAL * hessian[k][k].abs() {
            return None;
        }
        hessian[k][k] = pivot.sqrt();
        for i in k + 1..count {
            let known: f64 = (0..k).map(|j| hessian[i][j] * hessian[k][j]).sum();
            hessian[i][k] = (hessian[i][k] - known) / hessian[k][k];
        }
        let known: f64 = (0..k).map(|j| hessian[k][j] * x[j]).sum();
        x[k] = (x[k] - known) / hessian[k][k];
    }
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|i| hessian[i][k] * x[i]).sum();
        x[k] = (x[k] - known) / hessian[k][k];
    }
    Some(x)
}

/// A long step along the number along which the energy bends down most.
fn downhill(hessian: &[Vec<f64>], slope: &[f64], reach: f64) -> Vec<f64> {
    let bend = |axis: &usize| hessian[*axis][*axis];
    let axis = (0..slope.len()).min_by(|a, b| bend(a).total_cmp(&bend(b))).unwrap_or(0);
    let mut way = vec![0.0; slope.len()];
    way[axis] = if slope[axis] > 0.0 { -reach } else { reach };
    way
}

fn norm(way: &[f64]) -> f64 {
    way.iter().map(|own| own * own).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::{Accuracy, Valley};

    /// The lowest point, and the number of energies that it took.
    fn found(from: &[f64], tolerance: f64, energy: impl Fn(&[f64]) -> f64) -> (Vec<f64>, usize) {
        let mut valley = Valley::new(
            from.to_vec(),
            Accuracy {
                span: 0.1,
                reach: 0.8,
                shrinking: 0.25,
                tolerance,
                nothing: 0.0,
            },
        );
        let mut count = 0;
        while !valley.is_found() {
            let point = valley.point();
            valley.take(energy(&point));
            count += 1;
            assert!(count < 200, "{point:?}");
        }
        (valley.point(), count)
    }

    #[test]
    fn a_quadratic_takes_its_coefficients_and_one_more() {
        let (lowest, count) = found(&[0.0], 1e-6, |x| 3.0 + 2.0 * (x[0] - 0.7) * (x[0] - 0.7));
        assert!((lowest[0] - 0.7).abs() < 1e-12, "{lowest:?}");
        assert_eq!(count, 4);
        let coupled = |x: &[f64]| 1.0 + x[0] * x[0] + x[1] * x[1] + x[0] * x[1] - x[0] + x[2] * x[2] - x[1] * x[2];
        let (lowest, count) = found(&[0.1, -0.3, 0.2], 1e-6, coupled);
        // Where its gradient, 2 x + y − 1, 2 y + x − z, 2 z − y, is 0.
        for (own, meant) in lowest.iter().zip([0.75, -0.5, -0.25]) {
            assert!((own - meant).abs() < 1e-12, "{lowest:?}");
        }
        // The first step ends on the way.
        assert_eq!(count, 21);
    }

    #[test]
    fn a_ridge_is_left_and_a_plain_is_not() {
        let double_well = |x: &[f64]| (x[0] * x[0] - 1.0) * (x[0] * x[0] - 1.0);
        let (lowest, _) = found(&[0.0], 1e-4, double_well);
        assert!((lowest[0].abs() - 1.0).abs() < 1e-3, "{lowest:?}");
        assert_eq!(found(&[0.3], 1e-4, |_| 0.0).0, [0.3]);
    }
}
