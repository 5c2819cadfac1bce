//! Text in a file never controls a terminal: names, addresses and keywords are quoted wherever a sentence names them.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker;
use crate::gltf_maker::{Folder, Maker, grid, moved, try_open, try_save};
use glam::DVec3;
use pliant_io::{Format, Placement};
use serde_json::json;

/// Text that clears the screen, rings, reverses the writing direction, and is very long.
fn evil() -> String {
    "\u{1b}[2J\u{7}\u{202e}\r\n\u{9b}31m".to_owned() + &"x".repeat(5000)
}

fn assert_harmless(sentence: &str) {
    let steers = |letter: char| letter.is_control() || ('\u{202a}'..='\u{202e}').contains(&letter);
    assert!(!sentence.contains(steers), "{sentence:?}");
    assert!(
        sentence.chars().count() < 700,
        "{} characters",
        sentence.chars().count()
    );
}

/// The messages about a file, whether it is read or not.
fn said(bytes: &[u8], format: Format, folder: &Folder) -> Vec<String> {
    match try_open(bytes, format, folder) {
        Ok(opened) => opened.scene.notes().to_vec(),
        Err(error) => vec![error.to_string()],
    }
}

#[test]
fn nothing_that_a_gltf_says_steers_a_terminal() {
    let evil = evil();
    let broken: [&dyn Fn(&mut Maker); 9] = [
        &|maker| maker.root["buffers"][0]["uri"] = json!(evil),
        &|maker| maker.root["images"] = json!([{ "uri": evil }]),
        &|maker| maker.root["images"] = json!([{ "uri": format!("../{evil}") }]),
        &|maker| maker.root["materials"] = json!([{ "alphaMode": [evil] }]),
        &|maker| maker.root["accessors"][0]["bufferView"] = json!(evil),
        &|maker| maker.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(evil),
        &|maker| {
            maker.root["nodes"] = json!([{ "mesh": 0, "scale": [0, 0, 0], "name": evil }]);
        },
        &|maker| {
            maker.root["bufferViews"][0]["extensions"] = json!({ "EXT_meshopt_compression": {
                "buffer": 0, "byteLength": 4, "byteStride": 12, "count": 3, "mode": evil,
            } });
            maker.root["bufferViews"][0]["buffer"] = json!(7);
        },
        &|maker| maker.root["extensionsRequired"] = json!([evil]),
    ];
    for (number, change) in broken.into_iter().enumerate() {
        let mut maker = Maker::of(&grid(2));
        change(&mut maker);
        let text = maker.root.to_string();
        let sentences = said(
            &gltf_maker::glb(text.as_bytes(), &maker.bin),
            Format::Glb,
            &Folder::default(),
        );
        assert!(number == 8 || !sentences.is_empty(), "{number}");
        sentences.iter().for_each(|sentence| assert_harmless(sentence));
    }
}

#[test]
fn nothing_that_the_other_kinds_say_steers_a_terminal() {
    let evil = evil();
    let line = evil.replace(['\r', '\n'], "");
    let files = [
        (
            Format::Obj,
            format!("mtllib {line}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ),
        (Format::Obj, format!("v 0 0 0\nf {line}\n")),
        (Format::Off, format!("{line}\n")),
        (Format::Off, format!("OFF\n1 1 0\n{line}\n")),
        (Format::Stl, format!("solid a\n{line}\n")),
        (Format::Ply, format!("ply\nformat {line} 1.0\nend_header\n")),
        (
            Format::Ply,
            format!("ply\nformat ascii 1.0\nelement {line} 9999999\nproperty uchar a\nelement vertex 0\nend_header\n"),
        ),
        (
            Format::Ply,
            format!("ply\nformat ascii 1.0\nelement {line} 2\nproperty uchar a\nelement vertex 0\nend_header\n1\nx\n"),
        ),
        (
            Format::Ply,
            format!("ply\nformat ascii 1.0\nproperty {line}\nend_header\n"),
        ),
    ];
    for (format, text) in files {
        let sentences = said(text.as_bytes(), format, &Folder::default());
        assert!(!sentences.is_empty(), "{format}");
        sentences.iter().for_each(|sentence| assert_harmless(sentence));
    }
}

#[test]
fn neither_do_differences_nor_the_warnings_of_a_save() {
    let evil = evil();
    let mut maker = Maker::of(&grid(2));
    maker.root["extras"] = json!({ &evil: &evil, "b": 1 });
    maker.root["images"] = json!([{ "uri": evil }]);
    let primitive = &mut maker.root["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{ "POSITION": 0 }]);
    maker.root["meshes"][0]["name"] = json!(evil);
    let folder = Folder([("a.bin".to_owned(), maker.bin.clone())].into());
    let first = try_open(&maker.gltf("a.bin"), Format::Gltf, &folder).unwrap();
    maker.root["extras"] = json!({ &evil: "other", "b": &evil });
    let second = try_open(&maker.gltf("a.bin"), Format::Gltf, &folder).unwrap();
    let differences = first.scene.differences(&first.drawn, &second.scene, &second.drawn);
    assert_eq!(differences.len(), 2);
    differences
        .iter()
        .for_each(|difference| assert_harmless(&difference.to_string()));
    let positions = moved(&first, |v| v == 0, |p| p + DVec3::ONE);
    let saved = try_save(&first, &positions, "out.glb", Placement::OtherFolder).unwrap();
    assert!(saved.warnings.len() >= 2, "{:?}", saved.warnings);
    saved.warnings.iter().for_each(|warning| assert_harmless(warning));
}
