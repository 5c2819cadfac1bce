//! Other people's files under every name that a session may use, and other programs' changes of a folder meanwhile.

use std::fs;
use std::path::{Path, PathBuf};

use super::case::{Case, Entry};
use super::{meshes, models};
use crate::trials::Chance;

/// The names that the saves of a session may use beside the mesh `in.EXT` and the project `pose.pliant`.
fn names(input: &Path) -> Vec<String> {
    let extension = models::extension(input);
    let packed = if extension == "gltf" { "glb" } else { &*extension };
    let mut names: Vec<String> = ["", "-2", "-3"]
        .iter()
        .flat_map(|number| {
            [
                format!("in.original{number}.{packed}"),
                format!("pose.source{number}.{packed}"),
            ]
        })
        .collect();
    names.extend(
        [
            "in.bin",
            "in1.bin",
            "in-2.bin",
            "in_2.bin",
            "in.mtl",
            "in-2.mtl",
            "skin.png",
            "skin-2.png",
            "copy.bin",
        ]
        .map(String::from),
    );
    names.extend([format!("in.original.{extension}"), format!("copy.{extension}")]);
    names.extend(["pose.pliant", ".pliant.lock", ".pliant-in.tmp", "in.tmp", "in~"].map(String::from));
    names
}

/// Puts a stranger under one of the names.
pub fn mutate(case: &mut Case, chance: &mut Chance) {
    let place = Path::new("work").join(chance.of(&names(&case.input)));
    if case.entries.contains_key(&place) {
        return;
    }
    let entry = match chance.below(9) {
        0 => Entry::Folder,
        1 => Entry::Link("nowhere".into()),
        2 => Entry::Link("../outside/secret.bin".into()),
        3 => Entry::ReadOnly(b"somebody's".to_vec()),
        4 => Entry::Fifo,
        5 => Entry::Hard("outside/secret.bin".into()),
        6 => match case.entries.get(&Path::new("work").join(&case.input)) {
            // This is the file's own content, which is already kept there.
            Some(Entry::File(bytes)) => Entry::File(bytes.clone()),
            _ => return,
        },
        7 => Entry::File(other_model(&models::extension(&case.input), chance)),
        _ => Entry::File(b"somebody's".to_vec()),
    };
    case.entries.insert(place, entry);
}

/// Another model in one file of this format.
fn other_model(extension: &str, chance: &mut Chance) -> Vec<u8> {
    let count = 8 + chance.below(40);
    let soup = meshes::mesh(*chance.of(&meshes::Class::SOUND), count, chance);
    let format = if extension == "gltf" { "glb" } else { extension };
    let known = ["glb", "obj", "ply", "stl", "off"];
    let format = if known.contains(&format) { format } else { "off" };
    let made = models::made(&soup, format, String::new(), chance);
    let input = Path::new("work").join(&made.input);
    let file = made.entries.into_iter().find(|(place, _)| *place == input);
    match file {
        Some((_, Entry::File(bytes))) => bytes,
        _ => Vec::new(),
    }
}

/// Another program's changes of the files in `work`, whose content the session may have read or written.
pub fn meddle(work: &Path, input: &Path, chance: &mut Chance) {
    let mut places: Vec<PathBuf> = names(input).iter().map(|name| work.join(name)).collect();
    // Most often these are the open file itself and its project.
    places.extend(std::iter::repeat_n(work.join(input), 20));
    places.extend(std::iter::repeat_n(work.join("pose.pliant"), 5));
    let place = chance.of(&places).clone();
    let is_plain = fs::symlink_metadata(&place).is_ok_and(|metadata| metadata.is_file());
    let old = if is_plain { fs::read(&place).ok() } else { None };
    let extension = models::extension(input);
    let _ = match (chance.below(8), old) {
        // The same length and the same time.
        (0, Some(old)) => fs::metadata(&place)
            .and_then(|metadata| metadata.modified())
            .and_then(|time| {
                fs::write(&place, changed(old, chance))?;
                fs::File::options().write(true).open(&place)?.set_modified(time)
            }),
        (1, Some(old)) => fs::write(&place, &old[..old.len() / 2]),
        (2, Some(_)) => fs::remove_file(&place),
        // The same bytes in a new file.
        (3, Some(old)) => replace(&place, &old),
        (4, Some(_)) => fs::rename(&place, work.join("moved")),
        (5, Some(_)) => replace(&place, &other_model(&extension, chance)),
        // It does not write to a pipe or a folder.
        (_, None) if fs::symlink_metadata(&place).is_ok() => Ok(()),
        _ => fs::write(&place, other_model(&extension, chance)),
    };
}

/// Writes a new file and renames it into its place, like careful programs.
fn replace(place: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let beside = place.with_extension("theirs");
    fs::write(&beside, bytes)?;
    fs::rename(beside, place)
}

/// The same number of bytes, with one of them changed.
fn changed(mut bytes: Vec<u8>, chance: &mut Chance) -> Vec<u8> {
    if !bytes.is_empty() {
        let at = chance.below(bytes.len());
        bytes[at] ^= 1 << chance.below(8);
    }
    bytes
}
