//! A case: the contents of a folder, and the program's commands there. It is only a description, so its number alone
//! reproduces it anywhere.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;

use pliant_deform::METHODS;

use super::models::{self, Model};
use super::{bytes, edits, json_text, links, neighbours, pictures, projects, strangers};
use crate::trials::Chance;

/// The hostile part of a case.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Kind {
    Edit,
    Project,
    Neighbour,
    Link,
    Mesh,
    File,
    /// A broken file that is rendered.
    Render,
    /// Other programs' files and writes around the saves of a session.
    Session,
}

impl Kind {
    pub const ALL: [Self; 8] = [
        Self::Edit,
        Self::Project,
        Self::Neighbour,
        Self::Link,
        Self::Mesh,
        Self::File,
        Self::Render,
        Self::Session,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Edit => "edit",
            Self::Project => "project",
            Self::Neighbour => "neighbour",
            Self::Link => "link",
            Self::Mesh => "mesh",
            Self::File => "file",
            Self::Render => "render",
            Self::Session => "session",
        }
    }

    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// The size of the meshes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Size {
    /// Up to a few hundred triangles.
    Small,
    /// Usually thousands of triangles, sometimes a hundred thousand.
    Full,
}

/// The entry at a path in the folder.
#[derive(Clone, PartialEq, Debug)]
pub enum Entry {
    File(Vec<u8>),
    ReadOnly(Vec<u8>),
    Folder,
    /// A symbolic link; `@ROOT@` in it is the case's folder.
    Link(OsString),
    /// A hard link to the file at that path.
    Hard(PathBuf),
    Fifo,
    Socket,
}

/// A folder and a command. Entries' paths are relative to the case's folder, the command's paths to `work` in it.
#[derive(Clone, Debug)]
pub struct Case {
    pub seed: u64,
    pub kind: Kind,
    /// The kind of its mesh or file, for the table of results.
    pub class: String,
    pub entries: BTreeMap<PathBuf, Entry>,
    pub input: PathBuf,
    pub edit: PathBuf,
    pub output: PathBuf,
    pub report: Option<PathBuf>,
    /// Further arguments of `pliant apply` or `pliant render`.
    pub more: Vec<OsString>,
    /// The number of random changes to its base, including those that were left out.
    pub mutation_count: usize,
}

impl Case {
    /// The case with a given number. `without` has the indices of random changes to leave out.
    pub fn new(seed: u64, kind: Kind, size: Size, without: &[usize]) -> Self {
        let chance = &mut Chance(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ kind as u64);
        let model = match kind {
            Kind::Mesh => models::hard(size, chance),
            Kind::File | Kind::Render => models::any(chance),
            Kind::Neighbour => models::with_neighbours(chance),
            Kind::Project => models::alone(chance),
            Kind::Edit | Kind::Link | Kind::Session => models::sound(chance),
        };
        let mut case = Self::of(seed, kind, model, chance);
        case.mutation_count = match kind {
            Kind::Mesh => 0,
            Kind::Edit | Kind::Project | Kind::File | Kind::Render => 1 + chance.below(3) * chance.below(2),
            Kind::Neighbour | Kind::Link | Kind::Session => 1 + chance.below(3),
        };
        for mutation in 0..case.mutation_count {
            if !without.contains(&mutation) {
                case.mutate(&mut Chance(seed.rotate_left(17) ^ (mutation as u64 + 1)));
            }
        }
        case
    }

    /// The total size in bytes of the files for the program.
    pub fn byte_count(&self) -> usize {
        let files = self.entries.values().map(|entry| match entry {
            Entry::File(bytes) | Entry::ReadOnly(bytes) => bytes.len(),
            _ => 0,
        });
        files.sum()
    }

