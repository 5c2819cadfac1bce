//! Steps during which free handles slide to where the energy is least.

use glam::DVec3;

use super::slides::{FreeHandle, Slides};
use super::step::Step;
use super::{Bound, Way};
use crate::handles::Motion;
use crate::needs::Solve;
use crate::{SolveError, Warning};

impl Bound {
    /// Lets handles slide along lines: a handle with a world direction is held only across it, and a step moves it along
    /// it, from its target, to where the energy is least. A handle with `None` or without an entry is held in all
    /// directions, and so is one whose vertices have targets of their own. An iterative method tries places as long as
    /// its steps are not finished.
    ///
    /// # Errors
    /// A direction without length, or one that is not finite; the previous directions stay.
    pub fn set_free_along(&mut self, world_directions: &[Option<DVec3>]) -> Result<(), SolveError> {
        let mut directions = Vec::new();
        for (handle, direction) in world_directions.iter().enumerate() {
            let Some(direction) = direction else { continue };
            let unit = direction.try_normalize().filter(|unit| unit.is_finite());
            directions.push((handle, unit.ok_or(SolveError::NoDirection { handle })?));
        }
        let before = self.slides.take();
        let former = before.as_ref().map_or(&[][..], |before| &before.free);
        if former
            .iter()
            .map(|free| (free.handle, free.direction))
            .eq(directions.iter().copied())
        {
            self.slides = before;
            return Ok(());
        }
        let reached = |handle| former.iter().find(|free| free.handle == handle)?.reached;
        let free = directions.iter().map(|&(handle, direction)| FreeHandle {
            handle,
            direction,
            bound: self.bound_as(handle),
            distance: 0.0,
            reached: reached(handle),
        });
        let free: Vec<FreeHandle> = free.collect();
        let (given, placed) = match before {
            Some(before) => (before.given, before.placed),
            None => (self.motions.clone(), Vec::new()),
        };
        self.put_motions(given.clone());
        self.slides = (!free.is_empty()).then(|| {
            Box::new(Slides {
                free,
                given,
                placed,
                search: None,
            })
        });
        Ok(())
    }

    /// The distance by which the last step slid a handle from its target along its direction, in world units; 0 for one
    /// that is held.
    pub fn slide(&self, handle: usize) -> f64 {
        let mut free = self.slides.iter().flat_map(|slides| &slides.free);
        free.find(|free| free.handle == handle)
            .map_or(0.0, |free| free.distance)
    }

    /// The motions for new targets: those of the running search, if these are its targets.
    pub(super) fn slid(&mut self, given: Vec<Motion>, placed: &[bool]) -> Vec<Motion> {
        let Some(slides) = &mut self.slides else { return given };
        if slides.search.is_some() && slides.given == given && slides.placed == placed {
            return self.motions.clone();
        }
        slides.search = None;
        slides.placed = placed.to_vec();
        slides.given.clone_from(&given);
        given
    }

    /// A step of the search, or one at its end.
    ///
    /// # Errors
    /// Those of a step.
    pub(super) fn slide_step(
        &mut self,
        slides: &mut Slides,
        displacements: &mut [DVec3],
        way: Way,
    ) -> Result<Step, SolveError> {
        let is_direct = self.solve == Solve::Direct;
        if is_direct || slides.search.is_none() {
            self.put_motions(slides.given.clone());
            match self.is_at_rest() {
                true => slides.forget(),
                false => slides.begin(&self.handles, is_direct),
            }
        }
        let mut result = None;
        while slides.is_searching() {
            self.put_motions(slides.motions());
            let step = self.frame(displacements, way)?;
            if slides.is_judged(&step) {
                slides.take(step, (!is_direct).then_some(displacements));
            }
            let Some(search) = &slides.search else { break };
            let is_found = search.valley.is_found();
            let (shown, is_trial) = match &search.lowest {
                Some((lowest, shape)) if !is_found => {
                    displacements.copy_from_slice(shape);
                    (lowest, true)
                }
                _ => (&step, false),
            };
            result = Some(Step {
                is_trial,
                converged: is_found && shown.converged,
                finished: is_found && shown.finished,
                iteration: search.steps,
                ..*shown
            });
            if !is_direct {
                break;
            }
        }
        let step = match result {
            Some(step) => step,
            None => self.settled_frame(slides, displacements, way)?,
        };
        if slides.is_undecided() {
            let free = slides.free.iter();
            self.warnings
                .extend(free.map(|free| Warning::of_handle(free.handle, undecided)));
        }
        Ok(step)
    }

    /// A step at the end of the search, which takes the shape there to its own end.
    fn settled_frame(
        &mut self,
        slides: &mut Slides,
        displacements: &mut [DVec3],
        way: Way,
    ) -> Result<Step, SolveError> {
        let mut step = self.frame(displacements, way)?;
        if let Some(search) = &mut slides.search {
            search.steps += 1;
            step.iteration = search.steps;
        }
        Ok(step)
    }

    /// The bound handles that a handle is: one, or its sections.
    fn bound_as(&self, handle: usize) -> Vec<usize> {
        let Some(sections) = &self.sections else {
            return vec![handle];
        };
        let numbers = sections.handle_of.iter().enumerate();
        numbers
            .filter(|(_, of)| **of == handle)
            .map(|(number, _)| number)
            .collect()
    }
}

fn undecided(handle: &str) -> String {
    format!(
        "no energy chooses the place of {handle} along its free direction, so it stays where its transform puts it: hold \
         it in all directions, or take another method"
    )
}
