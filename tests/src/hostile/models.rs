//! The models from which cases start: generated ones of every format and class, and those of the readers' corpus,
//! including compressed ones.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde_json::Value;

use super::case::{Entry, Size};
use super::meshes::{self, Class, Soup};
use super::{formats, gltf};
use crate::trials::Chance;

/// A model with its neighbours, all below `work`.
#[derive(Clone, Debug)]
pub struct Model {
    pub entries: Vec<(PathBuf, Entry)>,
    /// Relative to `work`.
    pub input: PathBuf,
    /// The approximate number of its vertices.
    pub vertices: usize,
    pub class: String,
}

/// The largest file, in bytes, taken from the data beside the project into the corpus.
const LARGEST: u64 = 130_000;

/// A small sound mesh of any format, or a file of the corpus.
pub fn sound(chance: &mut Chance) -> Model {
    if chance.one_in(5) {
        return kept(chance);
    }
    let soup = sound_soup(chance);
    let format = *chance.of(&["glb", "gltf", "gltf", "obj", "ply", "stl", "off"]);
    made(&soup, format, format.to_owned(), chance)
}

/// A small sound mesh in one file.
pub fn alone(chance: &mut Chance) -> Model {
    let soup = sound_soup(chance);
    let format = *chance.of(&["ply", "stl", "off"]);
    made(&soup, format, format.to_owned(), chance)
}

/// A small sound mesh that names other files.
pub fn with_neighbours(chance: &mut Chance) -> Model {
    let soup = sound_soup(chance);
    let format = *chance.of(&["gltf", "gltf", "gltf", "glb", "obj"]);
    made(&soup, format, format.to_owned(), chance)
}

/// A small mesh of any class and format, or a file of the corpus.
pub fn any(chance: &mut Chance) -> Model {
    if chance.one_in(2) {
        return kept(chance);
    }
    let class = *chance.of(&Class::ALL);
    let count = 2 + chance.below(100);
    let soup = meshes::mesh(class, count, chance);
    let format = *chance.of(&["glb", "gltf", "obj", "ply", "stl", "off"]);
    made(&soup, format, format.to_owned(), chance)
}

/// A mesh that is difficult to solve.
pub fn hard(size: Size, chance: &mut Chance) -> Model {
    let class = *chance.of(&Class::ALL);
    let most = match size {
        Size::Small => 300.0,
        Size::Full if chance.one_in(300) => 300_000.0,
        Size::Full if chance.one_in(10) => 30_000.0,
        Size::Full => 3000.0,
    };
    let count = 2.0 * (most / 2.0_f64).powf(chance.share());
    let soup = meshes::mesh(class, count as usize, chance);
    let format = *chance.of(&["glb", "gltf", "obj", "ply", "stl", "off"]);
    made(&soup, format, format!("{class:?}"), chance)
}

/// The extension of a model's path.
pub fn extension(input: &Path) -> String {
    input.extension().unwrap_or_default().to_string_lossy().into_owned()
}

fn sound_soup(chance: &mut Chance) -> Soup {
    let class = *chance.of(&Class::SOUND);
    let count = 8 + chance.below(120);
    meshes::mesh(class, count, chance)
}

/// A mesh as the file `in.FORMAT` with its neighbours.
pub fn made(soup: &Soup, format: &str, class: String, chance: &mut Chance) -> Model {
    let at = |name: &str| Path::new("work").join(name);
    let image = image();
    let mut entries = Vec::new();
    let file = match format {
        "obj" => {
            entries.push((at("in.mtl"), Entry::File(formats::mtl("skin.png"))));
            entries.push((at("skin.png"), Entry::File(image.to_vec())));
            formats::obj(soup, "in.mtl", chance)
        }
        "ply" => formats::ply(soup, chance),
        "stl" => formats::stl(soup, chance),
        "off" => formats::off(soup),
        _ => {
            let count = if format == "glb" { 1 } else { 1 + chance.below(3) };
            let mut made = gltf::gltf(soup, count, image, chance);
            for (number, bytes) in made.buffers.iter().enumerate().filter(|_| format != "glb") {
                let name = ["in.bin", "in1.bin", "sub/in2.bin"][number];
                made.json["buffers"][number]["uri"] = name.into();
                entries.push((at(name), Entry::File(bytes.clone())));
            }
            for (number, bytes) in made.images.iter().enumerate() {
                let name = if number == 0 {
                    "skin.png".to_owned()
                } else {
                    format!("sub/skin{number}.png")
                };
                made.json["images"][number]["uri"] = name.clone().into();
                entries.push((at(&name), Entry::File(bytes.clone())));
            }
            if format == "glb" {
                made.glb()
            } else {
                made.json.to_string().into_bytes()
            }
        }
    };
    let input = PathBuf::from(format!("in.{format}"));
    entries.push((Path::new("work").join(&input), Entry::File(file)));
    Model {
        entries,
        input,
        vertices: soup.positions.len(),
        class,
    }
}

/// A file of the corpus, renamed to `in`.
fn kept(chance: &mut Chance) -> Model {
    let (path, files) = chance.of(corpus());
    let extension = extension(path);
    let input = PathBuf::from(format!("in.{extension}"));
    let entries = files.iter().map(|(name, bytes)| {
        let name = if name == path { &input } else { name };
        (Path::new("work").join(name), Entry::File(bytes.clone()))
    });
    Model {
        entries: entries.collect(),
        input,
        vertices: 8,
        class: extension,
    }
}

type Sound = (PathBuf, BTreeMap<PathBuf, Vec<u8>>);

/// Every model of the readers' corpus and the small ones of the data beside the project, with their neighbours.
fn corpus() -> &'static [Sound] {
    static CORPUS: OnceLock<Vec<Sound>> = OnceLock::new();
    CORPUS.get_or_init(|| {
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/io/tests/corpus");
        let mut paths = Vec::new();
        crate::collect(&own, &mut paths);
        paths.extend(crate::data(&["gltf", "bad"]));
        paths.sort();
        paths.retain(|path| path.metadata().is_ok_and(|data| data.len() < LARGEST));
        paths.iter().filter_map(|path| with_its_neighbours(path)).collect()
    })
}

fn with_its_neighbours(path: &Path) -> Option<Sound> {
    let (folder, name) = (path.parent()?, PathBuf::from(path.file_name()?));
    let bytes = std::fs::read(path).ok()?;
    let json: Value = serde_json::from_slice(&bytes).unwrap_or_default();
    let mut files = BTreeMap::new();
    for section in ["buffers", "images"] {
        for uri in json[section]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|item| item["uri"].as_str())
        {
            let is_small = folder.join(uri).metadata().is_ok_and(|data| data.len() < LARGEST);
            if is_small && !uri.contains("..") {
                files.insert(PathBuf::from(uri), std::fs::read(folder.join(uri)).ok()?);
            }
        }
    }
    files.insert(name.clone(), bytes);
    Some((name, files))
}

/// A small image.
fn image() -> &'static [u8] {
    include_bytes!("../../../crates/io/tests/corpus/ramp-etc1s.png")
}
