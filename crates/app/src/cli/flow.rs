//! `pliant flow`: dye that flows along a file's surface.

use pliant_engine::{EngineError, FlowJob, files, flow, memory, read_flow};
use pliant_io::Format;

use super::arguments::FlowArguments;
use crate::cli::console::{Console, warn};
use crate::cli::threads::on_threads;

pub(super) fn run(arguments: &FlowArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let FlowArguments {
        file,
        flow: flow_path,
        output,
        report,
        memory: most_memory,
        weld,
        compute,
    } = arguments;
    let output_name = output.to_string_lossy();
    Format::of_name(&output_name).map_err(|error| EngineError::Arguments(format!("--output: {error}")))?;
    files::refuse_shared(("--output", output), [("--flow", &**flow_path)])?;
    if let Some(report) = report {
        let others = [("FILE", &**file), ("--flow", flow_path), ("--output", output)];
        files::refuse_shared(("--report", report), others)?;
    }
    let read = read_flow(flow_path, &console.watch)?;
    let job = FlowJob {
        file,
        flow: &read,
        flow_path,
        output,
        report: report.as_deref(),
        weld: weld.options(),
        budget: memory::budget_within(*most_memory),
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let report = on_threads(*compute, || flow(&job, watch, staging))??;
    warn(console.err, &report.warnings);
    Ok(())
}
