//! Links, pipes, folders and odd names where files are expected, and results with a taken path.

use std::path::{Path, PathBuf};

use super::case::{Case, Entry};
use super::{models, names};
use crate::trials::Chance;

/// Makes one odd change to a path that the command reads or writes.
pub fn mutate(case: &mut Case, chance: &mut Chance) {
    match chance.below(6) {
        0 => odd_output(case, chance),
        1 => odd_report(case, chance),
        2 => rename_input(case, chance),
        _ => odd_place(case, chance),
    }
}

/// Puts something other than a plain file at a path that is read or written.
fn odd_place(case: &mut Case, chance: &mut Chance) {
    let mut places: Vec<PathBuf> = case
        .entries
        .keys()
        .filter(|place| place.starts_with("work"))
        .cloned()
        .collect();
    let output = Path::new("work").join(&case.output);
    places.retain(|place| place != Path::new("work/sub"));
    if !case.output.starts_with("@ROOT@") {
        places.extend([output.clone(), output.with_extension("bin")]);
    }
    places.extend([
        "work/report.json".into(),
        "work/out.bin".into(),
        "work/out_2.bin".into(),
    ]);
    let place = chance.of(&places).clone();
    let there = case.entries.get(&place).cloned();
    let moved = Path::new("outside").join(place.file_name().unwrap_or_default());
    let up: PathBuf = place
        .parent()
        .into_iter()
        .flat_map(Path::components)
        .map(|_| "..")
        .collect();
    let content = match &there {
        Some(Entry::File(bytes)) => bytes.clone(),
        _ => b"somebody's".to_vec(),
    };
    let link = |target: &Path| Entry::Link(target.as_os_str().to_owned());
    let name = place.file_name().unwrap_or_default();
    let new = match chance.below(13) {
        0 | 1 => {
            case.entries.insert(moved.clone(), Entry::File(content));
            link(&up.join(&moved))
        }
        2 => {
            case.entries.insert(moved.clone(), Entry::File(content));
            link(&Path::new("@ROOT@").join(&moved))
        }
        3 => {
            case.entries.insert(moved.clone(), Entry::File(content));
            Entry::Hard(moved)
        }
        4 => link(&up.join("outside/missing.glb")),
        5 => link(Path::new(name)),
        6 => link(&up.join("work").join(&case.input)),
        7 => link(&up.join("outside")),
        8 => Entry::Fifo,
        9 => Entry::Socket,
        10 => Entry::Folder,
        11 => Entry::ReadOnly(content),
        _ => Entry::Hard(Path::new("work").join(&case.input)),
    };
    if new != Entry::Hard(place.clone()) {
        case.entries.insert(place, new);
    }
}

/// Gives the result a difficult name, or the path of another object.
fn odd_output(case: &mut Case, chance: &mut Chance) {
    let extension = models::extension(&case.input);
    case.output = match chance.below(5) {
        0 => existing(case, chance),
        1 => PathBuf::from("missing").join(&case.output),
        2 => PathBuf::from("sub/../.").join(&case.input),
        _ => PathBuf::from(*chance.of(&["", "", "sub", "../target"])).join(names::odd_name(&extension, chance)),
    };
}

/// Gives the report the path of an input or output, or an odd name.
fn odd_report(case: &mut Case, chance: &mut Chance) {
    let output = case.output.clone();
    case.report = Some(match chance.below(6) {
        0 => output,
        1 => output.with_extension("bin"),
        2 => names::odd_name("json", chance).into(),
        3 => PathBuf::from("missing/report.json"),
        _ => existing(case, chance),
    });
}

/// The path of an existing object, relative to `work`, in one of several spellings.
fn existing(case: &Case, chance: &mut Chance) -> PathBuf {
    let places: Vec<&PathBuf> = case.entries.keys().collect();
    let place = *chance.of(&places);
    match place.strip_prefix("work") {
        Ok(inside) => match chance.below(3) {
            0 => Path::new("sub/..").join(inside),
            1 => Path::new("@ROOT@/work").join(inside),
            _ => inside.to_owned(),
        },
        Err(_) => Path::new("..").join(place),
    }
}

/// Gives the input a difficult name.
fn rename_input(case: &mut Case, chance: &mut Chance) {
    let extension = models::extension(&case.input);
    let new = PathBuf::from(names::odd_name(&extension, chance));
    let Some(file) = case.entries.remove(&Path::new("work").join(&case.input)) else {
        return;
    };
    if case.output == case.input {
        case.output.clone_from(&new);
    }
    case.entries.insert(Path::new("work").join(&new), file);
    case.input = new;
}
