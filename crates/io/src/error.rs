//! Errors, each as one sentence that names the culprit and the remedy.

use pliant_mesh::Cancelled;

use crate::{Format, quoted};

/// The reason why a file could not be read.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum ReadError {
    /// The bytes are not in the format.
    #[error("{} is not a readable {format} file: {reason}", quoted(.name))]
    Malformed {
        /// The file's name.
        name: String,
        /// The format that it was read as.
        format: Format,
        /// The fault and its place (an accessor, a line), without a final stop.
        reason: String,
    },
    /// The file is whole but uses a feature that is not read.
    #[error("{} uses {feature}, which is not supported: {remedy}", quoted(.name))]
    Unsupported {
        /// The file's name.
        name: String,
        /// The feature.
        feature: String,
        /// The remedy.
        remedy: String,
    },
    /// A neighbour with geometry could not be read.
    #[error("{} names {}, which could not be read ({reason}): put it beside the file", quoted(.name), quoted(.uri))]
    Neighbour {
        /// The file's name.
        name: String,
        /// The neighbour as the file names it.
        uri: String,
        /// The resolver's message.
        reason: String,
    },
    /// The file asks for more than its bytes can justify.
    #[error(
        "{} declares {what}, more than a file of its size can hold: it is damaged, so export it again",
        quoted(.name)
    )]
    TooLarge {
        /// The file's name.
        name: String,
        /// The quantity that is too large.
        what: String,
    },
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The reason why a scene could not be saved; nothing was written.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum SaveError {
    /// A position is beyond single precision, which nearly every reader uses.
    #[error(
        "vertex {file_vertex} would be saved at a position that single precision can't hold (beyond 3.4e38, or not a \
         number): undo the last edit, or scale the file down before you edit it"
    )]
    NotFinite {
        /// The vertex in the file's numbering.
        file_vertex: u32,
    },
    /// The positions don't belong to this scene.
    #[error("{given} positions were given for the {wanted} drawn vertices of this scene: open the file again")]
    OtherScene {
        /// The number of positions that were given.
        given: usize,
        /// The number of the scene's drawn vertices.
        wanted: usize,
    },
    /// The target can't hold the change.
    #[error("{what} can't be saved as {format}: {remedy}")]
    CannotHold {
        /// The change.
        what: String,
        /// The kind of OUT.
        format: Format,
        /// The remedy.
        remedy: String,
    },
    /// A neighbour would have to be written outside OUT's folder.
    #[error(
        "{} is outside the file's own folder, where nothing is written: save as .glb, which contains everything",
        quoted(.uri)
    )]
    NeighbourOutside {
        /// The neighbour as the file names it.
        uri: String,
    },
    /// The output would be larger than its format allows.
    #[error("the result is larger than the 4 GiB that {format} can hold: save as .gltf or in another format")]
    TooLarge {
        /// The kind of OUT.
        format: Format,
    },
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SaveError {
    /// The refusal of other colours in a file of a format whose colours other data of the file may name.
    pub(crate) fn without_new_colours(format: Format) -> Self {
        Self::CannotHold {
            what: format!("new colours of vertices beside those of the {format}"),
            format,
            remedy: "save as .glb, .gltf, .ply, .obj or .off".to_owned(),
        }
    }

    /// The refusal of vertex colours in an STL.
    pub fn without_colours() -> Self {
        Self::CannotHold {
            what: "colours of vertices".to_owned(),
            format: Format::Stl,
            remedy: "save as .glb, .gltf, .ply, .obj or .off".to_owned(),
        }
    }
}

/// The reason why an image could not be decoded.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the image could not be decoded ({reason}): convert it to PNG or JPEG, or make it smaller")]
pub struct ImageError {
    /// The decoder's message.
    pub reason: String,
}