    /// A sound model with a sound edit, and the command with random arguments.
    fn of(seed: u64, kind: Kind, model: Model, chance: &mut Chance) -> Self {
        let mut entries = BTreeMap::new();
        for folder in ["work/sub", "outside", "target"] {
            entries.insert(folder.into(), Entry::Folder);
        }
        entries.insert("outside/secret.bin".into(), Entry::File(vec![0x5e; 4096]));
        let extension = models::extension(&model.input);
        let (edit, text) = match kind {
            Kind::Project => ("pose.pliant", project_of(&model, chance)),
            Kind::Edit => (
                "edit.json",
                edits::rich(model.vertices, chance).to_string().into_bytes(),
            ),
            Kind::Mesh => ("edit.json", edits::short(chance).to_string().into_bytes()),
            Kind::Neighbour | Kind::Link | Kind::File | Kind::Render | Kind::Session => {
                ("edit.json", edits::plain(chance).to_string().into_bytes())
            }
        };
        entries.insert(PathBuf::from("work").join(edit), Entry::File(text));
        let output = match kind {
            Kind::Render => pictures::output(chance),
            _ => output(&model.input, &extension, chance),
        };
        let input = model.input.clone();
        entries.extend(model.entries);
        Self {
            seed,
            kind,
            class: model.class,
            entries,
            input,
            edit: edit.into(),
            output,
            report: chance.one_in(3).then(|| "report.json".into()),
            more: match kind {
                Kind::Render => pictures::more(chance),
                _ => more(kind, chance),
            },
            mutation_count: 0,
        }
    }

    fn mutate(&mut self, chance: &mut Chance) {
        match self.kind {
            Kind::Edit | Kind::Project => {
                let place = PathBuf::from("work").join(&self.edit);
                if let Some(Entry::File(text)) = self.entries.get_mut(&place) {
                    json_text::mutate(text, chance);
                }
            }
            Kind::Neighbour => neighbours::mutate(self, chance),
            Kind::Link => links::mutate(self, chance),
            Kind::Session => strangers::mutate(self, chance),
            Kind::Mesh => {}
            Kind::File | Kind::Render => {
                let names: Vec<PathBuf> = self
                    .entries
                    .keys()
                    .filter(|place| place.starts_with("work"))
                    .cloned()
                    .collect();
                let input = PathBuf::from("work").join(&self.input);
                let place = if chance.one_in(4) {
                    chance.of(&names).clone()
                } else {
                    input
                };
                if let Some(Entry::File(file)) = self.entries.get_mut(&place) {
                    bytes::mutate(file, chance);
                }
            }
        }
    }
}

/// A project on a model that needs no neighbours.
fn project_of(model: &Model, chance: &mut Chance) -> Vec<u8> {
    let input = PathBuf::from("work").join(&model.input);
    let Some((_, Entry::File(file))) = model.entries.iter().find(|(place, _)| *place == input) else {
        return Vec::new();
    };
    let loaded = pliant_engine::load_bytes(file.clone(), &model.input, &Default::default(), &Default::default());
    let (hash, drawn) = match &loaded {
        Ok(loaded) => (
            pliant_editor::geometry_hash(&loaded.model),
            loaded.model.rest().positions.len(),
        ),
        Err(_) => ("sha256:00".to_owned(), 4),
    };
    let project = projects::project(&hash, &model.input.to_string_lossy(), drawn, chance);
    project.to_string().into_bytes()
}

/// The place of the result: beside the input, over it, into another folder, or to another format.
fn output(input: &std::path::Path, extension: &str, chance: &mut Chance) -> PathBuf {
    let other = *chance.of(&["glb", "gltf", "obj", "ply", "stl", "off"]);
    let extension = if chance.one_in(3) { other } else { extension };
    match chance.below(8) {
        0 => input.to_owned(),
        1 => format!("../target/in.{extension}").into(),
        2 => format!("../target/out.{extension}").into(),
        3 => format!("sub/out.{extension}").into(),
        4 => format!("@ROOT@/work/out.{extension}").into(),
        _ => format!("out.{extension}").into(),
    }
}

/// Further arguments. A large mesh keeps its edit's method, which has few iterations.
fn more(kind: Kind, chance: &mut Chance) -> Vec<OsString> {
    let mut words: Vec<OsString> = Vec::new();
    if kind != Kind::Mesh && chance.one_in(3) {
        words.extend(["--method".into(), chance.of(METHODS).name.into()]);
    }
    if chance.one_in(8) {
        words.extend(["--frames".into(), (*chance.of(&["1", "2", "5"])).into()]);
    }
    if chance.one_in(3) {
        words.extend(["--threads".into(), (*chance.of(&["1", "2", "3", "8"])).into()]);
    }
    if chance.one_in(10) {
        words.extend([
            "--as-morph".into(),
            (*chance.of(&["bent", "\u{1b}[31m", "smile"])).into(),
        ]);
        if chance.one_in(2) {
            words.extend(["--morph-weight".into(), "0.25".into()]);
        }
    }
    words
}
