//! The kinds of files that an animation becomes, by the name of the output.

use std::path::{Path, PathBuf};

use pliant_io::{Format, PointCacheFormat};

use crate::EngineError;
use crate::frames::Frames;

/// The kind of an output.
pub(super) enum Kind {
    Cache(PointCacheFormat),
    /// A glTF with an animation of morph targets.
    Morphs,
    /// A file for each frame.
    Files,
}

impl Kind {
    pub(super) fn of(output: &Path) -> Result<Self, EngineError> {
        let name = output.to_string_lossy();
        if let Some(format) = PointCacheFormat::of_name(&name) {
            return Ok(Self::Cache(format));
        }
        let format = Format::of_name(&name).map_err(|error| EngineError::Arguments(format!("--output: {error}")))?;
        match (Frames::of(output, 1), format) {
            (Frames::Each { .. }, _) => Ok(Self::Files),
            (Frames::Last(..), format) if has_time(format) => Ok(Self::Morphs),
            (Frames::Last(..), _) => Err(EngineError::Arguments(format!(
                "--output {name} is one file: end its name in -#### for numbered files, or write a .glb, .pc2 or .mdd"
            ))),
        }
    }
}

/// Checks that an output's name is one of an animation.
///
/// # Errors
/// The name is not.
pub(crate) fn check_output(output: &Path) -> Result<(), EngineError> {
    Kind::of(output).map(|_| ())
}

/// True for formats whose files can have an animation.
fn has_time(format: Format) -> bool {
    matches!(format, Format::Glb | Format::Gltf)
}

/// The output for a name that a person has chosen: if its format has one shape in a file, `-####` comes before the
/// extension, so that each frame gets a file. Other names stay.
pub fn animation_path(chosen: &Path) -> PathBuf {
    match Format::of_name(&chosen.to_string_lossy()) {
        Ok(format) if !has_time(format) => Frames::numbered(chosen),
        _ => chosen.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_file_of_one_shape_gets_a_number_for_each_frame() {
        for (chosen, output) in [
            ("a/walk.obj", "a/walk-####.obj"),
            ("a/walk.v2.PLY", "a/walk.v2-####.PLY"),
            ("walk-##.stl", "walk-##.stl"),
            ("walk.glb", "walk.glb"),
            ("walk-####.glb", "walk-####.glb"),
            ("walk.pc2", "walk.pc2"),
            ("walk.mdd", "walk.mdd"),
            ("walk.txt", "walk.txt"),
            ("walk", "walk"),
        ] {
            assert_eq!(animation_path(Path::new(chosen)), Path::new(output));
        }
    }
}
