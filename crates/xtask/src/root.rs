//! The workspace's folder.

use std::path::{Path, PathBuf};

/// The workspace's folder: the one that cargo runs this program from, because a moved or copied checkout brings a
/// program that was built elsewhere.
pub fn root() -> PathBuf {
    let built = || env!("CARGO_MANIFEST_DIR").into();
    let here = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(built, PathBuf::from);
    here.ancestors().nth(2).unwrap_or(Path::new(".")).to_path_buf()
}
