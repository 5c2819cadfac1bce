//! The coarse level of a large surface: the same method on a surface of clusters, small enough for Newton steps in a
//! frame, like the decimated shells of [FB11].
//!
//! Dead loads make its gradient equal to that of the fine shape that it was last restricted from (the full
//! approximation scheme of [Bra77], as optimisation [Nas00]): at the fine minimum it does not move, and otherwise its
//! motion is a correction. Only its turns are carried over (`carry`), so that the clusters are invisible and the fine
//! shape keeps its details.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};
use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use super::blended::fitted;
use super::elements::{ABSENT, Elements};
use super::shape::Shape;
use super::{Shells, ShellsSolver};
use crate::coarse::clustered::{Share, Shares, on_clusters, shares, transposed};
use crate::coarse::clusters::Clusters;
use crate::coarse::domain::Domain;
use crate::descent::prescribed::Prescribed;
use crate::handles::blend::Origin;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::Field;
use crate::region::boundary_problem::BoundaryProblem;
use crate::{Budget, ExampleShape, Examples, Method};

/// The fewest vertices of a cluster.
const CLUSTER: f64 = 8.0;

/// The largest number of clusters, about, so that two steps fit into a frame.
const MOST: f64 = 3000.0;

/// The level's own solver and its connection with the fine one.
#[derive(Debug)]
pub(super) struct Coarse {
    solver: Box<ShellsSolver>,
    /// The shares of each solved vertex of the fine surface; they sum to 1, or are 0 if no cluster is near.
    shares: Vec<Shares>,
    /// The start of each solved coarse vertex' row in `members`; one more at the end.
    offsets: Vec<u32>,
    /// The solved fine vertices that have a share in it, with their shares.
    members: Vec<Share>,
    /// For each solved coarse vertex the fine local vertex at its centre.
    fine_of: Vec<u32>,
    /// Each coarse vertex' surface vertex.
    centres: Vec<u32>,
    next_offsets: Option<Offsets>,
    /// The coarse positions that the fine shape last followed.
    followed: Vec<DVec3>,
}

