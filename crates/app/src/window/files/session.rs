//! The open file, and the jobs that load and save it.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{EditFile, JobQueue, Revision, Snapshot};
use pliant_render::Image;

use super::names::file_name;
pub use super::opening::Source;
use super::opening::open;
use super::project_file::MeshSource;
pub use super::writing::KeepOriginal;
use super::writing::{Content, Model, SaveRequest, write};
use crate::drawing::Drawing;
use crate::window::threads::message::{Message, ModelToShow, Written, WrittenKind};
use crate::window::threads::workers::Workers;
use crate::window::viewport::gpu::Gpu;
use pliant_engine::Loaded;
use pliant_engine::watch::Watch;

/// The open file and the jobs that read and write it.
#[derive(Default)]
pub struct Session {
    /// What is open.
    pub open: Option<OpenFile>,
    next: u64,
    loading: JobQueue<(Source, Gpu)>,
    /// What the load that runs is doing.
    watch: Watch,
    saving: JobQueue<SaveRequest>,
}

/// Displacements of the surface from the file's shape, and the connected parts that are turned inside out.
pub type Shape<'a> = (&'a Arc<Vec<DVec3>>, &'a Arc<BTreeSet<u32>>);

/// What is open.
pub struct OpenFile {
    /// Where it was read from, or saved to since; the built-in sample stands nowhere.
    pub path: Option<PathBuf>,
    /// The file as stored when it was opened, and its vertex sets: what every save patches.
    pub loaded: Arc<Loaded>,
    /// The names of its morph targets.
    pub morph_targets: Vec<String>,
    /// What the renderer takes of it.
    pub drawing: Arc<Drawing>,
    /// Where the mesh as it was read stands now.
    pub source: MeshSource,
    /// The project that it was opened from or saved to.
    pub project: Option<PathBuf>,
    /// Whether a person agreed to write over `path`, or it was saved here under a new name.
    pub may_write_over: bool,
}

impl OpenFile {
    /// The name to show.
    pub fn name(&self) -> String {
        file_name(self.path.as_deref().unwrap_or(&self.loaded.path))
    }
}

impl Session {
    /// Opens a file, off the window's thread. A load that is under way is cancelled.
    pub fn load(&mut self, source: Source, gpu: &Gpu, workers: &Workers) {
        self.loading.cancel();
        let stamp = self.stamp();
        self.loading.request(stamp, (source, gpu.clone()));
        self.start_loading(workers);
    }

    /// Cancels what is under way: a load, or a save before it has changed anything on the disk.
    pub fn stop(&mut self) {
        self.loading.cancel();
        self.saving.cancel();
    }

    /// Takes a load's result. `None` if it is no longer wanted.
    pub fn loaded(
        &mut self,
        stamp: Revision,
        result: Result<Box<ModelToShow>, String>,
        workers: &Workers,
    ) -> Option<Result<Box<ModelToShow>, String>> {
        let wanted = self.loading.running().is_some_and(|running| running.stamp == stamp);
        self.loading.finish(stamp);
        self.start_loading(workers);
        wanted.then_some(result)
    }

    /// Makes an opened file the open one.
    pub fn adopt(&mut self, opened: &ModelToShow) {
        self.open = Some(OpenFile {
            path: opened.path.clone(),
            loaded: Arc::clone(&opened.loaded),
            morph_targets: opened.loaded.scene.morph_targets(),
            drawing: Arc::clone(&opened.drawing),
            source: opened.source.clone(),
            project: opened.project.clone(),
            may_write_over: false,
        });
    }

    /// Writes the model, off the window's thread. With `keep_original` the file that is replaced is kept beside it
    /// first, as [`original_name`](super::names::original_name) says.
    pub fn save(
        &mut self,
        path: PathBuf,
        (displacements, inside_out): Shape<'_>,
        keep_original: KeepOriginal,
        workers: &Workers,
    ) {
        let Some(open) = &self.open else { return };
        let content = Content::Model(Model {
            loaded: Arc::clone(&open.loaded),
            displacements: Arc::clone(displacements),
            inside_out: Arc::clone(inside_out),
            keep_original,
            source: open.source.clone(),
        });
        self.write(path, content, workers);
    }

