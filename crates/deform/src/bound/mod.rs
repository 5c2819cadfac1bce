//! A problem bound to a method: new transforms in, displacements out.

mod binding;
mod facts;
mod sections;
mod slides;
mod sliding;
mod slivers;
mod step;
mod target;
mod targets;
mod valley;

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::Cancel;
use rayon::prelude::*;

use self::sections::Sections;
use self::slides::Slides;
use self::slivers::Slivers;
pub use self::step::Step;
pub use self::target::{Target, TurnedMap};
pub use self::valley::{Accuracy, Valley};
use crate::attachment::{check_weights, finite};
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::residual::HandleResidual;
use crate::handles::turns::TurnLimit;
use crate::handles::{FRAME_CHUNK, Handle, Motion, clear};
use crate::method::BoundMethod;
use crate::needs::Solve;
use crate::region::follow::Followers;
use crate::rigid::Part;
use crate::{Attachment, AttachmentRefused, ReusableFactor, SolveError, Warning};

/// A bound problem: everything that does not depend on the handles' transforms is solved.
#[derive(Debug)]
pub struct Bound {
    revision: u64,
    vertex_count: usize,
    free_count: usize,
    handles: Vec<Handle>,
    /// The handles' rest positions, if the method takes places or a handle has sections.
    world_rest: Vec<Vec<DVec3>>,
    takes_places: bool,
    /// The largest difference between the turns of a handle's vertices with which the surface between them turns.
    largest_gap_rad: f64,
    /// True if the method holds hard handles exactly.
    is_exact: bool,
    /// Each handle's weight, if it is soft.
    soft: Vec<Option<f64>>,
    motions: Vec<Motion>,
    /// The offsets of handles' vertices from the motions.
    offsets: Arc<Offsets>,
    /// The displacements of vertices with maps of their own, if the method moves handles as a whole.
    own_ways: Vec<(u32, DVec3)>,
    /// The sections that are bound as handles, if a handle has several.
    sections: Option<Sections>,
    /// The handles that are free along a line, if there are any.
    slides: Option<Box<Slides>>,
    iteration: u32,
    /// The slivers that a linear method's shape may turn over, if there are any.
    slivers: Option<Box<Slivers>>,
    solve: Solve,
    name: &'static str,
    method: Box<dyn BoundMethod>,
    /// The attachment with the method's control points: its name, and its label for a person.
    attachment: Option<(&'static str, &'static str)>,
    /// The weights of the brought examples; `None` for a weight to be found.
    weights: Vec<Option<f64>>,
    followers: Followers,
    /// The rigid parts, if there are any.
    rigid: Option<Box<RigidParts>>,
    turn_limit: Option<TurnLimit>,
    /// The residual of hard handles that the method only fits.
    residual: HandleResidual,
    /// The binding's warnings.
    of_binding: Vec<Warning>,
    /// The binding's warnings that apply with the present targets first, then those about targets that the method can't
    /// follow.
    warnings: Vec<Warning>,
    binding_warnings: usize,
    /// The number of warnings before those about the last step.
    target_warnings: usize,
}

/// The computation of a step: the method's shortest one, or back-substitution.
#[derive(Clone, Copy, Debug)]
enum Way {
    Shortest,
    BackSubstitution,
}

impl Bound {
    /// The data that the next binding can reuse if only a few vertices' roles change. Only linear methods have such a
    /// factor, and it holds little unless [`crate::Problem::rebind`] bound it.
    pub fn reusable_factor(&self) -> Option<ReusableFactor> {
        self.method.reusable_factor()
    }

    fn put_offsets(&mut self, offsets: Arc<Offsets>) {
        self.begin_anew();
        self.method.set_offsets(&offsets);
        if let Some(rigid) = &mut self.rigid {
            rigid.bound.put_offsets(Arc::clone(&offsets));
        }
        self.offsets = offsets;
    }

    /// The next step has new targets.
    fn begin_anew(&mut self) {
        self.iteration = 0;
        if let Some(slides) = &mut self.slides {
            slides.search = None;
        }
    }

    /// Sets the handles' motions. An iterative method continues from its present shape.
    pub(crate) fn put_motions(&mut self, motions: Vec<Motion>) {
        if self.solve == Solve::Direct || motions != self.motions {
            self.iteration = 0;
            if let Some(rigid) = &mut self.rigid {
                rigid.bound.iteration = 0;
            }
        }
        self.motions = motions;
    }

