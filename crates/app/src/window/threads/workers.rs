//! Runs the editor's jobs and the window's own work: one thread per job, results as messages.
//!
//! The editor never has more than one job of a kind running, so a handful of threads live at a time; starting one
//! costs some tens of microseconds, and no job waits behind another kind's.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::Sender;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::Instant;

use eframe::egui;
use glam::{DVec3, Mat3};
use pliant_deform::Budget;
use pliant_editor::{Executor, Job, JobDone, JobResult, SolveResult, Unfinished};

use super::message::{Message, Painted, Posed};
use tracing::debug_span;

use pliant_engine::report::ms_since;
use pliant_engine::{Loaded, memory};
use pliant_picture::drawing::{self, Drawing, Field, Scale};

/// Starts work off the window's thread and wakes the window when it ends. Cloning shares the channel.
#[derive(Clone)]
pub struct Workers {
    /// Another channel after the graphics device was lost.
    context: Arc<Mutex<egui::Context>>,
    sender: Sender<Message>,
    pose_source: Arc<Mutex<Option<PoseSource>>>,
}

/// The input of poses.
#[derive(Clone)]
pub struct PoseSource {
    /// The open file.
    pub loaded: Arc<Loaded>,
    /// Its data for the renderer.
    pub drawing: Arc<Drawing>,
    /// The numbers that are shown as colours.
    pub field: Option<Field>,
    /// The scales used so far, cached because some need a pass over the whole surface.
    pub scales: Arc<Mutex<HashMap<Field, Arc<Scale>>>>,
}

impl PoseSource {
    /// Returns true if a shape has as many vertices as the file.
    fn fits(&self, displacements: &[DVec3]) -> bool {
        displacements.len() == self.loaded.model.surface.positions.len()
    }

    /// A shape, prepared for the renderer; its normals are turned by `jacobians` if these are known.
    pub fn pose(&self, displacements: Arc<Vec<DVec3>>, jacobians: Option<&[Mat3]>) -> Posed {
        let model = &self.loaded.model;
        let pose = match jacobians {
            Some(jacobians) => self.drawing.pose_turned(model, &displacements, jacobians),
            None => self.drawing.pose(model, &displacements),
        };
        let painted = self.field.map(|field| {
            let mut scales = self.scales.lock().unwrap_or_else(PoisonError::into_inner);
            let scale = scales.entry(field).or_insert_with(|| Arc::new(Scale::of(field, model)));
            let scale = Arc::clone(scale);
            drop(scales);
            let colours = drawing::colours(field, &scale, model, &displacements, None);
            Painted {
                field,
                scale,
                colours: drawing::drawn_colours(model, &colours),
            }
        });
        Posed {
            drawing: Arc::clone(&self.drawing),
            displacements,
            pose,
            painted,
        }
    }
}

impl Workers {
    /// Work's results go to `sender`, and `context` is woken.
    pub fn new(context: egui::Context, sender: Sender<Message>) -> Self {
        Self {
            context: Arc::new(Mutex::new(context)),
            sender,
            pose_source: Arc::default(),
        }
    }

    /// From now on the ends of work wake another window.
    pub fn wake(&self, context: egui::Context) {
        *self.context.lock().unwrap_or_else(PoisonError::into_inner) = context;
    }

    /// Shapes that are solved from now on are posed for this file on the job's own thread, which saves a step between
    /// the pointer and the picture.
    pub fn set_pose_source(&self, source: PoseSource) {
        *self.pose_source.lock().unwrap_or_else(PoisonError::into_inner) = Some(source);
    }

    /// The input for posing shapes.
    pub fn pose_source(&self) -> Option<PoseSource> {
        self.pose_source.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Does `work` on a thread of its own and sends its message. If it panics or the system gives no thread, the
    /// message is `failed` with a sentence.
    pub fn spawn(
        &self,
        name: &str,
        work: impl FnOnce() -> Message + Send + 'static,
        failed: impl Fn(String) -> Message + Send + Clone + 'static,
    ) {
        let workers = self.clone();
        let failed_to_start = failed.clone();
        let body = move || {
            let message = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| failed(panic_sentence(&*panic)));
            workers.send(message);
        };
        if let Err(error) = std::thread::Builder::new().name(name.to_owned()).spawn(body) {
            self.send(failed_to_start(format!(
                "the system can't start a thread for it ({error}): close other programs"
            )));
        }
    }

    /// Sends a message to the window and wakes it.
    pub fn send(&self, message: Message) {
        // A closed window needs no messages.
        if self.sender.send(message).is_ok() {
            self.context
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .request_repaint();
        }
    }
}

impl Executor for Workers {
    fn budget(&self) -> fn(Option<u64>) -> Budget {
        memory::budget_within
    }

    fn clock_ms(&self) -> fn() -> f64 {
        clock_ms
    }

    fn start(&mut self, job: Job) {
        let (kind, stamp) = (job.kind, job.stamp);
        let source = self.pose_source.lock().unwrap_or_else(PoisonError::into_inner).clone();
        self.spawn(
            kind.doing(),
            move || {
                let done = debug_span!("job", kind = kind.doing()).in_scope(|| job.run());
                let posed = match (&done.outcome, source) {
                    // The window may not have followed the editor to another mesh yet.
                    (Ok(JobResult::Solve(SolveResult::Shape(solved))), Some(source))
                        if source.fits(&solved.from_file) =>
                    {
                        Some(source.pose(Arc::clone(&solved.from_file), solved.jacobians.as_deref()))
                    }
                    _ => None,
                };
                Message::Job(done, posed)
            },
            move |sentence| {
                Message::Job(
                    JobDone {
                        kind,
                        stamp,
                        outcome: Err(Unfinished::Failed(sentence)),
                    },
                    None,
                )
            },
        );
    }
}

/// Milliseconds since the first call.
fn clock_ms() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    ms_since(*START)
}

fn panic_sentence(panic: &(dyn std::any::Any + Send)) -> String {
    let words = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let words = words.unwrap_or("no reason given");
    format!("an internal error stopped it ({words}): the document is unchanged; please report this")
}
