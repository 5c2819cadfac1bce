//! Writing the model, a project, an edit or a picture, off the window's thread.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pliant_io::MorphTarget;
use pliant_mesh::{Cancel, Progress};
use pliant_render::Image;

use super::in_file::SavedShape;
use super::project_file;
use super::rest_mesh::MeshSource;
use super::save_request::{
    AnimationToWrite, Changed, Content, FlowToWrite, KeepOriginal, Model, SaveRequest, Shape, Unwritten, Written,
    WrittenKind,
};
use super::written_frames;
use crate::files::names::file_name;
use crate::files::original::{Kept, Original};
use pliant_editor::Beginning;
use pliant_engine::files::{self, Staged, Staging, Stamp};
use pliant_engine::flow::{ColoursToSave, PlayedFlow, stage_played_flow, with_dye};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::{Animate, EditJob, MORPH_TOLERANCE, memory, stage_animation};
use pliant_engine::{EngineError, Loaded};
use pliant_picture::picture_file;

/// Writes the content. A save that was stopped in time has changed nothing.
///
/// # Errors
/// [`Unwritten::Changed`] if another program has changed a file that would be replaced, [`Unwritten::FramesExist`] if
/// numbered files would be, and [`Unwritten::Refused`] with a sentence otherwise; every file is then unchanged.
pub fn write(request: SaveRequest, progress: &Progress, cancel: &Cancel) -> Result<Written, Unwritten> {
    let name = file_name(&request.path);
    let stopped = || {
        let sentence = format!("Saving {name} was stopped, and nothing was written: save again to write it.");
        Unwritten::Refused(sentence)
    };
    match write_unless_changed(&request, progress, cancel) {
        Ok(Ok(written)) => Ok(written),
        Ok(Err(changed)) => Err(Unwritten::Changed(changed, Box::new(request))),
        Err(EngineError::FramesExist { first, count }) => Err(Unwritten::FramesExist {
            first,
            count,
            request: Box::new(request),
        }),
        Err(EngineError::Interrupted) => Err(stopped()),
        Err(error) => Err(Unwritten::Refused(error.to_string())),
    }
}

/// Files that are ready to be committed.
struct Ready {
    staged: Staged,
    what: WrittenKind,
    notes: Vec<String>,
    /// A file that contains the mesh as it was read once this is committed.
    copy: Option<PathBuf>,
}

impl Ready {
    fn new(staged: Staged, what: WrittenKind) -> Self {
        Self {
            staged,
            what,
            notes: Vec::new(),
            copy: None,
        }
    }
}

