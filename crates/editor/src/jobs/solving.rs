//! Bending: frames towards the handles' targets, from the shown shape or from a kept one.

use std::sync::{Arc, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{Bound, Method, Solve, SolveError};
use pliant_mesh::{Cancel, SurfaceVertex};

use super::computed::Computed;
use super::slot::{Unfinished, Work};
use super::solved::{ControlPlaces, Descent, SolveResult, Solved};
use crate::bending::{Carried, Kept, Start, Targets, Until};
use crate::document::{Document, HandleId, sum_of_shapes};
use crate::lines::Lines;
use crate::warning::HandleWarning;

/// Takes steps towards the handles' targets; `None` while nothing is bound.
pub(super) fn solve_work(computed: &Computed, document: &Document) -> Option<Work<SolveResult>> {
    let (binding, model) = (computed.slots.bind.last()?, computed.model.clone()?);
    let (bound, lines) = (Arc::clone(&binding.bound), binding.lines.clone());
    let (handles, carried) = (&computed.region.handles, computed.carried.as_ref());
    let carried = carried.filter(|_| !computed.solves_anew(document));
    let wanted = Wanted::of(document, &document.method, handles, &document.from_rest, carried)?;
    let wanted = match computed.solves_anew(document) {
        true => wanted.along(&lines, document).anew(),
        false => wanted.along(&lines, document),
    };
    let newer_targets = computed.newer_targets.clone();
    Some(Box::new(move |_, cancel| {
        cancel.check()?;
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        bound.set_cancel(&newer_targets);
        let is_from_file = wanted.rest.is_none();
        let solved = wanted.solve(&mut bound, cancel);
        let mut solved = solved.map_err(|error| {
            let error = error.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0);
            Unfinished::Failed(error.to_string())
        })?;
        if is_from_file && solved.carried.is_none() {
            solved.jacobians = bound.jacobians();
        }
        Ok(SolveResult::Shape(solved))
    }))
}

/// Computes the control points' positions for the document's targets, whose shape is known; `None` while nothing is
/// bound.
pub(super) fn controls_work(computed: &Computed, document: &Document) -> Option<Work<SolveResult>> {
    let binding = computed.slots.bind.last()?;
    let bound = Arc::clone(&binding.bound);
    let handles = &computed.region.handles;
    let targets = targets(document, &document.method, handles)?;
    let targets = targets.along(&present_lines(&binding.lines, document, handles), document.strength());
    Some(Box::new(move |_, cancel| {
        cancel.check()?;
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        let set = targets.set(&mut bound);
        set.map_err(|error| Unfinished::Failed(error.to_string()))?;
        let places = ControlPlaces::of(&bound).ok_or(Unfinished::Cancelled)?;
        Ok(SolveResult::Controls(places))
    }))
}

/// The task of a solve, and its start.
pub(super) struct Wanted {
    handles: Vec<HandleId>,
    targets: Targets,
    start: Start,
    /// True if it is independent of earlier solves, and goes on to its end.
    is_anew: bool,
    /// The rest shape, if it is not the file's.
    rest: Option<Arc<Vec<DVec3>>>,
}

impl Wanted {
    /// The document's targets for `handles` and a method, from the shown shape and from the last solution, if that
    /// continues a kept shape; `None` if a handle no longer exists.
    pub(super) fn of(
        document: &Document,
        method: &Method,
        handles: &[HandleId],
        from_rest: &Arc<Vec<DVec3>>,
        carried: Option<&Carried>,
    ) -> Option<Self> {
        Some(Self {
            handles: handles.to_vec(),
            targets: targets(document, method, handles)?,
            start: start(document, handles, from_rest, carried)?,
            is_anew: false,
            rest: document.applied.then(|| Arc::clone(&document.rest)),
        })
    }

    /// The same with handles that follow these lines.
    pub(super) fn along(self, lines: &Lines, document: &Document) -> Self {
        Self {
            targets: self
                .targets
                .along(&present_lines(lines, document, &self.handles), document.strength()),
            ..self
        }
    }

