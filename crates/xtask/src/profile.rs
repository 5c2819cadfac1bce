//! The two ways to build the program.

use crate::process::{cargo, succeed};

/// A profile of the workspace's `Cargo.toml`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Profile {
    /// Least time until it runs.
    Quick,
    /// Fast code, for measurements and daily use.
    Release,
}

impl Profile {
    /// Its name in `Cargo.toml`, and of its folder in cargo's target folder.
    pub fn name(self) -> &'static str {
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
        succeed(&mut cargo(&[
            "build",
            "--locked",
            "--profile",
            self.name(),
            "--package",
            "pliant-app",
            "--bin",
            "pliant",
        ]))
    }
}