    /// Sets motions that another solve finds and keeps improving: they count as the same targets.
    pub(crate) fn follow(&mut self, motions: Vec<Motion>) {
        self.motions = motions;
    }

    /// Sets the positions to which a person moved the control points of the problem's attachment: one world position
    /// for each. These displacements add to the handles' effect: the control points take them on, and the handles,
    /// which are still met, correct them as little as possible.
    ///
    /// # Errors
    /// A wrong count, a position that is not finite, or a binding without brought control points; the previous places
    /// stay.
    pub fn set_controls(&mut self, moved: &Arc<Vec<DVec3>>) -> Result<(), SolveError> {
        let controls = self.method.controls_mut().filter(|controls| controls.hand.is_some());
        let (Some(controls), Some((_, title))) = (controls, self.attachment) else {
            return Err(SolveError::NoControls);
        };
        let (found, expected) = (moved.len(), controls.rest.len());
        let checked = match found == expected {
            true => finite(moved),
            false => Err(AttachmentRefused::MovedCount { found, expected }),
        };
        checked.map_err(|refused| SolveError::Controls { title, refused })?;
        let is_other = controls.attachment.moved() != Some(moved);
        controls.move_to(Arc::clone(moved));
        if self.solve == Solve::Direct || is_other {
            self.begin_anew();
        }
        self.rigid
            .as_mut()
            .map_or(Ok(()), |rigid| rigid.bound.set_controls(moved))
    }

    /// Sets the weight of each of the problem's examples, as in [`crate::Examples::weights`].
    ///
    /// # Errors
    /// A wrong count, or a weight that is not finite or too large; the previous weights stay.
    pub fn set_weights(&mut self, weights: &[Option<f64>]) -> Result<(), SolveError> {
        let title = self.attachment.map_or("examples", |(_, title)| title);
        let checked = check_weights(weights, self.weights.len());
        checked.map_err(|refused| SolveError::Controls { title, refused })?;
        if self.weights != weights {
            self.begin_anew();
            self.weights = weights.to_vec();
            self.method.set_weights(weights);
        }
        self.rigid
            .as_mut()
            .map_or(Ok(()), |rigid| rigid.bound.set_weights(weights))
    }

    /// The weight of each of the problem's examples that the last step used or found; 0 before the first step.
    pub fn weights(&self) -> &[f64] {
        self.method.weights()
    }

    /// The cage or lattice in force, by its declared name: the problem's, with its points where a person moved them, or
    /// else the one that the method made, at rest. `None` for a method without one.
    pub fn attachment(&self) -> Option<(&'static str, &Attachment)> {
        let (name, _) = self.attachment?;
        Some((name, &self.method.controls()?.attachment))
    }

    /// The positions of its points with the present targets, moved by handles and by hand: world positions, empty for a
    /// method without control points.
    pub fn control_positions(&self) -> Vec<DVec3> {
        match self.method.controls() {
            Some(controls) if self.is_at_rest() => controls.rest.clone(),
            _ => self.method.control_positions(&self.motions),
        }
    }

    /// Returns true if nothing is moved by a handle, by hand or by an example. An example whose weight is to be found
    /// moves nothing by itself.
    pub fn is_at_rest(&self) -> bool {
        let are_moved = self.method.controls().is_some_and(|controls| controls.are_moved());
        let are_weighed = self.weights.iter().flatten().any(|weight| *weight != 0.0);
        !are_moved
            && !are_weighed
            && self.offsets.is_empty()
            && self.own_ways.is_empty()
            && self.motions.iter().all(Motion::is_rest)
    }

    /// One step towards the targets: fills `displacements`, one per surface vertex, in world units.
    ///
    /// A hard handle's vertices get exactly their displacements by its transform; vertices that nothing moves get zero
    /// to the last bit.
    ///
    /// # Errors
    /// A wrong length, or a result that is not finite; `displacements` are then all zero.
    pub fn step(&mut self, displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        self.go(displacements, Way::Shortest)
    }

    /// Sets the flag that ends a long step: once it is raised, a step that only settles the shape for unchanged targets
    /// returns with the shape that it has reached, not finished. A Newton step of a large surface takes seconds.
    pub fn set_cancel(&mut self, cancel: &Cancel) {
        self.method.set_cancel(cancel);
        if let Some(rigid) = &mut self.rigid {
            rigid.bound.set_cancel(cancel);
        }
    }

