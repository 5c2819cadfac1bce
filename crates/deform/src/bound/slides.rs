//! Handles that are free along a line, and the search for their places on it.
//!
//! A handle that is dragged in the plane of a picture is held only in the two directions that are seen. Its translation
//! is d + t r, where r is the direction of sight, and t is chosen so that the energy E(t) of the bent surface is least.
//! There the reaction dE/dt of the surface, the sum of its forces on the handle's vertices along r, vanishes.
//!
//! The energy of the finished shape is all that a method must know, so this holds for every method with an energy. An
//! iterative method goes on from shape to shape; until a lower one is found, the lowest so far stays visible.

use glam::DVec3;

use super::step::Step;
use super::valley::{Accuracy, Valley};
use crate::handles::{Handle, Motion};

/// A place is judged once this many steps in a row ..
const LEVEL_STEPS: u32 = 4;

/// .. lower the energy by less than this share, which is an error of the place far below the tolerance of the search.
const LEVEL: f64 = 1e-5;

/// A handle that is free along a line.
#[derive(Debug)]
pub(super) struct FreeHandle {
    /// Its number.
    pub handle: usize,
    /// A unit vector.
    pub direction: DVec3,
    /// The bound handles that it is.
    pub bound: Vec<usize>,
    /// Its distance from its given place.
    pub distance: f64,
    /// Its translation at the end of the last search.
    pub reached: Option<DVec3>,
}

/// The free handles, and the targets from which they slide.
#[derive(Debug)]
pub(super) struct Slides {
    pub free: Vec<FreeHandle>,
    /// The motions without slides.
    pub given: Vec<Motion>,
    /// The bound handles whose vertices have places of their own, which are held.
    pub placed: Vec<bool>,
    pub search: Option<Search>,
}

/// A search for given targets.
#[derive(Debug)]
pub(super) struct Search {
    pub valley: Valley,
    /// The lowest shape so far and its step, of an iterative method.
    pub lowest: Option<(Step, Vec<DVec3>)>,
    /// The number of steps so far.
    pub steps: u32,
    /// The energy of the last step at the point, and the number of steps that have hardly lowered it.
    level: (f64, u32),
    /// True if a shape had an energy.
    pub has_energy: bool,
}

impl Slides {
    /// Begins a search from the given targets, or, of an iterative method, from where the last search has ended. If no
    /// handle moves, there is none.
    pub fn begin(&mut self, handles: &[Handle], is_direct: bool) {
        let motion = self.given.iter().map(extent).fold(0.0, f64::max);
        self.free.iter_mut().for_each(|free| free.distance = 0.0);
        self.search = None;
        if motion == 0.0 {
            return;
        }
        let from = self.free.iter().map(|free| {
            let reached = free.reached.filter(|_| !is_direct);
            let given = free.bound.first().and_then(|own| self.given.get(*own));
            let way = reached.zip(given).map(|(reached, given)| reached - given.shift);
            way.map_or(0.0, |way| free.direction.dot(way))
        });
        let accuracy = Accuracy::of(motion, distance(handles), is_direct);
        self.search = Some(Search {
            valley: Valley::new(from.collect(), accuracy),
            lowest: None,
            steps: 0,
            level: (f64::INFINITY, 0),
            has_energy: false,
        });
    }

    /// Returns true if handles slide to their places, and are not there yet.
    pub fn is_searching(&self) -> bool {
        self.search.as_ref().is_some_and(|search| !search.valley.is_found())
    }

    /// The next step begins another search, where the given targets are.
    pub fn forget(&mut self) {
        self.search = None;
        for free in &mut self.free {
            (free.distance, free.reached) = (0.0, None);
        }
    }

    /// Returns true if the search has ended, and no shape had an energy.
    pub fn is_undecided(&self) -> bool {
        let search = self.search.as_ref();
        search.is_some_and(|search| search.valley.is_found() && !search.has_energy)
    }

    /// The motions at the search's point.
    pub fn motions(&self) -> Vec<Motion> {
        let mut motions = self.given.clone();
        let Some(search) = &self.search else { return motions };
        for (free, by) in self.free.iter().zip(search.valley.point()) {
            for &own in &free.bound {
                if !self.placed.get(own).is_some_and(|placed| *placed)
                    && let Some(motion) = motions.get_mut(own)
                {
                    motion.shift += free.direction * by;
                }
            }
        }
        motions
    }

    /// Takes a step at the search's point. Returns true if the shape there is good enough to judge the place.
    pub fn is_judged(&mut self, step: &Step) -> bool {
        let Some(search) = &mut self.search else { return true };
        search.steps += 1;
        let (before, count) = search.level;
        let is_level = before - step.energy <= LEVEL * step.energy;
        search.level = (step.energy, if is_level { count + 1 } else { 0 });
        step.finished || search.level.1 >= LEVEL_STEPS
    }

    /// Takes a judged shape at the search's point. `displacements` are those of an iterative method, which shows its
    /// lowest shape.
    pub fn take(&mut self, step: Step, displacements: Option<&[DVec3]>) {
        let Some(search) = &mut self.search else { return };
        let point = search.valley.point();
        search.level = (f64::INFINITY, 0);
        search.has_energy |= step.energy > 0.0;
        if !search.valley.take(step.energy) {
            return;
        }
        search.lowest = displacements.map(|own| (step, own.to_vec()));
        for (free, by) in self.free.iter_mut().zip(point) {
            free.distance = by;
            let given = free.bound.first().and_then(|own| self.given.get(*own));
            free.reached = given.map(|given| given.shift + free.direction * by);
        }
    }
}

/// The largest displacement of a handle by a motion, about.
fn extent(motion: &Motion) -> f64 {
    let linear = motion.linear;
    let turn = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::length);
    motion.shift.length() + turn.into_iter().fold(0.0, f64::max)
}

/// The largest distance between handles, or the radius of the largest one.
fn distance(handles: &[Handle]) -> f64 {
    let first = handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
    let distances = handles
        .iter()
        .map(|handle| handle.radius.max(handle.world_centre.distance(first)));
    distances.fold(f64::MIN_POSITIVE, f64::max)
}
