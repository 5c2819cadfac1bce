//! Pliant's own commands: `cargo xtask run|test|check|bench|assets|gallery|package|manual|python`.
//!
//! It depends only on the standard library, so it builds in seconds on a fresh machine.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command-line tool prints its results"
)]

mod arguments;
mod assets;
mod bench;
mod check;
mod display;
mod files;
mod gallery;
mod install;
mod make_assets;
mod manual;
mod package;
mod process;
mod profile;
mod python;
mod requirement;
mod root;
mod run;
mod system;
mod test;
mod test_programs;
mod tool;
mod validation;
mod verdict;

use std::process::ExitCode;

use arguments::Command;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let command = match arguments::parse(&words) {
        Ok(command) => command,
        Err(sentence) => {
            eprintln!("{sentence}\n\n{}", arguments::HELP);
            return ExitCode::from(2);
        }
    };
    let done = match command {
        Command::Help => {
            println!("{}", arguments::HELP);
            Ok(())
        }
        Command::Run { file, profile, consent } => run::run(file.as_deref(), profile, consent),
        Command::Test { filters, consent } => test::test(&filters, consent),
        Command::Check => check::check(),
        Command::Bench { sections, scale } => bench::bench(&sections, scale),
        Command::Assets(order) => make_assets::make_assets(&order),
        Command::Gallery => gallery::gallery(),
        Command::Package => package::package(),
        Command::Manual => manual::manual(),
        Command::Python => python::python(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            eprintln!("{sentence}");
            ExitCode::FAILURE
        }
    }
}
