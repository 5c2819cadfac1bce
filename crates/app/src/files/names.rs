//! Names of files: the sample, kept originals, and a path's last part for a person.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use pliant_engine::files::folder_of;

/// The name of the sample that the window shows when no file is named.
pub(crate) const SAMPLE_NAME: &str = "creature.glb";

/// The highest number in the name of an original.
const MOST_ORIGINALS: usize = 1000;

/// `NAME.original.EXT` beside `NAME.EXT`. A save also replaces a `.gltf`'s buffers, so its original is kept as a GLB,
/// `NAME.original.glb`.
pub fn original_name(path: &Path) -> PathBuf {
    marked_name(path, "original", 1)
}

/// The names under which originals of `path` are kept: [`original_name`], then `NAME.original-2.EXT` and so on.
pub(crate) fn original_names(path: &Path) -> impl Iterator<Item = PathBuf> {
    (1..=MOST_ORIGINALS).map(move |number| marked_name(path, "original", number))
}

/// The names under which a project keeps the mesh with the name `mesh`: `PROJECT.source.EXT`, then
/// `PROJECT.source-2.EXT` and so on; a `.gltf` is kept as a GLB.
pub(crate) fn source_names(project: &Path, mesh: &Path) -> impl Iterator<Item = PathBuf> {
    let like = project.with_extension(mesh.extension().unwrap_or_default());
    (1..=MOST_ORIGINALS).map(move |number| marked_name(&like, "source", number))
}

/// The meshes that are kept beside a project, with any former names; see [`source_names`].
pub(crate) fn sources_of(project: &Path) -> Vec<PathBuf> {
    let mut prefix = project.file_stem().unwrap_or_default().to_owned();
    prefix.push(".source");
    let is_kept = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().as_encoded_bytes();
        name.starts_with(prefix.as_encoded_bytes())
    };
    let entries = std::fs::read_dir(folder_of(project)).into_iter().flatten().flatten();
    let mut kept: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_kept).collect();
    kept.sort();
    kept
}

/// `NAME.MARK.EXT`; from the second on, `NAME.MARK-NUMBER.EXT`.
fn marked_name(path: &Path, mark: &str, number: usize) -> PathBuf {
    let tail = match number {
        1 => format!(".{mark}"),
        _ => format!(".{mark}-{number}"),
    };
    let extension = path.extension();
    let packed = extension.map(|extension| if is_gltf(path) { OsStr::new("glb") } else { extension });
    name_with(path, &tail, packed)
}

/// A free name beside `path`: `NAME-2.EXT`, or the next free number.
pub fn free_name(path: &Path) -> PathBuf {
    let mut names = (2..=MOST_ORIGINALS).map(|number| name_with(path, &format!("-{number}"), path.extension()));
    let free = names.find(|name| std::fs::symlink_metadata(name).is_err());
    free.unwrap_or_else(|| path.to_owned())
}

/// A path's name with `tail` after its stem, and this extension.
fn name_with(path: &Path, tail: &str, extension: Option<&OsStr>) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(tail);
    if let Some(extension) = extension {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

/// Returns true if a path is that of a glTF whose buffers are beside it.
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

/// The file that an original was kept for (see [`original_names`]), if `original` is such a name and the file is there.
pub fn saved_name(original: &Path) -> Option<PathBuf> {
    let (stem, mark) = original.file_stem()?.to_str()?.rsplit_once('.')?;
    let number = mark.strip_prefix("original")?;
    let is_number = |digits: &str| digits.parse::<usize>().is_ok_and(|number| number > 1);
    if !number.is_empty() && !number.strip_prefix('-').is_some_and(is_number) {
        return None;
    }
    let extension = original.extension()?.to_str()?;
    let of_gltf = extension.eq_ignore_ascii_case("glb").then_some("gltf");
    let saved = [Some(extension), of_gltf].into_iter().flatten();
    let mut saved = saved.map(|extension| original.with_file_name(format!("{stem}.{extension}")));
    saved.find(|saved| saved.is_file())
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn a_free_name_is_that_of_no_file_and_of_no_link() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        assert_eq!(free_name(&at("a.b.ply")), at("a.b-2.ply"));
        std::fs::write(at("a.b-2.ply"), "").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("nowhere", at("a.b-3.ply")).unwrap();
        #[cfg(not(unix))]
        std::fs::write(at("a.b-3.ply"), "").unwrap();
        assert_eq!(free_name(&at("a.b.ply")), at("a.b-4.ply"));
        assert_eq!(free_name(&at("scan")), at("scan-2"));
    }

    #[test]
    fn an_original_tells_the_file_that_it_was_kept_for() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (file, kept) in [
            ("scan.ply", "scan.original.ply"),
            ("a.b.glb", "a.b.original.glb"),
            ("x.gltf", "x.original.glb"),
        ] {
            assert_eq!(original_name(&at(file)), at(kept));
            std::fs::write(at(file), "").unwrap();
            for name in original_names(&at(file)).take(12) {
                assert_eq!(saved_name(&name), Some(at(file)), "{}", name.display());
            }
        }
        let second = original_names(&at("scan.ply")).nth(1);
        assert_eq!(second, Some(at("scan.original-2.ply")));
        for name in [
            "scan.ply",
            "scan.originals.ply",
            "scan.original-x.ply",
            "gone.original.ply",
        ] {
            assert_eq!(saved_name(&at(name)), None, "{name}");
        }
    }
}
