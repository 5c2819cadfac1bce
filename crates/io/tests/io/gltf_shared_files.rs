//! The shared glTF files, if present: unedited they come back byte for byte, edited they differ only in the moved
//! vertices' numbers and their bounds, and on every number of threads they are the same.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stderr, reason = "a test that is skipped says so")]

use std::path::{Path, PathBuf};

use crate::gltf_maker::{assert_near, bent, moved};
use glam::DVec3;
use pliant_io::{
    Bytes, Difference, Format, Material, Placement, ReadError, Resolver, Save, Saved, SceneAndDrawn, What, read,
};
use pliant_mesh::{Cancel, Drawn, Progress};
use serde_json::Value;

struct Disk(PathBuf);

impl Resolver for Disk {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        std::fs::read(self.0.join(uri))
            .map(Bytes::from)
            .map_err(|error| error.to_string())
    }
}

/// A fresh save, before the disk.
struct Fresh<'a>(&'a Saved, Disk);

impl Resolver for Fresh<'_> {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        let file = self.0.files.iter().find(|file| file.name == uri);
        file.map_or_else(|| self.1.read(uri), |file| Ok(file.bytes.clone().into()))
    }
}

fn files() -> Vec<PathBuf> {
    let root = PathBuf::from(std::env::var_os("PLIANT_DATA").unwrap_or_default()).join("gltf");
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

fn open_file(path: &Path) -> Result<(SceneAndDrawn, Vec<u8>), ReadError> {
    let bytes = std::fs::read(path).unwrap();
    let disk = Disk(path.parent().unwrap().to_path_buf());
    open_bytes(&bytes, path, &disk).map(|opened| (opened, bytes))
}

fn open_bytes(bytes: &[u8], path: &Path, resolver: &dyn Resolver) -> Result<SceneAndDrawn, ReadError> {
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

fn save(opened: &SceneAndDrawn, positions: &[DVec3], path: &Path) -> Saved {
    let name = path.file_name().unwrap().to_string_lossy();
    let format = Format::of_name(&name).unwrap();
    let placement = Placement::OtherFolder;
    opened
        .scene
        .save(
            &Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn: &opened.drawn,
                positions,
                format,
                name: &name,
                placement,
            },
            &Progress::new(),
            &Cancel::new(),
        )
        .unwrap()
}

#[test]
fn every_file_comes_back_byte_for_byte() {
    for path in files() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let (opened, bytes) = open_file(&path).unwrap_or_else(|error| panic!("{error}"));
        let saved = save(&opened, &opened.drawn.positions, &path);
        assert!(saved.files[0].bytes == bytes, "{name}");
        for neighbour in &saved.files[1..] {
            let there = std::fs::read(path.parent().unwrap().join(&neighbour.name)).unwrap();
            assert!(neighbour.bytes == there, "{name}: {}", neighbour.name);
        }
    }
}

/// Compressed positions match the accessor's own bounds.
#[test]
fn compressed_geometry_lies_where_its_file_says() {
    for (name, triangles, min, max) in [
        ("BoxDraco.gltf", 12, [-0.5; 3], [0.5; 3]),
        ("BoxMeshopt.glb", 12, [-0.5; 3], [0.5; 3]),
        (
            "DracoSparseMesh.gltf",
            102,
            [-0.039_652, 0.049_586, 0.028_699],
            [-0.013_483, 0.089_126, 0.031_651],
        ),
    ] {
        for path in files().iter().filter(|path| path.ends_with(name)) {
            let drawn = open_file(path).unwrap().0.drawn;
            assert_eq!(drawn.triangles.len(), triangles, "{name}");
            let low = drawn.positions.iter().copied().reduce(DVec3::min).unwrap();
            let high = drawn.positions.iter().copied().reduce(DVec3::max).unwrap();
            // Quantised to 11 or 14 bits.
            let step = (high - low).length() / 1000.0;
            assert!(
                low.distance(min.into()) < step && high.distance(max.into()) < step,
                "{name}: {low} {high}"
            );
        }
    }
}

