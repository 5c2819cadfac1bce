//! The shared glTF files, where they are there: unedited they come back byte for byte, edited they differ in nothing
//! but the moved vertices' numbers and their bounds, and on every number of threads they are the same.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stderr, reason = "a test that is skipped says so")]

mod gltf_maker;

use std::path::{Path, PathBuf};

use glam::DVec3;
use gltf_maker::{assert_near, bent, moved};
use pliant_io::{Format, Opened, Placement, ReadError, Resolver, Save, Saved, read};
use pliant_mesh::{Cancel, Progress};
use serde_json::Value;

struct Disk(PathBuf);

impl Resolver for Disk {
    fn read(&self, uri: &str) -> Result<Vec<u8>, String> {
        std::fs::read(self.0.join(uri)).map_err(|error| error.to_string())
    }
}

/// What was just saved, before the disk.
struct Fresh<'a>(&'a Saved, Disk);

impl Resolver for Fresh<'_> {
    fn read(&self, uri: &str) -> Result<Vec<u8>, String> {
        let file = self.0.files.iter().find(|file| file.name == uri);
        file.map_or_else(|| self.1.read(uri), |file| Ok(file.bytes.clone()))
    }
}

fn files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/gltf");
    let mut open = vec![root];
    let mut files = Vec::new();
    while let Some(folder) = open.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            continue;
        };
        for path in entries.map(|entry| entry.unwrap().path()) {
            match path.is_dir() {
                true => open.push(path),
                false if Format::of_name(&path.to_string_lossy()).is_ok() => files.push(path),
                false => {}
            }
        }
    }
    files.sort();
    if files.is_empty() {
        eprintln!("skipped: the shared glTF files are not here");
    }
    files
}

fn open_file(path: &Path) -> Result<(Opened, Vec<u8>), ReadError> {
    let bytes = std::fs::read(path).unwrap();
    let disk = Disk(path.parent().unwrap().to_path_buf());
    open_bytes(&bytes, path, &disk).map(|opened| (opened, bytes))
}

fn open_bytes(bytes: &[u8], path: &Path, resolver: &dyn Resolver) -> Result<Opened, ReadError> {
    let name = path.file_name().unwrap().to_string_lossy();
    read(
        bytes.to_vec(),
        Format::of_name(&name).unwrap(),
        &name,
        resolver,
        &Progress::new(),
        &Cancel::new(),
    )
}

fn save(opened: &Opened, positions: &[DVec3], path: &Path) -> Saved {
    let name = path.file_name().unwrap().to_string_lossy();
    let format = Format::of_name(&name).unwrap();
    let placement = Placement::OtherFolder;
    opened
        .scene
        .save(&Save {
            drawn: &opened.drawn,
            positions,
            format,
            name: &name,
            placement,
        })
        .unwrap()
}

#[test]
fn compressed_files_are_refused_and_all_others_come_back_byte_for_byte() {
    for path in files() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        match open_file(&path) {
            Ok((opened, bytes)) => {
                let saved = save(&opened, &opened.drawn.positions, &path);
                assert!(saved.files[0].bytes == bytes, "{name}");
                for neighbour in &saved.files[1..] {
                    let there = std::fs::read(path.parent().unwrap().join(&neighbour.name)).unwrap();
                    assert!(neighbour.bytes == there, "{name}: {}", neighbour.name);
                }
            }
            Err(error) => {
                let is_compressed = ["BoxDraco.gltf", "DracoSparseMesh.gltf", "BoxMeshopt.glb"].contains(&&*name);
                assert!(
                    is_compressed && matches!(error, ReadError::Unsupported { .. }),
                    "{error}"
                );
            }
        }
    }
}

#[test]
fn edited_files_keep_everything_but_the_moved_numbers() {
    for path in files() {
        let Ok((opened, bytes)) = open_file(&path) else {
            continue;
        };
        let positions = moved(&opened, |v| v % 2 == 1, |p| bent(p * 0.1) * 10.0);
        let saved = save(&opened, &positions, &path);
        let disk = Disk(path.parent().unwrap().to_path_buf());
        let again = open_bytes(&saved.files[0].bytes, &path, &Fresh(&saved, disk)).unwrap();
        let size = positions.iter().map(|p| p.length()).fold(1.0, f64::max);
        assert_near(&again.drawn.positions, &positions, size);
        let (old, new) = (json_of(&bytes), json_of(&saved.files[0].bytes));
        let kept = [
            "asset",
            "scene",
            "scenes",
            "materials",
            "images",
            "textures",
            "samplers",
            "skins",
            "animations",
        ];
        for key in kept.iter().chain(&[
            "cameras",
            "extensions",
            "extensionsUsed",
            "extensionsRequired",
            "extras",
        ]) {
            assert_eq!(old[key], new[key], "{}: {key}", path.display());
        }
        let length = |root: &Value, section: &str| root[section].as_array().map_or(0, Vec::len);
        // Meshes over shared accessors that came to differ name new ones.
        let is_split = length(&new, "accessors") > length(&old, "accessors");
        for section in ["accessors", "bufferViews", "meshes", "nodes"] {
            assert!(is_split || length(&old, section) == length(&new, section));
            let [old, new] = [&old[section], &new[section]].map(|list| list.as_array().cloned().unwrap_or_default());
            for (old, new) in old.into_iter().zip(new) {
                let [old, new] = [old, new].map(|value| without_what_may_change(value, is_split));
                assert_eq!(old, new, "{}: {section}", path.display());
            }
        }
        let looks = [opened.scene.appearance(), again.scene.appearance()];
        assert_eq!(looks[0].uvs, looks[1].uvs);
        assert_eq!(looks[0].colours, looks[1].colours);
        assert_eq!(looks[0].materials, looks[1].materials);
    }
}

/// An accessor, mesh or node without its bounds and, where accessors were split, the names of what was.
fn without_what_may_change(mut value: Value, is_split: bool) -> Value {
    for key in ["min", "max", "mesh"] {
        value.as_object_mut().unwrap().remove(key);
    }
    for primitive in value["primitives"]
        .as_array_mut()
        .into_iter()
        .flatten()
        .filter(|_| is_split)
    {
        for key in ["POSITION", "NORMAL", "TANGENT"] {
            primitive["attributes"].as_object_mut().unwrap().remove(key);
        }
    }
    value
}

fn json_of(bytes: &[u8]) -> Value {
    if bytes.starts_with(b"glTF") {
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        serde_json::from_slice(&bytes[20..20 + length]).unwrap()
    } else {
        serde_json::from_slice(bytes).unwrap()
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    for path in files() {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let (opened, _) = open_file(&path).ok()?;
                Some(save(
                    &opened,
                    &moved(&opened, |_| true, |p| bent(p * 0.1) * 10.0),
                    &path,
                ))
            })
        };
        let alone = run(1);
        assert!(run(2) == alone && run(3) == alone, "{}", path.display());
    }
}
