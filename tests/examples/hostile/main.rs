//! Runs the program's commands on hostile cases: `cargo run --release -p pliant-tests --example hostile -- SEED COUNT
//! [KIND]`, the cases with the numbers from SEED on; KIND is one of edit, project, neighbour, link, mesh, file, render
//! and session, and without it they take turns.
//!
//! A child process does the work under a limit of 2 GB, so that no failure ends the count; a command that takes more
//! than 10 s of the processor (20 s if something is bound) breaks a law, and one that continues is ended. Each broken
//! law is reported with the number that reproduces its case, and the first folders of each are kept. It ends with a
//! table of the worst cases of each kind, and with status 1 if a law was broken.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example speaks")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "it measures, and fails loudly")]

#[cfg(unix)]
#[path = "../../../crates/io/examples/counting/mod.rs"]
mod counting;
#[cfg(unix)]
mod driver;
#[cfg(unix)]
mod table;
#[cfg(unix)]
mod worker;

use std::process::ExitCode;

#[cfg(unix)]
#[global_allocator]
static ALLOCATOR: counting::Counting = counting::Counting;

#[cfg(unix)]
fn main() -> ExitCode {
    use pliant_tests::hostile::Kind;

    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.first().is_some_and(|word| word == "worker") {
        worker::work(words[1].as_ref());
        return ExitCode::SUCCESS;
    }
    let number = |place: usize| words.get(place).and_then(|word| word.parse::<u64>().ok());
    let kind = words.get(2).map(|name| Kind::of_name(name));
    match (number(0), number(1), kind) {
        (Some(seed), Some(count), None | Some(Some(_))) => driver::drive(seed, count, kind.flatten()),
        _ => {
            eprintln!("hostile SEED COUNT [edit|project|neighbour|link|mesh|file|render|session]");
            ExitCode::from(2)
        }
    }
}

#[cfg(not(unix))]
fn main() -> ExitCode {
    eprintln!("links and pipes are Unix's: run it there");
    ExitCode::from(2)
}
