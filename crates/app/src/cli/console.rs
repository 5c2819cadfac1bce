//! A command's output: its streams, and texts without control characters that they may quote from files.

use std::io::{ErrorKind, Write};

use pliant_engine::EngineError;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;
use pliant_io::steers;

/// A command's output streams, and the means to watch and stop it.
pub struct Console<'a> {
    /// Standard output, or its replacement.
    pub out: &'a mut dyn Write,
    /// Standard error, or its replacement: refusals, each one line.
    pub err: &'a mut dyn Write,
    /// The command's progress, and its cancel flag.
    pub watch: Watch,
    /// The files that it writes.
    pub staging: Staging,
}

/// A line without control characters. Text from files in it was shortened when it was quoted.
pub(super) fn plain(line: &str) -> String {
    line.chars()
        .map(|letter| if steers(letter) { '\u{fffd}' } else { letter })
        .collect()
}

/// Prints a text without the control characters that it may quote from files.
pub(super) fn print(out: &mut dyn Write, text: &str) -> Result<(), EngineError> {
    let lines = text.lines().map(|line| plain(line) + "\n");
    write_out(out, &lines.collect::<String>())
}

/// Prints warnings to standard error, a line each.
pub(super) fn warn<'a>(err: &mut dyn Write, warnings: impl IntoIterator<Item = &'a String>) {
    for warning in warnings {
        let line = plain(&warning.replace(['\n', '\r'], " "));
        // The work is done, even if nobody reads the warnings.
        let _ = writeln!(err, "pliant: warning: {line}");
    }
}

/// Prints JSON. Control characters are escaped, which does not change its meaning.
pub(super) fn print_json(out: &mut dyn Write, value: &serde_json::Value) -> Result<(), EngineError> {
    let mut text = String::new();
    for letter in format!("{value:#}\n").chars() {
        if steers(letter) && letter != '\n' {
            text += &format!("\\u{:04x}", u32::from(letter));
        } else {
            text.push(letter);
        }
    }
    write_out(out, &text)
}

/// Writes to standard output. A closed pipe is not an error: its reader has read enough.
fn write_out(out: &mut dyn Write, text: &str) -> Result<(), EngineError> {
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(EngineError::System(format!(
            "standard output can't be written: {error}; check where it goes"
        ))),
        _ => Ok(()),
    }
}
