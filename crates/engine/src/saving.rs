//! Saving a model: its files are encoded, named so that no file is lost, written beside their places and read back.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use pliant_io::{
    Format, MorphAnimation, MorphDeltas, MorphTarget, Placement, Role, Save, SaveError, Saved, Scene, SceneAndDrawn,
    UnsavedShape, quoted, with_neighbours_renamed,
};
use pliant_mesh::{Cancel, Drawn, Progress};
use tracing::info_span;

use crate::EngineError;
use crate::coloured::{save_targets_with_colours, save_with_colours};
use crate::files::check::{self, Written};
use crate::files::placement::{self, Action, Settled};
use crate::files::{self, Bridge, Destination, NewFile, Share, Staged, Staging, name_as_text};
use crate::loading::Loaded;
use crate::report::ms_since;

/// The content and the place of a save.
#[derive(Clone, Copy, Debug)]
pub struct SaveAs<'a> {
    /// The new world position of each drawn vertex.
    pub positions: &'a [DVec3],
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: &'a BTreeSet<u32>,
    /// The deltas of the file's morph targets: turning with the surface, or kept.
    pub deltas: MorphDeltas,
    /// Other colours, linear and from 0 to 65535, one for each drawn vertex.
    pub colours: Option<&'a [[u16; 4]]>,
    /// Saves the edit as a morph target beside the unchanged shape.
    pub morph: Option<&'a MorphTarget<'a>>,
    /// Saves an animation of morph targets; the shape is then that at rest.
    pub animation: Option<&'a MorphAnimation<'a>>,
    /// The file to write.
    pub output: &'a Path,
    /// A further output with a description: no neighbour may be the same file.
    pub beside: Option<(&'a str, &'a Destination)>,
}

impl<'a> SaveAs<'a> {
    /// Only a shape.
    pub fn shape(positions: &'a [DVec3], output: &'a Path) -> Self {
        Self {
            positions,
            inside_out: const { &BTreeSet::new() },
            deltas: MorphDeltas::default(),
            colours: None,
            morph: None,
            animation: None,
            output,
            beside: None,
        }
    }
}

/// A save that is ready to be committed.
#[derive(Debug)]
pub struct StagedSave {
    /// Its files.
    pub staged: Staged,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
    /// The time of reading back, in milliseconds.
    pub check_ms: f64,
}

/// A file that was read, to be saved with other positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Original<'a> {
    pub path: &'a Path,
    pub scene: &'a Scene,
    pub drawn: &'a Drawn,
    /// For each drawn vertex, whether its part is turned inside out; empty if none is.
    pub turned: &'a [bool],
}

/// Prepares a model's files: encoded, written beside their targets, synced and read back, ready for a commit.
///
/// # Errors
/// The format can't represent it or the disk can't store it; [`EngineError::ReadBack`] if the written files show
/// another shape; [`EngineError::Interrupted`] soon after `cancel` is raised. Nothing is left behind then.
pub fn stage(
    loaded: &Loaded,
    what: &SaveAs<'_>,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<StagedSave, EngineError> {
    let _span = info_span!("save", file = %what.output.display()).entered();
    check_names(loaded, what)?;
    let original = Original {
        path: &loaded.path,
        scene: &loaded.scene,
        drawn: &loaded.model.rest(),
        turned: &loaded.model.drawn_vertices_of(what.inside_out),
    };
    stage_of(&original, what, staging, progress, cancel)
}

/// Prepares the files of one that was read, as [`stage`] does.
///
/// # Errors
/// Those of [`stage`].
pub(crate) fn stage_of(
    original: &Original<'_>,
    what: &SaveAs<'_>,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<StagedSave, EngineError> {
    let to = Destination::of(what.output)?;
    // Encoding takes about as long as writing to the disk; reading back takes less.
    let (of_making, of_writing) = (progress.part(0.0, 0.4), progress.part(0.4, 0.8));
    let of_check = progress.part(0.8, 1.0);
    let format = Format::of_name(&what.output.to_string_lossy())?;
    let name = name_in(format, &to);
    let placed = (format, &*name, placement::placement(original.path, &to));
    let save = save_of(original, what, placed);
    let scene = original.scene;
    let saved = encoded(original, what, &save, &of_making, cancel)?;
    let triangles = saved.triangles.clone();
    let compare = |back: &SceneAndDrawn| scene.check_read_back(&save, what.morph, triangles.as_deref(), back);
    stage_saved(
        saved,
        format,
        (&to, what.beside),
        compare,
        staging,
        (&of_writing, &of_check, cancel),
    )
}

