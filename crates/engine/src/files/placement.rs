//! Names for the neighbours that a save writes, which overwrite no file that another file may need.
//!
//! **The rule.** A neighbour gets the name in the file, unless that place is taken, or another glTF in the folder names
//! a missing buffer that way. An existing file is shared if it has exactly the same bytes (a buffer only if no other
//! file names it, because buffers are edited). It is replaced only if it is this document's own: OUT exists and is a
//! save of this very document (equal to the letter in everything that no save changes), OUT names the neighbour, and no
//! other glTF in the folder does. In every other case, including a link that leads out of the folder, the neighbour
//! gets another name (`scene-2.bin`), and a warning says so.
//!
//! So an edit that is applied repeatedly writes the same files each time, a file that is saved over itself keeps its
//! names, and two downloads with buffers of the same name `scene.bin` both keep their shape. The rule depends only on
//! the folder's files; it needs no notes of our own.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use pliant_io::{Format, Placement, Role, Saved, is_same_document, neighbours_named, numbered, quoted};

use super::leftovers::{is_passing, real_name};
use super::named::names_in_folder;
use super::same_file::FileSet;
use super::{Destination, follow, holds, is_same};
use crate::EngineError;
use crate::file_error::FileError;
use crate::path_text::{folder_of, neighbour_path, shown};

/// The place of `output`, relative to `source`.
pub fn placement(source: &Path, output: &Destination) -> Placement {
    let folder = fs::canonicalize(folder_of(source)).ok();
    if folder.as_deref() != Some(&*output.home) {
        Placement::OtherFolder
    } else if is_same(source, &output.target) {
        Placement::SameFile
    } else {
        Placement::SameFolder
    }
}

/// The placement of one neighbour.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Its place among the save's files.
    pub file: usize,
    /// Its path.
    pub at: Destination,
    /// Its treatment.
    pub action: Action,
}

/// The treatment of a neighbour.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Action {
    /// It is written.
    Write,
    /// It is not: the same bytes are there already.
    Share,
}

/// Gives each neighbour of `saved` its name for writing, also in the texts that name it. Renamed neighbours are listed
/// among the save's warnings.
///
/// The folder must be locked: its files may not change until the save is committed.
///
/// # Errors
/// A neighbour can't have another name, or a thousand names are taken.
pub fn settle(saved: &mut Saved, format: Format, output: &Destination) -> Result<Vec<Settled>, EngineError> {
    if matches!(format, Format::Glb | Format::Gltf) {
        adopt_passing(saved, output)?;
    }
    if saved.files.len() == 1 {
        return Ok(Vec::new());
    }
    let mut folder = Folder::of(output, &saved.files[0].bytes, format);
    let mut settled = Vec::new();
    // Textures come after the libraries that name them, whose bytes change with those names.
    for place in (1..saved.files.len()).rev() {
        let old = saved.files[place].name.clone();
        let wanted = real_name(&old);
        // If a folder of its path can't exist, it is placed beside OUT.
        let flat = wanted.rsplit_once('/').map(|(_, flat)| flat);
        let candidates = [Some(&*wanted), flat].into_iter().flatten().flat_map(|name| {
            (1..1000).map(move |number| match number {
                1 => name.to_owned(),
                _ => numbered(name, number),
            })
        });
        let file = &saved.files[place];
        let found = candidates
            .map(|name| (folder.look_at(&name, &file.bytes, file.role), name))
            .find(|(there, _)| !matches!(there, There::Taken));
        let Some((there, name)) = found else {
            return Err(EngineError::System(format!(
                "{}: no name is free for {}: choose another folder",
                shown(&output.given),
                quoted(&wanted)
            )));
        };
        if name != old {
            saved.rename(place, &name, format).map_err(|source| EngineError::Save {
                file: output.given.clone(),
                source,
            })?;
        }
        if name != wanted {
            saved.warnings.push(format!(
                "{} was written as {}, because that name belongs to a file outside this document.",
                quoted(&wanted),
                quoted(&name)
            ));
        }
        let given = neighbour_path(folder_of(&output.given), &name);
        let (action, target) = match there {
            There::Nothing(target) | There::Own(target) => (Action::Write, target),
            There::Same(target) => (Action::Share, target),
            // It was not searched for.
            There::Taken => continue,
        };
        if action == Action::Write {
            folder.taken.insert(target.clone());
        }
        settled.push(Settled {
            file: place,
            at: output.neighbour(given, target),
            action,
        });
    }
    settled.reverse();
    Ok(settled)
}

