//! Folders that are not part of the project: environment variables name them, and `.cargo/config.toml` has their defaults.

use std::path::PathBuf;

/// Meshes for tests and measurements.
pub fn data() -> PathBuf {
    named("PLIANT_DATA")
}

/// Scripts that time other programs.
pub fn peers() -> PathBuf {
    named("PLIANT_PEERS")
}

fn named(variable: &str) -> PathBuf {
    std::env::var_os(variable).unwrap_or_default().into()
}
