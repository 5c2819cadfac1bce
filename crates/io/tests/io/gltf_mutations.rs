//! Damaged glTF: each is read or refused in a sentence; a file that is read can be saved or is refused; none panics.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{Folder, Maker, bent, cube, glb, grid, moved, open, sphere, split, try_open, try_save};
use pliant_io::{Format, Placement};
use serde_json::{Value, json};

/// A small generator of numbers; the seed determines the run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, below: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % below.max(1)
    }
}

/// A file with a little of everything.
fn rich() -> Maker {
    let mut maker = Maker::default();
    let mut first = maker.primitive(&grid(2));
    first["targets"] = json!([{ "POSITION": first["attributes"]["POSITION"] }]);
    first["material"] = 0.into();
    let mut second = maker.primitive(&sphere(3));
    second["mode"] = 5.into();
    let (indices, values) = (maker.view(&[0, 2]), maker.view(&[0; 24]));
    let position = second["attributes"]["POSITION"].as_u64().unwrap() as usize;
    maker.root["accessors"][position]["sparse"] = json!({
        "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values },
    });
    maker.mesh_of(vec![first, second]);
    maker.mesh(&cube());
    let child = maker.loose_node(json!({ "mesh": 1, "scale": [1, -2, 1] }));
    maker.node(json!({ "mesh": 0, "children": [child], "rotation": [0, 0, 0.6, 0.8] }));
    maker.node(json!({ "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1] }));
    let image = maker.view(b"\x89PNG\r\n\x1a\nnot really");
    maker.root["images"] = json!([{ "bufferView": image, "mimeType": "image/png" }]);
    maker.root["textures"] = json!([{ "source": 0 }]);
    maker.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    maker
}

/// Reads, inspects, moves and saves; only panics are failures.
fn exercise(bytes: &[u8], format: Format) -> bool {
    let mut folder = Folder::default();
    folder.0.insert("a.bin".to_owned(), vec![7; 500]);
    let opened = match try_open(bytes, format, &folder) {
        Ok(opened) => opened,
        Err(error) => {
            assert!(!error.to_string().contains('\n'), "{error}");
            return false;
        }
    };
    let drawn = &opened.drawn;
    assert_eq!(drawn.positions.len(), drawn.file_vertex.len());
    assert!(
        drawn
            .file_vertex
            .iter()
            .all(|file| file.index() < drawn.file_vertex_count)
    );
    assert!(
        drawn
            .triangles
            .iter()
            .flatten()
            .all(|corner| corner.index() < drawn.positions.len())
    );
    let looks = opened.scene.appearance();
    assert!(looks.groups.iter().all(|group| group.material < looks.materials.len()));
    assert!(
        looks
            .normals
            .is_none_or(|normals| normals.len() == drawn.positions.len())
    );
    opened.scene.summary();
    let same = try_save(
        &opened,
        &drawn.positions,
        &format!("out.{}", format.extension()),
        Placement::SameFolder,
    );
    assert!(same.unwrap().files[0].bytes == bytes);
    let positions = moved(&opened, |v| v % 2 == 0, bent);
    for out in ["out.glb", "out.gltf"] {
        if let Ok(saved) = try_save(&opened, &positions, out, Placement::SameFolder) {
            let mut beside = folder.clone();
            beside
                .0
                .extend(saved.files.iter().map(|file| (file.name.clone(), file.bytes.clone())));
            let again = try_open(&saved.files[0].bytes, Format::of_name(out).unwrap(), &beside);
            let again = again.unwrap_or_else(|error| panic!("what was saved as {out} can't be read: {error}"));
            assert_eq!(again.drawn.triangles.len(), drawn.triangles.len());
        }
    }
    true
}

#[test]
fn bytes_changed_at_random_never_panic() {
    let maker = rich();
    let mut dice = Dice(7);
    for (bytes, format) in [(maker.glb(), Format::Glb), (maker.embedded(), Format::Gltf)] {
        assert!(exercise(&bytes, format));
        for _ in 0..400 {
            let mut bytes = bytes.clone();
            for _ in 0..=dice.roll(4) {
                let at = dice.roll(bytes.len());
                match dice.roll(4) {
                    0 => bytes[at] = dice.roll(256) as u8,
                    1 => bytes[at] ^= 1 << dice.roll(8),
                    2 => bytes.truncate(at.max(1)),
                    _ => drop(bytes.splice(at..at, [0xff; 4])),
                }
            }
            exercise(&bytes, format);
        }
    }
}

#[test]
fn members_changed_at_random_never_panic() {
    let maker = rich();
    let odd: Vec<Value> = vec![
        json!(null),
        json!(-1),
        json!(0),
        json!(1),
        json!(2),
        json!(3),
        json!(17),
        json!(4_294_967_295_u64),
        json!(18_446_744_073_709_551_615_u64),
        json!(1e300),
        json!(0.5),
        json!("x"),
        json!([]),
        json!({}),
        json!(true),
        json!([0, 0, 0]),
        json!([0, 1]),
        json!(5125),
        json!(5126),
        json!("VEC3"),
        json!("SCALAR"),
        json!("a.bin"),
    ];
    let mut dice = Dice(11);
    let mut read = 0;
    for _ in 0..1500 {
        let mut root = maker.root.clone();
        for _ in 0..=dice.roll(2) {
            let mut paths = Vec::new();
            collect(&root, String::new(), &mut paths);
            let path = &paths[dice.roll(paths.len())];
            let value = odd[dice.roll(odd.len())].clone();
            if let Some(slot) = root.pointer_mut(path) {
                *slot = value;
            }
        }
        read += usize::from(exercise(&glb(root.to_string().as_bytes(), &maker.bin), Format::Glb));
    }
    assert!(read > 300, "most changes leave something to read: {read}");
}

fn collect(value: &Value, path: String, out: &mut Vec<String>) {
    match value {
        Value::Object(members) => members
            .iter()
            .for_each(|(key, value)| collect(value, format!("{path}/{key}"), out)),
        Value::Array(elements) => {
            elements
                .iter()
                .enumerate()
                .for_each(|(k, value)| collect(value, format!("{path}/{k}"), out));
        }
        _ => {}
    }
    out.push(path);
}

#[test]
fn the_undamaged_file_is_whole() {
    let maker = rich();
    assert!(open(&maker.glb()).drawn.triangles.len() > 20);
    assert!(split(&maker.glb()).1.len() >= maker.bin.len());
}
