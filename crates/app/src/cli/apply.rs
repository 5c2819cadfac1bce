//! `pliant apply`: an edit applied to a file.

use std::path::Path;

use pliant_io::Format;

use super::arguments::ApplyArguments;
use crate::cli::console::{Console, warn};
use crate::cli::threads::on_threads;
use pliant_engine::{EditJob, EngineError, files};

pub(super) fn run(arguments: &ApplyArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let ApplyArguments {
        file,
        edit: edit_path,
        output,
        report,
        morph,
        frames,
        bending,
    } = arguments;
    let output_name = output.to_string_lossy();
    Format::of_name(&output_name).map_err(|error| EngineError::Arguments(format!("--output: {error}")))?;
    files::refuse_shared(("--output", output), [("--edit", &**edit_path)])?;
    if let Some(report) = report {
        let others = [("FILE", &**file), ("--edit", edit_path), ("--output", output)];
        files::refuse_shared(("--report", report), others)?;
    }
    let edit = bending.edit(edit_path, &console.watch)?;
    let own_name = own_name(edit_path);
    let (deltas, morph) = (morph.deltas(), morph.target(&own_name));
    let job = pliant_engine::Apply {
        job: EditJob {
            file,
            edit: &edit,
            edit_path,
            output,
            report: report.as_deref(),
            weld: bending.weld.weld,
            budget: bending.budget(),
        },
        frames: *frames,
        deltas,
        morph,
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let report = on_threads(bending.compute, || pliant_engine::apply(&job, watch, staging))??;
    warn(console.err, &report.warnings);
    Ok(())
}

/// The name of an edit, for its morph targets and animations: its file's, without extensions.
pub(super) fn own_name(edit: &Path) -> String {
    let stem = edit.file_stem().unwrap_or_default().to_string_lossy();
    stem.strip_suffix(".edit").unwrap_or(&stem).to_owned()
}
