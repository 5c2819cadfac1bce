//! A save that a person has asked for, which waits until the shape has settled.

use std::path::{Path, PathBuf};

use super::writing::KeepOriginal;

/// What is to be saved, and where.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum SaveWish {
    /// The model.
    Model(PathBuf, KeepOriginal),
    /// The model at rest with the present shape as a morph target.
    Morph(PathBuf),
    /// The project.
    Project(PathBuf),
}

impl SaveWish {
    /// Where.
    pub fn path(&self) -> &Path {
        match self {
            Self::Model(path, _) | Self::Morph(path) | Self::Project(path) => path,
        }
    }
}
