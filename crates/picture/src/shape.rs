//! The shape of a file with an edit, and the marks of the edit's regions on it.

use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Beginning, Editor, Event, InlineExecutor, JobKind};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, files};
use pliant_render::SurfaceLine;

use crate::drawing;

/// The drawn shape.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The displacement of each surface vertex, in world space.
    pub displacements: Arc<Vec<DVec3>>,
    pub(crate) region_colours: Vec<[u8; 4]>,
    pub(crate) outlines: Vec<SurfaceLine>,
    pub(crate) stiffness: Option<Vec<f64>>,
}

/// The shape of an edit that is requested.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Posed {
    /// The file's, with the edit's regions; nothing is solved.
    AtRest,
    /// The edit's.
    Bent,
}

impl Shape {
    /// The shape and the regions that the window shows after it has opened the file with the edit and come to rest.
    ///
    /// # Errors
    /// The edit can't be solved; [`EngineError::Interrupted`] soon after the watch's flag is raised.
    pub fn of(loaded: &Loaded, edit: Option<Beginning>, posed: Posed, watch: &Watch) -> Result<Self, EngineError> {
        let progress = watch.begin("bending");
        let executor = InlineExecutor::new();
        let mut editor = Editor::new(Box::new(executor.clone()));
        editor.handle(Event::Opened {
            model: Arc::clone(&loaded.model),
            name: String::new(),
            beginning: edit,
        });
        while let Some(kind) = executor.waiting().first().copied() {
            if watch.cancel.is_cancelled() {
                return Err(EngineError::Interrupted);
            }
            let Some(job) = executor.take(kind) else { break };
            // A picture needs no hierarchy for rays, and a shape at rest needs no solver: without an ordering nothing
            // is bound.
            if kind.is_awaited() && (kind != JobKind::Order || posed == Posed::Bent) {
                editor.handle(Event::JobDone(job.run()));
            }
        }
        progress.set(1.0);
        let seen = editor.view();
        if let Some(problem) = seen.problem {
            return Err(EngineError::System(format!(
                "{}: {problem}",
                files::shown(&loaded.path)
            )));
        }
        let displacements = Arc::clone(seen.displacements);
        let mut region_colours = Vec::new();
        editor.region_colours(&mut region_colours);
        Ok(Self {
            displacements,
            region_colours,
            outlines: drawing::outlines(&editor, &loaded.model),
            stiffness: editor.document().stiffness().map(<[f64]>::to_vec),
        })
    }
}
