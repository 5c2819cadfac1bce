//! Steps of a large surface that its coarse level leads.
//!
//! For new targets the coarse level steps first and its motion is carried over: that is the frame while a handle is
//! dragged. For unchanged targets corrections by the coarse level alternate with quasi-Newton steps on top of the
//! unfolded energy's factor. Both only lower the energy of the whole surface, so the minimum is that of the whole
//! surface. Near the minimum they gain little: then Newton steps of the whole surface, which cost far more each, settle
//! the shape.

use glam::{DMat3, DQuat, DVec3};
use pliant_mesh::Cancel;

use super::carry::{Base, Carrier, Strains};
use super::coarse::Coarse;
use super::system::{Pattern, System};
use super::unfolded::Preconditioner;
use super::{Blending, Leader, Means, ShellsSolver};
use crate::budget::Budget;
use crate::descent::corrections::Corrections;
use crate::descent::prescribed::Prescribed;
use crate::descent::rule::State;
use crate::handles::Motion;
use crate::handles::blend::{Origin, Screws};
use crate::handles::offsets::Offsets;
use crate::handles::screw::{Screw, carried};
use crate::numerical::sums::Field;

/// Coarse steps for new targets.
const STEPS: u32 = 2;

/// Coarse steps of a correction.
const CORRECTING_STEPS: u32 = 3;

/// The most fine steps between two corrections.
const RAREST: u32 = 32;

/// The shares of a correction that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.2];

/// After this many steps for unchanged targets, Newton steps settle the shape.
const BEFORE_SETTLING: u32 = 24;

/// The most Newton steps for unchanged targets. Limbs take twenty; if a shape has not settled by then, a part of it is
/// drawn out to a thread, and steps go on for minutes.
const MOST_SETTLING: u32 = 60;

/// The state of a large surface's descent.
#[derive(Debug)]
pub(super) struct Led {
    pub preconditioner: Preconditioner,
    pub coarse: Coarse,
    pub carrier: Carrier,
    corrections: Corrections,
    /// The decrease of the last correction.
    corrected: f64,
    /// Steps since the targets changed.
    steps: u32,
    settling: Settling,
    /// The flag that ends a Newton step.
    cancel: Cancel,
}

/// The matrix of the Newton steps that settle a shape. It is analysed at its first use: a drag does not use it.
#[derive(Debug)]
enum Settling {
    /// The pattern, the ends of its supernodes and the memory that it may take.
    NotAnalysed(Pattern, Vec<u32>, Budget),
    Analysed(Box<System>),
    /// The matrix would take too much memory.
    TooLarge,
}

impl Settling {
    fn system(&mut self) -> Option<&mut System> {
        if let Self::NotAnalysed(pattern, ends, budget) = self {
            let system = System::of(pattern, ends, *budget);
            *self = system.map_or(Self::TooLarge, |(system, _)| Self::Analysed(Box::new(system)));
        }
        match self {
            Self::Analysed(system) => Some(system),
            _ => None,
        }
    }
}

impl Led {
    /// The state at rest.
    pub fn new(coarse: Coarse, means: Means) -> Self {
        let Means {
            preconditioner,
            carrier,
            matrix,
        } = means;
        let not_analysed = |(pattern, ends, budget)| Settling::NotAnalysed(pattern, ends, budget);
        Self {
            preconditioner,
            coarse,
            carrier,
            corrections: Corrections::after(0, RAREST),
            corrected: f64::INFINITY,
            steps: 0,
            settling: matrix.map_or(Settling::TooLarge, not_analysed),
            cancel: Cancel::new(),
        }
    }

    /// Forgets the earlier steps.
    pub fn forget(&mut self) {
        self.corrections = Corrections::after(0, RAREST);
        (self.corrected, self.steps) = (f64::INFINITY, 0);
        if let Settling::Analysed(system) = &mut self.settling {
            system.undamp();
        }
    }
}

impl Leader for Led {
    fn start(&mut self, solver: &mut ShellsSolver, motions: &[Motion]) {
        solver.start_led(self, motions);
    }

    fn step(&mut self, solver: &mut ShellsSolver) {
        solver.step_led(self);
    }

    fn rest(&mut self) {
        self.forget();
        self.coarse.rest();
    }

    fn set_weights(&mut self, weights: &[Option<f64>]) {
        self.coarse.set_weights(weights);
    }

    fn set_offsets(&mut self, offsets: &Offsets) {
        self.coarse.set_offsets(offsets);
    }

    fn set_cancel(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
    }

    fn is_settling(&self) -> bool {
        self.steps >= BEFORE_SETTLING
    }

    fn stored(&self) -> usize {
        let of_settling = match &self.settling {
            Settling::Analysed(system) => system.stored(),
            _ => 0,
        };
        self.preconditioner.stored() + self.coarse.stored() + of_settling
    }
}

