//! The command line (`pliant --help`): arguments in, files and an exit status out.

mod apply;
mod arguments;
mod compare;
mod diff;
mod generate;
mod info;
mod interrupt;
mod method_argument;
mod progress_line;
mod render;
mod stitch;
mod transfer;

use std::ffi::OsString;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::process::ExitCode;

pub use arguments::{LookArguments, PictureSize, RenderArguments, Shading, Up, View};

use pliant_io::steers;
use pliant_mesh::Vectors;

use crate::window::{self, Source};
use arguments::{Command, ComputeArguments};
use pliant_engine::EngineError;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;

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
    ExitCode::from(run(std::env::args_os().collect(), &mut console))
}

/// Does what the arguments request (the program's name comes first) and gives the exit status: 0 done, 1 refused, 2
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
            Some(Command::Cut(arguments)) => stitch::cut(&arguments, console),
            Some(Command::Merge(arguments)) => stitch::merge(&arguments, console),
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
    let line = plain(&error.to_string().replace(['\n', '\r'], " "));
    // If not even the error can be written, the exit status still reports it.
    let _ = writeln!(console.err, "pliant: {line}");
    error.status()
}

/// A line without control characters. Text from files in it was shortened when it was quoted.
fn plain(line: &str) -> String {
    line.chars()
        .map(|letter| if steers(letter) { '\u{fffd}' } else { letter })
        .collect()
}

/// Prints a text without the control characters that it may quote from files.
fn print(out: &mut dyn Write, text: &str) -> Result<(), EngineError> {
    let lines = text.lines().map(|line| plain(line) + "\n");
    write_out(out, &lines.collect::<String>())
}

/// Prints warnings to standard error, a line each.
fn warn<'a>(err: &mut dyn Write, warnings: impl IntoIterator<Item = &'a String>) {
    for warning in warnings {
        let line = plain(&warning.replace(['\n', '\r'], " "));
        // The work is done, even if nobody reads the warnings.
        let _ = writeln!(err, "pliant: warning: {line}");
    }
}

/// Prints JSON. Control characters are escaped, which does not change its meaning.
fn print_json(out: &mut dyn Write, value: &serde_json::Value) -> Result<(), EngineError> {
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

/// The most threads per core: more cost memory and gain nothing.
const MOST_THREADS_A_CORE: usize = 4;

/// Runs `work` on a pool of its own, with the requested number of threads and the requested vectors.
fn on_threads<T: Send>(asked: ComputeArguments, work: impl FnOnce() -> T + Send) -> Result<T, EngineError> {
    let ComputeArguments { threads, vectors } = asked;
    if let Some(vectors) = vectors.filter(|vectors| !vectors.choose()) {
        let others = Vectors::ALL.into_iter().filter(|other| other.is_available());
        let others: Vec<&str> = others.map(Vectors::name).collect();
        return Err(EngineError::Arguments(format!(
            "--vectors {}: this processor does not have them; leave it out, or give {}",
            vectors.name(),
            others.join(" or ")
        )));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = MOST_THREADS_A_CORE * cores;
    if let Some(threads) = threads.filter(|&threads| threads > most) {
        return Err(EngineError::Arguments(format!(
            "--threads {threads} is more than four for each of this machine's cores: give at most {most}"
        )));
    }
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build().map_err(|error| {
        EngineError::System(format!(
            "the threads can't be started ({error}): give a smaller --threads"
        ))
    })?;
    Ok(pool.install(work))
}
