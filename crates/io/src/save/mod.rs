//! The input and the output of a save.

pub(crate) mod animation;
pub(crate) mod bits;
pub(crate) mod colours;
pub(crate) mod course;
pub(crate) mod frames;
pub(crate) mod moved;
mod targets;
pub(crate) mod turned;
mod twins;

use glam::DVec3;
use pliant_mesh::Drawn;

pub use self::animation::MorphAnimation;
pub use self::targets::{FewTargets, ShapeDirections};
use crate::Format;

/// A request to save: the data and the format.
#[derive(Clone, Copy, Debug)]
pub struct Save<'a> {
    /// The drawn set that [`read`](crate::read) returned with the scene.
    pub drawn: &'a Drawn,
    /// The new world position of each drawn vertex. A vertex moved if it is not bit-equal to `drawn.positions`.
    pub positions: &'a [DVec3],
    /// For each drawn vertex, whether its connected part is turned inside out, with reversed faces and normals. Empty
    /// if none is. All drawn vertices of one triangle are turned, or none of them.
    pub turned: &'a [bool],
    /// The deltas of the file's morph targets: turning with the surface, or kept.
    pub deltas: MorphDeltas,
    /// The format of OUT.
    pub format: Format,
    /// OUT's file name, without a folder.
    pub name: &'a str,
    /// The place of OUT, which decides the names of its neighbours and whether they are copied.
    pub placement: Placement,
}

/// The deltas of a file's morph targets: all of a mesh's turn with the surface, or none.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum MorphDeltas {
    /// If one of them would otherwise be wrong by more than 30 degrees.
    #[default]
    WhereFarOff,
    /// Always.
    Turn,
    /// Never: they stay as stored.
    Stay,
}

/// An edit to be saved as a morph target.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MorphTarget<'a> {
    /// Its name.
    pub name: &'a str,
    /// The weight by which it is applied by default, usually 1 (shows the edited shape) or 0 (shows the shape before
    /// the edit).
    pub weight: f64,
}

/// The place of OUT relative to the input file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Placement {
    /// OUT is the input file.
    SameFile,
    /// OUT has another name in the same folder: neighbours that change get new names.
    SameFolder,
    /// OUT goes to another folder: its neighbours are copied there.
    OtherFolder,
}

/// The files that make up a saved scene.
#[derive(Clone, PartialEq, Debug)]
pub struct Saved {
    /// OUT first, then the neighbours to write, each under its own name.
    pub files: Vec<OutputFile>,
    /// The losses: data that the format could not hold or that did not follow the edit, each as a sentence.
    pub warnings: Vec<String>,
    /// For each triangle that OUT draws, in OUT's order, the drawn triangle that it came from. `None` if all of them
    /// are there in their old order.
    pub triangles: Option<Vec<u32>>,
}

/// A file to write.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OutputFile {
    /// Its path relative to OUT's folder, with `/` between folders. It never leaves that folder.
    pub name: String,
    /// Its role.
    pub role: Role,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// The role of a written file.
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
    /// A save that consists of one file.
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

/// The stem for the names of OUT's new neighbours: OUT's name without the extension, and without characters that a URI,
/// a material library or another system would read differently (a backslash is a folder there, `c:` a drive).
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
