//! A save that a person has requested, which waits until the shape has settled.

use std::path::{Path, PathBuf};

use super::save_request::KeepOriginal;

/// The content to be saved, and its path.
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
    /// The same in place of others with its path: if one of them was to keep the original, this one does.
    #[must_use]
    pub fn in_place_of(self, others: Vec<Self>) -> Self {
        let keeps = others
            .iter()
            .any(|other| matches!(other, Self::Model(_, KeepOriginal::Yes)));
        match self {
            Self::Model(path, _) if keeps => Self::Model(path, KeepOriginal::Yes),
            wish => wish,
        }
    }

    /// The path.
    pub fn path(&self) -> &Path {
        match self {
            Self::Model(path, _) | Self::Morph(path) | Self::Project(path) => path,
        }
    }
}
