//! Bending: the one way from targets to the visible shape, for the window's frames and for saved files.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Accuracy, Attachment, Bound, Solve, SolveError, Step, Target, Valley};
use pliant_mesh::Cancel;

use crate::document::{HandleCurve, HandleId, KeptShape};
use crate::lines::Lines;

/// A frame takes steps for this many vertices before it shows its shape: about as many as fit into its time. There is
/// no clock here.
const VERTEX_STEPS: usize = 100_000;

/// The most steps of one frame, even with few vertices.
const MOST_STEPS: usize = 16;

/// In a frame this many steps that change nothing visible count as one.
const TRIALS: usize = 4;

/// In a frame the solution at a kept shape gets this many times the steps of another: it is so close to the end of the
/// descent that the drag hides the rest.
const MOST_FIRST_ROUNDS: usize = 8;

/// The targets of handles and control points, and the weights of the examples.
#[derive(Clone, Debug)]
pub struct Targets {
    /// The map of each handle.
    handles: Vec<DAffine3>,
    /// The lines that handles follow first.
    lines: Lines,
    /// The share of the lines' way.
    line_share: f64,
    /// The free direction of each handle that has one.
    free_along: Vec<Option<DVec3>>,
    /// The places of the vertices of handles that are held there, whatever their maps, by the handles' numbers.
    held: Vec<(usize, Arc<Vec<DVec3>>)>,
    /// The positions of the brought control points, moved by hand.
    controls: Option<Arc<Vec<DVec3>>>,
    /// The weights of the examples, `None` for one to be found.
    weights: Vec<Option<f64>>,
}

impl Targets {
    /// The handles' maps, and the attachment of the method, if one was brought.
    pub fn new(handles: Vec<DAffine3>, attachment: Option<&Attachment>) -> Self {
        Self {
            handles,
            lines: Lines::default(),
            line_share: 1.0,
            free_along: Vec::new(),
            held: Vec::new(),
            controls: attachment.and_then(Attachment::moved).cloned(),
            weights: match attachment {
                Some(Attachment::Shapes(examples)) => examples.weights.clone(),
                _ => Vec::new(),
            },
        }
    }

    /// The same with handles that follow lines by a share of their way before their maps move them.
    #[must_use]
    pub fn along(self, lines: &Lines, share: f64) -> Self {
        Self {
            lines: lines.clone(),
            line_share: share,
            ..self
        }
    }

    /// The same with handles that slide along these directions.
    #[must_use]
    pub fn free_along(self, directions: Vec<Option<DVec3>>) -> Self {
        Self {
            free_along: directions,
            ..self
        }
    }

    /// The same with handles whose vertices are held at places, by the handles' numbers.
    #[must_use]
    pub(crate) fn holding(self, held: Vec<(usize, Arc<Vec<DVec3>>)>) -> Self {
        Self { held, ..self }
    }

    /// The same after the free points of curves have slid by these lengths.
    fn slid(&self, lengths: &[f64]) -> Self {
        Self {
            lines: self.lines.slid(lengths),
            ..self.clone()
        }
    }

    /// Takes an iterative method that rests towards lines that turn far, in steps: it would not see full turns. Every
    /// other binding stays as it is. `displacements` has one entry per surface vertex.
    ///
    /// # Errors
    /// Those of [`Targets::set`] and [`Bound::step`].
    pub fn lead(&self, bound: &mut Bound, displacements: &mut [DVec3], cancel: &Cancel) -> Result<(), SolveError> {
        let is_led = bound.is_at_rest() && bound.solve() != Solve::Direct;
        let count = if is_led { self.lines.steps(self.line_share) } else { 1 };
        for step in 1..count {
            let share = self.line_share * step as f64 / count as f64;
            let led = self.clone().along(&self.lines, share).free_along(Vec::new());
            led.set(bound)?;
            settle(bound, displacements, Until::Frame.steps(bound), cancel)?;
            if cancel.is_cancelled() {
                break;
            }
        }
        Ok(())
    }

    /// Gives them to a binding.
    ///
    /// # Errors
    /// Those of [`Bound::set_free_along`], [`Bound::set_places`], [`Bound::set_weights`] and [`Bound::set_controls`].
    pub fn set(&self, bound: &mut Bound) -> Result<(), SolveError> {
        bound.set_free_along(&self.free_along)?;
        match self.lines.is_empty() && self.held.is_empty() {
            true => bound.set_targets(&self.handles)?,
            false => {
                let mut targets = self.lines.targets(&self.handles, self.line_share);
                for (handle, places) in &self.held {
                    targets[*handle] = Target::Places(places.to_vec());
                }
                bound.set_places(&targets)?;
            }
        }
        // Examples of another method do not apply to this one.
        if bound.weights().len() == self.weights.len() {
            bound.set_weights(&self.weights)?;
        }
        self.controls.as_ref().map_or(Ok(()), |moved| bound.set_controls(moved))
    }
}

/// The end of a solve.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Until {
    /// A shape is worth showing.
    Frame,
    /// The shape has converged, or met the limit of the method's options.
    End,
}