    /// Like [`Bound::step`], but solves with the factor in f64 instead of using the handle bases. A method without
    /// bases takes an ordinary step.
    ///
    /// # Errors
    /// Those of [`Bound::step`].
    pub fn step_by_back_substitution(&mut self, displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        self.go(displacements, Way::BackSubstitution)
    }

    fn go(&mut self, displacements: &mut [DVec3], way: Way) -> Result<Step, SolveError> {
        let Some(mut slides) = self.slides.take() else {
            return self.frame(displacements, way);
        };
        let step = self.slide_step(&mut slides, displacements, way);
        if step.is_err() {
            slides.search = None;
        }
        self.slides = Some(slides);
        step
    }

    /// Computes the method's displacements, zeros elsewhere, then those of followers; then checks that all are finite.
    fn frame(&mut self, displacements: &mut [DVec3], way: Way) -> Result<Step, SolveError> {
        if displacements.len() != self.vertex_count {
            displacements.fill(DVec3::ZERO);
            return Err(SolveError::OutputLength {
                found: displacements.len(),
                expected: self.vertex_count,
            });
        }
        self.iteration += 1;
        let mut step = Step {
            converged: true,
            finished: true,
            energy: 0.0,
            iteration: self.iteration,
            handle_residual: 0.0,
            is_trial: false,
        };
        if self.is_at_rest() {
            clear(displacements);
            self.rest();
            return Ok(step);
        }
        let motions = &self.motions;
        let stepped = match way {
            Way::Shortest => self.method.step(motions, displacements),
            Way::BackSubstitution => self.method.step_by_back_substitution(motions, displacements),
        };
        let stepped = stepped.inspect_err(|_| displacements.fill(DVec3::ZERO))?;
        step.energy = stepped.energy;
        step.converged = stepped.converged;
        step.finished = step.converged
            || stepped.stalled
            || match self.solve {
                Solve::Direct => true,
                Solve::Iterative { max_iterations } => self.iteration >= max_iterations,
            };
        put(&self.own_ways, displacements);
        self.followers.carry(displacements);
        if let Some(rigid) = &mut self.rigid {
            gate(displacements)?;
            let last = rigid.step(motions, displacements);
            let last = last.inspect_err(|_| displacements.fill(DVec3::ZERO))?;
            put(&self.own_ways, displacements);
            step.energy = last.energy;
            step.converged &= last.converged;
            step.finished &= last.finished;
        }
        if stepped.finite == Finite::Unknown || !self.followers.is_empty() {
            gate(displacements)?;
        }
        // The rigid parts' binding has done it already.
        if let (Some(slivers), None) = (&self.slivers, &self.rigid) {
            slivers.turn_back(displacements);
        }
        step.handle_residual = self.residual.of(motions, displacements);
        self.warnings.truncate(self.target_warnings);
        self.warnings
            .extend(self.residual.warning(step.handle_residual).map(Warning::from));
        let shown = self.rigid.as_ref().map_or(&self.method, |rigid| &rigid.bound.method);
        self.warnings.extend(shown.faults().into_iter().map(Warning::from));
        if !step.energy.is_finite() {
            displacements.fill(DVec3::ZERO);
            return Err(SolveError::EnergyNotFinite);
        }
        Ok(step)
    }

    /// The next step begins at rest, whatever the last targets were. An iterative method otherwise goes on from the shape
    /// of its last step.
    pub fn rest(&mut self) {
        if let Some(slides) = &mut self.slides {
            slides.forget();
        }
        self.method.rest();
        if let Some(rigid) = &mut self.rigid {
            rigid.bound.rest();
        }
    }

