//! The present edit bent by every method, to choose one by looking.
//!
//! One job runs at a time: it binds a method, or takes the next steps with what is bound. The methods take turns, so
//! that all of them follow a drag.

use std::sync::{Arc, Mutex, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{Bound, METHODS, Method};
use pliant_mesh::{Distortion, Model, SurfaceVertex};

use super::computed::Computed;
use super::job::{Carried, Executor, JobOutcome, Solved, Work};
use super::solving::Wanted;
use crate::Setup;
use crate::document::{Document, HandleId, KeptShape, Versions};

/// What is said of a method whose job a person has stopped.
const STOPPED: &str = "it was stopped: compare again to go on";

/// What each method makes of the present edit.
#[derive(Debug)]
pub struct Comparison {
    alternatives: Vec<Alternative>,
    /// Which of them a job works on, and for which edit.
    under_way: Option<(usize, Edit)>,
    /// Whose turn it is.
    next: usize,
}

/// What one method makes of the present edit.
#[derive(Debug)]
pub struct Alternative {
    /// The method: the document's own with its options, every other with what a person begins with.
    pub method: Method,
    /// Per surface vertex, from the file's shape. Another allocation for every other shape.
    pub shape: Arc<Vec<DVec3>>,
    /// About the last shape that was solved to its end; `None` before that.
    pub figures: Option<Figures>,
    /// Why there is no shape for the present edit, in one sentence.
    pub refusal: Option<String>,
    /// Whether shape or refusal belong to the present edit.
    pub is_current: bool,
    binding: Option<Binding>,
    /// Which edit the shape or the refusal belongs to, once it is final.
    answers: Option<Edit>,
}

/// What a method took and how much its shape is stretched.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Figures {
    /// The time of binding in milliseconds.
    pub bind_ms: f64,
    /// The time from new transforms to the shape in milliseconds.
    pub frame_ms: f64,
    /// The mean over the edges of the larger of new by old length and old by new.
    pub edge_stretch_mean: f64,
    /// The largest.
    pub edge_stretch_max: f64,
}

/// A bound method and where its steps are.
#[derive(Clone, Debug)]
struct Binding {
    bound: Arc<Mutex<Bound>>,
    /// The edit that it was last used for.
    of: Edit,
    bind_ms: f64,
    /// The last shape, from the rest shape.
    from_rest: Arc<Vec<DVec3>>,
    carried: Option<Carried>,
    /// The time spent on the present transforms so far.
    frame_ms: f64,
}

/// The edit that something was made for, its method apart.
#[derive(Clone, Debug)]
struct Edit {
    versions: Versions,
    targets: Vec<(HandleId, DAffine3)>,
    kept: Option<Arc<KeptShape>>,
}

/// What a job of the comparison brings.
#[derive(Debug)]
pub struct Compared {
    binding: Binding,
    /// The shape, or why there is none.
    shape: Result<Arc<Vec<DVec3>>, String>,
    /// Once the shape is solved to its end.
    figures: Option<Figures>,
}

impl Comparison {
    /// Every method, of which nothing is bound; each shows what the document shows.
    pub(super) fn new(document: &Document) -> Self {
        let alternatives = METHODS.iter().map(|declaration| {
            let own = Some(&document.method).filter(|method| method.name() == declaration.name);
            Alternative {
                method: own.cloned().unwrap_or_else(|| (declaration.first_choice)()),
                shape: Arc::clone(&document.from_file),
                figures: None,
                refusal: None,
                is_current: false,
                binding: None,
                answers: None,
            }
        });
        Self {
            alternatives: alternatives.collect(),
            under_way: None,
            next: 0,
        }
    }

    /// One for each method, in the order in which methods are shown.
    pub fn alternatives(&self) -> &[Alternative] {
        &self.alternatives
    }

    /// Whether every shape belongs to the present edit, or is refused for it.
    pub fn is_current(&self) -> bool {
        self.alternatives.iter().all(|alternative| alternative.is_current)
    }

