//! Local shape matching: each prism takes its best rotation between its fixed neighbours ([BPGK06], section 4.2), which
//! unfolds prisms that Newton's method can't.
//!
//! Prisms of one colour share no joint and are updated in parallel; each update minimises the energy over one rotation,
//! so a sweep never raises it. The translations are then solved for together.

use glam::{DMat3, DQuat};
use rayon::prelude::*;

use super::bodies::{Bodies, State};
use super::colours::Colours;
use super::joints::Joints;
use super::pose::Pose;
use crate::descent::rule;
use crate::numerical::rotation::fit;
use crate::numerical::rows::CHUNK;

/// The most sweeps before Newton's method continues with the present pose.
const SWEEPS: u32 = 200;

impl Pose {
    /// Turns every prism once.
    pub fn sweep(&mut self, joints: &Joints, colours: &Colours) {
        for class in colours.classes() {
            let turned: Vec<DQuat> = class
                .par_iter()
                .with_min_len(CHUNK)
                .map(|&prism| self.best_turn(joints, prism as usize))
                .collect();
            for (&prism, rotation) in class.iter().zip(turned) {
                self.rotations[prism as usize] = rotation;
                self.turns[prism as usize] = DMat3::from_quat(rotation);
            }
        }
    }

    /// The best rotation if nothing else moves: it maximises tr(Rᵀ S) with S = Σ w (x m_iᵀ + R_j C), x pointing from
    /// the prism's centre to the quad's middle under the other prism.
    fn best_turn(&self, joints: &Joints, prism: usize) -> DQuat {
        let mut sum = DMat3::ZERO;
        for side in joints.sides(prism) {
            let arm = side.own_arm;
            let target = arm + self.displacement(side.other as usize, side.other_arm) - self.shifts[prism];
            sum += (self.turns[side.other as usize] * side.spread
                + DMat3::from_cols(target * arm.x, target * arm.y, target * arm.z))
                * side.weight;
        }
        fit(&sum, self.rotations[prism])
    }

    /// Returns true if some prism is rotated by more than a quarter turn from a neighbour.
    pub fn is_folded(&self, joints: &Joints) -> bool {
        (0..joints.count()).into_par_iter().with_min_len(CHUNK).any(|prism| {
            let own = self.rotations[prism];
            let mut others = joints.sides(prism).iter().map(|side| side.other as usize);
            others.any(|other| other < prism && own.dot(self.rotations[other]).abs() < std::f64::consts::FRAC_1_SQRT_2)
        })
    }
}

impl Bodies {
    /// The kind of step that the present pose needs.
    pub(super) fn how_folded(&self) -> State {
        if self.current.is_folded(&self.joints) {
            State::Folded(SWEEPS)
        } else {
            State::Steps(rule::State::Descending)
        }
    }

    /// One sweep; sweeping ends when nothing is folded or a sweep gains nothing.
    pub(super) fn unfold(&mut self, left: u32) {
        self.trial.clone_from(&self.current);
        self.trial.sweep(&self.joints, &self.colours);
        self.trial.settle(&self.joints, &self.springs);
        self.trial.evaluate(&self.joints);
        if self.trial.energy >= self.current.energy || !self.trial.energy.is_finite() {
            self.state = State::Steps(rule::State::Descending);
            return;
        }
        self.memory.clear();
        std::mem::swap(&mut self.current, &mut self.trial);
        if left == 1 || !self.current.is_folded(&self.joints) {
            self.state = State::Steps(rule::State::Descending);
        } else {
            self.state = State::Folded(left - 1);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_mesh::shapes;

    use super::super::colours::Colours;
    use super::super::pose::tests::{joints_of, scattered};

    #[test]
    fn prisms_of_one_colour_share_no_joint_and_a_sweep_lowers_the_energy() {
        for drawn in [shapes::torus(16, 8), shapes::non_manifold_fan(5)] {
            let joints = joints_of(drawn);
            let colours = Colours::of(&joints);
            let mut seen = 0;
            for class in colours.classes() {
                seen += class.len();
                for &prism in class {
                    let mut others = joints.sides(prism as usize).iter().map(|side| side.other);
                    assert!(others.all(|other| !class.contains(&other)));
                }
            }
            assert_eq!(seen, joints.count());
            let mut pose = scattered(&joints, 3.0, 1.0);
            pose.evaluate(&joints);
            for sweep in 0..5 {
                let before = pose.energy;
                pose.sweep(&joints, &colours);
                pose.evaluate(&joints);
                assert!(if sweep == 0 {
                    pose.energy < before
                } else {
                    pose.energy <= before * (1.0 + 1e-12)
                });
            }
        }
    }
}