    /// Writes the model at rest with the present shape as a morph target, off the window's thread.
    pub fn save_morph(&mut self, path: PathBuf, (displacements, inside_out): Shape<'_>, workers: &Workers) {
        let Some(open) = &self.open else { return };
        let content = Content::Morph {
            loaded: Arc::clone(&open.loaded),
            displacements: Arc::clone(displacements),
            inside_out: Arc::clone(inside_out),
        };
        self.write(path, content, workers);
    }

    /// Writes a project, off the window's thread.
    pub fn save_project(&mut self, path: PathBuf, snapshot: Snapshot, workers: &Workers) {
        let Some(open) = &self.open else { return };
        let content = Content::Project {
            snapshot: Box::new(snapshot),
            loaded: Arc::clone(&open.loaded),
            source: open.source.clone(),
        };
        self.write(path, content, workers);
    }

    /// Writes an edit file, off the window's thread.
    pub fn export(&mut self, path: PathBuf, edit: EditFile, workers: &Workers) {
        self.write(path, Content::Edit(Box::new(edit)), workers);
    }

    /// Writes a picture as PNG, off the window's thread.
    pub fn save_picture(&mut self, path: PathBuf, image: Image, workers: &Workers) {
        self.write(path, Content::Picture(image), workers);
    }

    /// Takes a save's end.
    pub fn written(&mut self, stamp: Revision, result: &Result<Written, String>, workers: &Workers) {
        self.saving.finish(stamp);
        if let (Some(open), Ok(written)) = (&mut self.open, result) {
            match &written.what {
                WrittenKind::Model(source) => {
                    open.path = Some(written.path.clone());
                    open.may_write_over = true;
                    if let Some(source) = source {
                        open.source = source.clone();
                    }
                }
                WrittenKind::Project => open.project = Some(written.path.clone()),
                WrittenKind::Edit | WrittenKind::Morph | WrittenKind::Picture => {}
            }
        }
        self.start_saving(workers);
    }

    /// What runs, with its progress (0 to 1).
    pub fn doing(&self) -> Option<(&'static str, f32)> {
        let loading = self
            .loading
            .running()
            .map(|_| self.watch.now().unwrap_or(("opening the file", 0.0)));
        loading.or_else(|| self.saving.running().map(|running| ("saving", running.progress.get())))
    }

    fn stamp(&mut self) -> Revision {
        self.next += 1;
        Revision(self.next)
    }

    fn write(&mut self, path: PathBuf, content: Content, workers: &Workers) {
        let stamp = self.stamp();
        let of_open = |open: &OpenFile| {
            let sources = open.loaded.sources().skip(usize::from(open.path.is_none()));
            sources.map(|(_, path)| path.to_owned()).collect()
        };
        let sources = self.open.as_ref().map(of_open).unwrap_or_default();
        self.saving.request(stamp, SaveRequest { path, content, sources });
        self.start_saving(workers);
    }

    fn start_loading(&mut self, workers: &Workers) {
        let Some((running, (source, gpu))) = self.loading.start_next() else {
            return;
        };
        let stamp = running.stamp;
        let watch = Watch::cancelled_by(&running.cancel);
        self.watch = watch.clone();
        workers.spawn(
            "opening",
            move || Message::Opened(stamp, open(&source, &gpu, &watch).map_err(|error| error.to_string())),
            move |sentence| Message::Opened(stamp, Err(sentence)),
        );
    }

    fn start_saving(&mut self, workers: &Workers) {
        let Some((running, request)) = self.saving.start_next() else {
            return;
        };
        let stamp = running.stamp;
        let (progress, cancel) = (running.progress.clone(), running.cancel.clone());
        workers.spawn(
            "saving",
            move || Message::Written(stamp, write(request, &progress, &cancel)),
            move |sentence| Message::Written(stamp, Err(sentence)),
        );
    }
}
