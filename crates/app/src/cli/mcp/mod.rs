//! `pliant mcp`: a server of the Model Context Protocol, by which assistants open, bend, look at and save files.
//!
//! The client starts the program and writes JSON-RPC messages to its standard input, one on each line; the answers go
//! to standard output. Both eras of the protocol are spoken: the one in which each request names its version
//! (2026-07-28), and the one that begins with `initialize` (2024-11-05 to 2025-11-25).
//!
//! The protocol is our own code over `serde_json`, because the official crate `rmcp` is asynchronous and needs tokio,
//! which this program has no use for (`deny.toml`): one client, one request at a time, and a thread that listens for
//! cancellations. Its types for resources, prompts, sampling and HTTP would remain unused.

mod answer;
mod bending;
mod message;
mod models;
mod opening;
mod pictures;
mod protocol;
mod queue;
mod tools;

use std::io::{BufRead, BufReader, ErrorKind, Write};

use pliant_engine::EngineError;
use serde_json::Value;

use models::Models;
use queue::Incoming;

use super::console::Console;

/// Serves the client at standard input until it closes.
pub(super) fn run(console: &mut Console<'_>) -> Result<(), EngineError> {
    serve(BufReader::new(std::io::stdin()), console)
}

/// Answers the messages of `input`, one after another, until it ends; those that were read before its end are
/// answered.
fn serve(input: impl BufRead + Send + 'static, console: &mut Console<'_>) -> Result<(), EngineError> {
    let (messages, under_way) = queue::listen(input);
    let mut models = Models::new(console.staging.clone());
    for incoming in messages {
        let answer = match incoming {
            Incoming::Refused(id, fault) => message::error(&id, &fault),
            Incoming::Request {
                id,
                method,
                params,
                cancel,
            } => {
                let answer = protocol::answer(&method, &params, &mut models, &cancel);
                under_way.end(&id);
                if cancel.is_cancelled() {
                    // The client no longer waits for it.
                    continue;
                }
                match answer {
                    Ok(result) => message::result(&id, result),
                    Err(fault) => message::error(&id, &fault),
                }
            }
        };
        if !write(console.out, &answer)? {
            return Ok(());
        }
    }
    Ok(())
}

/// Writes an answer as one line; false if the client no longer reads.
fn write(out: &mut dyn Write, answer: &Value) -> Result<bool, EngineError> {
    let line = format!("{answer}\n");
    match out.write_all(line.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(EngineError::System(format!(
            "standard output can't be written: {error}; check where it goes"
        ))),
    }
}
