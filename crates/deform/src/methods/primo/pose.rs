//! The prisms' positions, and the energy and its gradient there.
//!
//! A body's motion takes its rest centre c to c + shift and transforms its surroundings by a linear map: a rotation for
//! a prism, any map for a ground, since a handle moves affinely. Velocities are in the body's own frame: (ω, v) takes a
//! prism with the rotation R to R exp(ω), its shift further by R v. A joint's gradient is then a function of the
//! relative position of its two prisms, and the Gauss–Newton matrix does not change if a rigid motion moves both.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::joints::{Joints, Side};
use super::springs::Springs;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::Field;

/// The bodies' motions from rest.
#[derive(Clone, Debug)]
pub(crate) struct Pose {
    /// The rotation of each solved prism.
    pub rotations: Vec<DQuat>,
    /// The linear part of each body's motion: the rotations again, then the grounds'.
    pub turns: Vec<DMat3>,
    /// The displacement of each body's centre.
    pub shifts: Vec<DVec3>,
    /// dE/dω of each solved prism, with the best translations.
    pub gradient: Field,
    /// E.
    pub energy: f64,
}

impl Pose {
    /// The rest pose of `prism_count` prisms on `ground_count` grounds.
    pub fn at_rest(prism_count: usize, ground_count: usize) -> Self {
        Self {
            rotations: vec![DQuat::IDENTITY; prism_count],
            turns: vec![DMat3::IDENTITY; prism_count + ground_count],
            shifts: vec![DVec3::ZERO; prism_count + ground_count],
            gradient: vec![[0.0; 3]; prism_count],
            energy: 0.0,
        }
    }

    /// The displacement of a point at `arm` from the centre of `body`.
    #[inline]
    pub fn displacement(&self, body: usize, arm: DVec3) -> DVec3 {
        (self.turns[body] * arm - arm) + self.shifts[body]
    }

