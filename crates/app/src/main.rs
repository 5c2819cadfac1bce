//! The program `pliant`: everything is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    pliant_app::cli::main()
}
