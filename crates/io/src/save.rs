//! What a save asks for and what it gives.

use glam::DVec3;
use pliant_mesh::Drawn;

use crate::Format;

/// What is to be saved, and as what.
#[derive(Clone, Copy, Debug)]
pub struct Save<'a> {
    /// What [`read`](crate::read) gave with the scene.
    pub drawn: &'a Drawn,
    /// The new world position of each drawn vertex. A vertex moved where this is not bit-equal to `drawn.positions`.
    pub positions: &'a [DVec3],
    /// The kind of OUT.
    pub format: Format,
    /// OUT's file name, without a folder.
    pub name: &'a str,
    /// Where OUT goes, which decides what its neighbours are called and whether they come along.
    pub placement: Placement,
}

/// An edit to be saved as a morph target.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MorphTarget<'a> {
    /// Its name.
    pub name: &'a str,
    /// How far it is applied by default, usually 1 (the edited shape shows) or 0 (the one before).
    pub weight: f64,
}

/// Where OUT stands relative to the file that was read.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Placement {
    /// OUT is the file that was read.
    SameFile,
    /// OUT has another name in the same folder: neighbours that change get names of their own.
    SameFolder,
    /// OUT goes to another folder: its neighbours are brought along.
    OtherFolder,
}

/// The files that make up a saved scene.
#[derive(Clone, PartialEq, Debug)]
pub struct Saved {
    /// OUT first, then the neighbours that have to be written.
    pub files: Vec<OutputFile>,
    /// What the target could not hold, or what did not follow the edit, each as a sentence.
    pub warnings: Vec<String>,
}

/// A file to be written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OutputFile {
    /// Its path relative to OUT's folder, with `/` between folders; it never leaves that folder.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}
