//! The coarse level of a large surface, which predicts its shape in a fraction of the time.
//!
//! It has the same energy on a surface of clusters, and dead loads that make its gradient equal to that of the fine
//! shape it was last restricted from (the full approximation scheme of [Bra77], as optimisation [Nas00]): at the fine
//! minimum it does not move, and otherwise its motion is a correction. Only rotations are prolongated. Each fine cell
//! turns with the coarse cells around it, and one global step (see `lead`) moves the vertices accordingly, so that the
//! clusters are invisible and the details of the fine shape stay.

use glam::Quat;
use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use super::ArapSolver;
use super::cells::vector;
use super::history::Field;
use super::shape::{Guesses, IDENTITY, Rotation, Shape, wide};
use crate::coarse::clustered::{Share, Shares, on_clusters, shares, transposed};
use crate::coarse::clusters::Clusters;
use crate::coarse::domain::{ABSENT, Domain};
use crate::descent::rule::State;
use crate::handles::blend::Origin;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::{Arap, Method, Ordering};

/// The fewest vertices of a cluster: smaller clusters are less stiff against bending and closer to the fine surface,
/// but more expensive. At the end of a drag of a scan of 173k vertices the energy is 4% above the minimum with 12, 5%
/// with 16, 3% with 8 and 2% with 4; without a coarse level it is 62%.
const CLUSTER: f64 = 12.0;

/// The approximate limit of the number of clusters, so that steps of the coarse level fit into a frame.
const MOST: f64 = 25_000.0;

/// The level's own solver, and how it is connected with the fine one.
#[derive(Debug)]
pub(crate) struct Coarse {
    solver: Box<ArapSolver>,
    /// The coarse cells near each fine cell, with shares; they sum to 1, or are 0 if no coarse cell is near.
    shares: Vec<Shares>,
    leads_all: bool,
    /// The start of each solved coarse vertex' row in `members`; one more at the end.
    offsets: Vec<u32>,
    /// The solved fine vertices with a share in it, and that share.
    members: Vec<Share>,
    /// The fine local vertex at each solved coarse vertex.
    fine_of: Vec<u32>,
    /// Each coarse vertex's surface vertex.
    centres: Vec<u32>,
    next_offsets: Option<Offsets>,
    /// The coarse rotations that were last prolongated.
    followed: Vec<Rotation>,
}

