//! `pliant animate`: an edit with keys over time.

use pliant_engine::{Animate, EditJob, EngineError, ExistingFrames, animate, files};

use super::apply::own_name;
use super::motion_arguments::AnimateArguments;
use crate::cli::console::{Console, warn};
use crate::cli::threads::on_threads;

pub(super) fn run(arguments: &AnimateArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let AnimateArguments {
        file,
        edit: edit_path,
        output,
        report,
        tolerance,
        fps,
        replace,
        bending,
    } = arguments;
    files::refuse_shared(("--output", output), [("--edit", &**edit_path)])?;
    if let Some(report) = report {
        let others = [("FILE", &**file), ("--edit", edit_path), ("--output", output)];
        files::refuse_shared(("--report", report), others)?;
    }
    let edit = bending.edit(edit_path, &console.watch)?;
    let name = own_name(edit_path);
    let job = Animate {
        job: EditJob {
            file,
            edit: &edit,
            edit_path,
            output,
            report: report.as_deref(),
            weld: bending.weld.weld,
            budget: bending.budget(),
        },
        name: &name,
        tolerance: *tolerance,
        fps: *fps,
        frames: ExistingFrames::replaced(*replace),
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let report = on_threads(bending.compute, || animate(&job, watch, staging))??;
    warn(console.err, &report.warnings);
    Ok(())
}