impl ShellsSolver {
    /// Makes the shape for new motions that the coarse level predicts.
    fn start_led(&mut self, led: &mut Led, motions: &[Motion]) {
        if self.is_at_rest() {
            led.coarse.rest();
        } else if self.is_unstrained() {
            // Its gradient is rounding, and as a load it would move whatever hardly resists.
            led.coarse.follow(&self.current);
        } else if self.has_slopes {
            led.coarse.restrict(&self.current, &self.slopes.energy);
        }
        let Screws { from_rest, onwards, .. } = Screws::of(&self.handles, &self.motions, motions);
        let mut origin = led.coarse.start(motions, STEPS);
        if self.blending.is_some() {
            // The strains that examples give the surface are known at rest.
            origin = Origin::Rest;
            led.coarse.follow_from_rest();
        }
        self.motions.copy_from_slice(motions);
        self.energy.springs.aim(motions);
        self.has_converged = false;
        led.forget();
        self.memory.clear();
        self.has_slopes = false;
        let screws = match origin {
            Origin::Rest => from_rest,
            Origin::Current => onwards,
        };
        let base: Vec<DVec3> = match origin {
            Origin::Rest => self.energy.elements.rest.clone(),
            Origin::Current => self.positions(),
        };
        self.carry(&screws, origin);
        if origin == Origin::Rest {
            self.energy.evaluate(&mut self.trial, &self.energy.springs);
        }
        let weights = led.coarse.weights().to_vec();
        let turns = self.turns(led, &screws, self.blending.as_ref().map(|own| (own, &weights[..])));
        let strains = self.blending.as_ref();
        let strains = strains.map(|own| Strains::of(&self.energy, &own.turns, &weights));
        let base = Base {
            places: &base,
            turns: &turns,
            strains,
        };
        let away = self.away(led, &base);
        let blended = self.trial.clone();
        self.trial.move_by(&away, -1.0);
        if self.blending.is_some() {
            self.trial.weights = weights;
            self.energy.relax_angles(&mut self.trial);
        }
        self.energy.evaluate(&mut self.trial, &self.energy.springs);
        if origin == Origin::Rest && (self.trial.energy.is_nan() || self.trial.energy > blended.energy) {
            self.trial = blended;
        }
        std::mem::swap(&mut self.current, &mut self.trial);
    }

    /// Takes a step towards unchanged motions.
    fn step_led(&mut self, led: &mut Led) {
        if led.is_settling()
            && let Some(system) = led.settling.system()
        {
            self.step_newton(system, &led.cancel);
            if led.cancel.is_cancelled() {
                return;
            }
            led.steps += 1;
            self.has_stalled |= !self.has_converged && led.steps >= BEFORE_SETTLING + MOST_SETTLING;
            return;
        }
        led.steps += 1;
        let before = self.current.energy;
        if led.corrections.is_due() {
            self.correct(led);
            led.corrected = before - self.current.energy;
            led.corrections.corrected(led.corrected, 1.0);
            return;
        }
        let preconditioner = &mut led.preconditioner;
        let lowered = self.lower(|_, _, x| preconditioner.apply(x));
        led.corrections.stepped(lowered.gained);
        let state = self.rule().state(lowered, self.current.energy);
        self.has_stalled = state == State::Stalled;
        if state == State::Converged {
            // It has not converged if the coarse level's last correction gained more.
            self.has_converged = lowered.gained <= 0.0 || led.corrected <= self.tolerance * self.current.energy;
            led.corrections.hurry();
        }
    }

    /// Loads the coarse level with the remaining gradient, lets it step, and follows it as far as that lowers the
    /// energy.
    fn correct(&mut self, led: &mut Led) {
        led.coarse.restrict(&self.current, &self.slopes.energy);
        led.coarse.go_on(CORRECTING_STEPS);
        let turns = self.turns(led, &[], None);
        self.trial.clone_from(&self.current);
        let base = Base {
            places: &self.positions(),
            turns: &turns,
            strains: None,
        };
        let away = self.away(led, &base);
        for share in SHARES {
            self.trial.clone_from(&self.current);
            self.trial.move_by(&away, -share);
            self.energy.evaluate(&mut self.trial, &self.energy.springs);
            if self.trial.energy < self.current.energy {
                std::mem::swap(&mut self.current, &mut self.trial);
                self.learn();
                return;
            }
        }
    }

    pub(super) fn positions(&self) -> Vec<DVec3> {
        let rest = self.energy.elements.rest.iter();
        rest.zip(&self.current.displacements)
            .map(|(rest, moved)| *rest + *moved)
            .collect()
    }

    /// The turn of each local vertex' surroundings: that of its handle or of the coarse level, or, if no cluster is
    /// near, that of the blended `screws` (the identity without screws). With weights of examples the examples' turns
    /// come first, because the coarse level has no sharp folds; it gives only the further turn.
    fn turns(&self, led: &mut Led, screws: &[Screw], examples: Option<(&Blending, &[f64])>) -> Vec<DMat3> {
        let mut of_handles: Vec<DQuat> = screws.iter().map(Screw::turn).collect();
        of_handles.resize(self.motions.len(), DQuat::IDENTITY);
        let (rest, count) = (&self.energy.elements.rest, screws.len());
        let blended = |vertex: usize| {
            let own = &self.weights[vertex * count..(vertex + 1) * count];
            carried(rest[vertex], screws, own).turn.normalize()
        };
        let weights = examples.map(|(_, weights)| weights);
        let mut turns = led.coarse.turns(&of_handles, weights, &blended);
        turns.resize(rest.len(), DMat3::IDENTITY);
        if let Some((blending, weights)) = examples {
            for (turn, own) in turns.iter_mut().zip(blending.turns.blended(weights)) {
                *turn *= DMat3::from_quat(own);
            }
        }
        for (local, _, turn) in Prescribed::seen(&self.prescribed, &of_handles) {
            turns[local] = DMat3::from_quat(*turn);
        }
        turns
    }

    /// The distance of the trial shape's solved vertices from the positions that fit the turned base.
    fn away(&self, led: &mut Led, base: &Base) -> Field {
        let mut away = led.carrier.pull(&self.energy, base, &self.trial);
        led.preconditioner.apply(&mut away);
        away
    }
}
