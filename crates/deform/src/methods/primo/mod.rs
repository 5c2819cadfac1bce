//! Coupled prisms [BPGK06]: every triangle is a rigid prism, elastically joined to its neighbours over the quads that
//! they share at rest.
//!
//! The prisms' rotations are the unknowns. Given the rotations, the best translations solve a linear problem with one
//! constant matrix, so they are always solved exactly (variable projection). The remaining problem has no long valleys:
//! with the translations among the unknowns, turning a chain of prisms would stretch it to second order, and steps
//! would stay short. The rotations descend by a quasi-Newton method on top of the factored Gauss–Newton matrix of *all*
//! velocities; the angular part of its inverse is that of the reduced problem. In the prisms' own frames this matrix
//! hardly changes while they turn together, so the rest pose's is good for many steps, and is factored again only if
//! the minimum is far. The line search uses the true energy, which never rises.
//!
//! Measured on the bar of [BS08] (12,106 faces), iterations to within 1% of the least energy at a thickness of 0.02:
//! with translations among the unknowns and the rest pose's matrix over 1000, or 10 plain Gauss–Newton steps that each
//! factor; with translations eliminated 23, or 17 with the matrix renewed every twelve steps.
//!
//! Above some thousands of prisms the matrix is inverted only approximately, by cells of prisms, which is enough for a
//! descent direction: on a scan of 86,482 faces binding took 0.75 instead of more than 3 s, a step 0.13 instead of 0.3
//! s, and the number of steps was the same.
//!
//! Parts: `bodies` are rigid bodies on joints, here the prisms, and their descent. `edges` finds triangles with a
//! common edge, `prisms` sorts them, `quad` is the integral over a shared quad, `joints` are the couplings, `pose` has
//! the prisms' positions and energy, `system` and `factored` make the matrices, `hierarchy` the cells, `start` chooses
//! the first pose, `sweep` unfolds, `descent` takes a step, and `vertices` takes the prisms' mean.

pub(crate) mod bodies;
mod colours;
mod declaration;
mod descent;
pub(crate) mod edges;
mod factored;
mod hierarchy;
pub(crate) mod joints;
mod options;
pub(crate) mod pose;
mod prisms;
mod quad;
mod second;
mod springs;
mod start;
mod sweep;
mod system;
mod vertices;

use glam::DVec3;
use pliant_mesh::{Cancel, Progress};

pub(crate) use self::declaration::DECLARATION;
pub use self::options::Primo;

use self::bodies::Bodies;
use self::edges::Edges;
use self::joints::{Joints, Material};
use self::prisms::Prisms;
use self::vertices::Vertices;
use crate::BindError;
use crate::handles::{Handle, Motion};
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::region::slender;
use crate::sparse::Elimination;
use crate::sparse::ordering::graph::elimination;
use crate::sparse::system_error::SystemError;

/// The bound method, with its present pose.
#[derive(Debug)]
pub(crate) struct PrimoSolver {
    bodies: Bodies,
    vertices: Vertices,
    /// The surface vertices of each handle, with their coordinates.
    prescribed: Vec<Vec<(u32, [f64; 4])>>,
}

impl PrimoSolver {
    /// Sorts the prisms, joins them, factors, and solves for the weights of `handles`.
    pub fn bind(
        problem: &BoundaryProblem,
        options: &Primo,
        partition: &Partition,
        handles: &[Handle],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let (surface, topology) = (problem.surface, problem.topology);
        let most = slender::MOST_EDGES_OF_PRISMS;
        slender::check(&partition.triangulation, &partition.solved, most, None)?;
        let edges = Edges::of(surface, topology);
        let mut prisms = Prisms::of(&edges, problem.roles);
        cancel.check()?;
        progress.set(0.1);
        let (offsets, neighbours) = prisms.graph(&edges);
        let Elimination { order, ends } = elimination(&offsets, &neighbours, cancel)?;
        prisms.reorder(&order);
        cancel.check()?;
        progress.set(0.2);
        let world_origin = handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
        let mut world_grounds = vec![world_origin];
        world_grounds.extend(handles.iter().map(|handle| handle.world_centre));
        let size = problem.size();
        let mut joints = Joints::of(
            &prisms,
            &Material {
                edges: &edges,
                stiffness: problem.stiffness,
                thickness: options.thickness * size,
                world_origin,
                world_grounds: &world_grounds,
            },
        );
        joints.block_ends = ends;
        cancel.check()?;
        progress.set(0.3);
        let component = |prism: usize| {
            let corner = surface.triangles[prisms.faces[prism] as usize][0];
            (topology.component(corner), corner)
        };
        let refused = |error| {
            SystemError::of(error, |prism| component(prism).1.0).into_bind_error(topology, partition.free_count)
        };
        let unheld = |prism: usize| !partition.held[component(prism).0 as usize];
        let bodies = Bodies::of(
            joints,
            handles,
            world_origin,
            unheld,
            options.tolerance,
            partition.budget,
            cancel,
        );
        let bodies = bodies.map_err(refused)?;
        progress.set(1.0);
        let world_rest = |vertex: u32| surface.positions[vertex as usize];
        let vertices = Vertices::of(
            surface,
            topology,
            problem.roles,
            &prisms,
            &bodies.joints.centres,
            world_origin,
        );
        Ok(Self {
            bodies,
            vertices,
            prescribed: handles
                .iter()
                .map(|handle| {
                    let of = |&vertex: &u32| (vertex, handle.coordinates(world_rest(vertex)));
                    handle.vertices.iter().map(of).collect()
                })
                .collect(),
        })
    }

