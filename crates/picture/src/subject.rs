//! A file with an edit that fits it, to be drawn.

use std::collections::BTreeSet;
use std::path::Path;

use pliant_editor::{Beginning, Setup};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, examples};
use pliant_mesh::WeldOptions;

use crate::shape::Shape;

/// A file and the shape in which it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The file.
    pub loaded: &'a Loaded,
    /// The shape.
    pub shape: &'a Shape,
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: &'a BTreeSet<u32>,
}

/// An edit that fits a file, with the files that it names, and its setup.
#[derive(Debug)]
pub struct Resolved {
    /// The edit.
    pub edit: Beginning,
    /// Its setup on the file.
    pub setup: Setup,
}

/// Reads a file with a shape, and makes the edit fit it, if there is one; `place` is the edit's file, or its name in
/// messages. The vertices are welded within `weld`, or else as the edit says.
///
/// # Errors
/// Those of `apply` before it binds.
pub fn with_edit(
    file: &Path,
    edit: Option<(&Beginning, &Path)>,
    weld: Option<f64>,
    watch: &Watch,
) -> Result<(Loaded, Option<Resolved>), EngineError> {
    let weld = match (weld, edit) {
        (None, Some((edit, _))) => edit.weld_options(),
        (distance, _) => WeldOptions { distance },
    };
    let loaded = pliant_engine::load(file, &weld, watch)?;
    pliant_engine::check_not_empty(file, &loaded.model)?;
    let edit = edit.map(|(edit, place)| resolved(edit, place, &loaded, watch));
    let edit = edit.transpose()?;
    Ok((loaded, edit))
}

/// Makes an edit fit the model, with the same refusals as `apply`: the editor itself would accept any edit.
///
/// # Errors
/// The edit does not fit, or a file that it names can't be read.
pub fn resolved(edit: &Beginning, place: &Path, loaded: &Loaded, watch: &Watch) -> Result<Resolved, EngineError> {
    let mut edit = edit.clone();
    examples::bring(&mut edit, place, loaded, watch)?;
    let setup = edit.resolve(&loaded.model).map_err(|source| EngineError::Edit {
        edit: place.to_owned(),
        source,
    })?;
    Ok(Resolved { edit, setup })
}