/// The save of a file in a format, under a name at a place.
fn save_of<'a>(
    original: &Original<'a>,
    what: &SaveAs<'a>,
    (format, name, placement): (Format, &'a str, Placement),
) -> Save<'a> {
    Save {
        deltas: what.deltas,
        turned: original.turned,
        drawn: original.drawn,
        positions: what.positions,
        format,
        name,
        placement,
    }
}

/// The bytes of a save and of its neighbours.
fn encoded(
    original: &Original<'_>,
    what: &SaveAs<'_>,
    save: &Save<'_>,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Saved, EngineError> {
    let scene = original.scene;
    let refused = |error| refused(what.output, error);
    let file = (original.path, scene);
    match (what.colours, what.morph, what.animation) {
        (Some(colours), None, None) => save_with_colours(file, save, colours, refused, (progress, cancel)),
        (Some(colours), Some(morph), _) => {
            let targets = |scene: &Scene, save: &Save<'_>, progress: &Progress| {
                scene.save_as_morph(save, morph, progress, cancel)
            };
            save_targets_with_colours(file, save, colours, targets, refused, (progress, cancel))
        }
        (Some(colours), None, Some(animation)) => {
            let targets = |scene: &Scene, save: &Save<'_>, progress: &Progress| {
                scene.save_as_animation(save, animation, progress, cancel)
            };
            save_targets_with_colours(file, save, colours, targets, refused, (progress, cancel))
        }
        (None, Some(morph), _) => scene.save_as_morph(save, morph, progress, cancel).map_err(refused),
        (None, None, Some(animation)) => scene
            .save_as_animation(save, animation, progress, cancel)
            .map_err(refused),
        (None, None, None) => scene.save(save, progress, cancel).map_err(refused),
    }
}

/// The files that a save over a file itself would write, in the format of `what.output`'s name.
///
/// # Errors
/// The format can't represent it; [`EngineError::Interrupted`] soon after `cancel` is raised.
pub(crate) fn in_memory(
    loaded: &Loaded,
    what: &SaveAs<'_>,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Saved, EngineError> {
    let original = Original {
        path: &loaded.path,
        scene: &loaded.scene,
        drawn: &loaded.model.rest(),
        turned: &loaded.model.drawn_vertices_of(what.inside_out),
    };
    let format = Format::of_name(&what.output.to_string_lossy())?;
    let name = name_as_text(what.output.file_name().unwrap_or_default());
    let save = save_of(&original, what, (format, &name, Placement::SameFile));
    encoded(&original, what, &save, progress, cancel)
}

