//! Shapes: `apply` and `save`.

use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_engine::files::{self, Destination};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::stitching::Replace;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Given};
use pliant_io::Format;
use pliant_mesh::WeldOptions;
use pliant_picture::{Resolved, resolved};
use serde::Deserialize;
use serde_json::Value;

use super::answer::Answer;
use super::models::{Bent, Models, Opened};
use crate::cli::method_argument::method_argument;
use crate::cli::replaced::keep_replaced;

/// The arguments of `apply`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Apply {
    model: String,
    edit: Value,
    method: Option<String>,
}

/// The arguments of `save`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Save {
    model: String,
    output: PathBuf,
    #[serde(default)]
    replace: bool,
}

/// An edit as a path, or as its contents.
pub fn given_edit(edit: Value) -> Given {
    match edit {
        Value::String(path) => Given::File(path.into()),
        contents => Given::Contents(contents, "edit"),
    }
}

/// Bends a model by an edit, in place of an earlier one.
pub fn apply(models: &mut Models, given: Apply, watch: &Watch) -> Result<Answer, EngineError> {
    let opened = models.get(&given.model)?;
    let watch = opened.watch.of_next(&watch.cancel);
    let source = given_edit(given.edit);
    let mut edit = source.edit(&watch)?;
    if let Some(name) = &given.method {
        edit.set_method(method_argument("method", name)?);
    }
    let loaded = &opened.loaded;
    check_weld(opened, edit.weld_options())?;
    let Resolved { edit: fitting, setup } = resolved(&edit, source.place(), loaded, &watch)?;
    let solved = pliant_engine::solved(&loaded.path, &fitting, None, loaded, &setup, &watch)?;
    let rest = loaded.model.surface.positions.iter();
    let displacements: Vec<DVec3> = solved
        .surface_positions
        .iter()
        .zip(rest)
        .map(|(bent, rest)| *bent - *rest)
        .collect();
    opened.bent = Some(Bent {
        edit,
        place: source.place().to_owned(),
        inside_out: setup.inside_out,
        positions: solved.positions,
        displacements,
    });
    Ok(Answer::text(solved.report.to_json()))
}

/// Refuses an edit that welds otherwise than the model was read.
fn check_weld(opened: &Opened, own: WeldOptions) -> Result<(), EngineError> {
    match own.distance {
        Some(distance) if opened.weld != own => Err(EngineError::Arguments(format!(
            "the edit welds within {distance}, but the model was opened otherwise: open the file again with the weld \
             {distance}"
        ))),
        _ => Ok(()),
    }
}

/// Saves a model's shape, with the same bytes as `pliant apply`. A file that is replaced is kept beside it.
pub fn save(models: &mut Models, given: Save, watch: &Watch) -> Result<Answer, EngineError> {
    let staging = models.staging.clone();
    let Save { model, output, replace } = given;
    let opened = models.get(&model)?;
    let watch = opened.watch.of_next(&watch.cancel);
    check_output(&opened.loaded.path, &output, replace)?;
    watch.refuse_outputs(&[("--output", &output)], Some(&opened.loaded.path))?;

    let at_rest;
    let (positions, inside_out) = match &opened.bent {
        Some(bent) => (&bent.positions, &bent.inside_out),
        None => {
            at_rest = opened.loaded.model.rest_positions();
            (&at_rest, &Default::default())
        }
    };
    let what = SaveAs {
        inside_out,
        ..SaveAs::shape(positions, &output)
    };
    let loaded = &opened.loaded;
    let progress = watch.begin("saving");
    let saved = saving::stage(loaded, &what, &staging, &progress, &watch.cancel)?;
    loaded.refuse_changed(&saved.staged)?;
    let (kept, first) = keep_replaced(loaded, &output, &staging, &watch.cancel)?;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    let staged = match first {
        Some(first) => first.and(saved.staged),
        None => saved.staged,
    };
    staged.commit()?;

    let mut said = format!("saved {}", files::shown(&output));
    if let Some(kept) = kept {
        said += &format!("; the original is kept as {}", files::shown(&kept));
    }
    if files::is_same(&loaded.path, &output) {
        let watch = Watch::cancelled_by(&watch.cancel);
        opened.loaded = pliant_engine::load(&output, &opened.weld, &watch)?;
        opened.watch = watch;
        opened.bent = None;
        said += &format!("; {model} is now the saved file, without an edit");
    }
    let warnings = saved
        .warnings
        .into_iter()
        .map(|warning| format!("\nwarning: {warning}"));
    Ok(Answer::text(said + &warnings.collect::<String>()))
}

/// Refuses a file that is there already, unless it may be replaced.
fn check_output(source: &Path, output: &Path, replace: bool) -> Result<(), EngineError> {
    Format::of_name(&output.to_string_lossy()).map_err(|error| EngineError::Arguments(format!("output: {error}")))?;
    let to = Destination::of(output)?;
    if replace {
        return Ok(());
    }
    Replace::Never.check(source, output)?;
    match to.existing()? {
        None => Ok(()),
        Some(_) => Err(EngineError::Arguments(format!(
            "output {} is there already: give another name, or set `replace` to true, which keeps the old file beside \
             the new one",
            files::shown(output)
        ))),
    }
}
