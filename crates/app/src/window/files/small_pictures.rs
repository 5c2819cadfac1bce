//! Small pictures of recent files, kept as PNG files in a folder of the program's own. Whatever is missing or can't be
//! read is made again when its file is opened.

use std::collections::BTreeSet;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use pliant_engine::files::{self, Staging};
use pliant_render::Image;

use super::recovery::make_private_folder;
use pliant_picture::picture_file;

/// The size of a picture in pixels.
pub const SIZE_PX: [u32; 2] = [192, 144];

/// The path of a file's picture. Another version of the program may name it otherwise, and then makes it again.
fn place(folder: &Path, file: &Path) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    file.hash(&mut hasher);
    folder.join(format!("{:016x}.png", hasher.finish()))
}

/// Keeps the picture of `file`, and deletes those of all files that are not `recent`.
///
/// # Errors
/// If the folder or the picture can't be written, in a sentence.
pub fn keep(folder: &Path, file: &Path, picture: Image, recent: &[PathBuf]) -> Result<(), String> {
    make_private_folder(folder)
        .map_err(|error| format!("{} can't be made ({error}): check its rights", files::shown(folder)))?;
    let png = picture_file::png(picture).map_err(|error| error.to_string())?;
    Staging::private()
        .stage([(place(folder, file), &*png)])
        .and_then(|staged| Ok(staged.commit()?))
        .map_err(|error| error.to_string())?;
    let kept: BTreeSet<PathBuf> = recent.iter().map(|file| place(folder, file)).collect();
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_picture = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "png");
    for path in entries.map(|entry| entry.path()).filter(is_picture) {
        if !kept.contains(&path) {
            // Another window may have deleted it.
            let _ = fs::remove_file(path);
        }
    }
    Ok(())
}

/// The pictures of these files, those that exist.
pub fn read(folder: &Path, recent: &[PathBuf]) -> Vec<(PathBuf, Image)> {
    let pictures = recent.iter().filter_map(|file| {
        let bytes = fs::read(place(folder, file)).ok()?;
        let decoded = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png).ok()?;
        let [width, height] = [decoded.width(), decoded.height()];
        let rgba = decoded.into_rgba8().into_raw();
        ([width, height] == SIZE_PX).then_some((file.clone(), Image { width, height, rgba }))
    });
    pictures.collect()
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn picture(shade: u8) -> Image {
        let [width, height] = SIZE_PX;
        let rgba = [shade, shade, shade, 255].repeat((width * height) as usize);
        Image { width, height, rgba }
    }

    #[test]
    fn a_picture_comes_back_and_those_of_forgotten_files_are_deleted() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("pictures");
        let files: Vec<PathBuf> = ["a.ply", "b.ply", "c.ply"].map(PathBuf::from).to_vec();
        assert!(read(&folder, &files).is_empty());
        for (shade, file) in (10..).zip(&files) {
            keep(&folder, file, picture(shade), &files[1..]).unwrap();
        }
        let found = read(&folder, &files);
        assert_eq!(found.len(), 2, "the first is not recent");
        assert_eq!((&found[0].0, found[0].1.rgba[0]), (&files[1], 11));
        assert_eq!((&found[1].0, found[1].1.rgba[0]), (&files[2], 12));
        assert_eq!(
            fs::read_dir(&folder).unwrap().count(),
            2,
            "nothing else stays in the folder"
        );
        fs::write(place(&folder, &files[1]), "no picture").unwrap();
        assert_eq!(read(&folder, &files).len(), 1);
    }
}