    /// Computes energy and gradient; sums don't depend on the number of threads.
    pub fn evaluate(&mut self, joints: &Joints) {
        let mut gradient = std::mem::take(&mut self.gradient);
        let partial: Vec<f64> = gradient
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, gradient)| {
                let mut sum = 0.0;
                for (place, own) in gradient.iter_mut().enumerate() {
                    let (energy, torque) = self.prism(joints, chunk * CHUNK + place);
                    sum += energy;
                    *own = torque.to_array();
                }
                sum
            })
            .collect();
        self.gradient = gradient;
        self.energy = partial.iter().sum();
    }

    /// Solves for the translations that minimise the energy with these rotations: a linear problem.
    pub fn settle(&mut self, joints: &Joints, laplacian: &Springs) {
        let pull = |prism: usize| {
            let sum: DVec3 = joints
                .sides(prism)
                .iter()
                .map(|side| self.apart(prism, side) * side.weight)
                .sum();
            sum.to_array()
        };
        let mut pulls: Field = (0..joints.count())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(pull)
            .collect();
        laplacian.apply(&mut pulls);
        for (shift, pull) in self.shifts.iter_mut().zip(pulls) {
            *shift -= DVec3::from_array(pull);
        }
    }

    /// A prism's part of the energy and of the gradient; joints that two prisms share count half in the energy.
    fn prism(&self, joints: &Joints, prism: usize) -> (f64, DVec3) {
        let turn = self.turns[prism];
        let mut energy = 0.0;
        // The sum is in world axes; it is turned into the prism's at the end.
        let mut moment = DMat3::ZERO;
        for side in joints.sides(prism) {
            let apart = self.apart(prism, side);
            let difference = turn - self.turns[side.other as usize];
            let bent = difference * side.spread;
            let share = if (side.other as usize) < joints.count() {
                0.25
            } else {
                0.5
            };
            let square = bent.x_axis.dot(difference.x_axis)
                + bent.y_axis.dot(difference.y_axis)
                + bent.z_axis.dot(difference.z_axis);
            energy += share * side.weight * (apart.length_squared() + square);
            let pull = apart * side.weight;
            let arm = side.own_arm;
            moment += bent * side.weight + DMat3::from_cols(pull * arm.x, pull * arm.y, pull * arm.z);
        }
        // dE = tr(Rᵀ moment [ω]ᵀ): the axial vector of Rᵀ moment's skew part.
        let b = turn.transpose() * moment;
        let torque = DVec3::new(
            b.y_axis.z - b.z_axis.y,
            b.z_axis.x - b.x_axis.z,
            b.x_axis.y - b.y_axis.x,
        );
        (energy, torque)
    }

    /// The gap at the quad's middle: its position under this prism less that under the other.
    #[inline]
    pub fn apart(&self, prism: usize, side: &Side) -> DVec3 {
        self.displacement(prism, side.own_arm) - self.displacement(side.other as usize, side.other_arm)
    }

    /// Makes `self` the pose at `length` along `direction` from `from`, still to be evaluated.
    pub fn moved(&mut self, from: &Self, direction: &Field, length: f64) {
        let count = self.rotations.len();
        self.turns[count..].copy_from_slice(&from.turns[count..]);
        self.shifts[count..].copy_from_slice(&from.shifts[count..]);
        self.rotations
            .par_iter_mut()
            .zip(&mut self.turns[..count])
            .zip(&mut self.shifts[..count])
            .with_min_len(CHUNK)
            .enumerate()
            .for_each(|(prism, ((rotation, turn), shift))| {
                let step = DQuat::from_scaled_axis(DVec3::from_array(direction[prism]) * length);
                *rotation = (from.rotations[prism] * step).normalize();
                *turn = DMat3::from_quat(*rotation);
                *shift = from.shifts[prism];
            });
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
pub(crate) mod tests {
    use glam::{DMat3, DQuat, DVec3};
    use pliant_mesh::{Cancel, Drawn, Model, shapes};

    use super::Pose;
    use crate::Role;
    use crate::methods::primo::edges::Edges;
    use crate::methods::primo::joints::{Joints, Material};
    use crate::methods::primo::prisms::Prisms;
    use crate::methods::primo::springs::Springs;
    use crate::methods::primo::system::gauss_newton;
    use crate::numerical::sums::Field;

    pub fn noise(k: usize) -> f64 {
        2.0 * ((k as f64 * 12.9898).sin() * 43_758.545).fract()
    }

    /// The joints of a shape whose highest tenth of z is the handle and whose lowest is fixed.
    pub fn joints_of(drawn: Drawn) -> Joints {
        let model = shapes::model(drawn);
        let bounds = model.bounds().unwrap();
        let height = |p: DVec3| (p.z - bounds.min.z) / bounds.extent().z;
        let role = |p: &DVec3| match height(*p) {
            h if h > 0.9 => Role::Handle(0),
            h if h < 0.1 => Role::Fixed,
            _ => Role::Free,
        };
        let roles: Vec<Role> = model.surface.positions.iter().map(role).collect();
        joints(&model, &roles, 0.1 * bounds.diagonal())
    }

    fn joints(model: &Model, roles: &[Role], thickness: f64) -> Joints {
        let (surface, topology) = (&model.surface, &model.topology);
        let count = surface.positions.len();
        let stiffness: Vec<f64> = (0..count).map(|v| 1.0 + (v % 5) as f64).collect();
        let edges = Edges::of(surface, topology);
        let prisms = Prisms::of(&edges, roles);
        assert!(prisms.count() > 0);
        Joints::of(
            &prisms,
            &Material {
                edges: &edges,
                stiffness: &stiffness,
                thickness,
                world_origin: DVec3::ZERO,
                world_grounds: &[DVec3::ZERO, DVec3::Z],
            },
        )
    }

    /// Every prism turned and moved at random, the handle stretched.
    pub fn scattered(joints: &Joints, turn: f64, shift: f64) -> Pose {
        let mut pose = Pose::at_rest(joints.count(), 2);
        for prism in 0..joints.count() {
            let random =
                |k: usize| DVec3::new(noise(9 * prism + k), noise(9 * prism + k + 1), noise(9 * prism + k + 2));
            pose.rotations[prism] = DQuat::from_scaled_axis(random(0) * turn);
            pose.turns[prism] = DMat3::from_quat(pose.rotations[prism]);
            pose.shifts[prism] = random(3) * shift;
        }
        pose.turns[joints.count() + 1] = DMat3::from_diagonal(DVec3::new(1.1, 0.9, -0.2));
        pose.shifts[joints.count() + 1] = DVec3::new(0.3, 0.1, 0.2);
        pose
    }

    fn shapes_with_joints() -> [Drawn; 3] {
        let upright = glam::DAffine3::from_rotation_x(1.2);
        [
            shapes::torus(16, 8),
            shapes::moved(&shapes::grid(7, 9), upright),
            shapes::non_manifold_fan(5),
        ]
    }

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        for drawn in shapes_with_joints() {
            let joints = joints_of(drawn);
            let mut pose = scattered(&joints, 0.7, 0.2);
            pose.evaluate(&joints);
            let largest = pose.gradient.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            for prism in (0..joints.count()).step_by(5) {
                for axis in 0..3 {
                    let beside = |sign: f64| {
                        let mut direction: Field = vec![[0.0; 3]; joints.count()];
                        direction[prism][axis] = 1.0;
                        let mut moved = pose.clone();
                        moved.moved(&pose, &direction, sign * 1e-5);
                        moved.evaluate(&joints);
                        moved.energy
                    };
                    let slope = (beside(1.0) - beside(-1.0)) / 2e-5;
                    let error = (slope - pose.gradient[prism][axis]).abs();
                    assert!(
                        error < 1e-7 * largest,
                        "{prism} {axis}: {slope} {}",
                        pose.gradient[prism][axis]
                    );
                }
            }
        }
    }

    #[test]
    fn settled_prisms_have_the_least_energy_for_their_turns() {
        for drawn in shapes_with_joints() {
            let joints = joints_of(drawn);
            let springs = Springs::of(&joints, crate::Budget::default(), &Cancel::new()).unwrap();
            let mut pose = scattered(&joints, 0.7, 0.2);
            pose.settle(&joints, &springs);
            pose.evaluate(&joints);
            for seed in 0..4 {
                let mut other = pose.clone();
                for (k, shift) in other.shifts[..joints.count()].iter_mut().enumerate() {
                    *shift += 1e-3 * DVec3::new(noise(k + seed), noise(2 * k + seed), noise(3 * k + seed));
                }
                other.evaluate(&joints);
                assert!(other.energy > pose.energy);
            }
        }
    }

    #[test]
    fn at_rest_the_gauss_newton_matrix_is_the_energys_hessian() {
        for drawn in shapes_with_joints() {
            let joints = joints_of(drawn);
            let rest = Pose::at_rest(joints.count(), 2);
            let matrix = gauss_newton(&joints, &rest).unwrap();
            let direction: Vec<f64> = (0..6 * joints.count()).map(noise).collect();
            let mut quadratic = 0.0;
            for column in 0..direction.len() {
                for entry in matrix.lower_offsets[column] as usize..matrix.lower_offsets[column + 1] as usize {
                    let row = matrix.lower_rows[entry] as usize;
                    let value = matrix.lower_values[entry] / (matrix.scale[row] * matrix.scale[column]);
                    let twice = if row == column { 1.0 } else { 2.0 };
                    quadratic += twice * value * direction[row] * direction[column];
                }
            }
            let length = 1e-5;
            let mut moved = rest;
            for prism in 0..joints.count() {
                let v = |k: usize| DVec3::from_slice(&direction[6 * prism + k..]) * length;
                moved.turns[prism] = DMat3::from_quat(DQuat::from_scaled_axis(v(0)));
                moved.shifts[prism] = v(3);
            }
            moved.evaluate(&joints);
            let energy = moved.energy * 2.0 / (length * length);
            assert!((energy - quadratic).abs() < 1e-4 * quadratic, "{energy} {quadratic}");
        }
    }
}