    /// Begins the descent to the targets that were just set at a shape: `displacements`, one per surface vertex, in world
    /// units, whose handles' vertices need not be at their targets. Where the method's own start is lower, that stays.
    /// Neighbouring frames of a sequence end at shapes that are close, so the end of one of them is a start from which
    /// another one needs half the steps or fewer; the minimum is the same, to the method's tolerance.
    ///
    /// Returns false, and changes nothing, for a method that takes no start, for slides and rigid parts, and for a wrong
    /// number of displacements or one that is not finite.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use pliant_deform::{Arap, Method, Problem, Role};
    /// use pliant_mesh::{Cancel, Progress, shapes};
    ///
    /// let model = shapes::model(shapes::tube(12, 16, 5.0));
    /// let roles: Vec<Role> = model.surface.positions.iter().map(|p| match p.z {
    ///     z if z < 0.5 => Role::Fixed,
    ///     z if z > 4.5 => Role::Handle(0),
    ///     _ => Role::Free,
    /// }).collect();
    /// let (stiffness, method) = (vec![1.0; roles.len()], Method::from(Arap::default()));
    /// let problem = Problem::new((&model.surface, &model.topology), &roles, &stiffness, &method);
    /// let (progress, cancel) = (Progress::new(), Cancel::new());
    /// let ordering = method.ordering(&model.topology, &progress, &cancel)?;
    /// let end = |angle: f64, start: Option<&[DVec3]>| -> Result<_, Box<dyn std::error::Error>> {
    ///     let mut bound = problem.bind(ordering.as_ref(), &progress, &cancel)?;
    ///     bound.set_targets(&[DAffine3::from_rotation_x(angle)])?;
    ///     assert!(start.is_none_or(|start| bound.begin_at(start)));
    ///     let mut displacements = vec![DVec3::ZERO; roles.len()];
    ///     loop {
    ///         let step = bound.step(&mut displacements)?;
    ///         if step.finished {
    ///             return Ok((displacements, step.iteration));
    ///         }
    ///     }
    /// };
    /// let (neighbour, _) = end(0.60, None)?;
    /// let (_, alone) = end(0.61, None)?;
    /// let (_, led) = end(0.61, Some(&neighbour))?;
    /// assert!(led < alone);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn begin_at(&mut self, displacements: &[DVec3]) -> bool {
        let is_shape = displacements.len() == self.vertex_count && displacements.iter().all(|way| way.is_finite());
        is_shape && self.slides.is_none() && self.rigid.is_none() && self.method.begin_at(&self.motions, displacements)
    }

    /// The energy of any displacements, one per surface vertex, as in [`Step::energy`], with soft handles pulling
    /// towards the present targets; `None` if the method has no energy or the length is wrong.
    pub fn energy_of(&self, displacements: &[DVec3]) -> Option<f64> {
        if displacements.len() != self.vertex_count {
            return None;
        }
        self.method.energy_of(&self.motions, displacements)
    }
}

/// The rigid parts, and the binding in which they are handles.
#[derive(Debug)]
struct RigidParts {
    parts: Vec<Part>,
    /// Displacements of a part, kept from frame to frame.
    moved: Vec<DVec3>,
    bound: Bound,
}

impl RigidParts {
    /// Replaces a shape in which the parts are very stiff by one in which they are rigid.
    ///
    /// # Errors
    /// Those of a step.
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        let winds = motions.iter().any(Motion::is_wound);
        let of_parts = self.parts.iter().zip(&self.bound.motions[motions.len()..]);
        let of_parts: Vec<Motion> = of_parts
            .map(|(part, last)| {
                let motion = part.motion(displacements, &mut self.moved);
                if winds { part.wound(motion, last) } else { motion }
            })
            .collect();
        self.bound.follow([motions, &of_parts].concat());
        let step = self.bound.step(displacements)?;
        // A method that only fits handles bends the parts a little.
        for (part, motion) in self.parts.iter().zip(&of_parts) {
            part.place(motion, displacements);
        }
        Ok(step)
    }
}

/// Puts these displacements in.
fn put(ways: &[(u32, DVec3)], displacements: &mut [DVec3]) {
    for (vertex, way) in ways {
        displacements[*vertex as usize] = *way;
    }
}

/// Every result passes through here, so that none with a non-finite displacement is returned.
fn gate(displacements: &mut [DVec3]) -> Result<(), SolveError> {
    // Beyond the root of the largest number the energy overflows. Any value that can be measured is finite.
    let is_measurable = displacements.par_chunks(FRAME_CHUNK).all(|chunk| {
        chunk
            .iter()
            .all(|displacement| displacement.length_squared().is_finite())
    });
    if is_measurable {
        return Ok(());
    }
    if displacements.iter().all(|displacement| displacement.is_finite()) {
        displacements.fill(DVec3::ZERO);
        return Err(SolveError::EnergyNotFinite);
    }
    let vertex = displacements
        .iter()
        .position(|displacement| !displacement.is_finite())
        .unwrap_or_default();
    displacements.fill(DVec3::ZERO);
    Err(SolveError::NotFinite { vertex: vertex as u32 })
}
