//! The origin of a mesh.

use std::path::Path;

/// The origin of a mesh, which refusals name.
#[derive(Clone, Copy, Debug)]
pub enum Origin<'a> {
    /// A file.
    File(&'a Path),
    /// Arrays.
    Arrays,
}

impl<'a> Origin<'a> {
    /// The file's path, or a word for arrays.
    pub fn name(self) -> &'a Path {
        match self {
            Self::File(path) => path,
            Self::Arrays => Path::new("the mesh"),
        }
    }
}
