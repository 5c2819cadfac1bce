//! Saving other vertex colours: every format that has them gets them, and every other byte stays.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker;
use crate::gltf_maker::{Maker, grid, split};
use crate::text;
use crate::text::{changed_lines, open};
use pliant_io::{Format, Placement, Save, SaveError, Saved, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};
use serde_json::{Value, json};

fn try_coloured(opened: &SceneAndDrawn, colours: &[[u16; 4]], format: Format) -> Result<Saved, SaveError> {
    let name = format!("out.{}", format.extension());
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions: &opened.drawn.positions,
        format,
        name: &name,
        placement: Placement::SameFolder,
    };
    opened
        .scene
        .save_with_colours(&save, colours, &Progress::new(), &Cancel::new())
}

fn coloured(opened: &SceneAndDrawn, colours: &[[u16; 4]], format: Format) -> Vec<u8> {
    try_coloured(opened, colours, format)
        .unwrap()
        .files
        .swap_remove(0)
        .bytes
}

/// A colour for each drawn vertex that every kind of file can hold, the same for those of one file vertex.
fn colours(opened: &SceneAndDrawn) -> Vec<[u16; 4]> {
    let white_and_black = |file: u32| [0, 1, 2].map(|channel| if file >> channel & 1 == 1 { u16::MAX } else { 0 });
    let of = |file: u32| {
        let [r, g, b] = white_and_black(file);
        [r, g, b, u16::MAX]
    };
    opened.drawn.file_vertex.iter().map(|file| of(file.0)).collect()
}

fn found(bytes: &[u8], format: Format) -> Vec<[u16; 4]> {
    open(bytes, format).scene.appearance().colours.unwrap()
}