impl Coarse {
    /// Makes the level of the bound `fine` elements of `problem`; `None` if no coarse level is possible.
    pub fn of(
        problem: &BoundaryProblem,
        options: &Shells,
        handles: &[Handle],
        solved: &[u32],
        fine: &Elements,
        budget: Budget,
        cancel: &Cancel,
    ) -> Option<Self> {
        let domain = Domain::of(problem.surface, problem.topology, solved);
        let size = CLUSTER.max(domain.vertices.len() as f64 / MOST);
        let clusters = Clusters::of(problem, &domain, handles, size);
        let mut own = options.clone();
        own.led_above = usize::MAX;
        let method = Method::from(own.clone());
        let examples = problem.examples.map(|examples| examples_of(examples, &clusters));
        let solver = on_clusters(
            problem,
            &clusters,
            &method,
            examples.as_ref(),
            handles,
            |coarse, mut partition, handles| {
                partition.budget = budget;
                // The bending depends on the size D, which differs between both surfaces.
                let sizes = problem.size() / coarse.size();
                if sizes.is_finite() {
                    own.bending *= sizes * sizes;
                }
                ShellsSolver::bind(coarse, &own, &partition, handles, &Progress::new(), cancel).ok()
            },
        )?;
        let elements = &solver.energy.elements;
        if elements.solved_count == 0 {
            return None;
        }
        let coarse_of = elements.local_of(clusters.centres.len());
        let cell = |cluster: u32| Some(coarse_of[cluster as usize]).filter(|&local| local != ABSENT);
        let shares: Vec<Shares> = fine.vertices[..fine.solved_count]
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&vertex| shares(problem, &clusters, &cell, vertex))
            .collect();
        let (offsets, members) = transposed(&shares, elements.solved_count);
        let fine_local = fine.local_of(problem.roles.len());
        let centre = |&cluster: &u32| fine_local[clusters.centres[cluster as usize] as usize];
        Some(Self {
            centres: clusters.centres.clone(),
            next_offsets: None,
            fine_of: elements.vertices[..elements.solved_count].iter().map(centre).collect(),
            followed: elements.rest.clone(),
            solver: Box::new(solver),
            shares,
            offsets,
            members,
        })
    }

    /// The count of numbers that its factor stores.
    pub fn stored(&self) -> usize {
        self.solver.stored()
    }

    /// Sets the offsets of handles' vertices from the motions; the next start uses them.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        self.next_offsets = Some(offsets.of((0..).zip(self.centres.iter().copied())));
    }

    /// Sets the weights of the examples; the next start uses them.
    pub fn set_weights(&mut self, weights: &[Option<f64>]) {
        self.solver.give(weights);
    }

    /// The weights that it has found.
    pub fn weights(&self) -> &[f64] {
        &self.solver.current.weights
    }

    /// The next turns are measured from rest.
    pub fn follow_from_rest(&mut self) {
        self.followed.clone_from(&self.solver.energy.elements.rest);
    }

    /// Returns to the rest shape.
    pub fn rest(&mut self) {
        self.solver.back_to_rest();
        self.followed.clone_from(&self.solver.energy.elements.rest);
    }

    /// Takes over the fine shape for its present motions, without loads: every centre takes its fine position.
    pub fn follow(&mut self, fine: &Shape) {
        let solver = &mut *self.solver;
        for (own, &place) in solver.current.displacements.iter_mut().zip(&self.fine_of) {
            if place != ABSENT {
                *own = fine.displacements[place as usize];
            }
        }
        solver.energy.springs.loads.clear();
        solver.energy.evaluate(&mut solver.current, &solver.energy.springs);
        solver.has_converged = false;
        solver.has_slopes = false;
        self.followed = solver.positions();
    }

    /// Like [`Coarse::follow`], with loads that make the coarse gradient equal to the fine one.
    pub fn restrict(&mut self, fine: &Shape, gradient: &Field) {
        self.follow(fine);
        let solver = &mut *self.solver;
        solver.energy.find_slopes(&solver.current, &mut solver.slopes);
        let (offsets, members) = (&self.offsets, &self.members);
        let own = solver.slopes.energy.iter().zip(offsets.windows(2));
        solver.energy.springs.loads = own
            .map(|(own, row)| {
                let mut load = *own;
                for &(member, share) in &members[row[0] as usize..row[1] as usize] {
                    let wanted = gradient[member as usize];
                    load.iter_mut()
                        .zip(wanted)
                        .for_each(|(load, wanted)| *load -= f64::from(share) * wanted);
                }
                load
            })
            .collect();
        solver.energy.evaluate(&mut solver.current, &solver.energy.springs);
    }

    /// Starts for new motions and takes `steps` steps. Returns the origin of the start: if it is rest, the fine shape
    /// must start from rest too.
    pub fn start(&mut self, motions: &[Motion], steps: u32) -> Origin {
        if let Some(offsets) = self.next_offsets.take() {
            self.solver.set_offsets(&offsets);
        }
        let origin = self.solver.start(motions);
        if origin == Origin::Rest {
            self.followed.clone_from(&self.solver.energy.elements.rest);
        }
        self.go_on(steps);
        origin
    }

    /// Takes up to `steps` steps.
    pub fn go_on(&mut self, steps: u32) {
        for _ in 0..steps {
            if !self.solver.has_converged {
                self.solver.descend();
            }
        }
        if !self.solver.current.energy.is_finite() {
            self.rest();
        }
    }

    /// The turns of the solved fine vertices with the coarse level since they last followed it. `of_handles` are the
    /// turns of the handles; `otherwise` turns vertices without a cluster near. With `weights` the turns exclude those
    /// of the examples.
    pub fn turns(
        &mut self,
        of_handles: &[DQuat],
        weights: Option<&[f64]>,
        otherwise: &(impl Fn(usize) -> DQuat + Sync),
    ) -> Vec<DMat3> {
        let mut turns = self.own_turns(of_handles);
        if let (Some(weights), Some(blending)) = (weights, &self.solver.blending) {
            let blended = blending.turns.blended(weights);
            for (turn, own) in turns.iter_mut().zip(blended) {
                *turn *= own.conjugate();
            }
        }
        self.followed = self.solver.positions();
        self.shares
            .par_iter()
            .enumerate()
            .with_min_len(CHUNK)
            .map(|(vertex, shares)| {
                if shares[0].1 <= 0.0 {
                    return DMat3::from_quat(otherwise(vertex));
                }
                let first = turns[shares[0].0 as usize];
                let mut sum = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
                for &(cell, share) in shares {
                    let other = turns[cell as usize];
                    // Both signs are the same rotation: the blend takes the one nearer to the first.
                    sum += other * f64::from(share).copysign(other.dot(first));
                }
                // Opposed turns may cancel out.
                let sum = if sum.length_squared() > 1e-6 { sum } else { first };
                DMat3::from_quat(sum.normalize())
            })
            .collect()
    }

    /// The turns of all coarse vertices: those that fit their edges best, and their handles'.
    fn own_turns(&self, of_handles: &[DQuat]) -> Vec<DQuat> {
        let elements = &self.solver.energy.elements;
        let mut turns = fitted(elements, &self.followed, &self.solver.positions());
        turns[elements.solved_count..].fill(DQuat::IDENTITY);
        for (local, _, turn) in Prescribed::seen(&self.solver.prescribed, of_handles) {
            turns[local] = *turn;
        }
        turns
    }
}

/// The examples at the clusters' centres.
fn examples_of(examples: &Examples, clusters: &Clusters) -> Examples {
    let restricted = |shape: &ExampleShape| {
        let centres = clusters.centres.iter();
        ExampleShape {
            name: shape.name.clone(),
            displacements: Arc::new(centres.map(|&vertex| shape.displacements[vertex as usize]).collect()),
        }
    };
    Examples {
        shapes: Arc::new(examples.shapes.iter().map(restricted).collect()),
        weights: examples.weights.clone(),
    }
}
