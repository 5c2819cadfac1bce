//! `pliant transfer`: a pose of one mesh put onto another.

use pliant_io::Format;

use super::arguments::TransferArguments;
use crate::cli::console::{Console, warn};
use crate::cli::threads::on_threads;
use pliant_engine::{EngineError, Transfer, transfer};

pub(super) fn run(arguments: &TransferArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let output_name = arguments.output.to_string_lossy();
    Format::of_name(&output_name).map_err(|error| EngineError::Arguments(format!("--output: {error}")))?;
    let own_name = arguments.pose.file_stem().unwrap_or_default().to_string_lossy();
    let job = Transfer {
        source: &arguments.source,
        pose: &arguments.pose,
        target: &arguments.target,
        correspondences: arguments.correspondences.as_deref(),
        output: &arguments.output,
        weld: arguments.weld.options(),
        deltas: arguments.morph.deltas(),
        morph: arguments.morph.target(&own_name),
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let warnings = on_threads(arguments.compute, || transfer(&job, watch, staging))??;
    warn(console.err, &warnings);
    Ok(())
}
