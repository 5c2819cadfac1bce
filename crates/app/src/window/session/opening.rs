//! Opens a mesh or a project, off the window's thread: from a file to a model with its drawing on the device.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Animation, Beginning, SavedAs, Snapshot};
use pliant_mesh::WeldOptions;

use super::clause::as_sentence;
use crate::files::names::saved_name;
use crate::window::files::in_file::SavedShape;
use crate::window::files::project_file;
use crate::window::files::recovery::left::opened_project;
use crate::window::files::rest_mesh::{MeshSource, load_sample};
use crate::window::session::frames::mesh_of;
use crate::window::threads::message::ModelToShow;
use crate::window::viewport::gpu::Gpu;
use pliant_engine::files::Stamp;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, OpenSequence, examples, files};
use pliant_picture::drawing::Drawing;

/// The source of a model.
#[derive(Clone, Debug)]
pub enum Source {
    /// The built-in sample.
    Sample,
    /// A mesh or a project.
    File(PathBuf),
    /// A sequence: a folder of frames, a point cache, or a glTF with an animation of morph targets.
    Sequence {
        /// The folder or the file.
        path: PathBuf,
        /// The file that a person chose: it is shown first, if it is one of the frames.
        chosen: Option<PathBuf>,
        /// The mesh that is open, to which a point cache may belong.
        open: Option<PathBuf>,
    },
    /// A mesh, and an edit or a project to begin with.
    Edited {
        /// The mesh.
        file: PathBuf,
        /// The edit or project.
        edit: PathBuf,
        /// The sequence of whose frames the mesh is one.
        sequence: Option<PathBuf>,
    },
    /// A project from a session that ended without saving.
    Recovered(PathBuf),
    /// The open mesh again: another program has changed its file, or its vertices are welded in another way.
    Reloaded(Box<Reload>),
}

/// A mesh that is read again, and the work that is applied to it.
#[derive(Clone, Debug)]
pub struct Reload {
    /// The path of the mesh; `None` for the built-in sample.
    pub file: Option<PathBuf>,
    /// The path for saving it; `None` if nobody has chosen one.
    pub path: Option<PathBuf>,
    /// The welding of its vertices.
    pub weld: WeldOptions,
    /// The document.
    pub snapshot: Snapshot,
    /// The shape with which the mesh in `file` was saved there, if it was.
    pub saved: Option<SavedShape>,
    /// True if the work counts as unsaved.
    pub unsaved: bool,
    /// The project that is open.
    pub project: Option<PathBuf>,
}

impl Source {
    /// The files that a person names: a mesh or a project with the edit on it, or nothing.
    pub fn of(file: Option<PathBuf>, edit: Option<PathBuf>) -> Self {
        match (file, edit) {
            (None, _) => Self::Sample,
            (Some(file), None) => Self::file(file),
            (Some(file), Some(edit)) => Self::Edited {
                file,
                edit,
                sequence: None,
            },
        }
    }

    /// A mesh, a project, a folder of frames or a point cache.
    pub fn file(path: PathBuf) -> Self {
        let is_sequence = path.is_dir() || pliant_io::PointCacheFormat::of_name(&path.to_string_lossy()).is_some();
        match is_sequence {
            false => Self::File(path),
            true => Self::Sequence {
                path,
                chosen: None,
                open: None,
            },
        }
    }

    /// The same by absolute paths: a session's paths must survive a change of the current folder, and there must be one
    /// path to a file.
    pub(super) fn absolute(self) -> Self {
        match self {
            Self::Sample => Self::Sample,
            Self::File(file) => Self::File(absolute(&file)),
            Self::Sequence { path, chosen, open } => Self::Sequence {
                path: absolute(&path),
                chosen: chosen.as_deref().map(absolute),
                open,
            },
            Self::Edited { file, edit, sequence } => Self::Edited {
                sequence: sequence.as_deref().map(absolute),
                file: absolute(&file),
                edit: absolute(&edit),
            },
            Self::Recovered(project) => Self::Recovered(absolute(&project)),
            Self::Reloaded(reload) => Self::Reloaded(reload),
        }
    }
}

/// The absolute path; the path itself if the system can't give the current folder.
pub(super) fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// The file in which the work is saved while this project is open.
fn saved_as(project: Option<&Path>) -> SavedAs {
    match project {
        Some(_) => SavedAs::Project,
        None => SavedAs::Model,
    }
}

