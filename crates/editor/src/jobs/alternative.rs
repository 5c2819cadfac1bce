//! One method's result for the present edit: its binding, its shape, and their costs.

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use pliant_deform::Method;
use pliant_mesh::{Bounds, Distortion, Model, SurfaceVertex, bounding_box};

use super::allowance::Allowance;
use super::compared::{Binding, Compared, Edit, Figures};
use super::computed::Computed;
use super::slot::{Unfinished, Work};
use super::solved::Solved;
use super::solving::Wanted;
use crate::Setup;
use crate::document::Document;
use crate::warning::in_window_words;

/// The message about a method whose job a person has stopped.
/// The least visible displacement, as a share of the model's size.
const SEEN: f64 = 1e-3;

const STOPPED: &str = "it was stopped: compare again";

/// One method's result for the present edit.
#[derive(Debug)]
pub struct Alternative {
    /// The method: the document's own with its options, every other with its initial options.
    pub method: Method,
    /// Displacements per surface vertex, from the file's shape. Every other shape has another allocation.
    pub shape: Arc<Vec<DVec3>>,
    /// Figures of the last shape that was solved to its end; `None` before that.
    pub figures: Option<Figures>,
    /// The reason why there is no shape for the present edit, in one sentence.
    pub refusal: Option<String>,
    /// Whether shape or refusal belong to the present edit.
    pub is_current: bool,
    binding: Option<Binding>,
    /// The edit of the shape or the refusal, once it is final.
    answers: Option<Edit>,
}

impl Alternative {
    /// An unbound method, which shows the document's shape.
    pub(super) fn new(method: Method, document: &Document) -> Self {
        Self {
            method,
            shape: Arc::clone(&document.from_file),
            figures: None,
            refusal: None,
            is_current: false,
            binding: None,
            answers: None,
        }
    }

    /// Follows the document: data of another edit are dropped, and everything if the method is the document's own and
    /// has other options now. Returns whether that is so.
    pub(super) fn follow(&mut self, document: &Document, present: &Edit) -> bool {
        let own = &document.method;
        let has_other_options = self.method.name() == own.name() && self.method != *own;
        if has_other_options {
            self.method = own.clone();
        }
        let is_stale = |of: &Edit| has_other_options || of.is_other_problem(present);
        self.binding.take_if(|binding| is_stale(&binding.of));
        self.answers.take_if(|of| is_stale(of));
        // A method that can't be bound can't be bound for other transforms either.
        let is_unbound = self.binding.is_none();
        let is_answer = |of: &Edit| is_unbound || of.has_targets_of(present);
        self.is_current = self.answers.as_ref().is_some_and(is_answer);
        has_other_options
    }

    /// Binds the method if it is unbound, and takes the next steps; `None` if the ordering is missing.
    pub(super) fn work(
        &self,
        document: &Document,
        computed: &Computed,
        allowance: Allowance,
        clock_ms: fn() -> f64,
    ) -> Option<Work<Box<Compared>>> {
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
        let wanted = Wanted::of(document, &self.method, &computed.region.handles, &from_rest, carried)?;
        let (document, region, binding) = (document.clone(), computed.region.clone(), self.binding.clone());
        let method = self.method.clone();
        let of = Edit::of(&document);
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
                        ..Setup::of_document(&document, &region, &model.surface)
                    };
                    let problem = setup.problem(&model);
                    let bound = problem.bind_within(ordering.as_deref(), allowance.budget(), progress, cancel);
                    match bound {
                        Ok(bound) => Binding {
                            bound: Arc::new(Mutex::new(bound)),
                            lines: setup.lines.clone(),
                            of,
                            bind_ms: clock_ms() - start_ms,
                            from_rest,
                            carried: None,
                            frame_ms: 0.0,
                        },
                        Err(_) if cancel.is_cancelled() => return Err(Unfinished::Cancelled),
                        Err(error) => return Err(Unfinished::Failed(error.renumbered(known).to_string())),
                    }
                }
            };
            let start_ms = clock_ms();
            let mut bound = binding.bound.lock().unwrap_or_else(PoisonError::into_inner);
            let solved = wanted.along(&binding.lines, &document).solve(&mut bound, cancel);
            drop(bound);
            let frame_ms = binding.frame_ms + clock_ms() - start_ms;
            Ok(Box::new(match solved {
                Err(error) => Compared {
                    shape: Err(error.renumbered(known).to_string()),
                    figures: None,
                    binding,
                },
                Ok(solved) => after(binding, solved, frame_ms, &model),
            }))
        }))
    }

    /// Stores the result of a job for this edit.
    pub(super) fn take(&mut self, outcome: Result<Box<Compared>, Unfinished>, of: Edit) {
        match outcome {
            Ok(compared) => {
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
            Err(Unfinished::Failed(sentence)) => self.refuse(sentence, of),
            // Something else stopped it: beginning again at once could go on for ever.
            Err(Unfinished::Cancelled) => self.refuse(STOPPED.to_owned(), of),
        }
    }

    /// Leaves it unchanged until the edit changes.
    pub(super) fn stop(&mut self, document: &Document) {
        self.refuse(STOPPED.to_owned(), Edit::of(document));
    }

    fn refuse(&mut self, sentence: String, of: Edit) {
        self.refusal = Some(in_window_words(&sentence));
        self.answers = Some(of);
    }
}

/// The binding after a solve, with the shape, and with figures if that is the last one.
fn after(binding: Binding, solved: Solved, frame_ms: f64, model: &Model) -> Compared {
    let figures = solved.finished.then(|| {
        let rest = model.surface.positions.iter();
        let moved: Vec<DVec3> = rest.zip(solved.from_file.iter()).map(|(p, d)| *p + *d).collect();
        let distortion = Distortion::of(&model.surface, &model.topology, &moved);
        Figures {
            bind_ms: binding.bind_ms,
            frame_ms,
            edge_stretch_mean: distortion.edge_stretch_mean,
            edge_stretch_max: distortion.edge_stretch_max,
            bounds: bounding_box(model.topology.main_positions(&moved)),
            moved: box_of_moved(model, &moved),
        }
    });
    Compared {
        binding: Binding {
            from_rest: solved.from_rest,
            carried: solved.carried,
            frame_ms,
            ..binding
        },
        shape: Ok(solved.from_file),
        figures,
    }
}

/// The box around the vertices that differ visibly from the file's shape, there and now.
fn box_of_moved(model: &Model, now: &[DVec3]) -> Option<Bounds> {
    let least = SEEN * model.bounds()?.diagonal();
    let pairs = model.surface.positions.iter().zip(now);
    let moved = pairs.filter(|(rest, now)| rest.distance(**now) > least);
    Bounds::around(moved.flat_map(|(rest, now)| [*rest, *now]))
}