/// Writes the content, or returns the file that another program has changed.
fn write_unless_changed(
    request: &SaveRequest,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Result<Written, PathBuf>, EngineError> {
    let SaveRequest {
        path, content, known, ..
    } = request;
    let is_changed = |path: &Path| request.changed == Changed::Ask && known.is_changed(path);
    let go_on = || cancel.check().map_err(|_| EngineError::Interrupted);
    // The progress shows that the work has begun.
    progress.set(0.02);
    go_on()?;
    // This comes before the work, so that the question comes at once, and again after it.
    if is_changed(path) {
        return Ok(Err(path.clone()));
    }
    if let Content::Frames(frames) = content {
        let notes = written_frames::write(frames, path, cancel)?;
        return Ok(Ok(written(request, WrittenKind::Frames, notes)));
    }
    let progress = progress.part(0.02, 1.0);
    let staging = Staging::default();
    let (sources, role) = match content {
        Content::Model(model) => {
            let neighbours = model.mesh.loaded.neighbours.iter();
            let neighbours = neighbours.map(|(path, _)| path.clone()).collect();
            (neighbours, "a file that the open one needs")
        }
        _ => (request.sources.clone(), "the open file or one that it needs"),
    };
    let sources = sources.iter().map(|source| (role, &**source));
    files::refuse_shared(("the file to be saved,", path), sources)?;
    let Ready {
        staged,
        what,
        notes,
        copy,
    } = ready(request, &staging, &progress, cancel)?;
    go_on()?;
    if let Some(changed) = staged.targets().find(|target| is_changed(target)) {
        return Ok(Err(changed.to_owned()));
    }
    let stamps = staged.stamps()?;
    staged.commit()?;
    for (target, stamp) in stamps {
        known.note(&target, stamp);
    }
    if let (Some(mesh), Some(copy)) = (content.mesh(), copy)
        && let Ok(stamp) = Stamp::of(&copy)
    {
        mesh.note_copy(&copy, stamp);
    }
    Ok(Ok(written(request, what, notes)))
}

fn written(request: &SaveRequest, what: WrittenKind, notes: Vec<String>) -> Written {
    Written {
        path: request.path.clone(),
        what,
        notes,
        mark: request.mark,
        opened: request.opened,
    }
}

fn ready(request: &SaveRequest, staging: &Staging, progress: &Progress, cancel: &Cancel) -> Result<Ready, EngineError> {
    let path = &request.path;
    match &request.content {
        Content::Picture(image) => {
            let png = picture_file::png(Image::clone(image))?;
            Ok(Ready::new(
                staging.stage([(path.clone(), &*png)])?,
                WrittenKind::Picture,
            ))
        }
        Content::Edit(edit, model) => {
            let mut edit = edit.with_places(model).map_err(|source| EngineError::Edit {
                edit: path.clone(),
                source,
            })?;
            cancel.check().map_err(|_| EngineError::Interrupted)?;
            if let Some(mix) = &mut edit.mix {
                mix.sequence = project_file::relative(Path::new(&mix.sequence), files::folder_of(path));
            }
            let text = edit.to_json();
            let staged = staging.stage([(path.clone(), text.as_bytes())])?;
            Ok(Ready::new(staged, WrittenKind::Edit))
        }
        Content::Project(snapshot, mesh) => {
            let project = project_file::stage(snapshot, mesh, path, staging, progress, cancel)?;
            Ok(Ready {
                copy: project.kept,
                ..Ready::new(project.staged, WrittenKind::Project)
            })
        }
        Content::Morph(shape, mesh) => {
            let mut positions = Vec::new();
            mesh.loaded.model.drawn_positions(&shape.displacements, &mut positions);
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let morph = MorphTarget {
                name: &stem,
                weight: 1.0,
            };
            let ColoursToSave { colours, lost } = colours(shape, &mesh.loaded, path, true);
            let save = SaveAs {
                morph: Some(&morph),
                inside_out: &shape.inside_out,
                colours: colours.as_deref(),
                ..SaveAs::shape(&positions, path)
            };
            let saved = saving::stage(&mesh.loaded, &save, staging, progress, cancel)?;
            Ok(Ready {
                notes: saved.warnings.into_iter().chain(lost).collect(),
                ..Ready::new(saved.staged, WrittenKind::Morph)
            })
        }
        // They are written by themselves.
        Content::Frames(_) => Err(EngineError::Interrupted),
        Content::Animation(animation) => ready_animation(animation, path, staging, cancel),
        Content::Flow(flow) => ready_flow(flow, path, staging, cancel),
        Content::Model(model) => ready_model(model, path, staging, progress, cancel),
    }
}

/// The frames of the edit over time, by the function of `pliant animate`.
fn ready_animation(
    animation: &AnimationToWrite,
    path: &Path,
    staging: &Staging,
    cancel: &Cancel,
) -> Result<Ready, EngineError> {
    let loaded = &*animation.mesh.loaded;
    let beginning = Beginning::from(animation.edit.clone());
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let wanted = Animate {
        job: EditJob {
            file: &loaded.path,
            edit: &beginning,
            edit_path: Path::new("the present edit"),
            output: path,
            report: None,
            weld: None,
            budget: memory::budget(),
        },
        name: &stem,
        tolerance: MORPH_TOLERANCE,
        fps: animation.fps,
        frames: animation.frames,
    };
    let watch = animation.watch.stopped_by(cancel);
    let dye = animation.dye.as_ref().map(|dye| dye.as_slice());
    let animated = stage_animation(&wanted, loaded, (&animation.edit, dye), &watch, staging)?;
    Ok(Ready {
        notes: animated.report.warnings,
        ..Ready::new(animated.staged, WrittenKind::Animation)
    })
}

/// The frames of a flow.
fn ready_flow(flow: &FlowToWrite, path: &Path, staging: &Staging, cancel: &Cancel) -> Result<Ready, EngineError> {
    let loaded = &*flow.mesh.loaded;
    let mut positions = Vec::new();
    loaded.model.drawn_positions(&flow.shape.displacements, &mut positions);
    let played = PlayedFlow {
        recording: &flow.recording,
        loaded,
        positions: &positions,
        inside_out: &flow.shape.inside_out,
        output: path,
        fps: flow.fps,
        frames: flow.frames,
        budget: memory::budget(),
    };
    let staged = stage_played_flow(&played, &flow.watch.stopped_by(cancel), staging)?;
    Ok(Ready {
        notes: staged.warnings,
        ..Ready::new(staged.staged, WrittenKind::Animation)
    })
}

/// The colours of a shape with kept dye.
fn colours(shape: &Shape, loaded: &Loaded, path: &Path, as_morph: bool) -> ColoursToSave {
    let dye = shape.dye.as_ref();
    dye.map_or_else(ColoursToSave::default, |dye| with_dye(loaded, dye, path, as_morph))
}

/// The model, together with the original of the file that it replaces.
fn ready_model(
    model: &Model,
    path: &Path,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Ready, EngineError> {
    let Model { mesh, shape, .. } = model;
    let loaded = &*mesh.loaded;
    let mut positions = Vec::new();
    loaded.model.drawn_positions(&shape.displacements, &mut positions);
    cancel.check().map_err(|_| EngineError::Interrupted)?;
    let is_source = matches!(&mesh.source, MeshSource::File(file) if files::is_same(file, path));
    let keeps = model.keep_original == KeepOriginal::Yes || is_source;
    let split = if keeps { 0.5 } else { 1.0 };
    let (of_save, of_original) = (progress.part(0.0, split), progress.part(split, 1.0));
    let ColoursToSave { colours, lost } = colours(shape, loaded, path, false);
    let save = SaveAs {
        inside_out: &shape.inside_out,
        colours: colours.as_deref(),
        ..SaveAs::shape(&positions, path)
    };
    let saved = saving::stage(loaded, &save, staging, &of_save, cancel)?;
    let written = |source| WrittenKind::Model {
        of: Arc::clone(&mesh.loaded),
        source,
        saved: SavedShape {
            displacements: Arc::clone(&shape.displacements),
            dye: shape.dye.clone().filter(|_| colours.is_some()),
        },
    };
    let mut ready = Ready {
        notes: saved.warnings.into_iter().chain(lost).collect(),
        ..Ready::new(saved.staged, written(is_source.then_some(MeshSource::Gone)))
    };
    if !keeps {
        return Ok(ready);
    }
    let originals = [
        Some(Original::of(path, loaded, cancel)?),
        Original::as_read(path, loaded),
    ];
    let mut taken = Vec::new();
    for original in originals.into_iter().flatten() {
        let (kept, staged) = original.keep(&taken, loaded, staging, &of_original, cancel)?;
        if let Some(original) = staged {
            // The original comes first: the file that replaces it must not exist without it.
            ready.staged = original.and(ready.staged);
        }
        let is_former = original.is_former(loaded);
        let (place, sentence) = match kept {
            Kept::Nothing => continue,
            Kept::Already(place) => {
                let sentence = format!("The original is already kept as {}.", file_name(&place));
                (place, sentence)
            }
            Kept::Under(place) => {
                let which = if is_former { "opened" } else { "previous" };
                let sentence = format!("The {which} file is kept as {}.", file_name(&place));
                (place, sentence)
            }
        };
        ready.notes.insert(taken.len(), sentence);
        taken.push(place.clone());
        if is_source && (is_former || mesh.is_in(path, Stamp::is_current)) {
            ready.what = written(Some(MeshSource::File(place.clone())));
            ready.copy = Some(place);
        }
    }
    Ok(ready)
}