/// The differences that an edit may cause: numbers of moved vertices and their bounds; and, if an accessor, a mesh or a
/// compressed primitive could not change in place, its storage.
fn may_differ(difference: &Difference, allowance: Allowance) -> bool {
    let place = difference.place.as_str();
    let is_moved_attribute = ["POSITION", "NORMAL", "TANGENT"]
        .iter()
        .any(|name| place.starts_with("mesh ") && place.ends_with(&format!(", {name}")));
    match difference.what {
        What::Elements { .. } | What::Bounds => is_moved_attribute,
        What::Stored { .. } => is_moved_attribute && allowance == Allowance::Meshopt,
        What::OnlyInFirst => {
            allowance == Allowance::Draco && (place.starts_with("extensions") || place.ends_with(", extensions"))
        }
        What::OnlyInSecond => allowance == Allowance::SharedMesh && place.starts_with("mesh ") && !place.contains(','),
        _ => false,
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Allowance {
    Nothing,
    Draco,
    Meshopt,
    SharedMesh,
}

#[test]
fn edited_files_keep_everything_but_the_moved_numbers() {
    for path in files() {
        let (opened, bytes) = open_file(&path).unwrap_or_else(|error| panic!("{error}"));
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert_eq!(
            opened
                .scene
                .differences(&opened.drawn, &open_file(&path).unwrap().0.scene, &opened.drawn),
            [],
            "{name} and itself"
        );
        let is_moved = |v: usize| v % 2 == 1;
        let positions = moved(&opened, is_moved, |p| bent(p * 0.1) * 10.0);
        let saved = save(&opened, &positions, &path);
        let disk = Disk(path.parent().unwrap().to_path_buf());
        let again = open_bytes(&saved.files[0].bytes, &path, &Fresh(&saved, disk)).unwrap();
        let size = positions.iter().map(|p| p.length()).fold(1.0, f64::max);
        assert_near(&again.drawn.positions, &positions, size);
        for v in (0..positions.len()).filter(|&v| !is_moved(v)) {
            let bits = |drawn: &Drawn| drawn.positions[v].to_array().map(f64::to_bits);
            assert_eq!(
                bits(&opened.drawn),
                bits(&again.drawn),
                "{name}: vertex {v} was not moved"
            );
        }
        let old = json_of(&bytes);
        let uses = |extension: &str| old["extensionsUsed"].to_string().contains(extension);
        let nodes = old["nodes"].as_array().into_iter().flatten();
        let mut shown: Vec<u64> = nodes.filter_map(|node| node["mesh"].as_u64()).collect();
        let count = shown.len();
        shown.sort_unstable();
        shown.dedup();
        let allowance = match count > shown.len() {
            _ if uses("KHR_draco_mesh_compression") => Allowance::Draco,
            _ if uses("EXT_meshopt_compression") => Allowance::Meshopt,
            true => Allowance::SharedMesh,
            false => Allowance::Nothing,
        };
        let differences = opened.scene.differences(&opened.drawn, &again.scene, &again.drawn);
        assert!(differences.is_empty() == opened.drawn.positions.is_empty(), "{name}");
        for difference in &differences {
            assert!(may_differ(difference, allowance), "{name}: {difference}");
        }
        let changed = |ending: &str| {
            let of_kind = differences
                .iter()
                .filter(|difference| difference.place.ends_with(ending));
            let counts = of_kind.map(|difference| match &difference.what {
                What::Elements { elements, .. } => elements.len(),
                _ => 0,
            });
            counts.sum::<usize>()
        };
        let moved_count = (0..positions.len()).filter(|&v| is_moved(v)).count();
        assert!(
            changed("POSITION") <= moved_count && changed("NORMAL") <= moved_count,
            "{name}"
        );
        let looks = [opened.scene.appearance(), again.scene.appearance()];
        assert_eq!(looks[0].uvs, looks[1].uvs);
        assert_eq!(looks[0].colours, looks[1].colours);
        assert_eq!(looks[0].materials, looks[1].materials);
    }
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

#[test]
fn what_an_obj_can_not_say_of_the_materials_is_named() {
    type Has = fn(&Material) -> bool;
    let kinds: [(&str, Has); 4] = [
        ("metal and roughness", |material| {
            material.metallic_roughness_map.is_some()
        }),
        ("normal maps", |material| material.normal_map.is_some()),
        ("occlusion maps", |material| material.occlusion_map.is_some()),
        ("emission", |material| {
            material.emissive != [0.0; 3] || material.emissive_map.is_some()
        }),
    ];
    let mut named = 0;
    for path in files() {
        let (opened, _) = open_file(&path).unwrap_or_else(|error| panic!("{error}"));
        let saved = save(&opened, &opened.drawn.positions, Path::new("out.obj"));
        for (kind, has) in kinds {
            let is_lost = opened.scene.appearance().materials.iter().any(has);
            let is_named = saved.warnings.iter().any(|warning| warning.contains(kind));
            assert!(is_named || !is_lost, "{}: {kind}, {:?}", path.display(), saved.warnings);
            named += usize::from(is_lost);
        }
    }
    assert!(named > 0 || files().is_empty());
}
