//! The files of a run: the last state, or one for each step.

use std::path::{Path, PathBuf};

use crate::EngineError;
use crate::files::Destination;
use crate::path_text::shown;

/// The most frames of an animation: more than an hour at 24 frames a second.
const MOST_FRAMES: f64 = 100_000.0;

/// A time this many frames before a whole frame still counts as that frame.
pub(crate) const ROUNDING: f64 = 1e-6;

/// The place of `#`s in a name: before its extension, after this.
const BEFORE: char = '-';

/// The treatment of files with the names of an animation's numbered files.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum ExistingFrames {
    /// They are kept, and the animation is refused.
    #[default]
    Keep,
    /// They are replaced.
    Replace,
}

impl ExistingFrames {
    /// Those that may be replaced on request.
    pub fn replaced(is_wanted: bool) -> Self {
        if is_wanted { Self::Replace } else { Self::Keep }
    }

    /// Refuses names that are taken.
    ///
    /// # Errors
    /// [`EngineError::FramesExist`].
    pub(crate) fn check(self, frames: &Frames) -> Result<(), EngineError> {
        let Frames::Each { .. } = frames else { return Ok(()) };
        if self == Self::Replace {
            return Ok(());
        }
        let mut taken = frames.all().filter(|place| place.exists());
        match taken.next() {
            Some(first) => Err(EngineError::FramesExist {
                first,
                count: 1 + taken.count(),
            }),
            None => Ok(()),
        }
    }
}

/// The files that are written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Frames {
    /// One file after this many steps.
    Last(PathBuf, usize),
    /// A file at the start and after each step.
    Each {
        /// Its folder and the name before the number.
        before: PathBuf,
        /// The least count of digits.
        digits: usize,
        /// The name after the number: the extension with its dot.
        after: String,
        /// The number of steps.
        steps: usize,
    },
}

impl Frames {
    /// The frames of an output; `#`s in its name are places for a number.
    pub fn of(output: &Path, steps: usize) -> Self {
        let stem = output.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let before = stem.trim_end_matches('#');
        let digits = stem.len() - before.len();
        if digits == 0 || !before.ends_with(BEFORE) {
            return Self::Last(output.to_owned(), steps);
        }
        let extension = output.extension().map(|extension| extension.to_string_lossy());
        Self::Each {
            before: output.with_file_name(before),
            digits,
            after: extension.map_or(String::new(), |extension| format!(".{extension}")),
            steps,
        }
    }

    /// A name with `-####` before its extension, unless `#`s for a number are there.
    pub fn numbered(chosen: &Path) -> PathBuf {
        let (Some(stem), Self::Last(..)) = (chosen.file_stem(), Self::of(chosen, 1)) else {
            return chosen.to_owned();
        };
        let mut name = stem.to_owned();
        name.push("-####");
        if let Some(extension) = chosen.extension() {
            name.push(".");
            name.push(extension);
        }
        chosen.with_file_name(name)
    }

    /// The file to write after so many steps.
    pub fn at(&self, step: usize) -> Option<PathBuf> {
        match self {
            Self::Last(place, steps) => (step == *steps).then(|| place.clone()),
            Self::Each {
                before, digits, after, ..
            } => {
                let mut place = before.clone().into_os_string();
                place.push(format!("{step:0digits$}{after}"));
                Some(place.into())
            }
        }
    }

    /// A clause about files that stay beside numbered ones and seem to belong to them, because their numbers go on.
    pub fn left_after(&self) -> Option<String> {
        let Self::Each { steps, .. } = self else { return None };
        let after = (*steps + 1..).map_while(|step| self.at(step).filter(|place| place.exists()));
        let names: Vec<String> = after
            .filter_map(|place| place.file_name().map(|name| shown(Path::new(name))))
            .collect();
        let (first, last) = (names.first()?, names.last()?);
        Some(match names.len() {
            1 => format!("{first} is not one of these frames, and stays: delete it if it belongs to an earlier export"),
            count => format!(
                "{count} files from {first} to {last} are none of these frames, and stay: delete them if they belong to \
                 an earlier export"
            ),
        })
    }

    /// All files.
    pub fn all(&self) -> impl Iterator<Item = PathBuf> + '_ {
        let (Self::Last(_, steps) | Self::Each { steps, .. }) = self;
        (0..=*steps).filter_map(|step| self.at(step))
    }
}

/// The number of frames up to a time, both ends included.
///
/// # Errors
/// More frames than [`MOST_FRAMES`].
pub(crate) fn frame_count(duration: f64, fps: f64) -> Result<usize, EngineError> {
    let last = (duration * fps + ROUNDING).floor();
    if last >= MOST_FRAMES {
        return Err(EngineError::Arguments(format!(
            "--fps {fps} gives {last} frames, more than {MOST_FRAMES}: lower it, or shorten the animation"
        )));
    }
    Ok(last as usize + 1)
}

/// The places of an animation's files.
///
/// # Errors
/// A place where no file can be written.
pub(crate) fn checked_places(output: &Path, count: usize) -> Result<Vec<PathBuf>, EngineError> {
    let places: Vec<PathBuf> = Frames::of(output, count.saturating_sub(1)).all().collect();
    for place in &places {
        Destination::of(place)?;
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_signs_before_the_extension_are_numbers() {
        let frames = Frames::of(Path::new("a/bust-####.glb"), 2);
        let names: Vec<PathBuf> = frames.all().collect();
        assert_eq!(
            names,
            ["a/bust-0000.glb", "a/bust-0001.glb", "a/bust-0002.glb"].map(PathBuf::from)
        );
        for name in ["bust.glb", "bust####.glb", "bust-####-b.glb", "####.glb"] {
            let names: Vec<PathBuf> = Frames::of(Path::new(name), 2).all().collect();
            assert_eq!(names, [PathBuf::from(name)]);
        }
        assert_eq!(
            Frames::of(Path::new("b-#.ply"), 12).at(12),
            Some(PathBuf::from("b-12.ply"))
        );
    }
}
