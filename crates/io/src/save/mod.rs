//! What a save asks for and what it gives.

pub(crate) mod bits;
pub(crate) mod course;
pub(crate) mod frames;
pub(crate) mod moved;
mod rename;

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
    /// OUT first, then the neighbours that have to be written, each under a name of its own.
    pub files: Vec<OutputFile>,
    /// What the target could not hold, or what did not follow the edit, each as a sentence.
    pub warnings: Vec<String>,
    /// The drawn triangle that was read behind each one that OUT draws, in OUT's order; `None` where they are all
    /// there, in their old order.
    pub triangles: Option<Vec<u32>>,
}

/// A file to be written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OutputFile {
    /// Its path relative to OUT's folder, with `/` between folders; it never leaves that folder.
    pub name: String,
    /// What it is to OUT.
    pub role: Role,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// What a written file is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// OUT itself.
    Out,
    /// A glTF's buffer.
    Buffer,
    /// An OBJ's material library.
    Library,
    /// An image.
    Image,
}

impl Saved {
    /// A save of one file.
    pub(crate) fn alone(name: &str, bytes: Vec<u8>, warnings: Vec<String>) -> Self {
        let file = OutputFile {
            name: name.to_owned(),
            role: Role::Out,
            bytes,
        };
        Self {
            files: vec![file],
            warnings,
            triangles: None,
        }
    }
}

/// What neighbours made for an OUT of this name are called: its name without the extension and without what a URI, a
/// material library or another system would read otherwise (a backslash is a folder there, `c:` a drive).
pub(crate) fn own_stem(out: &str) -> String {
    let stem = out.rsplit_once('.').map_or(out, |(stem, _)| stem);
    let is_drive = stem.as_bytes().get(1) == Some(&b':');
    let safe = |(place, letter): (usize, char)| match letter {
        '\\' | '/' | '"' => '_',
        ':' if is_drive && place == 1 => '_',
        letter if letter.is_control() => '_',
        letter => letter,
    };
    stem.trim().chars().enumerate().map(safe).collect()
}

/// `name` with a number before its extension: `a/scene.bin` becomes `a/scene-2.bin`.
pub fn numbered(name: &str, number: usize) -> String {
    let (folder, file) = name
        .rsplit_once('/')
        .map_or(("", name), |(folder, file)| (folder, file));
    let numbered = match file.rsplit_once('.') {
        Some((stem, extension)) => format!("{stem}-{number}.{extension}"),
        None => format!("{file}-{number}"),
    };
    if folder.is_empty() {
        numbered
    } else {
        format!("{folder}/{numbered}")
    }
}
