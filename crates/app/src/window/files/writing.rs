//! Writing the model, a project, an edit or a picture, off the window's thread.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{EditFile, Snapshot};
use pliant_io::MorphTarget;
use pliant_mesh::{Cancel, Progress};
use pliant_render::Image;

use super::names::{file_name, is_gltf, original_name};
use super::project_file::{self, MeshSource};
use crate::picture_file;
use crate::window::threads::message::{Written, WrittenKind};
use pliant_engine::files::{self, Destination, NewFile, Staged, Staging};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::{EngineError, Loaded};

/// What is to be written.
pub(super) struct SaveRequest {
    pub path: PathBuf,
    pub content: Content,
    /// The files of the open model, which nothing else may be saved over.
    pub sources: Vec<PathBuf>,
}

/// What it holds.
pub(super) enum Content {
    Model(Model),
    Project {
        snapshot: Box<Snapshot>,
        loaded: Arc<Loaded>,
        source: MeshSource,
    },
    /// The mesh at rest with its bent shape as a morph target.
    Morph {
        loaded: Arc<Loaded>,
        displacements: Arc<Vec<DVec3>>,
        inside_out: Arc<BTreeSet<u32>>,
    },
    Edit(Box<EditFile>),
    Picture(Image),
}

/// The bent mesh.
pub(super) struct Model {
    pub loaded: Arc<Loaded>,
    pub displacements: Arc<Vec<DVec3>>,
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: Arc<BTreeSet<u32>>,
    pub keep_original: KeepOriginal,
    pub source: MeshSource,
}

/// Whether the file that a save replaces is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum KeepOriginal {
    /// Under [`original_name`], unless such a file exists already: that one is older and stays.
    Yes,
    /// It is one of ours.
    No,
}

/// Writes the content. A save that was stopped in time has changed nothing.
pub(super) fn write(request: SaveRequest, progress: &Progress, cancel: &Cancel) -> Result<Written, String> {
    let name = file_name(&request.path);
    write_unless_stopped(request, progress, cancel).map_err(|error| match error {
        EngineError::Interrupted => {
            format!("Saving {name} was stopped: nothing was written. Save again when you like.")
        }
        error => error.to_string(),
    })
}

fn write_unless_stopped(request: SaveRequest, progress: &Progress, cancel: &Cancel) -> Result<Written, EngineError> {
    let SaveRequest { path, content, sources } = request;
    let go_on = || cancel.check().map_err(|_| EngineError::Interrupted);
    // What has begun shows that it has.
    progress.set(0.02);
    go_on()?;
    let progress = progress.part(0.02, 1.0);
    let staging = Staging::default();
    if !matches!(content, Content::Model { .. }) {
        let sources = sources
            .iter()
            .map(|source| ("the open file or one that it needs", &**source));
        files::refuse_shared(("the file to be saved,", &path), sources)?;
    }
    let written = |path, what, warnings| Written { path, what, warnings };
    match content {
        Content::Picture(image) => {
            let png = picture_file::png(image)?;
            staging.stage([(path.clone(), &*png)])?.commit()?;
            Ok(written(path, WrittenKind::Picture, Vec::new()))
        }
        Content::Edit(edit) => {
            let text = edit.to_json();
            staging.stage([(path.clone(), text.as_bytes())])?.commit()?;
            Ok(written(path, WrittenKind::Edit, Vec::new()))
        }
        Content::Project {
            snapshot,
            loaded,
            source,
        } => {
            project_file::write(&snapshot, &loaded, &source, &path, &staging, &progress, cancel)?;
            Ok(written(path, WrittenKind::Project, Vec::new()))
        }
        Content::Morph {
            loaded,
            displacements,
            inside_out,
        } => {
            let mut positions = Vec::new();
            loaded.model.drawn_positions(&displacements, &mut positions);
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let morph = MorphTarget {
                name: &stem,
                weight: 1.0,
            };
            let save = SaveAs {
                morph: Some(&morph),
                inside_out: &inside_out,
                ..SaveAs::shape(&positions, &path)
            };
            let saved = saving::stage(&loaded, &save, &staging, &progress, cancel)?;
            go_on()?;
            saved.staged.commit()?;
            Ok(written(path, WrittenKind::Morph, saved.warnings))
        }
        Content::Model(model) => {
            let (moved, warnings) = write_model(&model, &path, &staging, &progress, cancel)?;
            Ok(written(path, WrittenKind::Model(moved), warnings))
        }
    }
}

/// Writes the model. Returns where the mesh as it was read is now, if that changed, and warnings.
fn write_model(
    model: &Model,
    path: &Path,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(Option<MeshSource>, Vec<String>), EngineError> {
    let loaded = &*model.loaded;
    let go_on = || cancel.check().map_err(|_| EngineError::Interrupted);
    let mut positions = Vec::new();
    loaded.model.drawn_positions(&model.displacements, &mut positions);
    go_on()?;
    let original = original_name(path);
    let keeps = model.keep_original == KeepOriginal::Yes && !original.exists();
    let split = if keeps { 0.5 } else { 1.0 };
    let (of_save, of_original) = (progress.part(0.0, split), progress.part(split, 1.0));
    let neighbours = loaded
        .neighbours
        .iter()
        .map(|path| ("a file that the open one needs", &**path));
    files::refuse_shared(("the file to be saved,", path), neighbours)?;
    let save = SaveAs {
        inside_out: &model.inside_out,
        ..SaveAs::shape(&positions, path)
    };
    let saved = saving::stage(loaded, &save, staging, &of_save, cancel)?;
    let (mut staged, warnings) = (saved.staged, saved.warnings);
    let is_source = matches!(&model.source, MeshSource::File(mesh) if files::is_same(mesh, path));
    let mut moved = is_source.then_some(MeshSource::Gone);
    if keeps {
        // The original first: the file that replaces it must not be there without it.
        staged = stage_original(loaded, path, &original, staging, &of_original, cancel)?.and(staged);
        moved = moved.map(|_| MeshSource::File(original));
    }
    go_on()?;
    staged.commit()?;
    Ok((moved, warnings))
}

/// Stages the file at `path` under the name `original`.
fn stage_original(
    loaded: &Loaded,
    path: &Path,
    original: &Path,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Staged, EngineError> {
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
