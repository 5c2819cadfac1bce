//! The open file: loading it, saving it, and what a person is asked before a source is written over.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Beginning, EditFile, JobQueue, Revision, Snapshot};
use pliant_mesh::{Cancel, Progress, WeldOptions};
use pliant_render::Image;

use super::names::{SAMPLE, SAMPLE_NAME, file_name, is_gltf, original_name, saved_name};
use super::project_file::{self, MeshSource};
use crate::AppError;
use crate::drawing::Drawing;
use crate::engine::{self, Loaded};
use crate::files::{self, Destination, NewFile, Staged, Staging};
use crate::picture_file;
use crate::saving::{self, SaveAs};
use crate::watch::Watch;
use crate::window::threads::message::{Message, Opened, Written, WrittenKind};
use crate::window::threads::workers::Workers;
use crate::window::viewport::gpu::Gpu;

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

/// What is open.
pub struct OpenFile {
    /// Where it was read from, or saved to since; the built-in sample stands nowhere.
    pub path: Option<PathBuf>,
    /// The file as stored when it was opened, and its vertex sets: what every save patches.
    pub loaded: Arc<Loaded>,
    /// What the renderer takes of it.
    pub drawing: Arc<Drawing>,
    /// Where the mesh as it was read stands now.
    pub source: MeshSource,
    /// The project that it was opened from or saved to.
    pub project: Option<PathBuf>,
    /// Whether a person agreed to write over `path`, or it was written by us under a name of its own.
    pub may_write_over: bool,
}

impl OpenFile {
    /// The name to show.
    pub fn name(&self) -> String {
        file_name(self.path.as_deref().unwrap_or(&self.loaded.path))
    }
}

/// Where a model comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// The built-in sample.
    Sample,
    /// A mesh or a project.
    File(PathBuf),
    /// A project that a session has left which ended without saving.
    Recovered(PathBuf),
}

/// What is to be written.
struct SaveRequest {
    path: PathBuf,
    what: What,
    /// The open file's own files, which nothing else may be saved over.
    sources: Vec<PathBuf>,
}

enum What {
    Model {
        loaded: Arc<Loaded>,
        displacements: Arc<Vec<DVec3>>,
        keep_original: KeepOriginal,
        source: MeshSource,
    },
    Project {
        snapshot: Box<Snapshot>,
        loaded: Arc<Loaded>,
        source: MeshSource,
    },
    Edit(Box<EditFile>),
    Picture(Image),
}

impl Session {
    /// Opens a file, off the window's thread. A load that is under way is given up.
    pub fn load(&mut self, source: Source, gpu: &Gpu, workers: &Workers) {
        self.loading.cancel();
        let stamp = self.stamp();
        self.loading.request(stamp, (source, gpu.clone()));
        self.start_loading(workers);
    }

    /// Gives up what is under way: a load, or a save before it has changed anything on the disk.
    pub fn stop(&mut self) {
        self.loading.cancel();
        self.saving.cancel();
    }

    /// Takes a load's result. `None` if nobody wants it any more.
    pub fn loaded(
        &mut self,
        stamp: Revision,
        result: Result<Box<Opened>, String>,
        workers: &Workers,
    ) -> Option<Result<Box<Opened>, String>> {
        let wanted = self.loading.running().is_some_and(|running| running.stamp == stamp);
        self.loading.finish(stamp);
        self.start_loading(workers);
        wanted.then_some(result)
    }

    /// Makes an opened file the open one.
    pub fn adopt(&mut self, opened: &Opened) {
        self.open = Some(OpenFile {
            path: opened.path.clone(),
            loaded: Arc::clone(&opened.loaded),
            drawing: Arc::clone(&opened.drawing),
            source: opened.source.clone(),
            project: opened.project.clone(),
            may_write_over: false,
        });
    }

    /// Writes the model, off the window's thread. With `keep_original` the file that is replaced is kept beside it
    /// first, as [`original_name`] says.
    pub fn save(
        &mut self,
        path: PathBuf,
        displacements: &Arc<Vec<DVec3>>,
        keep_original: KeepOriginal,
        workers: &Workers,
    ) {
        let Some(open) = &self.open else { return };
        let (loaded, displacements) = (Arc::clone(&open.loaded), Arc::clone(displacements));
        let what = What::Model {
            loaded,
            displacements,
            keep_original,
            source: open.source.clone(),
        };
        self.write(path, what, workers);
    }

