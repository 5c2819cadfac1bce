//! Neighbours outside the file's own folder are read and reported, and go into a result only if they really are of the
//! kind that the file claims: a stranger's file may point at any file there.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use std::io::Cursor;

use crate::gltf_maker::{Folder, Maker, grid, moved, open, try_open, try_save};
use glam::DVec3;
use pliant_io::{Format, Placement, Saved, SceneAndDrawn};
use serde_json::json;

const SECRET: &[u8] = b"-----BEGIN OPENSSH PRIVATE KEY-----";

fn png() -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_pixel(4, 4, image::Rgba([9, 8, 7, 255]));
    picture.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

fn holds(saved: &Saved, needle: &[u8]) -> bool {
    let holds = |bytes: &[u8]| bytes.windows(needle.len()).any(|window| window == needle);
    saved.files.iter().any(|file| holds(&file.bytes))
}

/// A square with the buffer `buffer` and the image `image`.
fn gltf(buffer: &str, image: &str, files: &[(&str, &[u8])]) -> SceneAndDrawn {
    let mut maker = Maker::of(&grid(2));
    maker.root["images"] = json!([{ "uri": image }]);
    maker.root["textures"] = json!([{ "source": 0 }]);
    maker.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    maker.root["meshes"][0]["primitives"][0]["material"] = json!(0);
    let mut folder = Folder([(buffer.to_owned(), maker.bin.clone())].into());
    folder
        .0
        .extend(files.iter().map(|&(name, bytes)| (name.to_owned(), bytes.to_vec())));
    try_open(&maker.gltf(buffer), Format::Gltf, &folder).unwrap()
}

fn told(sentences: &[String], name: &str) -> bool {
    sentences
        .iter()
        .any(|sentence| sentence.contains(name) && sentence.contains("outside"))
}

#[test]
fn what_is_used_and_decodes_is_packed_and_told() {
    let png = png();
    let opened = gltf("../a.bin", "../a.png", &[("../a.png", &png)]);
    for name in ["../a.bin", "../a.png"] {
        assert!(told(opened.scene.notes(), name), "{:?}", opened.scene.notes());
    }
    let positions = moved(&opened, |v| v == 0, |p| p + DVec3::ONE);
    for positions in [&positions, &opened.drawn.positions] {
        let saved = try_save(&opened, positions, "out.glb", Placement::OtherFolder).unwrap();
        assert!(
            told(&saved.warnings, "../a.bin") && told(&saved.warnings, "../a.png"),
            "{:?}",
            saved.warnings
        );
        let again = open(&saved.files[0].bytes);
        assert_eq!(*again.scene.appearance().images[0].encoded, *png);
    }
    // No message for neighbours beside the file.
    let beside = gltf("a.bin", "./b/../a.png", &[("./b/../a.png", &png)]);
    assert!(beside.scene.notes().is_empty(), "{:?}", beside.scene.notes());
    assert!(
        try_save(&beside, &positions, "out.glb", Placement::OtherFolder)
            .unwrap()
            .warnings
            .is_empty()
    );
}

#[test]
fn what_is_no_image_is_never_taken_along() {
    // One image claims another kind than its first bytes; one is true to its first bytes.
    let disguised = [&png()[..16], SECRET].concat();
    for bytes in [SECRET, &disguised] {
        let opened = gltf("a.bin", "../../key", &[("../../key", bytes)]);
        let positions = moved(&opened, |v| v == 0, |p| p + DVec3::ONE);
        for name in ["out.glb", "out.obj", "out.ply"] {
            let saved = try_save(&opened, &positions, name, Placement::OtherFolder).unwrap();
            assert!(!holds(&saved, SECRET), "{name}");
            assert!(
                name == "out.ply" || told(&saved.warnings, "../../key"),
                "{name}: {:?}",
                saved.warnings
            );
        }
    }
}

#[test]
fn a_buffer_that_nothing_reads_is_never_taken_along() {
    let mut maker = Maker::of(&grid(2));
    maker.root["buffers"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "uri": "../../key", "byteLength": SECRET.len() }));
    let folder = Folder(
        [
            ("a.bin".to_owned(), maker.bin.clone()),
            ("../../key".to_owned(), SECRET.to_vec()),
        ]
        .into(),
    );
    let opened = try_open(&maker.gltf("a.bin"), Format::Gltf, &folder).unwrap();
    let refused = try_save(&opened, &opened.drawn.positions, "out.glb", Placement::OtherFolder).unwrap_err();
    assert!(refused.to_string().contains("../../key"), "{refused}");
}

#[test]
fn textures_of_an_obj_are_held_to_the_same() {
    let obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    let png = png();
    for (bytes, is_taken) in [(SECRET, false), (&png[..], true)] {
        let library = b"newmtl a\nmap_Kd ../key\n".to_vec();
        let folder = Folder([("a.mtl".to_owned(), library), ("../key".to_owned(), bytes.to_vec())].into());
        let opened = try_open(obj, Format::Obj, &folder).unwrap();
        assert!(told(opened.scene.notes(), "../key"), "{:?}", opened.scene.notes());
        let saved = try_save(&opened, &opened.drawn.positions, "out.glb", Placement::OtherFolder).unwrap();
        assert_eq!(holds(&saved, bytes), is_taken);
        assert!(told(&saved.warnings, "key"), "{:?}", saved.warnings);
    }
}
