//! The frames of a folder: its mesh files of one format, in the order of their names.

use std::cmp::Ordering;
use std::fs;
use std::path::{Path, PathBuf};

use pliant_io::{Format, quoted};

use crate::EngineError;
use crate::file_error::FileError;
use crate::path_text::shown;

/// The frames of a sequence.
#[derive(Debug)]
pub(super) struct Folder {
    /// Each frame's file, in order; at least one.
    pub frames: Vec<PathBuf>,
    /// A sentence about numbers that are missing between the names' numbers.
    pub gap: Option<String>,
}

impl Folder {
    /// Finds the frames. Numbers in names count by their value, so that `walk-2` comes before `walk-10`. Hidden files are
    /// left out.
    ///
    /// # Errors
    /// A folder that can't be read, without mesh files, or with files of different formats.
    pub fn of(folder: &Path) -> Result<Self, EngineError> {
        let refuse = |error| EngineError::from(FileError::reading(folder, error));
        let mut found: Vec<(String, Format)> = Vec::new();
        for entry in fs::read_dir(folder).map_err(refuse)? {
            let entry = entry.map_err(refuse)?;
            let name = entry.file_name();
            let Some(name) = name.to_str().filter(|name| !name.starts_with('.')) else {
                continue;
            };
            if let Ok(format) = Format::of_name(name)
                && entry.path().is_file()
            {
                found.push((name.to_owned(), format));
            }
        }
        found.sort_by(|(a, _), (b, _)| by_numbers(a, b));
        let Some((first, format)) = found.first() else {
            return Err(EngineError::Unsupported(format!(
                "{} holds no mesh file: give the folder of the frames, or a .pc2 or .mdd cache",
                shown(folder)
            )));
        };
        if let Some((other, _)) = found.iter().find(|(_, other)| other != format) {
            return Err(EngineError::Unsupported(format!(
                "{} holds frames of different formats, such as {} and {}: keep one format in the folder",
                shown(folder),
                quoted(first),
                quoted(other)
            )));
        }
        Ok(Self {
            gap: gap(&found),
            frames: found.iter().map(|(name, _)| folder.join(name)).collect(),
        })
    }
}

/// The order of names in which runs of digits count as numbers.
fn by_numbers(a: &str, b: &str) -> Ordering {
    let (of_a, of_b) = (runs(a), runs(b));
    let pairs = of_a.iter().zip(&of_b).map(|(a, b)| match (digits(a), digits(b)) {
        // Numbers of any length: without zeros in front, the longer one is larger.
        (Some(a), Some(b)) => a.len().cmp(&b.len()).then(a.cmp(b)),
        _ => a.cmp(b),
    });
    let first = pairs.into_iter().find(|order| order.is_ne());
    first.unwrap_or_else(|| of_a.len().cmp(&of_b.len()).then(a.cmp(b)))
}

/// A name cut where digits begin or end.
fn runs(name: &str) -> Vec<&str> {
    let bytes = name.as_bytes();
    let is_cut = |at: &usize| bytes[at - 1].is_ascii_digit() != bytes[*at].is_ascii_digit();
    let mut ends: Vec<usize> = (1..bytes.len()).filter(is_cut).collect();
    ends.push(bytes.len());
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(&ends).map(|(start, &end)| &name[start..end]).collect()
}

/// The digits of a number, without zeros in front; `None` for other runs.
fn digits(run: &str) -> Option<&str> {
    run.starts_with(|letter: char| letter.is_ascii_digit())
        .then(|| run.trim_start_matches('0'))
}

/// The last number of a name.
fn number(name: &str) -> Option<u64> {
    runs(name).into_iter().rev().find_map(digits)?.parse().ok()
}

/// A sentence about the first place at which the names' numbers leave one out.
fn gap(found: &[(String, Format)]) -> Option<String> {
    let mut pairs = found.windows(2).enumerate();
    pairs.find_map(|(frame, pair)| {
        let [(before, _), (after, _)] = pair else { return None };
        let (from, to) = (stem_number(before)?, stem_number(after)?);
        (to > from + 1).then(|| {
            format!(
                "no frame is numbered from {} to {}: {} is frame {}, after {}",
                from + 1,
                to - 1,
                quoted(after),
                frame + 1,
                quoted(before)
            )
        })
    })
}

/// The last number before a name's extension.
fn stem_number(name: &str) -> Option<u64> {
    number(name.rsplit_once('.').map_or(name, |(stem, _)| stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_ordered_by_their_numbers() {
        let mut names = [
            "b-1.obj",
            "a-10.obj",
            "a-9.obj",
            "a-010.obj",
            "a-2b.obj",
            "a-2.obj",
            "a.obj",
        ];
        names.sort_by(|a, b| by_numbers(a, b));
        assert_eq!(
            names,
            [
                "a-2.obj",
                "a-2b.obj",
                "a-9.obj",
                "a-010.obj",
                "a-10.obj",
                "a.obj",
                "b-1.obj"
            ]
        );
    }

    #[test]
    fn a_missing_number_is_told() {
        let told = |names: &[&str]| {
            let found: Vec<(String, Format)> = names.iter().map(|name| ((*name).to_owned(), Format::Obj)).collect();
            gap(&found)
        };
        assert_eq!(told(&["a-1.obj", "a-2.obj", "a-3.obj"]), None);
        assert_eq!(told(&["a.obj", "b.obj"]), None);
        let sentence = told(&["a-1.obj", "a-2.obj", "a-5.obj"]).unwrap_or_default();
        assert!(sentence.contains("from 3 to 4: a-5.obj is frame 2"), "{sentence}");
    }
}