    /// Writes a project, off the window's thread.
    pub fn save_project(&mut self, path: PathBuf, snapshot: Snapshot, workers: &Workers) {
        let Some(open) = &self.open else { return };
        let what = What::Project {
            snapshot: Box::new(snapshot),
            loaded: Arc::clone(&open.loaded),
            source: open.source.clone(),
        };
        self.write(path, what, workers);
    }

    /// Writes an edit file, off the window's thread.
    pub fn export(&mut self, path: PathBuf, edit: EditFile, workers: &Workers) {
        self.write(path, What::Edit(Box::new(edit)), workers);
    }

    /// Writes a picture as PNG, off the window's thread.
    pub fn save_picture(&mut self, path: PathBuf, image: Image, workers: &Workers) {
        let what = What::Picture(image);
        self.write(path, what, workers);
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
                WrittenKind::Edit | WrittenKind::Picture => {}
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

    fn write(&mut self, path: PathBuf, what: What, workers: &Workers) {
        let stamp = self.stamp();
        let of_open = |open: &OpenFile| {
            let sources = open.loaded.sources().skip(usize::from(open.path.is_none()));
            sources.map(|(_, path)| path.to_owned()).collect()
        };
        let sources = self.open.as_ref().map(of_open).unwrap_or_default();
        self.saving.request(stamp, SaveRequest { path, what, sources });
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

/// Whether the file that a save replaces is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum KeepOriginal {
    /// Under [`original_name`], unless such a file exists already: that one is older and stays.
    Yes,
    /// It is one of ours.
    No,
}

fn open(source: &Source, gpu: &Gpu, watch: &Watch) -> Result<Box<Opened>, AppError> {
    let weld = WeldOptions::default();
    let mut beginning = None;
    let (mut project, mut recovered) = (None, None);
    let (loaded, path, source) = match source {
        Source::Sample => (
            engine::load_bytes(SAMPLE.to_vec(), Path::new(SAMPLE_NAME), &weld, watch)?,
            None,
            MeshSource::Sample,
        ),
        Source::File(path) if !engine::is_project(path) => (
            engine::load(path, &weld, watch)?,
            Some(path.clone()),
            MeshSource::File(path.clone()),
        ),
        Source::File(path) | Source::Recovered(path) => {
            let opened = project_file::read(path, watch)?;
            match source {
                Source::Recovered(_) => recovered = Some(path.clone()),
                _ => project = Some(path.clone()),
            }
            beginning = Some(Beginning::from(opened.project));
            let mesh = match &opened.source {
                MeshSource::File(mesh) => Some(saved_name(mesh).unwrap_or_else(|| mesh.clone())),
                MeshSource::Sample | MeshSource::Gone => None,
            };
            // What a recovered session kept for itself goes with it: it stands nowhere that lasts.
            let source = match opened.source {
                MeshSource::File(_) if recovered.is_some() && is_in_folder_of(&opened.source, path) => MeshSource::Gone,
                source => source,
            };
            (opened.loaded, mesh, source)
        }
    };
    let progress = watch.begin("getting the picture ready");
    let notes: Vec<String> = loaded.scene.notes().to_vec();
    let drawing = Drawing::new(&loaded.model, loaded.scene.appearance());
    progress.set(0.7);
    let displacements = Arc::new(vec![DVec3::ZERO; loaded.model.surface.positions.len()]);
    let pose = drawing.pose(&loaded.model, &displacements);
    progress.set(0.8);
    let surface = gpu
        .upload(&drawing, &pose)
        .map_err(|error| AppError::System(error.to_string()))?;
    Ok(Box::new(Opened {
        path,
        loaded: Arc::new(loaded),
        drawing: Arc::new(drawing),
        surface,
        displacements,
        beginning,
        project,
        source,
        recovered,
        notes,
    }))
}

/// Whether a mesh stands in the same folder as the project.
fn is_in_folder_of(mesh: &MeshSource, project: &Path) -> bool {
    matches!(mesh, MeshSource::File(mesh) if files::folder_of(mesh) == files::folder_of(project))
}

/// Writes, or says why not; what was stopped in time has changed nothing.
fn write(request: SaveRequest, progress: &Progress, cancel: &Cancel) -> Result<Written, String> {
    let name = file_name(&request.path);
    write_unless_stopped(request, progress, cancel).map_err(|error| match error {
        AppError::Interrupted => format!("Saving {name} was stopped: nothing was written. Save again when you like."),
        error => error.to_string(),
    })
}

fn write_unless_stopped(request: SaveRequest, progress: &Progress, cancel: &Cancel) -> Result<Written, AppError> {
    let SaveRequest { path, what, sources } = request;
    let go_on = || cancel.check().map_err(|_| AppError::Interrupted);
    // What has begun shows that it has.
    progress.set(0.02);
    go_on()?;
    let progress = progress.part(0.02, 1.0);
    let staging = Staging::default();
    if !matches!(what, What::Model { .. }) {
        let sources = sources
            .iter()
            .map(|source| ("the open file or one that it needs", &**source));
        files::refuse_shared(("the file to be saved,", &path), sources)?;
    }
    match what {
        What::Picture(image) => {
            let png = picture_file::png(image)?;
            staging.stage([(path.clone(), &*png)])?.commit()?;
            Ok(Written {
                path,
                what: WrittenKind::Picture,
                warnings: Vec::new(),
            })
        }
        What::Edit(edit) => {
            let text = edit.to_json();
            staging.stage([(path.clone(), text.as_bytes())])?.commit()?;
            Ok(Written {
                path,
                what: WrittenKind::Edit,
                warnings: Vec::new(),
            })
        }
        What::Project {
            snapshot,
            loaded,
            source,
        } => {
            project_file::write(&snapshot, &loaded, &source, &path, &staging, &progress, cancel)?;
            Ok(Written {
                path,
                what: WrittenKind::Project,
                warnings: Vec::new(),
            })
        }
        What::Model {
            loaded,
            displacements,
            keep_original,
            source,
        } => {
            let mut positions = Vec::new();
            loaded.model.drawn_positions(&displacements, &mut positions);
            go_on()?;
            let original = original_name(&path);
            let keeps = keep_original == KeepOriginal::Yes && !original.exists();
            let split = if keeps { 0.5 } else { 1.0 };
            let (of_save, of_original) = (progress.part(0.0, split), progress.part(split, 1.0));
            let neighbours = loaded
                .neighbours
                .iter()
                .map(|path| ("a file that the open one needs", &**path));
            files::refuse_shared(("the file to be saved,", &path), neighbours)?;
            let save = SaveAs::shape(&positions, &path);
            let saved = saving::stage(&loaded, &save, &staging, &of_save, cancel)?;
            let (mut staged, warnings) = (saved.staged, saved.warnings);
            let is_source = matches!(&source, MeshSource::File(mesh) if files::is_same(mesh, &path));
            let mut moved = is_source.then_some(MeshSource::Gone);
            if keeps {
                // The original first: what replaces it must not stand there without it.
                staged = stage_original(&loaded, &path, &original, &staging, &of_original, cancel)?.and(staged);
                moved = moved.map(|_| MeshSource::File(original));
            }
            go_on()?;
            staged.commit()?;
            Ok(Written {
                path,
                what: WrittenKind::Model(moved),
                warnings,
            })
        }
    }
}

/// What stands at `path`, to be kept under the name `original`.
fn stage_original(
    loaded: &Loaded,
    path: &Path,
    original: &Path,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Staged, AppError> {
    if is_gltf(path) {
        let at_rest = &loaded.model.rest_positions();
        let staged = saving::stage(loaded, &SaveAs::shape(at_rest, original), staging, progress, cancel)?.staged;
        Ok(staged)
    } else {
        let bytes = files::read(path)?;
        let file = NewFile {
            to: Destination::of(original)?,
            bytes: &bytes,
        };
        staging.stage_watched(&[file], None, progress, cancel)
    }
}
