//! The two ways to build the program.

use std::process::Command;

use crate::process::{cargo, succeed};

/// A profile of the workspace's `Cargo.toml`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Profile {
    /// Least time until it runs.
    Quick,
    /// Optimised as a whole, for measurements and daily use.
    Release,
}

impl Profile {
    /// Its name in `Cargo.toml`.
    fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Release => "release",
        }
    }

    /// Builds the program.
    ///
    /// # Errors
    /// One sentence with the command line, if cargo fails.
    pub fn build(self) -> Result<(), String> {
        succeed(&mut self.cargo("build", &[]))
    }

    /// The cargo command `verb` on the program, with `more` arguments.
    pub fn cargo(self, verb: &str, more: &[&str]) -> Command {
        let fixed = [
            verb,
            "--locked",
            "--profile",
            self.name(),
            "--package",
            "pliant-app",
            "--bin",
            "pliant",
        ];
        cargo(&[&fixed, more].concat())
    }
}