impl Until {
    /// The most steps of a solve.
    fn steps(self, bound: &Bound) -> usize {
        match self {
            Self::Frame => (VERTEX_STEPS / bound.step_cost().max(1)).clamp(1, MOST_STEPS),
            Self::End => usize::MAX,
        }
    }

    /// The most solves for a kept shape's own targets.
    fn first_rounds(self) -> usize {
        match self {
            Self::Frame => MOST_FIRST_ROUNDS,
            Self::End => 1,
        }
    }
}

/// The visible shape at the last change of the constraints or correction by hand.
#[derive(Clone, PartialEq, Debug)]
pub struct Kept {
    /// The shape, as displacements from the rest shape.
    pub shape: Arc<KeptShape>,
    /// The handles' maps at that time.
    pub targets: Vec<DAffine3>,
    /// The curve of each handle at that time, if it has one.
    pub curves: Vec<Option<HandleCurve>>,
}

impl Kept {
    /// `None` for a handle that did not exist yet.
    pub(crate) fn of(shape: &Arc<KeptShape>, handles: impl Iterator<Item = HandleId>) -> Option<Self> {
        let own = handles.map(|id| Some((*shape.targets.get(&id)?, shape.curves.get(&id).cloned())));
        let own: Option<Vec<_>> = own.collect();
        let (targets, curves) = own?.into_iter().unzip();
        Some(Self {
            shape: Arc::clone(shape),
            targets,
            curves,
        })
    }

    /// Solves for its own targets. `present` has the control points for a shape that was kept with those of another
    /// method or with none.
    fn solved(
        self,
        bound: &mut Bound,
        present: &Targets,
        until: Until,
        cancel: &Cancel,
    ) -> Result<Carried, SolveError> {
        let own = &self.shape.controls;
        let is_same = |kept: &&Arc<Vec<DVec3>>| present.controls.as_ref().is_some_and(|own| own.len() == kept.len());
        let first = Targets {
            handles: self.targets,
            lines: present
                .lines
                .moved(|handle| self.curves.get(handle)?.as_ref())
                .slid(&[]),
            line_share: present.line_share,
            free_along: Vec::new(),
            held: Vec::new(),
            controls: own.as_ref().filter(is_same).or(present.controls.as_ref()).cloned(),
            weights: self.shape.weights.clone(),
        };
        let mut solution = self.shape.shape.to_vec();
        for _ in 0..until.first_rounds() {
            if steps(bound, &first, &mut solution, until, cancel)?.finished || cancel.is_cancelled() {
                break;
            }
        }
        let at_first = Arc::new(solution);
        Ok(Carried {
            corrections: None,
            shown: Arc::clone(&self.shape.shape),
            kept: self.shape,
            solution: Arc::clone(&at_first),
            at_first,
        })
    }
}

/// The state from which a solve with a kept shape continues.
#[derive(Clone, Debug)]
pub struct Carried {
    /// The kept shape.
    pub(crate) kept: Arc<KeptShape>,
    /// The solution for the transforms of the kept shape.
    pub(crate) at_first: Arc<Vec<DVec3>>,
    /// The solution for the present transforms, without the residual.
    pub(crate) solution: Arc<Vec<DVec3>>,
    /// The shown shape.
    pub(crate) shown: Arc<Vec<DVec3>>,
    /// The part of it that was corrected by hand.
    pub(crate) corrections: Option<Arc<Vec<DVec3>>>,
}

/// The start of a solve.
#[derive(Clone, Debug)]
pub enum Start {
    /// This shape, as displacements from the rest shape.
    Shape(Arc<Vec<DVec3>>),
    /// A kept shape for the first time: its solution must be found, with its own targets.
    Kept(Kept),
    /// The last solution, with the residual.
    Carried(Carried),
}

/// The result of a solve.
#[derive(Debug)]
pub struct Bent {
    /// The visible shape, as displacements from the rest shape.
    pub shown: Arc<Vec<DVec3>>,
    /// The start of the next solve, if a shape was kept.
    pub(crate) carried: Option<Carried>,
    /// The progress of the descent.
    pub step: Step,
    /// The lengths by which the free points of curves slid, by the handles' numbers.
    pub(crate) slides: Vec<(usize, f64)>,
}

impl Start {
    /// The start of a replay: with a kept shape its solution for these targets, the last of the replay, is found, and
    /// the replay goes on from rest.
    ///
    /// # Errors
    /// Those of [`Start::bend`].
    pub fn replay(
        kept: Option<Kept>,
        bound: &mut Bound,
        targets: &Targets,
        cancel: &Cancel,
    ) -> Result<Self, SolveError> {
        let rest = Arc::new(vec![DVec3::ZERO; bound.vertex_count()]);
        Ok(match kept {
            None => Self::Shape(rest),
            Some(kept) => Self::Carried(Carried {
                solution: rest,
                ..kept.solved(bound, targets, Until::End, cancel)?
            }),
        })
    }

