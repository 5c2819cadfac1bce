//! B-spline and Bernstein functions of one axis, and their slopes.

use super::LatticeBasis;

/// The most functions that are not zero at a point: those of the Bernstein polynomials of degree 10.
pub(super) const MOST: usize = 11;

/// The functions of one axis, over 0 ≤ t ≤ 1. They sum to 1, and so do linear functions with their Greville points.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Axis {
    pub basis: LatticeBasis,
    pub degree: usize,
    pub cells: usize,
}

/// The functions that are not zero at a point: `count` of them from number `first` on, with their values and slopes
/// along t.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    pub first: usize,
    pub count: usize,
    pub values: [f64; MOST],
    pub slopes: [f64; MOST],
}

impl Axis {
    /// The number of functions, and so of control points.
    pub fn count(&self) -> usize {
        match self.basis {
            LatticeBasis::BSpline => self.cells + self.degree,
            LatticeBasis::Bernstein => self.degree + 1,
        }
    }

    /// The place of a control point with which the control points reproduce t.
    pub fn greville(&self, number: usize) -> f64 {
        match self.basis {
            LatticeBasis::BSpline => (number as f64 - 0.5 * (self.degree as f64 - 1.0)) / self.cells as f64,
            LatticeBasis::Bernstein => number as f64 / self.degree as f64,
        }
    }

    /// The functions at t. Outside of 0 to 1 the polynomials of the outermost cell continue.
    pub fn at(&self, t: f64) -> Values {
        let (first, t) = match self.basis {
            LatticeBasis::BSpline => {
                let x = t * self.cells as f64;
                let cell = x.floor().clamp(0.0, (self.cells - 1) as f64);
                (cell as usize, x - cell)
            }
            LatticeBasis::Bernstein => (0, t),
        };
        let mut values = [0.0; MOST];
        values[0] = 1.0;
        let mut slopes = [0.0; MOST];
        for degree in 1..=self.degree {
            let d = degree as f64;
            let lower = values;
            for j in 0..=degree {
                let left = if j > 0 { lower[j - 1] } else { 0.0 };
                let right = if j < degree { lower[j] } else { 0.0 };
                let at = j as f64;
                (values[j], slopes[j]) = match self.basis {
                    LatticeBasis::BSpline => (
                        ((t + d - at) * left + (1.0 - t + at) * right) / d,
                        (left - right) * self.cells as f64,
                    ),
                    LatticeBasis::Bernstein => (t * left + (1.0 - t) * right, (left - right) * d),
                };
            }
        }
        Values {
            first,
            count: self.degree + 1,
            values,
            slopes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_sum_to_one_reproduce_t_and_have_the_slopes_of_differences() {
        let axes = (1..=10).flat_map(|cells| {
            let bernstein = Axis {
                basis: LatticeBasis::Bernstein,
                degree: cells,
                cells,
            };
            let splines = (1..=3).map(move |degree| Axis {
                basis: LatticeBasis::BSpline,
                degree,
                cells,
            });
            splines.chain([bernstein])
        });
        for axis in axes {
            for step in 0..=40 {
                let t = (f64::from(step) + 0.3) / 41.0;
                let at = axis.at(t);
                let numbers = || (0..at.count).map(|j| (at.first + j, at.values[j], at.slopes[j]));
                assert!(numbers().all(|(number, value, _)| number < axis.count() && value >= 0.0));
                let sum: f64 = numbers().map(|(_, value, _)| value).sum();
                let linear: f64 = numbers().map(|(number, value, _)| axis.greville(number) * value).sum();
                assert!((sum - 1.0).abs() < 1e-13 && (linear - t).abs() < 1e-13, "{axis:?} {t}");
                let (ahead, behind) = (axis.at(t + 1e-6), axis.at(t - 1e-6));
                if ahead.first == at.first && behind.first == at.first {
                    for (j, (_, _, slope)) in numbers().enumerate() {
                        let difference = (ahead.values[j] - behind.values[j]) / 2e-6;
                        assert!((slope - difference).abs() < 1e-6, "{axis:?} {t}: {slope} {difference}");
                    }
                }
            }
        }
    }
}