    /// Follows the document: bindings of another edit are dropped, and so is that of the document's own method when it
    /// gets other options. Whether what a job works on is not wanted any more.
    pub(super) fn follow(&mut self, document: &Document) -> bool {
        let present = Edit::of(document);
        let mut is_unwanted = matches!(&self.under_way, Some((_, of)) if of.is_other_problem(&present));
        for (number, alternative) in self.alternatives.iter_mut().enumerate() {
            let own = &document.method;
            let has_other_options = alternative.method.name() == own.name() && alternative.method != *own;
            if has_other_options {
                alternative.method = own.clone();
                is_unwanted |= matches!(&self.under_way, Some((under_way, _)) if *under_way == number);
            }
            let is_stale = |of: &Edit| has_other_options || of.is_other_problem(&present);
            alternative.binding.take_if(|binding| is_stale(&binding.of));
            alternative.answers.take_if(|of| is_stale(of));
            // What can't be bound can't be bound for other transforms either.
            let is_unbound = alternative.binding.is_none();
            alternative.is_current = alternative
                .answers
                .as_ref()
                .is_some_and(|of| is_unbound || of.has_targets_of(&present));
        }
        if is_unwanted {
            self.under_way = None;
        }
        is_unwanted
    }

    /// The power of the ordering that the method whose turn it is lacks.
    pub(super) fn missing_ordering(&self, computed: &Computed) -> Option<u32> {
        let power = self.alternatives[self.turn()?].method.ordering_power()?;
        computed.ordering(power).is_none().then_some(power)
    }

    /// The work of the method whose turn it is; `None` if all are done, or the ordering is missing.
    pub(super) fn next_work(
        &mut self,
        document: &Document,
        computed: &Computed,
        executor: &dyn Executor,
    ) -> Option<Work> {
        let number = self.turn()?;
        let work = self.alternatives[number].work(document, computed, executor)?;
        self.under_way = Some((number, Edit::of(document)));
        self.next = number + 1;
        Some(work)
    }

    /// Takes what a job has brought.
    pub(super) fn take(&mut self, outcome: JobOutcome) {
        let Some((number, of)) = self.under_way.take() else {
            return;
        };
        self.alternatives[number].take(outcome, of);
    }

    /// Leaves everything that is not done as it is, until the edit changes.
    pub(super) fn stop(&mut self, document: &Document) {
        self.under_way = None;
        for alternative in self
            .alternatives
            .iter_mut()
            .filter(|alternative| !alternative.is_current)
        {
            alternative.refuse(STOPPED.to_owned(), Edit::of(document));
        }
    }

    /// The next that is not current, after the one that had its turn last.
    fn turn(&self) -> Option<usize> {
        let count = self.alternatives.len();
        let mut numbers = (0..count).map(|step| (self.next + step) % count);
        numbers.find(|&number| !self.alternatives[number].is_current)
    }
}

