//! `pliant sequence`: an edit of a sequence of shapes.

use pliant_engine::{EngineError, Sequence, files, memory, read_edit, sequence};

use super::method_argument::method_argument;
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
        method,
        memory: most_memory,
        weld,
        compute,
    } = arguments;
    if let Some(report) = report {
        files::refuse_shared(("--report", report), [("--edit", &**edit_path), ("--output", output)])?;
    }
    let method = method.as_deref();
    let method = method.map(|name| method_argument("--method", name)).transpose()?;
    let mut edit = read_edit(edit_path, &console.watch)?;
    if let Some(method) = method {
        edit.set_method(method);
    }
    let job = Sequence {
        frames,
        mesh: mesh.as_deref(),
        edit: &edit,
        edit_path,
        output,
        report: report.as_deref(),
        weld: weld.weld,
        budget: memory::budget_within(*most_memory),
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let report = on_threads(*compute, || sequence(&job, watch, staging))??;
    warn(console.err, &report.warnings);
    Ok(())
}
