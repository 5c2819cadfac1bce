//! Pictures of a file on disk, as `pliant render` and Python's `render` draw them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use pliant_editor::Beginning;
use pliant_engine::EngineError;
use pliant_engine::files::{self, Destination};
use pliant_engine::watch::Watch;
use pliant_render::Image;

use crate::options::StillOptions;
use crate::shape::{Posed, Shape};
use crate::still::draw;
use crate::subject::{Subject, with_edit};

/// The input of [`draw_file`].
#[derive(Clone, Copy, Debug)]
pub struct OfFile<'a> {
    /// The file.
    pub file: &'a Path,
    /// The edit to show, and its file, or its name in messages.
    pub edit: Option<(&'a Beginning, &'a Path)>,
    /// The distance within which vertices are welded, in world units; `None` is the edit's own.
    pub weld: Option<f64>,
    /// The options.
    pub options: &'a StillOptions,
}

/// The files of the pictures: `output`, or for a turntable a number before its extension, as in `OUT-0001.png`.
/// `sources` are the given files with their roles.
///
/// # Errors
/// A name that is no picture's or no file's, or that of a source.
pub fn outputs(output: &Path, turntable: Option<u32>, sources: &[(&str, &Path)]) -> Result<Vec<PathBuf>, EngineError> {
    check_png(output)?;
    let numbered = |number: u32| {
        let mut name = output.file_stem().unwrap_or_default().to_owned();
        name.push(format!("-{number:04}.png"));
        output.with_file_name(name)
    };
    let paths: Vec<PathBuf> = match turntable {
        None => vec![output.to_owned()],
        Some(count) => (1..=count).map(numbered).collect(),
    };
    for path in &paths {
        files::refuse_shared(("--output", path), sources.iter().copied())?;
        // A name that is not a file's is refused before anything is drawn.
        Destination::of(path)?;
    }
    Ok(paths)
}

/// Refuses a name without a picture's extension.
///
/// # Errors
/// [`EngineError::Arguments`], naming it.
pub fn check_png(output: &Path) -> Result<(), EngineError> {
    let extension = output.extension();
    if extension.is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        return Ok(());
    }
    let output = files::shown(output);
    Err(EngineError::Arguments(format!(
        "--output {output} is not a .png: give a name that ends with .png"
    )))
}

/// Draws a file, at rest or with an edit applied, and hands each picture to `take`, whose colours are premultiplied by
/// alpha. `outputs` are the files for which they are meant; none may be a file that is read. The result describes the
/// parts of the file that the pictures don't show, a sentence each.
///
/// # Errors
/// Any refusal of the file, of the edit or of the device; an error of `take`; [`EngineError::Interrupted`].
pub fn draw_file(
    job: &OfFile<'_>,
    outputs: &[PathBuf],
    watch: &Watch,
    take: impl FnMut(Image) -> Result<(), EngineError>,
) -> Result<Vec<String>, EngineError> {
    let (loaded, edit) = with_edit(job.file, job.edit, job.weld, watch)?;
    let mut inside_out = BTreeSet::new();
    if let Some(edit) = &edit {
        inside_out.clone_from(&edit.setup.inside_out);
        pliant_engine::check_bends(job.file, &loaded.model, &edit.setup.method)?;
    }
    let outputs: Vec<(&str, &Path)> = outputs.iter().map(|path| ("--output", &**path)).collect();
    watch.refuse_outputs(&outputs, None)?;
    let posed = if edit.is_some() { Posed::Bent } else { Posed::AtRest };
    let shape = Shape::of(&loaded, edit.map(|edit| edit.edit), posed, watch)?;
    let subject = Subject {
        loaded: &loaded,
        shape: &shape,
        inside_out: &inside_out,
    };
    draw(&subject, job.options, watch, take)
}
