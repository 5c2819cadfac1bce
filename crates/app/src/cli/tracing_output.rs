//! The times of stages, jobs and frames on standard error, for a person who looks for a fault or for lost time.
//!
//! `PLIANT_TRACE=debug` prints a line at the end of each stage of a command and of each job of the window, with its
//! time; `trace` adds the window's frames, and `pliant_engine=debug` prints the lines of one crate. Without the
//! variable nothing is recorded.

use std::io::{IsTerminal, stderr};

use pliant_engine::EngineError;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::fmt::format::FmtSpan;
use tracing_subscriber::layer::SubscriberExt;

/// The variable that asks for the output.
const VARIABLE: &str = "PLIANT_TRACE";

/// Begins the output if the environment asks for it.
///
/// # Errors
/// A value that is neither a level nor a list of targets with levels.
pub(crate) fn begin() -> Result<(), EngineError> {
    let Some(wanted) = std::env::var_os(VARIABLE) else {
        return Ok(());
    };
    let targets = targets(&wanted.to_string_lossy())?;
    let lines = tracing_subscriber::fmt::layer()
        .with_writer(stderr)
        .with_ansi(stderr().is_terminal())
        .with_span_events(FmtSpan::CLOSE);
    let subscriber = tracing_subscriber::registry().with(targets).with(lines);
    // An error means that a program which uses this library has its own output.
    let _ = tracing::subscriber::set_global_default(subscriber);
    Ok(())
}

/// Reads a level, which then holds for our own crates, or TARGET=LEVEL,..
fn targets(wanted: &str) -> Result<Targets, EngineError> {
    let own = |level: &str| format!("pliant_app={level},pliant_engine={level}");
    let text = match wanted.contains('=') {
        true => wanted.to_owned(),
        false => own(wanted),
    };
    text.parse().map_err(|_| {
        EngineError::Arguments(format!(
            "{VARIABLE}: give a level (info, debug, trace) or targets with levels, such as pliant_engine=debug"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::targets;
    use tracing::Level;

    #[test]
    fn a_level_holds_for_our_crates_and_targets_for_themselves() {
        let is_on = |wanted: &str, target: &str, level| targets(wanted).is_ok_and(|on| on.would_enable(target, &level));
        assert!(is_on("debug", "pliant_engine", Level::DEBUG) && is_on("debug", "pliant_app::window", Level::DEBUG));
        assert!(!is_on("debug", "pliant_app", Level::TRACE) && !is_on("debug", "wgpu_core", Level::ERROR));
        assert!(is_on("pliant_engine=trace", "pliant_engine", Level::TRACE));
        assert!(!is_on("pliant_engine=trace", "pliant_app", Level::ERROR));
        assert!(targets("loud").is_err());
    }
}
