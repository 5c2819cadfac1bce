//! Where a mesh comes from.

use std::path::Path;

/// Where a mesh comes from: what refusals speak of.
#[derive(Clone, Copy, Debug)]
pub enum Origin<'a> {
    /// A file.
    File(&'a Path),
    /// Arrays.
    Arrays,
}

impl<'a> Origin<'a> {
    /// The file's path, or what stands for it.
    pub fn name(self) -> &'a Path {
        match self {
            Self::File(path) => path,
            Self::Arrays => Path::new("the mesh"),
        }
    }
}
