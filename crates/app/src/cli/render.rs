//! `pliant render`: a picture of a file, at rest or with an edit applied, as the window shows it.

use std::path::PathBuf;

use pliant_picture::{OfFile, draw_file, outputs, picture_file};

use super::picture_arguments::RenderArguments;
use super::shared_arguments::ComputeArguments;
use crate::cli::console::{Console, print};
use crate::cli::threads::on_threads;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, read_edit};

pub(super) fn run(arguments: &RenderArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let watch = &console.watch;
    let mut sources = vec![("FILE", &*arguments.file)];
    sources.extend(arguments.edit.as_deref().map(|edit| ("--edit", edit)));
    let paths = outputs(&arguments.output, arguments.turntable, &sources)?;
    let Pictures { pngs, notes } = on_threads(ComputeArguments::default(), || pictures(arguments, &paths, watch))??;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    let files = paths.into_iter().zip(pngs.iter().map(Vec::as_slice));
    console.staging.stage(files)?.commit()?;
    let lines: String = notes.iter().map(|note| format!("note: {note}\n")).collect();
    print(console.out, &lines)
}

/// The pictures.
struct Pictures {
    pngs: Vec<Vec<u8>>,
    /// The parts of the file that they don't show, a sentence each.
    notes: Vec<String>,
}

/// The pictures that go to `paths`.
fn pictures(arguments: &RenderArguments, paths: &[PathBuf], watch: &Watch) -> Result<Pictures, EngineError> {
    let place = arguments.edit.as_deref();
    let edit = place.map(|path| read_edit(path, watch)).transpose()?;
    let job = OfFile {
        file: &arguments.file,
        edit: edit.as_ref().zip(place),
        weld: arguments.weld.weld,
        options: &arguments.options(),
    };
    let mut pngs = Vec::new();
    let notes = draw_file(&job, paths, watch, |picture| {
        pngs.push(picture_file::png(picture)?);
        Ok(())
    })?;
    Ok(Pictures { pngs, notes })
}