impl Alternative {
    fn work(&self, document: &Document, computed: &Computed, executor: &dyn Executor) -> Option<Work> {
        let model = computed.model.clone()?;
        let ordering = match self.method.ordering_power() {
            Some(power) => Some(computed.ordering(power)?),
            None => None,
        };
        let rest = || Arc::new(vec![DVec3::ZERO; document.from_rest.len()]);
        let from_rest = self
            .binding
            .as_ref()
            .map_or_else(rest, |binding| Arc::clone(&binding.from_rest));
        let carried = self.binding.as_ref().and_then(|binding| binding.carried.as_ref());
        let wanted = Wanted::of(document, &computed.region.handles, &from_rest, carried)?;
        let (document, region, binding) = (document.clone(), computed.region.clone(), self.binding.clone());
        let method = self.method.clone();
        let of = Edit::of(&document);
        let (budget, clock_ms) = (executor.budget(), executor.clock_ms());
        Some(Box::new(move |progress, cancel| {
            let known = |vertex| model.first_file_vertex(SurfaceVertex(vertex)).0;
            let start_ms = clock_ms();
            let binding = match binding {
                Some(binding) if binding.of.has_targets_of(&of) => binding,
                Some(binding) => Binding {
                    frame_ms: 0.0,
                    of,
                    ..binding
                },
                None => {
                    let setup = Setup {
                        method,
                        ..Setup::of_document(&document, &region)
                    };
                    let problem = setup.problem(&model);
                    let bound = problem.bind_within(ordering.as_deref(), budget(), progress, cancel);
                    match bound {
                        Ok(bound) => Binding {
                            bound: Arc::new(Mutex::new(bound)),
                            of,
                            bind_ms: clock_ms() - start_ms,
                            from_rest,
                            carried: None,
                            frame_ms: 0.0,
                        },
                        Err(_) if cancel.is_cancelled() => return JobOutcome::Cancelled,
                        Err(error) => return JobOutcome::Failed(error.renumbered(known).to_string()),
                    }
                }
            };
            let start_ms = clock_ms();
            let mut bound = binding.bound.lock().unwrap_or_else(PoisonError::into_inner);
            let solved = wanted.solve(&mut bound, cancel);
            drop(bound);
            let frame_ms = binding.frame_ms + clock_ms() - start_ms;
            JobOutcome::Compared(Box::new(match solved {
                Err(error) => Compared {
                    shape: Err(error.renumbered(known).to_string()),
                    figures: None,
                    binding,
                },
                Ok(solved) => binding.after(solved, frame_ms, &model),
            }))
        }))
    }

    fn take(&mut self, outcome: JobOutcome, of: Edit) {
        match outcome {
            JobOutcome::Compared(compared) => {
                self.binding = Some(compared.binding);
                match compared.shape {
                    Err(sentence) => self.refuse(sentence, of),
                    Ok(shape) => {
                        self.shape = shape;
                        self.refusal = None;
                        if compared.figures.is_some() {
                            self.figures = compared.figures;
                        }
                        self.answers = compared.figures.map(|_| of);
                    }
                }
            }
            JobOutcome::Failed(sentence) => self.refuse(sentence, of),
            // Somebody else stopped it: beginning again at once would go on for ever.
            _ => self.refuse(STOPPED.to_owned(), of),
        }
    }

    fn refuse(&mut self, sentence: String, of: Edit) {
        self.refusal = Some(sentence);
        self.answers = Some(of);
    }
}

impl Edit {
    fn of(document: &Document) -> Self {
        let handles = document.handles().iter();
        Self {
            versions: *document.versions(),
            targets: handles.map(|handle| (handle.id, handle.affine())).collect(),
            kept: document.kept.clone(),
        }
    }

    /// Whether a binding for one is no good for the other.
    fn is_other_problem(&self, other: &Self) -> bool {
        self.versions.are_other_edit(&other.versions)
    }

    /// Whether the same is to be solved for.
    fn has_targets_of(&self, other: &Self) -> bool {
        let addresses = [self, other].map(|edit| edit.kept.as_ref().map(Arc::as_ptr));
        self.targets == other.targets && addresses[0] == addresses[1]
    }
}

impl Binding {
    /// The binding after a solve, with the shape, and with figures if that is the last one.
    fn after(self, solved: Solved, frame_ms: f64, model: &Model) -> Compared {
        let figures = solved.finished.then(|| {
            let rest = model.surface.positions.iter();
            let moved: Vec<DVec3> = rest.zip(solved.from_file.iter()).map(|(p, d)| *p + *d).collect();
            let distortion = Distortion::of(&model.surface, &model.topology, &moved);
            Figures {
                bind_ms: self.bind_ms,
                frame_ms,
                edge_stretch_mean: distortion.edge_stretch_mean,
                edge_stretch_max: distortion.edge_stretch_max,
            }
        });
        Compared {
            binding: Self {
                from_rest: solved.from_rest,
                carried: solved.carried,
                frame_ms,
                ..self
            },
            shape: Ok(solved.from_file),
            figures,
        }
    }
}
