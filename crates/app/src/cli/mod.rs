//! The command line (`pliant --help`): arguments in, files and an exit status out.

mod animate;
mod apply;
mod arguments;
mod compare;
mod console;
mod cut_plane;
mod diff;
mod flow;
mod generate;
mod info;
mod interrupt;
mod mcp;
mod method_argument;
mod motion_arguments;
mod picture_arguments;
mod progress_line;
mod render;
mod replaced;
mod sequence;
mod shared_arguments;
mod stitch;
mod stitch_arguments;
mod threads;
mod tracing_output;
mod transfer;

use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::process::ExitCode;

pub use console::Console;

use crate::window::{self, Source};
use arguments::Command;
use console::{plain, print};
use pliant_engine::EngineError;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;

/// The program: the process's own arguments and streams, progress on a terminal, and Ctrl-C.
pub fn main() -> ExitCode {
    let (watch, staging) = (Watch::default(), Staging::default());
    interrupt::listen(&watch, &staging);
    let stderr = io::stderr();
    let progress = stderr.is_terminal().then(|| progress_line::show(watch.clone()));
    let mut err = progress_line::ErasingWriter::new(progress);
    let mut console = Console {
        out: &mut io::stdout().lock(),
        err: &mut err,
        watch,
        staging,
    };
    let status = match tracing_output::begin() {
        Ok(()) => run(std::env::args_os().collect(), &mut console),
        Err(error) => refuse(&error, &mut console),
    };
    ExitCode::from(status)
}

/// Executes the arguments' request (the program's name comes first) and gives the exit status: 0 done, 1 refused, 2
/// wrong arguments. A refusal is one line on `console.err`.
pub fn run(arguments: Vec<OsString>, console: &mut Console<'_>) -> u8 {
    let result = match arguments::parse(arguments) {
        Ok(arguments) => match arguments.command {
            Some(Command::Info(arguments)) => info::run(&arguments, console),
            Some(Command::Apply(arguments)) => apply::run(&arguments, console),
            Some(Command::Render(arguments)) => render::run(&arguments, console),
            Some(Command::Compare(arguments)) => compare::run(&arguments, console),
            Some(Command::Diff(arguments)) => diff::run(&arguments, console),
            Some(Command::Transfer(arguments)) => transfer::run(&arguments, console),
            Some(Command::Fill(arguments)) => stitch::fill(&arguments, console),
            Some(Command::Bridge(arguments)) => stitch::bridge(&arguments, console),
            Some(Command::Cut(arguments)) => stitch::cut(&arguments, console),
            Some(Command::Merge(arguments)) => stitch::merge(&arguments, console),
            Some(Command::Animate(arguments)) => animate::run(&arguments, console),
            Some(Command::Sequence(arguments)) => sequence::run(&arguments, console),
            Some(Command::Flow(arguments)) => flow::run(&arguments, console),
            Some(Command::Mcp) => mcp::run(console),
            Some(Command::Generate(arguments)) => generate::run(&arguments, console),
            None => window::run(Source::of(arguments.file, arguments.edit)),
        },
        Err(help) if !help.use_stderr() => print(console.out, &help.render().to_string()),
        Err(error) => Err(EngineError::Arguments(arguments::one_line(&error))),
    };
    let error = match result {
        Ok(()) => return 0,
        // A cancelled job may return any error: the person stopped it.
        Err(_) if console.watch.cancel.is_cancelled() => EngineError::Interrupted,
        Err(error) => error,
    };
    refuse(&error, console)
}

/// Writes a refusal as one line and gives its exit status.
fn refuse(error: &EngineError, console: &mut Console<'_>) -> u8 {
    let line = plain(&error.to_string().replace(['\n', '\r'], " "));
    // If not even the error can be written, the exit status still reports it.
    let _ = writeln!(console.err, "pliant: {line}");
    error.status()
}
