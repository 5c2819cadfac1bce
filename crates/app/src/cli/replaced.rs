//! The original of a file that a command replaces.

use std::path::{Path, PathBuf};

use pliant_engine::files::{Staged, Staging};
use pliant_engine::{EngineError, Loaded};
use pliant_mesh::{Cancel, Progress};

use crate::files::original::{Kept, Original};

/// Prepares a copy of the file at `output` beside it, unless there is one already. Gives the place of the copy, and the
/// staged copy, to be committed before the new file. `loaded` is the open file, which may be the same.
///
/// # Errors
/// The file can't be read or the copy can't be written.
pub(super) fn keep_replaced(
    loaded: &Loaded,
    output: &Path,
    staging: &Staging,
    cancel: &Cancel,
) -> Result<(Option<PathBuf>, Option<Staged>), EngineError> {
    let original = Original::of(output, loaded, cancel)?;
    let (place, staged) = original.keep(&[], loaded, staging, &Progress::new(), cancel)?;
    let kept = match place {
        Kept::Already(place) | Kept::Under(place) => Some(place),
        Kept::Nothing => None,
    };
    Ok((kept, staged))
}
