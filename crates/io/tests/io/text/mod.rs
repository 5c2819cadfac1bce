//! The common code of the tests of the text and scan formats: opening, moving and saving without a file system.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    dead_code,
    reason = "a test fails by panicking, and uses what it needs"
)]

use std::collections::HashMap;
use std::path::PathBuf;

use glam::DVec3;
use pliant_io::{Bytes, Format, Placement, ReadError, Resolver, Save, Saved, SceneAndDrawn, read};
use pliant_mesh::{Cancel, Progress};

/// Neighbours in memory.
#[derive(Default)]
pub struct Folder(pub HashMap<String, Vec<u8>>);

impl Resolver for Folder {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        self.0
            .get(uri)
            .cloned()
            .map(Bytes::from)
            .ok_or_else(|| "no such file".to_owned())
    }
}

/// A folder with these files.
pub fn folder(files: &[(&str, &str)]) -> Folder {
    Folder(
        files
            .iter()
            .map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()))
            .collect(),
    )
}

pub fn try_open(bytes: &[u8], format: Format) -> Result<SceneAndDrawn, ReadError> {
    open_in(bytes, format, &Folder::default())
}

pub fn open_in(bytes: &[u8], format: Format, folder: &Folder) -> Result<SceneAndDrawn, ReadError> {
    let name = format!("test.{}", format.extension());
    read(bytes.to_vec(), format, &name, folder, &Progress::new(), &Cancel::new())
}

pub fn open(bytes: &[u8], format: Format) -> SceneAndDrawn {
    try_open(bytes, format).unwrap()
}

/// The message of a refusal.
pub fn refusal(bytes: &[u8], format: Format) -> String {
    match try_open(bytes, format) {
        Ok(opened) => panic!("was read: {:?}", opened.drawn),
        Err(error) => error.to_string(),
    }
}

pub fn save_as(opened: &SceneAndDrawn, positions: &[DVec3], format: Format) -> Saved {
    let name = format!("out.{}", format.extension());
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions,
        format,
        name: &name,
        placement: Placement::SameFolder,
    };
    opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap()
}

/// The bytes of OUT in the scene's own format.
pub fn save(opened: &SceneAndDrawn, positions: &[DVec3]) -> Vec<u8> {
    save_as(opened, positions, opened.scene.format())
        .files
        .swap_remove(0)
        .bytes
}

/// New positions: `change` of every drawn vertex whose file vertex is wanted.
pub fn moved(opened: &SceneAndDrawn, is_moved: impl Fn(u32) -> bool, change: impl Fn(DVec3) -> DVec3) -> Vec<DVec3> {
    let files = opened.drawn.file_vertex.iter();
    let pairs = opened.drawn.positions.iter().zip(files);
    pairs
        .map(|(&position, file)| if is_moved(file.0) { change(position) } else { position })
        .collect()
}

/// The lines (with their endings) in which two texts with the same number of lines differ, from 0.
pub fn changed_lines(before: &[u8], after: &[u8]) -> Vec<usize> {
    let lines = |text: &[u8]| {
        text.split_inclusive(|&byte| byte == b'\n')
            .map(<[u8]>::to_vec)
            .collect::<Vec<_>>()
    };
    let (before, after) = (lines(before), lines(after));
    assert_eq!(before.len(), after.len(), "lines were added or removed");
    (0..before.len()).filter(|&line| before[line] != after[line]).collect()
}

/// The places of bytes in which two files of one length differ.
pub fn changed_bytes(before: &[u8], after: &[u8]) -> Vec<usize> {
    assert_eq!(before.len(), after.len(), "the length changed");
    (0..before.len()).filter(|&at| before[at] != after[at]).collect()
}

/// Bit equality of positions, so that a NaN equals itself.
pub fn same_bits(a: &[DVec3], b: &[DVec3]) -> bool {
    let bits = |positions: &[DVec3]| {
        positions
            .iter()
            .map(|p| p.to_array().map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    bits(a) == bits(b)
}

/// The files of a folder in `PLIANT_DATA`; tests that need them skip by name where it is absent.
pub fn data(folder: &str) -> Option<Vec<(PathBuf, Vec<u8>)>> {
    let root = PathBuf::from(std::env::var_os("PLIANT_DATA").unwrap_or_default()).join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(root)
        .ok()?
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    Some(
        files
            .into_iter()
            .map(|path| (path.clone(), std::fs::read(path).unwrap()))
            .collect(),
    )
}
