//! The libraries and textures that are copied with a saved OBJ file, and those that are not.

use super::Materials;
use super::library::is_other_map;
use crate::save::{OutputFile, Role};
use crate::text::excerpt;
use crate::{Bytes, ObjNames};

/// The libraries and textures of materials; without groups.
pub(in crate::obj) fn names_of(materials: &Materials) -> ObjNames {
    let images = materials.image_paths.iter().zip(&materials.images);
    ObjNames {
        libraries: materials.libraries.clone(),
        textures: images
            .map(|(path, image)| (path.clone(), image.encoded.clone()))
            .collect(),
        names_other_maps: materials.unread.iter().any(|keyword| is_other_map(keyword)),
        ..ObjNames::default()
    }
}

/// The libraries and textures that an OBJ file in another folder needs beside it, and warnings about those that are not
/// copied.
pub(in crate::obj) fn neighbours(names: &ObjNames) -> (Vec<OutputFile>, Vec<String>) {
    let (mut files, mut warnings): (Vec<OutputFile>, Vec<String>) = (Vec::new(), Vec::new());
    let of_role = |role| move |(path, bytes): &'_ (String, Bytes)| (role, path.clone(), bytes.clone());
    let libraries = names.libraries.iter().map(of_role(Role::Library));
    for (role, path, bytes) in libraries.chain(names.textures.iter().map(of_role(Role::Image))) {
        if files.iter().any(|file| file.name == path) {
            continue;
        }
        if is_inside(&path) {
            files.push(OutputFile {
                name: path,
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
    if names.names_other_maps {
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
