//! The libraries and textures that are copied with a saved OBJ file, and those that are not.

use super::Materials;
use super::library::is_other_map;
use crate::save::{OutputFile, Role};
use crate::text::excerpt;

/// The libraries and textures that an OBJ file in another folder needs beside it, and warnings about those that are not
/// copied.
pub(in crate::obj) fn neighbours(materials: &Materials) -> (Vec<OutputFile>, Vec<String>) {
    let (mut files, mut warnings): (Vec<OutputFile>, Vec<String>) = (Vec::new(), Vec::new());
    let libraries = materials.libraries.iter();
    let libraries = libraries.map(|(path, bytes)| (Role::Library, path, &**bytes));
    let images = materials.image_paths.iter().zip(&materials.images);
    let images = images.map(|(path, image)| (Role::Image, path, &*image.encoded));
    for (role, path, bytes) in libraries.chain(images) {
        if files.iter().any(|file| file.name == *path) {
            continue;
        }
        if is_inside(path) {
            files.push(OutputFile {
                name: path.clone(),
                role,
                bytes: bytes.to_vec(),
            });
        } else {
            let path = excerpt(path.as_bytes());
            warnings.push(format!(
                "{path} is outside the file's own folder and was not copied: copy it yourself."
            ));
        }
    }
    if materials.unread.iter().any(|keyword| is_other_map(keyword)) {
        let warning = "Maps other than the base colour's stay in the old folder: copy them yourself.";
        warnings.push(warning.to_owned());
    }
    (files, warnings)
}

/// A warning that names the statements of the libraries that a file of another format does not have.
pub(in crate::obj) fn unread_lost(materials: &Materials, kind: &str) -> Option<String> {
    let names: Vec<&str> = materials.unread.iter().map(String::as_str).collect();
    (!names.is_empty()).then(|| {
        format!(
            "{kind} output leaves out the material library's statements {}: keep the .obj for them.",
            names.join(", ")
        )
    })
}

/// Returns true if a path stays within its starting folder, on every system.
fn is_inside(path: &str) -> bool {
    !path.is_empty()
        && !path.contains([':', '\\', '\0'])
        && path.split('/').all(|part| !matches!(part, "" | "." | ".."))
}

#[cfg(test)]
mod tests {
    use super::is_inside;

    #[test]
    fn paths_that_leave_the_folder_are_never_written() {
        for path in ["a.mtl", "textures/skin one.png"] {
            assert!(is_inside(path), "{path}");
        }
        for path in ["", "/etc/x", "../a.mtl", "a/../../b", "C:/a.png", "a//b", "./a", "a\\b"] {
            assert!(!is_inside(path), "{path}");
        }
    }
}
