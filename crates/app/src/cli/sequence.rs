//! `pliant sequence`: an edit of a sequence of shapes.

use pliant_engine::{EditJob, EngineError, ExistingFrames, Sequence, files, sequence};

use super::apply::own_name;
use super::motion_arguments::SequenceArguments;
use crate::cli::console::{Console, warn};
use crate::cli::threads::on_threads;

pub(super) fn run(arguments: &SequenceArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let SequenceArguments {
        frames,
        mesh,
        edit: edit_path,
        output,
        report,
        fps,
        replace,
        bending,
    } = arguments;
    if let Some(report) = report {
        files::refuse_shared(("--report", report), [("--edit", &**edit_path), ("--output", output)])?;
    }
    let edit = bending.edit(edit_path, &console.watch)?;
    let job = Sequence {
        mesh: mesh.as_deref(),
        fps: *fps,
        name: &own_name(edit_path),
        frames: ExistingFrames::replaced(*replace),
        job: EditJob {
            file: frames,
            edit: &edit,
            edit_path,
            output,
            report: report.as_deref(),
            weld: bending.weld.weld,
            budget: bending.budget(),
        },
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let report = on_threads(bending.compute, || sequence(&job, watch, staging))??;
    warn(console.err, &report.warnings);
    Ok(())
}
