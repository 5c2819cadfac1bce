//! What can go wrong, each as one sentence that names the culprit and the remedy.

use pliant_mesh::Cancelled;

use crate::{Format, quoted};

/// A name whose extension tells no known kind of file.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("\"{}\" has no extension of a known kind: name it .glb, .gltf, .obj, .ply, .stl or .off", quoted(.name))]
pub struct UnknownFormat {
    /// The file's name.
    pub name: String,
}

/// Why a file could not be read.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum ReadError {
    /// The bytes are not what the format asks for.
    #[error("{} is not a readable {format} file: {reason}", quoted(.name))]
    Malformed {
        /// The file's name.
        name: String,
        /// What it was read as.
        format: Format,
        /// What is wrong and where (an accessor, a line), without a final stop.
        reason: String,
    },
    /// The file is whole but uses something that is not read.
    #[error("{} uses {feature}, which is not read: {remedy}", quoted(.name))]
    Unsupported {
        /// The file's name.
        name: String,
        /// What it uses.
        feature: String,
        /// What the person can do.
        remedy: String,
    },
    /// A neighbour that holds geometry could not be read.
    #[error("{} names {}, which could not be read ({reason}): put it back beside the file", quoted(.name), quoted(.uri))]
    Neighbour {
        /// The file's name.
        name: String,
        /// The neighbour as the file names it.
        uri: String,
        /// What the resolver said.
        reason: String,
    },
    /// The file asks for more than its bytes can justify.
    #[error(
        "{} asks for {what}, more than a file of its size can hold: it is damaged or not meant to be opened",
        quoted(.name)
    )]
    TooLarge {
        /// The file's name.
        name: String,
        /// What is too many.
        what: String,
    },
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Why a scene could not be saved; nothing was written.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum SaveError {
    /// A position is beyond single precision, which nearly every reader uses.
    #[error(
        "vertex {file_vertex} would be saved at a position that single precision can't hold, beyond 3.4e38 or no number: undo the last edit, or scale the file down before it is edited"
    )]
    NotFinite {
        /// The vertex in the file's numbering.
        file_vertex: u32,
    },
    /// The positions don't belong to this scene.
    #[error("{given} positions were given for the {wanted} drawn vertices of this scene: open the file again")]
    OtherScene {
        /// How many positions were given.
        given: usize,
        /// How many drawn vertices the scene has.
        wanted: usize,
    },
    /// The target can't hold the change.
    #[error("{what} can't be saved as {format}: {remedy}")]
    CannotHold {
        /// What can't be saved.
        what: String,
        /// The kind of OUT.
        format: Format,
        /// What the person can do.
        remedy: String,
    },
    /// A neighbour would have to be written outside OUT's folder.
    #[error(
        "{} lies outside the file's own folder and is never written there: save as .glb, which holds everything",
        quoted(.uri)
    )]
    NeighbourOutside {
        /// The neighbour as the file names it.
        uri: String,
    },
    /// The output would be larger than its format allows.
    #[error("the result is larger than the 4 GiB that {format} can hold: save as .gltf or as another kind")]
    TooLarge {
        /// The kind of OUT.
        format: Format,
    },
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Why an image could not be decoded.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the image could not be decoded ({reason}): convert it to PNG or JPEG, or make it smaller")]
pub struct ImageError {
    /// What the decoder said.
    pub reason: String,
}
