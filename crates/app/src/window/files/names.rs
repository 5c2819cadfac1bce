//! Names of files: the sample, kept originals, and a path's last part for a person.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The name of the sample that is shown when no file is named.
pub(in crate::window) const SAMPLE_NAME: &str = "creature.glb";

/// `NAME.original.EXT` beside `NAME.EXT`. A `.gltf`'s buffers are saved over along with it, so its original is kept as
/// a GLB, `NAME.original.glb`.
pub fn original_name(path: &Path) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(".original");
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(if is_gltf(path) { OsStr::new("glb") } else { extension });
    }
    path.with_file_name(name)
}

/// Whether a path is that of a glTF whose buffers stand beside it.
pub fn is_gltf(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("gltf"))
}

/// A path's last part, for a person.
pub fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// The file that `NAME.original.EXT` was kept for, if that is such a name and the file is there.
pub fn saved_name(original: &Path) -> Option<PathBuf> {
    let stem = original.file_stem()?.to_str()?.strip_suffix(".original")?;
    let extension = original.extension()?.to_str()?;
    let saved = original.with_file_name(format!("{stem}.{extension}"));
    saved.is_file().then_some(saved)
}