const TEXTS: [(Format, &str); 9] = [
    (
        Format::Obj,
        "# a\nv 0 0 0 # zero\nv 1 0 0\r\nv 0 1 0 1.0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n",
    ),
    (
        Format::Obj,
        "v 0 0 0 1 0 0\nv 1 0 0 0.5 0.5 0.5 0.25\nv 0 1 0 0 0 0\nv 9 9 9\nf 1 2 3\n",
    ),
    (Format::Off, "OFF\n3 1 0\n0 0 0\n1 0 0 # one\n0 1 0\n3 0 1 2\n"),
    (Format::Off, "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
    (
        Format::Off,
        "STNOFF 3 1 0\n0 0 0 0 0 1 0.5 0.5\n1 0 0 0 0 1 0 0\n0 1 0 0 0 1 1 1\n3 0 1 2\n",
    ),
    (
        Format::Off,
        "COFF\n3 1 0\n0 0 0 9 9 9 255\n1 0 0 1 2 3 255\n0 1 0 0 0 0 255\n3 0 1 2\n",
    ),
    (
        Format::Ply,
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float q\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 7\n1 0 0 8\n0 1 0 9\n3 0 1 2\n",
    ),
    (
        Format::Ply,
        "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty uchar blue\r\n\
         property float z\r\nproperty uchar red\r\nproperty uchar green\r\nelement face 1\r\n\
         property list uchar int vertex_indices\r\nend_header\r\n0 0 1 0 2 3\r\n1 0 1 0 2 3\r\n0 1 1 0 2 3\r\n3 0 1 2\r\n",
    ),
    (
        Format::Ply,
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         property float red\nproperty float green\nproperty float blue\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n",
    ),
];

#[test]
fn text_gets_colours_in_its_vertices_lines_alone() {
    for (format, file) in TEXTS {
        let opened = open(file.as_bytes(), format);
        let wanted = colours(&opened);
        let bytes = coloured(&opened, &wanted, format);
        assert_eq!(found(&bytes, format), wanted, "{}", String::from_utf8_lossy(&bytes));
        let again = open(&bytes, format);
        assert!(
            text::same_bits(&again.drawn.positions, &opened.drawn.positions),
            "{file}"
        );
        assert_eq!(again.drawn.triangles, opened.drawn.triangles);
        // Other colours again change nothing else.
        let second = coloured(&again, &vec![[u16::MAX; 4]; wanted.len()], format);
        assert!(changed_lines(&bytes, &second).len() <= wanted.len(), "{file}");
    }
    let opened = open(TEXTS[0].1.as_bytes(), Format::Obj);
    let bytes = coloured(&opened, &[[0, u16::MAX, 0, u16::MAX]; 4], Format::Obj);
    let expected = "# a\nv 0 0 0 0 1 0 # zero\nv 1 0 0 0 1 0\r\nv 0 1 0 0 1 0\nv 0 0 1 0 1 0\nf 1 2 3\nf 1 3 4\n";
    assert_eq!(String::from_utf8(bytes).unwrap(), expected);
}

#[test]
fn binary_records_grow_by_three_bytes_and_keep_the_others() {
    for format_name in ["binary_little_endian", "binary_big_endian"] {
        let mut file = format!(
            "ply\nformat {format_name} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property list uchar int extra\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        )
        .into_bytes();
        let number = |value: f32| match format_name {
            "binary_big_endian" => value.to_be_bytes(),
            _ => value.to_le_bytes(),
        };
        let whole = |value: i32| match format_name {
            "binary_big_endian" => value.to_be_bytes(),
            _ => value.to_le_bytes(),
        };
        for (vertex, position) in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
            .into_iter()
            .enumerate()
        {
            position.into_iter().for_each(|x| file.extend(number(x)));
            file.push(vertex as u8);
            (0..vertex).for_each(|item| file.extend(whole(item as i32)));
        }
        file.push(3);
        (0..3).for_each(|corner| file.extend(whole(corner)));
        let opened = open(&file, Format::Ply);
        let wanted = colours(&opened);
        let bytes = coloured(&opened, &wanted, Format::Ply);
        assert_eq!(found(&bytes, Format::Ply), wanted);
        let header = 3 * "property uchar ".len() + "red\ngreen\nblue\n".len();
        assert_eq!(bytes.len(), file.len() + header + 3 * 3);
        let again = open(&bytes, Format::Ply);
        assert!(text::same_bits(&again.drawn.positions, &opened.drawn.positions));
        assert_eq!(again.drawn.triangles, opened.drawn.triangles);
        let white = coloured(&again, &[[u16::MAX; 4]; 3], Format::Ply);
        assert_eq!(white.len(), bytes.len(), "over the old ones");
        assert_eq!(found(&white, Format::Ply), [[u16::MAX; 4]; 3]);
    }
}

#[test]
fn a_gltf_gets_an_accessor_of_16_bits_and_keeps_its_texture_and_its_other_bytes() {
    let mut maker = Maker::of(&grid(3));
    maker.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    let opened = gltf_maker::open(&maker.glb());
    let mut wanted: Vec<[u16; 4]> = (0..opened.drawn.positions.len() as u16)
        .map(|v| [v * 11, 65_535 - v * 7, v * v, u16::MAX])
        .collect();
    wanted[0] = [u16::MAX; 4];
    let before = split(&maker.glb());
    let bytes = coloured(&opened, &wanted, Format::Glb);
    assert_eq!(gltf_maker::open(&bytes).scene.appearance().colours.unwrap(), wanted);
    let (text, bin) = split(&bytes);
    assert_eq!(bin[..maker.bin.len()], before.1[..maker.bin.len()]);
    let root: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(root["materials"], maker.root["materials"]);
    let number = root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
        .as_u64()
        .unwrap();
    let accessor = &root["accessors"][number as usize];
    assert_eq!(
        (&accessor["componentType"], &accessor["normalized"], &accessor["type"]),
        (&json!(5123), &json!(true), &json!("VEC4"))
    );
    // A second time the attribute names another accessor, and with the same colours nothing changes.
    let again = gltf_maker::open(&bytes);
    assert_eq!(coloured(&again, &wanted, Format::Glb), bytes);
    wanted.reverse();
    let second = coloured(&again, &wanted, Format::Glb);
    assert_eq!(gltf_maker::open(&second).scene.appearance().colours.unwrap(), wanted);
    // Without colours nothing changes either.
    let white = vec![[u16::MAX; 4]; wanted.len()];
    assert_eq!(coloured(&opened, &white, Format::Glb), maker.glb());
}

#[test]
fn a_mesh_that_two_nodes_show_is_cloned_only_if_their_colours_differ() {
    let mut maker = Maker::of(&grid(2));
    maker.node(json!({ "mesh": 0, "translation": [5, 0, 0] }));
    let opened = gltf_maker::open(&maker.glb());
    let half = opened.drawn.positions.len() / 2;
    for (second, meshes) in [([0, 0, 0, u16::MAX], 1), ([7, 7, 7, u16::MAX], 2), ([u16::MAX; 4], 2)] {
        let mut wanted = vec![[0, 0, 0, u16::MAX]; half];
        wanted.resize(2 * half, second);
        let bytes = coloured(&opened, &wanted, Format::Glb);
        assert_eq!(gltf_maker::open(&bytes).scene.appearance().colours.unwrap(), wanted);
        let root: Value = serde_json::from_str(&split(&bytes).0).unwrap();
        assert_eq!(root["meshes"].as_array().unwrap().len(), meshes);
    }
}

#[test]
fn other_formats_take_colours_over_and_an_stl_is_refused_in_words() {
    let opened = open(TEXTS[0].1.as_bytes(), Format::Obj);
    let wanted = colours(&opened);
    for format in [Format::Glb, Format::Ply, Format::Off] {
        let bytes = coloured(&opened, &wanted, format);
        let mut found = found(&bytes, format);
        let mut wanted = wanted.clone();
        found.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(found, wanted, "{format}");
    }
    let refused = try_coloured(&opened, &wanted, Format::Stl).unwrap_err().to_string();
    assert!(refused.contains("colours") && refused.contains(".glb"), "{refused}");
    assert!(try_coloured(&opened, &wanted[1..], Format::Glb).is_err());
}
