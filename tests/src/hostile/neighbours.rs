//! Oddities of the files that a model names: their spelling, two names for one file, other models that name the same
//! file, files that are missing, short or elsewhere.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::bytes::with_glb_json;
use super::case::{Case, Entry};
use super::{bytes, gltf, json_text, meshes, names};
use crate::trials::Chance;

/// Makes one change to a case's neighbours.
pub fn mutate(case: &mut Case, chance: &mut Chance) {
    match chance.below(9) {
        0 | 1 => respell(case, chance),
        2 => one_place_twice(case, chance),
        3 | 4 => stranger(case, chance),
        5 => {
            let neighbours = neighbours(case);
            if !neighbours.is_empty() {
                let place = chance.of(&neighbours).clone();
                match chance.below(3) {
                    0 => drop(case.entries.remove(&place)),
                    1 => drop(case.entries.insert(place, Entry::File(Vec::new()))),
                    _ => {
                        if let Some(Entry::File(file)) = case.entries.get_mut(&place) {
                            bytes::plain(file, chance);
                        }
                    }
                }
            }
        }
        6 => outside(case, chance),
        7 => {
            let extension = *chance.of(&["gltf", "glb", "gltf"]);
            case.output = (*chance.of(&["out", "in", "other", "../target/in", "../target/other", "sub/in"])).into();
            case.output.set_extension(extension);
        }
        _ => change_json(case, json_text::mutate, chance),
    }
}

/// Changes the input's JSON, also inside a GLB.
fn change_json(case: &mut Case, change: impl FnOnce(&mut Vec<u8>, &mut Chance), chance: &mut Chance) {
    let place = PathBuf::from("work").join(&case.input);
    match case.entries.get_mut(&place) {
        Some(Entry::File(file)) if file.starts_with(b"{") => change(file, chance),
        Some(Entry::File(file)) if file.starts_with(b"glTF") => with_glb_json(file, |text| change(text, chance)),
        _ => {}
    }
}

/// Spells URIs in another way.
fn respell(case: &mut Case, chance: &mut Chance) {
    let named = ["in.bin", "in1.bin", "sub/in2.bin", "skin.png"];
    let set = |text: &mut Vec<u8>, chance: &mut Chance| {
        let mut number = 0;
        json_text::set_some(
            text,
            "uri",
            &mut |chance| {
                number += 1;
                let name = if chance.one_in(3) {
                    chance.of(&named)
                } else {
                    &named[(number - 1) % 2]
                };
                json_text::quoted(&names::respelled(name, chance))
            },
            chance,
        );
    };
    change_json(case, set, chance);
    let library = PathBuf::from("work/in.mtl");
    if let Some(Entry::File(text)) = case.entries.get_mut(&library) {
        let name = names::respelled("skin.png", chance);
        *text = super::formats::mtl(&name);
    }
}

/// Adds a second buffer that is the first one's file in another spelling; half of the views use it.
fn one_place_twice(case: &mut Case, chance: &mut Chance) {
    let twice = |text: &mut Vec<u8>, chance: &mut Chance| {
        let Ok(mut json) = serde_json::from_slice::<Value>(text) else {
            return;
        };
        let Some(first) = json["buffers"].get(0).cloned() else {
            return;
        };
        let Some(buffers) = json["buffers"].as_array_mut() else {
            return;
        };
        let number = buffers.len();
        let mut second = first;
        second["uri"] = names::respelled("in.bin", chance).into();
        buffers.push(second);
        for view in json["bufferViews"].as_array_mut().into_iter().flatten() {
            if view["buffer"] == json!(0) && chance.one_in(2) {
                view["buffer"] = number.into();
            }
        }
        *text = json.to_string().into_bytes();
    };
    change_json(case, twice, chance);
}

/// Adds another model, which names a path that the save may use.
fn stranger(case: &mut Case, chance: &mut Chance) {
    let folder = *chance.of(&["work", "work", "target", "work/sub"]);
    let stem = *chance.of(&["other", "out", "in", "scene"]);
    let buffer = *chance.of(&["in.bin", "out.bin", "in1.bin", "out_2.bin", "other.bin"]);
    let model = PathBuf::from(folder).join(stem).with_extension("gltf");
    if case.entries.contains_key(&model) {
        return;
    }
    let place = PathBuf::from(folder).join(buffer);
    if case.entries.contains_key(&place) {
        // It shares the neighbour: it is a copy of the input under another name.
        let input = PathBuf::from("work").join(&case.input);
        if let Some(Entry::File(text)) = case.entries.get(&input).cloned() {
            case.entries.insert(model, Entry::File(text));
        }
        return;
    }
    let soup = meshes::mesh(meshes::Class::Ball, 40, chance);
    let mut made = gltf::gltf(&soup, 1, &[], chance);
    made.json["buffers"][0]["uri"] = buffer.into();
    if let Some(members) = made.json.as_object_mut() {
        members.remove("images");
        members.remove("textures");
        members.remove("materials");
    }
    for primitive in made.json["meshes"][0]["primitives"]
        .as_array_mut()
        .into_iter()
        .flatten()
    {
        primitive.as_object_mut().map(|members| members.remove("material"));
    }
    case.entries.insert(place, Entry::File(made.buffers[0].clone()));
    case.entries
        .insert(model, Entry::File(made.json.to_string().into_bytes()));
}

/// Moves a neighbour out of the folder; the model names it at its new path.
fn outside(case: &mut Case, chance: &mut Chance) {
    let neighbours = neighbours(case);
    if neighbours.is_empty() {
        return;
    }
    let place = chance.of(&neighbours).clone();
    let Some(file) = case.entries.remove(&place) else {
        return;
    };
    let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let old = place
        .strip_prefix("work")
        .unwrap_or(&place)
        .to_string_lossy()
        .into_owned();
    case.entries.insert(PathBuf::from("outside").join(&name), file);
    let new = match chance.below(3) {
        0 => format!("@ROOT@/outside/{name}"),
        _ => format!("../outside/{name}"),
    };
    change_json(
        case,
        |text, _| {
            let [old, new] = [&old, &new].map(|name| String::from_utf8(json_text::quoted(name)).unwrap_or_default());
            *text = String::from_utf8_lossy(text).replace(&old, &new).into_bytes();
        },
        chance,
    );
}

/// The paths of the input's neighbours.
fn neighbours(case: &Case) -> Vec<PathBuf> {
    let is_one = |place: &&PathBuf| {
        let name = place.to_string_lossy();
        place.starts_with("work") && (name.ends_with(".bin") || name.ends_with(".png") || name.ends_with(".mtl"))
    };
    case.entries.keys().filter(is_one).cloned().collect()
}