    /// The same from where every frame of an animation begins, the rest shape or the kept one, to the end.
    pub(super) fn anew(self) -> Self {
        let start = match self.start {
            Start::Shape(shape) => Start::Shape(Arc::new(vec![DVec3::ZERO; shape.len()])),
            kept => kept,
        };
        Self {
            start,
            is_anew: true,
            ..self
        }
    }

    /// Takes steps until the shape is worth showing, or to the end.
    pub(super) fn solve(self, bound: &mut Bound, cancel: &Cancel) -> Result<Solved, SolveError> {
        let bent = match self.is_anew {
            true => self.start.bend_anew(bound, &self.targets, cancel)?,
            false => self.start.bend(bound, &self.targets, Until::Frame, cancel)?,
        };
        let step = bent.step;
        let slides = self
            .handles
            .iter()
            .enumerate()
            .map(|(number, id)| (*id, bound.slide(number)));
        let slides = slides.filter(|(_, distance)| step.finished && *distance != 0.0);
        Ok(Solved {
            slides: slides.collect(),
            point_slides: match step.finished {
                true => bent
                    .slides
                    .iter()
                    .map(|(number, length)| (self.handles[*number], *length))
                    .collect(),
                false => Vec::new(),
            },
            jacobians: None,
            controls: ControlPlaces::of(bound),
            from_file: sum_of_shapes(self.rest.as_ref(), &bent.shown),
            from_rest: bent.shown,
            carried: bent.carried,
            example_weights: bound.weights().to_vec(),
            blind_to: HandleWarning::list(bound.blind_to(), &self.handles),
            finished: step.finished,
            descent: (bound.solve() != Solve::Direct).then_some(Descent {
                energy: step.energy,
                converged: step.converged,
                finished: step.finished,
            }),
        })
    }
}

/// The start of the document's next solve; `None` if a handle did not exist yet when the shape was kept.
fn start(
    document: &Document,
    handles: &[HandleId],
    from_rest: &Arc<Vec<DVec3>>,
    carried: Option<&Carried>,
) -> Option<Start> {
    let Some(kept) = &document.kept else {
        return Some(Start::Shape(Arc::clone(from_rest)));
    };
    let Some(carried) = carried.filter(|carried| Arc::ptr_eq(&carried.kept, kept)) else {
        return Kept::of(kept, handles.iter().copied()).map(Start::Kept);
    };
    let mut carried = carried.clone();
    if !Arc::ptr_eq(&carried.shown, from_rest) {
        // Undo has brought another shape: its path is computed again from the beginning.
        carried.solution = Arc::clone(&carried.at_first);
    }
    Some(Start::Carried(carried))
}

/// The document's targets for handles in the region's order and for a method; `None` if a handle no longer exists.
pub(super) fn targets(document: &Document, method: &Method, handles: &[HandleId]) -> Option<Targets> {
    let declared = method.declaration();
    let mut attachments = document.attachments.iter();
    let own = attachments.find(|(name, _)| declared.attachment(name).is_some());
    let targets = Targets::new(maps(document, handles)?, own.map(|(_, attachment)| attachment));
    let free_along = handles.iter().map(|id| document.freedom(*id));
    let held = handles.iter().enumerate();
    let held = held.filter_map(|(number, id)| Some((number, document.handle(*id)?.held.clone()?)));
    Some(targets.free_along(free_along.collect()).holding(held.collect()))
}

/// The lines of a binding of `handles` with the document's present ways of their curves.
pub(super) fn present_lines(lines: &Lines, document: &Document, handles: &[HandleId]) -> Lines {
    if lines.is_empty() {
        return lines.clone();
    }
    lines.moved(|number| document.handle(*handles.get(number)?)?.line.as_ref()?.curve())
}

/// The maps of the handles in the region's order; `None` if one of them no longer exists.
fn maps(document: &Document, handles: &[HandleId]) -> Option<Vec<DAffine3>> {
    let map = |id: &HandleId| document.handle(*id).map(|handle| handle.affine());
    handles.iter().map(map).collect()
}
