//! Opens a mesh or a project, off the window's thread: from a file to a model with its drawing on the device.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_assets::CREATURE;
use pliant_editor::Beginning;
use pliant_mesh::WeldOptions;

use super::names::{SAMPLE_NAME, saved_name};
use super::project_file::{self, MeshSource};
use crate::drawing::Drawing;
use crate::window::threads::message::ModelToShow;
use crate::window::viewport::gpu::Gpu;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, examples, files};

/// Where a model comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// The built-in sample.
    Sample,
    /// A mesh or a project.
    File(PathBuf),
    /// A mesh, with an edit or a project to begin with.
    Edited {
        /// The mesh.
        file: PathBuf,
        /// What is set up on it.
        edit: PathBuf,
    },
    /// A project that was left by a session that ended without saving.
    Recovered(PathBuf),
}

impl Source {
    /// What a person names: a mesh or a project with the edit on it, or nothing.
    pub fn of(file: Option<PathBuf>, edit: Option<PathBuf>) -> Self {
        match (file, edit) {
            (None, _) => Self::Sample,
            (Some(file), None) => Self::File(file),
            (Some(file), Some(edit)) => Self::Edited { file, edit },
        }
    }
}

/// Reads, welds and uploads.
pub(super) fn open(source: &Source, gpu: &Gpu, watch: &Watch) -> Result<Box<ModelToShow>, EngineError> {
    let weld = WeldOptions::default();
    let mut beginning = None;
    let (mut project, mut recovered) = (None, None);
    let (loaded, path, source) = match source {
        Source::Sample => (
            pliant_engine::load_bytes(CREATURE.to_vec(), Path::new(SAMPLE_NAME), &weld, watch)?,
            None,
            MeshSource::Sample,
        ),
        Source::File(path) if !pliant_engine::is_project(path) => (
            pliant_engine::load(path, &weld, watch)?,
            Some(path.clone()),
            MeshSource::File(path.clone()),
        ),
        Source::Edited { file, edit } => {
            let (mut read, _) = pliant_engine::read_edit(edit, watch)?;
            let loaded = pliant_engine::load(file, &read.weld_options(), watch)?;
            examples::bring(&mut read, edit, &loaded, watch)?;
            beginning = Some(read);
            (loaded, Some(file.clone()), MeshSource::File(file.clone()))
        }
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
            // A recovered session's own mesh file is removed with the recovery, so it counts as gone.
            let source = match opened.source {
                MeshSource::File(_) if recovered.is_some() && is_in_folder_of(&opened.source, path) => MeshSource::Gone,
                source => source,
            };
            (opened.loaded, mesh, source)
        }
    };
    let progress = watch.begin("getting the picture ready");
    let notes: Vec<String> = loaded.scene.notes().to_vec();
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
