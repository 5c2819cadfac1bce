//! Limbs: round cones along a curve, grouped so that a distant group costs one comparison.

use super::solid::{chain, sphere};
use super::vector::{Vec3, v};

/// Round cones that share one bounding sphere.
const GROUP: usize = 4;

/// A limb.
pub struct Limb {
    /// Centre and radius of every ball along the limb.
    pub knots: Vec<(Vec3, f64)>,
    /// Bounding sphere of each group (centre and radius), and the group's first ball.
    groups: Vec<(Vec3, f64, usize)>,
}

impl Limb {
    /// A limb along the smooth curve through `knots`, with `pieces` round cones per span.
    pub fn through(knots: &[(Vec3, f64)], pieces: usize) -> Self {
        let knots = smooth_knots(knots, pieces);
        let groups = (0..knots.len() - 1)
            .step_by(GROUP)
            .map(|from| {
                let group = &knots[from..(from + GROUP + 1).min(knots.len())];
                let centre = group.iter().fold(v(0.0, 0.0, 0.0), |sum, knot| sum + knot.0) * (1.0 / group.len() as f64);
                let reach = group
                    .iter()
                    .fold(0.0, |reach: f64, knot| reach.max((knot.0 - centre).length() + knot.1));
                (centre, reach, from)
            })
            .collect();
        Self { knots, groups }
    }

    /// The distance to the limb if it is below `limit`; otherwise any value not below `limit`.
    pub fn distance(&self, p: Vec3, limit: f64) -> f64 {
        self.groups.iter().fold(f64::INFINITY, |near, &(centre, reach, from)| {
            if sphere(p, centre, reach) >= near.min(limit) {
                return near;
            }
            near.min(chain(p, &self.knots[from..(from + GROUP + 1).min(self.knots.len())]))
        })
    }
}

/// The Catmull-Rom curve through `knots`, with `pieces` round cones per span.
pub fn smooth_knots(knots: &[(Vec3, f64)], pieces: usize) -> Vec<(Vec3, f64)> {
    let at = |i: isize| knots[i.clamp(0, knots.len() as isize - 1) as usize];
    let mut out = Vec::new();
    for span in 0..knots.len() as isize - 1 {
        let (k0, k1, k2, k3) = (at(span - 1), at(span), at(span + 1), at(span + 2));
        for piece in 0..pieces {
            let t = piece as f64 / pieces as f64;
            let (t2, t3) = (t * t, t * t * t);
            let w = [
                -t3 + 2.0 * t2 - t,
                3.0 * t3 - 5.0 * t2 + 2.0,
                -3.0 * t3 + 4.0 * t2 + t,
                t3 - t2,
            ];
            let centre = (k0.0 * w[0] + k1.0 * w[1] + k2.0 * w[2] + k3.0 * w[3]) * 0.5;
            let radius = (k0.1 * w[0] + k1.1 * w[1] + k2.1 * w[2] + k3.1 * w[3]) * 0.5;
            out.push((centre, radius));
        }
    }
    out.push(at(knots.len() as isize - 1));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_knots_pass_through_the_given_ones() {
        let knots = [
            (v(0.0, 0.0, 0.0), 1.0),
            (v(1.0, 0.0, 0.0), 0.5),
            (v(1.0, 1.0, 0.0), 0.2),
        ];
        let smooth = smooth_knots(&knots, 4);
        assert_eq!(smooth.len(), 9);
        for (i, knot) in knots.iter().enumerate() {
            assert!((smooth[4 * i].0 - knot.0).length() < 1e-12 && (smooth[4 * i].1 - knot.1).abs() < 1e-12);
        }
    }

    #[test]
    fn leaving_groups_out_changes_no_distance_below_the_limit() {
        let knots = [
            (v(0.0, 0.0, 0.0), 0.3),
            (v(1.0, 0.2, 0.0), 0.2),
            (v(1.5, 1.0, 0.3), 0.1),
            (v(1.0, 2.0, 0.0), 0.05),
        ];
        let limb = Limb::through(&knots, 5);
        for i in 0..1000_i32 {
            let t = f64::from(i);
            let p = v((t * 0.37) % 4.0 - 1.0, (t * 0.73) % 4.0 - 1.0, (t * 0.11) % 3.0 - 1.5);
            let all = chain(p, &limb.knots);
            assert_eq!(limb.distance(p, f64::INFINITY), all);
            let limited = limb.distance(p, 0.2);
            assert!(
                if all < 0.2 { limited == all } else { limited >= 0.2 },
                "{all} {limited}"
            );
        }
    }
}