/// The files of a new shape, in the format of `output`'s name.
///
/// # Errors
/// Those of [`in_memory`].
pub(crate) fn new_in_memory(
    shape: &UnsavedShape<'_>,
    output: &Path,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Saved, EngineError> {
    let format = Format::of_name(&output.to_string_lossy())?;
    let name = name_as_text(output.file_name().unwrap_or_default());
    let saved = shape.save(format, &name, progress, cancel);
    saved.map_err(|error| refused(output, error))
}

/// Refuses morph targets with names that others of the file already have.
fn check_names(loaded: &Loaded, what: &SaveAs<'_>) -> Result<(), EngineError> {
    let of_animation = what.animation.iter().flat_map(|animation| animation.target_names());
    let new = what.morph.map(|morph| morph.name.to_owned());
    let mut new = new.into_iter().chain(of_animation);
    let known = loaded.scene.morph_targets();
    match new.find(|name| known.contains(name)) {
        None => Ok(()),
        Some(name) => Err(EngineError::Unsupported(format!(
            "{} already has a morph target called {}: give the new one another name",
            files::shown(&loaded.path),
            quoted(&name)
        ))),
    }
}

/// Prepares the files of a shape that no file has yet, as [`stage`] does.
///
/// # Errors
/// Those of [`stage`].
pub fn stage_new(
    shape: &UnsavedShape<'_>,
    output: &Path,
    beside: Option<(&str, &Destination)>,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<StagedSave, EngineError> {
    let to = Destination::of(output)?;
    let (of_making, of_writing) = (progress.part(0.0, 0.4), progress.part(0.4, 0.8));
    let of_check = progress.part(0.8, 1.0);
    let format = Format::of_name(&output.to_string_lossy())?;
    let saved = shape.save(format, &name_in(format, &to), &of_making, cancel);
    let saved = saved.map_err(|error| refused(output, error))?;
    let triangles = saved.triangles.clone();
    let compare = |back: &SceneAndDrawn| shape.check_read_back(format, triangles.as_deref(), back);
    stage_saved(
        saved,
        format,
        (&to, beside),
        compare,
        staging,
        (&of_writing, &of_check, cancel),
    )
}

/// Names the neighbours of encoded files, writes all of them and reads them back.
fn stage_saved(
    mut saved: Saved,
    format: Format,
    (to, beside): (&Destination, Option<(&str, &Destination)>),
    compare: impl FnOnce(&SceneAndDrawn) -> Result<(), String>,
    staging: &Staging,
    (of_writing, of_check, cancel): (&Progress, &Progress, &Cancel),
) -> Result<StagedSave, EngineError> {
    // While files that name each other are written, no other save may write there.
    let is_alone = saved.files.len() > 1 || format == Format::Gltf;
    let share = if is_alone { Share::Alone } else { Share::Together };
    let further = beside.map(|(_, beside)| (beside, Share::Together));
    let held = staging.hold([(to, share)].into_iter().chain(further), cancel)?;
    let settled = placement::settle(&mut saved, format, to)?;
    if let Some((role, beside)) = beside {
        let neighbours = settled
            .iter()
            .map(|settled| ("a file that OUT needs", &*settled.at.target));
        files::refuse_shared((role, &beside.given), neighbours)?;
    }
    let (staged, names) = write(&saved, &settled, to, staging, of_writing, cancel)?;
    let staged = staged.holding(held);
    let Saved {
        files, mut warnings, ..
    } = saved;
    // The bytes are on the disk now and are read from there.
    drop(files);
    warnings.extend(staged.notes());

    let start = Instant::now();
    let last = names.len();
    let neighbours = names.into_iter().enumerate();
    let written = Written {
        output: to,
        file: staged.temporary(last),
        neighbours: neighbours.map(|(file, name)| (name, staged.temporary(file))).collect(),
    };
    check::read_back(&written, format, compare, of_check, cancel)?;
    Ok(StagedSave {
        staged,
        warnings,
        check_ms: ms_since(start),
    })
}

/// The bytes that [`stage`] writes for the model at rest under the name `output`, without its neighbours.
///
/// # Errors
/// Those of [`stage`].
pub fn bytes_at_rest(
    loaded: &Loaded,
    output: &Path,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Vec<u8>, EngineError> {
    let to = Destination::of(output)?;
    let format = Format::of_name(&output.to_string_lossy())?;
    let drawn = loaded.model.rest();
    let save = Save {
        deltas: MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &drawn,
        positions: &drawn.positions,
        format,
        name: &name_in(format, &to),
        placement: placement::placement(&loaded.path, &to),
    };
    let saved = loaded.scene.save(&save, progress, cancel);
    let saved = saved.map_err(|error| refused(output, error))?;
    let file = saved.files.into_iter().next();
    Ok(file.map(|file| file.bytes).unwrap_or_default())
}

/// The name of OUT in its format.
fn name_in(format: Format, to: &Destination) -> String {
    match format {
        // Only URIs can name files whose names are not UTF-8.
        Format::Glb | Format::Gltf => name_as_text(to.name()),
        _ => to.name().to_string_lossy().into_owned(),
    }
}

fn refused(file: &Path, error: SaveError) -> EngineError {
    match error {
        SaveError::Cancelled(_) => EngineError::Interrupted,
        source => EngineError::Save {
            file: file.to_owned(),
            source,
        },
    }
}

/// Writes OUT's neighbours and then OUT beside their places. Returns the names of the written neighbours too.
fn write(
    saved: &Saved,
    settled: &[Settled],
    to: &Destination,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(Staged, Vec<String>), EngineError> {
    // Neighbours come first: the file that names them must not exist without them.
    let neighbours: Vec<&Settled> = settled
        .iter()
        .filter(|settled| settled.action == Action::Write)
        .collect();
    let names: Vec<String> = neighbours
        .iter()
        .map(|settled| saved.files[settled.file].name.clone())
        .collect();
    let mut files: Vec<NewFile<'_>> = neighbours
        .iter()
        .map(|settled| NewFile {
            to: settled.at.clone(),
            bytes: &saved.files[settled.file].bytes,
        })
        .collect();
    files.push(NewFile {
        to: to.clone(),
        bytes: &saved.files[0].bytes,
    });
    // Only a glTF's neighbours can be edited or belong to this document alone, and so be replaced.
    let is_bridged = neighbours
        .iter()
        .all(|settled| saved.files[settled.file].role != Role::Library);
    let passing: Vec<String> = names.iter().map(|name| files::passing_name(name)).collect();
    let renamed: Vec<(&str, String)> = names.iter().map(String::as_str).zip(passing.iter().cloned()).collect();
    let bytes = is_bridged
        .then(|| with_neighbours_renamed(&saved.files[0].bytes, &renamed))
        .flatten();
    let bridge = bytes.as_deref().map(|bytes| Bridge {
        file: names.len(),
        bytes,
        neighbours: passing.into_iter().enumerate().collect(),
    });
    let staged = staging.stage_watched(&files, bridge.as_ref(), progress, cancel)?;
    Ok((staged, names))
}