impl Coarse {
    /// The level for the bound `fine` domain of `problem`; `None` if no coarse level can be made.
    pub fn of(
        problem: &BoundaryProblem,
        options: &Arap,
        handles: &[Handle],
        fine: &Domain,
        cancel: &Cancel,
    ) -> Option<Self> {
        let size = CLUSTER.max(fine.vertices.len() as f64 / MOST);
        let clusters = Clusters::of(problem, fine, handles, size);
        let mut own = options.clone();
        own.coarse_above = usize::MAX;
        let method = Method::from(own.clone());
        let progress = Progress::new();
        let ordering = Ordering::of(&clusters.topology, own.operator_power(), &progress, cancel).ok()?;
        let solver = on_clusters(
            problem,
            &clusters,
            &method,
            None,
            handles,
            |coarse, partition, handles| {
                ArapSolver::bind(coarse, &own, &partition, handles, &ordering, &progress, cancel).ok()
            },
        )?;
        let domain = &solver.domain;
        if domain.solved_count == 0 {
            return None;
        }
        let cell = |cluster: u32| {
            let local = domain.local_of[cluster as usize];
            ((local as usize) < domain.cell_count).then_some(local)
        };
        let shares: Vec<Shares> = fine.vertices[..fine.cell_count]
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&vertex| shares(problem, &clusters, &cell, vertex))
            .collect();
        let (offsets, members) = transposed(&shares[..fine.solved_count], domain.solved_count);
        let fine_of = domain.vertices[..domain.solved_count]
            .iter()
            .map(|&v| fine.local_of[clusters.centres[v as usize] as usize])
            .collect();
        Some(Self {
            followed: solver.current.rotations.clone(),
            solver: Box::new(solver),
            leads_all: shares.iter().all(|shares| shares[0].1 > 0.0),
            shares,
            offsets,
            members,
            fine_of,
            centres: clusters.centres,
            next_offsets: None,
        })
    }

    /// Returns true if every fine cell has a coarse one near it; small parts may have none.
    pub fn leads_all(&self) -> bool {
        self.leads_all
    }

    /// The number of entries that its factor stores.
    pub fn factor_len(&self) -> usize {
        self.solver.factor_len()
    }

    /// Sets the offsets of handles' vertices from the motions. They take effect with [`Coarse::aim`], because a
    /// restriction before it still uses the offsets of the fine shape.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        self.next_offsets = Some(offsets.of((0..).zip(self.centres.iter().copied())));
    }

    /// Passes the offsets that were set last to the solver.
    pub fn aim(&mut self) {
        if let Some(offsets) = self.next_offsets.take() {
            self.solver.set_offsets(&offsets);
        }
    }

    /// Returns to the rest shape.
    pub fn rest(&mut self) {
        self.solver.rest();
        self.followed.fill(IDENTITY);
    }

    /// Restricts the fine shape for `motions`, whose gradient in `unit` is known: every centre takes its fine position,
    /// and the loads make the coarse gradient equal to the fine one.
    pub fn restrict(&mut self, fine: &Shape, unit: f64, motions: &[Motion]) {
        let solver = &mut *self.solver;
        solver.leave(motions);
        for (own, &place) in solver.current.displacements.iter_mut().zip(&self.fine_of) {
            if place != ABSENT {
                *own = fine.displacements[place as usize];
            }
        }
        solver.current.place(&solver.prescribed, motions);
        solver.springs.loads.clear();
        let ArapSolver {
            cells,
            springs,
            current,
            scratch,
            ..
        } = solver;
        cells.evaluate(current, Guesses::Own, scratch);
        current.add_energy_of(springs);
        current.add_gradient_of(springs);
        let (offsets, members) = (&self.offsets, &self.members);
        let units = (unit / cells.unit()) as f32;
        let gathered = |vertex: usize| {
            let mut sum = [0.0; 3];
            for &(member, share) in &members[offsets[vertex] as usize..offsets[vertex + 1] as usize] {
                for (sum, own) in sum.iter_mut().zip(fine.gradient[member as usize]) {
                    *sum += share * own;
                }
            }
            sum.map(|value| value * units)
        };
        let wanted: Field = (0..current.gradient.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(gathered)
            .collect();
        springs.loads = current
            .gradient
            .iter()
            .zip(&wanted)
            .map(|(own, wanted)| std::array::from_fn(|k| own[k] - wanted[k]))
            .collect();
        current.gradient = wanted;
        current.energy += springs.load_energy(|vertex| vector(current.displacements[vertex]));
        solver.state = State::Descending;
        self.followed.copy_from_slice(&current.rotations);
    }

    /// Starts for new motions and takes `steps` steps. Returns its start: if that is the rest shape, the fine shape
    /// must start from rest too.
    pub fn start(&mut self, motions: &[Motion], steps: u32) -> Origin {
        let origin = self.solver.start(motions);
        if origin == Origin::Rest {
            self.followed.fill(IDENTITY);
        }
        self.go_on(steps);
        origin
    }

    /// Takes up to `steps` steps.
    pub fn go_on(&mut self, steps: u32) {
        for _ in 0..steps {
            if self.solver.state == State::Descending {
                self.solver.descend();
            }
        }
        if !self.solver.current.energy.is_finite() {
            // These rotations are not prolongated; the level continues from the next restriction.
            self.rest();
        }
    }

    /// Turns the fine cells with the coarse ones, `from` being their rotations at the last restriction; fine cells
    /// without a coarse cell near keep their rotations in `to`.
    pub fn turn(&mut self, from: &[Rotation], to: &mut [Rotation]) {
        let rotations = &self.solver.current.rotations;
        let turn = |(now, before): (&Rotation, &Rotation)| (wide(*now) * wide(*before).conjugate()).as_quat();
        let turns: Vec<Quat> = rotations.iter().zip(&self.followed).map(turn).collect();
        self.followed.copy_from_slice(rotations);
        to.par_chunks_mut(CHUNK)
            .zip(from.par_chunks(CHUNK))
            .zip(self.shares.par_chunks(CHUNK))
            .for_each(|((to, from), shares)| {
                let turned = to.iter_mut().zip(from).zip(shares);
                for ((to, from), shares) in turned.filter(|(_, shares)| shares[0].1 > 0.0) {
                    let first = turns[shares[0].0 as usize];
                    let mut sum = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
                    for &(cell, share) in shares {
                        let other = turns[cell as usize];
                        // Both signs are the same rotation: the one nearer to the first is blended.
                        sum += other * share.copysign(other.dot(first));
                    }
                    // Opposed turns may cancel out.
                    let sum = if sum.length_squared() > 1e-6 {
                        sum
                    } else {
                        Quat::IDENTITY
                    };
                    *to = (sum * Quat::from_array(*from)).normalize().to_array();
                }
            });
    }
}