/// Reads, welds and uploads.
pub(super) fn open(asked: &Source, gpu: &Gpu, watch: &Watch) -> Result<Box<ModelToShow>, EngineError> {
    let weld = WeldOptions::default();
    let mut beginning = None;
    let mut stamps = Vec::new();
    let mut notes = Vec::new();
    let (mut unsaved, mut done) = (None, None);
    let (mut project, mut recovered) = (None, None);
    let mut sequence: Option<(PathBuf, Option<&Path>)> = None;
    let mut read_at = None;
    let (loaded, path, source) = match asked {
        Source::Sample => (load_sample(&weld, watch)?, None, MeshSource::Sample),
        Source::File(path) if !pliant_engine::is_project(path) => (
            pliant_engine::load(path, &weld, watch)?,
            Some(path.clone()),
            MeshSource::File(path.clone()),
        ),
        Source::Sequence { path, chosen, open } => {
            let mesh = mesh_of(path, open.as_deref())?;
            sequence = Some((path.clone(), chosen.as_deref()));
            let loaded = pliant_engine::load(&mesh, &weld, watch)?;
            (loaded, Some(mesh.clone()), MeshSource::File(mesh))
        }
        Source::Edited {
            file,
            edit,
            sequence: place,
        } => {
            sequence = place.clone().map(|place| (place, None));
            // This comes before reading: a write in between shows as a change.
            stamps.push((edit.clone(), Stamp::of(edit)?));
            let mut read = pliant_engine::read_edit(edit, watch)?;
            let loaded = pliant_engine::load(file, &read.weld_options(), watch)?;
            examples::bring(&mut read, edit, &loaded, watch)?;
            let placed = read.placed(&loaded.model).map_err(|source| EngineError::Edit {
                edit: edit.clone(),
                source,
            })?;
            if let Some((other, matched)) = placed {
                notes.push(as_sentence(&matched.sentence()));
                done = notes.first().cloned();
                read = other;
            }
            beginning = Some(read);
            (loaded, Some(file.clone()), MeshSource::File(file.clone()))
        }
        Source::Reloaded(reload) => {
            let (loaded, source) = match &reload.file {
                Some(file) => (
                    pliant_engine::load(file, &reload.weld, watch)?,
                    MeshSource::File(file.clone()),
                ),
                None => (load_sample(&reload.weld, watch)?, MeshSource::Sample),
            };
            let displacements = reload.saved.as_ref().map(|saved| &**saved.displacements);
            let dye = reload.saved.as_ref().and_then(|saved| saved.dye.as_ref());
            let without_dye = dye.map(|dye| reload.snapshot.without_saved_dye(dye));
            let snapshot = without_dye.as_ref().unwrap_or(&reload.snapshot);
            let (carried, unmatched) = snapshot.on_changed_mesh(&loaded.model, displacements);
            if unmatched > 0 {
                notes.push(format!(
                    "{unmatched} vertices of the changed file are new: they stay fixed until you paint them."
                ));
            }
            beginning = Some(carried);
            project.clone_from(&reload.project);
            unsaved = reload.unsaved.then(|| saved_as(project.as_deref()));
            (loaded, reload.path.clone(), source)
        }
        Source::File(path) | Source::Recovered(path) => {
            let opened = project_file::read(path, watch)?;
            stamps.push((path.clone(), opened.stamp));
            sequence = opened.sequence.map(|place| (place, None));
            // Projects of earlier versions have keys at frames of this rate.
            read_at = (!opened.project.has_own_key_times()).then(|| Animation::default().fps());
            match asked {
                Source::Recovered(_) => {
                    recovered = Some(path.clone());
                    project = opened_project(path);
                    if let Some(project) = &project {
                        stamps.push((project.clone(), Stamp::of(project)?));
                    }
                    unsaved = Some(saved_as(project.as_deref()));
                }
                _ => project = Some(path.clone()),
            }
            beginning = Some(Beginning::from(opened.project));
            // The mesh file of a recovered session is deleted with the recovery, so it counts as gone.
            match opened.source {
                MeshSource::File(mesh) if recovered.is_some() && files::folder_of(&mesh) == files::folder_of(path) => {
                    let model = Some(opened.named).filter(|named| files::folder_of(named) != files::folder_of(path));
                    (opened.loaded, model, MeshSource::Gone)
                }
                MeshSource::File(mesh) => {
                    let saved = saved_name(&mesh).unwrap_or_else(|| mesh.clone());
                    (opened.loaded, Some(saved), MeshSource::File(mesh))
                }
                source => (opened.loaded, None, source),
            }
        }
    };
    let loaded = Arc::new(loaded);
    let sequence = match sequence {
        None => {
            notes.extend(OpenSequence::beside(&loaded, watch));
            None
        }
        Some((path, chosen)) => {
            let sequence = OpenSequence::of(&path, Arc::clone(&loaded), read_at, watch)?;
            notes.extend(sequence.note().map(str::to_owned));
            let shown = chosen.and_then(|file| sequence.frame_of(file));
            if let (Some(Beginning::Edit(edit)), Source::Edited { edit: path, .. }) = (&beginning, asked) {
                beginning = Some(sequence.applied(edit, path, watch)?.into());
            }
            Some((Arc::new(sequence), shown))
        }
    };
    let progress = watch.begin("preparing the picture");
    notes.extend_from_slice(loaded.scene.notes());
    let drawing = Drawing::new(&loaded.model, loaded.scene.appearance(), Arc::default());
    progress.set(0.7);
    let displacements = Arc::new(vec![DVec3::ZERO; loaded.model.surface.positions.len()]);
    let pose = drawing.pose(&loaded.model, &displacements);
    progress.set(0.8);
    let surface = gpu
        .upload(&drawing, &pose)
        .map_err(|error| EngineError::System(error.to_string()))?;
    Ok(Box::new(ModelToShow {
        path,
        loaded,
        drawing: Arc::new(drawing),
        surface,
        displacements,
        sequence,
        beginning,
        project,
        source,
        recovered,
        unsaved,
        stamps,
        notes,
        done,
    }))
}