    /// Bends to the end towards the targets, independent of all that was bent before with this binding.
    ///
    /// # Errors
    /// Those of [`Start::bend`].
    pub fn bend_anew(self, bound: &mut Bound, targets: &Targets, cancel: &Cancel) -> Result<Bent, SolveError> {
        bound.rest();
        self.bend(bound, targets, Until::End, cancel)
    }

    /// Bends towards the targets. Stops after the step during which `cancel` was raised.
    ///
    /// # Errors
    /// Those of [`Targets::set`] and [`Bound::step`].
    pub fn bend(self, bound: &mut Bound, targets: &Targets, until: Until, cancel: &Cancel) -> Result<Bent, SolveError> {
        let carried = match self {
            Self::Shape(shape) => {
                let mut solution = Arc::unwrap_or_clone(shape);
                let (step, slides) = slid_steps(bound, targets, &mut solution, until, cancel)?;
                return Ok(Bent {
                    shown: Arc::new(solution),
                    carried: None,
                    step,
                    slides,
                });
            }
            Self::Kept(kept) => kept.solved(bound, targets, until, cancel)?,
            Self::Carried(carried) => carried,
        };
        let Carried {
            kept,
            at_first,
            solution,
            ..
        } = carried;
        let mut solution = Arc::unwrap_or_clone(solution);
        let (step, slides) = slid_steps(bound, targets, &mut solution, until, cancel)?;
        let shown = Arc::new(kept.carried(&at_first, &solution));
        let carried = Carried {
            corrections: kept.corrections_left(&at_first, &solution),
            kept,
            at_first,
            solution: Arc::new(solution),
            shown: Arc::clone(&shown),
        };
        Ok(Bent {
            shown,
            carried: Some(carried),
            step,
            slides,
        })
    }
}

impl Bent {
    /// The start of the next solve.
    pub fn next(self) -> Start {
        match self.carried {
            Some(carried) => Start::Carried(carried),
            None => Start::Shape(self.shown),
        }
    }
}

/// Takes steps towards the targets; once they have finished, the free points of curves slide to where the energy of the
/// finished shape is least. Returns also their lengths, by the handles' numbers.
fn slid_steps(
    bound: &mut Bound,
    targets: &Targets,
    displacements: &mut [DVec3],
    until: Until,
    cancel: &Cancel,
) -> Result<(Step, Vec<(usize, f64)>), SolveError> {
    let mut step = steps(bound, targets, displacements, until, cancel)?;
    let free: Vec<(usize, &HandleCurve)> = targets.lines.free_curves().collect();
    // A part of the edit leaves the whole edit as it is.
    if free.is_empty() || targets.line_share != 1.0 || !step.finished || step.energy == 0.0 {
        return Ok((step, Vec::new()));
    }
    let motion = free.iter().map(|(_, curve)| curve.largest_way()).fold(0.0, f64::max);
    let distance = free.iter().map(|(_, curve)| curve.rest().length()).fold(0.0, f64::max);
    let accuracy = Accuracy::of(motion, distance, bound.solve() == Solve::Direct);
    let mut valley = Valley::new(vec![0.0; free.len()], accuracy);
    let mut lowest = displacements.to_vec();
    valley.take(step.energy);
    while !valley.is_found() {
        let slid = targets.slid(&valley.point());
        let tried = steps(bound, &slid, displacements, Until::End, cancel)?;
        if cancel.is_cancelled() {
            // Newer targets wait.
            displacements.copy_from_slice(&lowest);
            step.finished = false;
            return Ok((step, Vec::new()));
        }
        if valley.take(tried.energy) {
            lowest.copy_from_slice(displacements);
        } else {
            displacements.copy_from_slice(&lowest);
        }
    }
    let found = valley.point();
    let step = steps(bound, &targets.slid(&found), displacements, Until::End, cancel)?;
    Ok((step, free.into_iter().map(|(handle, _)| handle).zip(found).collect()))
}

/// Takes steps towards the targets.
fn steps(
    bound: &mut Bound,
    targets: &Targets,
    displacements: &mut [DVec3],
    until: Until,
    cancel: &Cancel,
) -> Result<Step, SolveError> {
    targets.lead(bound, displacements, cancel)?;
    targets.set(bound)?;
    let most = until.steps(bound);
    settle(bound, displacements, most, cancel)
}

/// Steps towards the set targets until the shape has converged or met the limit of the method's options, or at the
/// latest after `most` steps, of which four that change nothing visible count as one. `displacements` has one entry
/// per surface vertex. Stops after the step during which `cancel` was raised.
///
/// # Errors
/// Those of [`Bound::step`].
pub fn settle(
    bound: &mut Bound,
    displacements: &mut [DVec3],
    most: usize,
    cancel: &Cancel,
) -> Result<Step, SolveError> {
    let mut left = most.saturating_mul(TRIALS);
    loop {
        let step = bound.step(displacements)?;
        left = left.saturating_sub(if step.is_trial { 1 } else { TRIALS });
        if step.finished || left == 0 || cancel.is_cancelled() {
            return Ok(step);
        }
    }
}