    /// One step towards `motions`: writes the displacements of solved prisms' free vertices. Returns whether it
    /// converged, and the energy.
    pub fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> (bool, f64) {
        // The pool is entered once: otherwise each of the many short loops would wait for it.
        rayon::scope(|_| {
            self.bodies.advance(motions);
            self.vertices.write(self.bodies.shown(), displacements);
        });
        self.bodies.outcome()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use glam::{DAffine3, DMat3, DQuat, DVec3};
    use pliant_mesh::{Cancel, Drawn, Progress, shapes};

    use super::bodies::State;
    use super::pose::tests::noise;
    use super::{Primo, PrimoSolver};
    use crate::handles::{Handle, Motion};
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::{Method, Role};

    /// A solver with the lowest tenth of z fixed and the highest a handle, and the handle's motion.
    fn solver(drawn: Drawn) -> (PrimoSolver, Vec<Motion>, usize) {
        let model = shapes::model(drawn);
        let bounds = model.bounds().unwrap();
        let role = |p: &DVec3| match (p.z - bounds.min.z) / bounds.extent().z {
            h if h > 0.9 => Role::Handle(0),
            h if h < 0.1 => Role::Fixed,
            _ => Role::Free,
        };
        let positions = &model.surface.positions;
        let roles: Vec<Role> = positions.iter().map(role).collect();
        let options = Primo {
            tolerance: 1e-9,
            ..Primo::default()
        };
        let method = Method::from(options.clone());
        let stiffness = vec![1.0; roles.len()];
        let problem = BoundaryProblem::new((&model.surface, &model.topology), &roles, &stiffness);
        let partition = method.partition(&problem).unwrap();
        let handles = [Handle::new(partition.handles[0].clone(), positions)];
        let target =
            DAffine3::from_translation(DVec3::new(0.2, 0.1, 0.0) * bounds.diagonal()) * DAffine3::from_rotation_z(0.5);
        let motions = vec![handles[0].motion(&target)];
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let solver = PrimoSolver::bind(&problem, &options, &partition, &handles, &progress, &cancel).unwrap();
        (solver, motions, roles.len())
    }

    fn least(solver: &mut PrimoSolver, motions: &[Motion], count: usize) -> f64 {
        let mut displacements = vec![DVec3::ZERO; count];
        let mut last = f64::INFINITY;
        for _ in 0..2000 {
            let (converged, energy) = solver.step(motions, &mut displacements);
            assert!(energy <= last);
            last = energy;
            if converged {
                return energy;
            }
        }
        unreachable!("it converges");
    }

    #[test]
    fn a_pose_from_which_no_step_leads_down_has_stalled_and_not_converged() {
        let (mut solver, motions, count) = solver(shapes::torus(24, 12));
        let mut displacements = vec![DVec3::ZERO; count];
        let (converged, energy) = solver.step(&motions, &mut displacements);
        assert!(!converged && energy > 0.0);
        // No trial has a lower energy.
        solver.bodies.current.energy *= 1e-6;
        solver.bodies.memory.clear();
        let (converged, _) = solver.step(&motions, &mut displacements);
        assert!(!converged && solver.bodies.has_stalled());
    }

    #[test]
    fn prisms_scattered_at_random_come_back() {
        for drawn in [shapes::tube(16, 24, 6.0), shapes::torus(24, 12), shapes::icosphere(3)] {
            let (mut solver, motions, count) = solver(drawn);
            let expected = least(&mut solver, &motions, count);
            // Sorted by triangle, so that the order of elimination doesn't matter.
            for (place, &prism) in solver.bodies.joints.order.iter().enumerate() {
                let prism = prism as usize;
                let random = |k: usize| noise(3 * place + k);
                let turn = DQuat::from_scaled_axis(DVec3::new(random(0), random(1), random(2)) * 3.0);
                solver.bodies.current.rotations[prism] = turn;
                solver.bodies.current.turns[prism] = DMat3::from_quat(turn);
            }
            solver
                .bodies
                .current
                .settle(&solver.bodies.joints, &solver.bodies.springs);
            solver.bodies.current.evaluate(&solver.bodies.joints);
            solver.bodies.memory.clear();
            solver.bodies.state = solver.bodies.how_folded();
            assert!(matches!(solver.bodies.state, State::Folded(_)));
            assert!(solver.bodies.current.energy / solver.bodies.joints.area > 5.0 * expected);
            let again = least(&mut solver, &motions, count);
            assert!((again - expected).abs() < 1e-4 * expected, "{again} {expected}");
        }
    }
}