/// Adds the unchanged neighbours that OUT names by passing names: an earlier save of it was cut off, and this one
/// restores their own names.
fn adopt_passing(saved: &mut Saved, output: &Destination) -> Result<(), FileError> {
    let Some(named) = neighbours_named(&saved.files[0].bytes) else {
        return Ok(());
    };
    for name in named.into_iter().filter(|name| is_passing(name)) {
        if saved.files.iter().any(|file| file.name == name) {
            continue;
        }
        let bytes = super::read(&output.home.join(&name))?;
        saved.files.push(pliant_io::OutputFile {
            name,
            role: Role::Buffer,
            bytes,
        });
    }
    Ok(())
}

/// The state of a neighbour's place.
enum There {
    /// Free: the neighbour can be written there.
    Nothing(PathBuf),
    /// This document's own neighbour, from an earlier save.
    Own(PathBuf),
    /// A file with the same bytes.
    Same(PathBuf),
    /// Another file, which must stay.
    Taken,
}

/// OUT's folder, examined as far as needed.
struct Folder<'a> {
    output: &'a Destination,
    /// The neighbours that the existing OUT names, if it is a save of the same document.
    own: BTreeSet<String>,
    /// The neighbours that other files in the folder name; `None` before the first query.
    others: Option<Others>,
    /// Places that this save writes.
    taken: FileSet,
}

/// The files that other glTFs in the folder name; `None` if one of them is too large to search.
type Others = Option<BTreeSet<String>>;

impl<'a> Folder<'a> {
    fn of(output: &'a Destination, new: &[u8], format: Format) -> Self {
        let is_gltf = matches!(format, Format::Glb | Format::Gltf);
        let existing = is_gltf.then(|| super::read(&output.target).ok()).flatten();
        let existing = existing.filter(|existing| is_same_document(existing, new));
        let own = existing
            .and_then(|existing| neighbours_named(&existing))
            .unwrap_or_default();
        let mut taken = FileSet::default();
        taken.insert(output.target.clone());
        Self {
            output,
            own: own.iter().map(|name| real_name(name)).collect(),
            others: None,
            taken,
        }
    }

    fn look_at(&mut self, name: &str, bytes: &[u8], role: Role) -> There {
        let home = &self.output.home;
        let path = neighbour_path(home, name);
        // Its folder may be a link, or not a folder.
        let mut parent = home.clone();
        let steps: Vec<&str> = name.split('/').collect();
        for step in &steps[..steps.len() - 1] {
            parent.push(step);
            match fs::symlink_metadata(&parent) {
                Ok(metadata) if metadata.is_dir() => {}
                Ok(metadata) if metadata.is_symlink() && parent.is_dir() => {}
                Err(error) if error.kind() == io::ErrorKind::NotFound => break,
                _ => return There::Taken,
            }
        }
        let Ok(target) = follow_to_new(&path) else {
            return There::Taken;
        };
        let is_inside = target.starts_with(home);
        if self.taken.contains(&target) {
            return There::Taken;
        }
        match fs::metadata(&target) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let is_link = fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_symlink());
                // A link that leads nowhere is kept: its file may come back. So may the missing buffer of another file,
                // which would otherwise get this shape.
                let is_missed = role == Role::Buffer && self.is_named_by_others(name);
                return if is_inside && !is_link && !is_missed {
                    There::Nothing(target)
                } else {
                    There::Taken
                };
            }
            Ok(metadata) if metadata.is_file() => {}
            _ => return There::Taken,
        }
        let is_equal = holds(&target, bytes);
        let is_own = is_inside && self.own.contains(name) && !self.is_named_by_others(name);
        match (is_equal, is_own, role) {
            (true, true, _) => There::Same(target),
            (true, false, Role::Buffer) if self.is_named_by_others(name) => There::Taken,
            (true, false, _) => There::Same(target),
            (false, true, _) => There::Own(target),
            (false, false, _) => There::Taken,
        }
    }

    fn is_named_by_others(&mut self, name: &str) -> bool {
        let output = self.output;
        let others = self
            .others
            .get_or_insert_with(|| names_in_folder(&output.home, Some(&output.target)));
        others.as_ref().is_none_or(|others| others.contains(name))
    }
}

/// Like [`follow`], but folders on the way may be missing.
fn follow_to_new(path: &Path) -> io::Result<PathBuf> {
    if folder_of(path).exists() {
        return follow(path);
    }
    let name = path.file_name().ok_or(io::ErrorKind::NotFound)?;
    Ok(follow_to_new(folder_of(path))?.join(name))
}
