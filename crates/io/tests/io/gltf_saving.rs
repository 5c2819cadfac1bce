//! Saving glTF: only the moved vertices' numbers and their bounds may differ, for any shared data.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker;
use crate::gltf_maker::{
    Folder, Maker, assert_near, bent, glb, grid, moved, open, saved_glb, shapes, sphere, split, try_open, try_save,
};
use glam::{DQuat, DVec3};
use pliant_io::{Format, Placement, SaveError};
use serde_json::{Value, json};

/// The place of the elements of an attribute of mesh 0's first primitive in the BIN chunk.
fn element_bytes(root: &Value, attribute: &str, element: usize) -> std::ops::Range<usize> {
    let accessor = root["meshes"][0]["primitives"][0]["attributes"][attribute]
        .as_u64()
        .unwrap() as usize;
    let accessor = &root["accessors"][accessor];
    let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
    let size = if attribute == "TANGENT" { 16 } else { 12 };
    let stride = view["byteStride"].as_u64().map_or(size, |stride| stride as usize);
    let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]) + element * stride;
    start..start + size
}

/// A text with the content of every "min" and "max" list taken out.
fn without_bounds(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = ["\"min\"", "\"max\""].iter().filter_map(|key| rest.find(key)).min() {
        let open = at + rest[at..].find('[').unwrap();
        let close = open + rest[open..].find(']').unwrap();
        out += &rest[..=open];
        rest = &rest[close..];
    }
    out + rest
}

/// Asserts that every accessor of f32 with bounds has those of its elements.
fn assert_bounds(glb: &[u8]) {
    let (text, bin) = split(glb);
    let root: Value = serde_json::from_str(&text).unwrap();
    for accessor in root["accessors"].as_array().unwrap() {
        if accessor["componentType"] != 5126 || accessor["min"].is_null() || !accessor["sparse"].is_null() {
            continue;
        }
        let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let lanes = accessor["min"].as_array().unwrap().len();
        let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
        let stride = view["byteStride"].as_u64().map_or(4 * lanes, |stride| stride as usize);
        let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
        for lane in 0..lanes {
            let at = |element: usize| {
                let at = start + element * stride + 4 * lane;
                f64::from(f32::from_le_bytes(bin[at..at + 4].try_into().unwrap()))
            };
            let all = (0..number(&accessor["count"])).map(at);
            assert_eq!(
                accessor["min"][lane].as_f64(),
                all.clone().reduce(f64::min),
                "{accessor}"
            );
            assert_eq!(accessor["max"][lane].as_f64(), all.reduce(f64::max), "{accessor}");
        }
    }
}

#[test]
fn a_save_without_an_edit_is_the_same_bytes() {
    for (name, shape) in shapes() {
        let maker = Maker::of(&shape);
        let odd_text = maker
            .root
            .to_string()
            .replace(',', " ,\n\t")
            .replace("2.0", "2\\u002e0")
            + "   ";
        let mut folder = Folder::default();
        folder.0.insert("x.bin".to_owned(), maker.bin.clone());
        folder.0.insert("./x.bin".to_owned(), maker.bin.clone());
        let mut with_tail = maker.glb();
        with_tail.extend(b"tail");
        let files = [
            (maker.glb(), Format::Glb),
            (glb(odd_text.as_bytes(), &maker.bin), Format::Glb),
            (with_tail, Format::Glb),
            (maker.embedded(), Format::Gltf),
            (maker.gltf("./x.bin"), Format::Gltf),
            ([b"\xef\xbb\xbf", &maker.gltf("x.bin")[..]].concat(), Format::Gltf),
        ];
        for (bytes, format) in files {
            let opened = try_open(&bytes, format, &folder).unwrap();
            for placement in [Placement::SameFile, Placement::SameFolder, Placement::OtherFolder] {
                let out = format!("out.{}", format.extension());
                let saved = try_save(&opened, &opened.drawn.positions, &out, placement).unwrap();
                assert!(saved.files[0].bytes == bytes, "{name}, {format}, {placement:?}");
            }
        }
    }
}

#[test]
fn an_edit_changes_the_moved_elements_and_their_bounds_and_nothing_else() {
    for (name, shape) in shapes() {
        let mut maker = Maker::of(&shape);
        maker.root["nodes"][0]["rotation"] = json!([0.5, 0.5, 0.5, 0.5]);
        maker.root["extras"] = json!({ "numbers": [1e0, 2.50, -0.0], "unknown": { "min": "x" } });
        let text = serde_json::to_string_pretty(&maker.root)
            .unwrap()
            .replace("1.0", "1.000");
        let before = glb(text.as_bytes(), &maker.bin);
        let opened = open(&before);
        let is_moved = |v: usize| v % 3 == 1;
        let positions = moved(&opened, is_moved, bent);
        let after = saved_glb(&opened, &positions);
        assert_near(&open(&after).drawn.positions, &positions, 4.0);
        assert_bounds(&after);
        let ((old_text, old_bin), (new_text, new_bin)) = (split(&before), split(&after));
        let old_root: Value = serde_json::from_str(&old_text).unwrap();
        assert_eq!(
            without_bounds(old_text.trim_end()),
            without_bounds(new_text.trim_end()),
            "{name}"
        );
        let mut allowed = vec![false; old_bin.len()];
        for v in (0..shape.positions.len()).filter(|&v| is_moved(v)) {
            for attribute in ["POSITION", "NORMAL", "TANGENT"] {
                allowed[element_bytes(&old_root, attribute, v)].fill(true);
            }
        }
        assert_eq!(old_bin.len(), new_bin.len());
        for at in 0..old_bin.len() {
            assert!(allowed[at] || old_bin[at] == new_bin[at], "{name}: byte {at} changed");
        }
    }
}

#[test]
fn a_bound_that_still_says_the_same_keeps_its_text() {
    let maker = Maker::of(&grid(2));
    let text = maker
        .root
        .to_string()
        .replacen("\"max\":[1.0,1.0,", "\"max\":[1.00e0,1,", 1);
    assert!(text.contains("1.00e0"));
    let opened = open(&glb(text.as_bytes(), &maker.bin));
    let after = saved_glb(&opened, &moved(&opened, |v| v == 4, |p| p + DVec3::Z * 9.0));
    assert!(split(&after).0.contains("[1.00e0,1,9."), "{}", split(&after).0);
}

#[test]
fn nodes_that_come_to_differ_get_a_clone_and_those_that_agree_do_not() {
    let shape = sphere(4);
    let mut maker = Maker::of(&shape);
    maker.node(json!({ "mesh": 0, "translation": [5, 0, 0], "rotation": [0, 1, 0, 0] }));
    maker.node(json!({ "mesh": 0, "translation": [10, 0, 0] }));
    let before = maker.glb();
    let opened = open(&before);
    let count = shape.positions.len();

    let positions = moved(&opened, |v| v / count == 1, bent);
    let after = saved_glb(&opened, &positions);
    let root: Value = serde_json::from_str(&split(&after).0).unwrap();
    assert_eq!(root["meshes"].as_array().unwrap().len(), 2);
    let meshes: Vec<u64> = root["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|node| node["mesh"].as_u64().unwrap())
        .collect();
    assert_eq!(meshes, [0, 1, 0], "the nodes that did not move keep the original");
    assert_eq!(root["meshes"][0], maker.root["meshes"][0]);
    assert_eq!(
        root["meshes"][1]["primitives"][0]["indices"],
        root["meshes"][0]["primitives"][0]["indices"]
    );
    assert!(split(&after).1.starts_with(&maker.bin), "what was there stays there");
    assert_near(&open(&after).drawn.positions, &positions, 20.0);
    assert_bounds(&after);

    let up = moved(&opened, |_| true, |p| p + DVec3::Y * 0.7);
    let after = saved_glb(&opened, &up);
    let root: Value = serde_json::from_str(&split(&after).0).unwrap();
    assert_eq!(root["meshes"].as_array().unwrap().len(), 1);
    assert_near(&open(&after).drawn.positions, &up, 20.0);

    let three_ways = moved(&opened, |_| true, bent);
    let after = saved_glb(&opened, &three_ways);
    assert_near(&open(&after).drawn.positions, &three_ways, 20.0);
    assert_bounds(&after);
}

#[test]
fn accessors_that_cannot_be_patched_in_place_make_room_for_the_edit() {
    type Share = fn(&mut Maker, &mut Value, &gltf_maker::Shape) -> Value;
    let zeros_and_sparse = |maker: &mut Maker, primitive: &mut Value, shape: &gltf_maker::Shape| {
        let flat: Vec<u8> = shape.positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let all: Vec<u8> = (0..shape.positions.len() as u16)
            .flat_map(|k| k.to_le_bytes())
            .collect();
        let (indices, values) = (maker.view(&all[2..]), maker.view(&flat[12..]));
        let count = shape.positions.len();
        let accessor = json!({
            "componentType": 5126, "count": count, "type": "VEC3", "name": "sparse",
            "sparse": {
                "count": count - 1,
                "indices": { "bufferView": indices, "componentType": 5123 }, "values": { "bufferView": values },
            },
        });
        primitive["attributes"]["POSITION"] = maker.accessor(accessor).into();
        primitive.clone()
    };
    let quantised = |maker: &mut Maker, primitive: &mut Value, shape: &gltf_maker::Shape| {
        let short = |x: &f32| ((x * 20000.0) as i16).to_le_bytes();
        let bytes: Vec<u8> = shape
            .positions
            .iter()
            .flat_map(|p| [short(&p[0]), short(&p[1]), short(&p[2]), [0, 0]])
            .flatten()
            .collect();
        let view = maker.view(&bytes);
        maker.root["bufferViews"][view]["byteStride"] = 8.into();
        let count = shape.positions.len();
        let accessor = json!({
            "bufferView": view, "componentType": 5122, "normalized": true, "count": count, "type": "VEC3",
            "min": [-20000, -20000, -20000], "max": [20000, 20000, 20000],
        });
        primitive["attributes"]["POSITION"] = maker.accessor(accessor).into();
        primitive.clone()
    };
    let cases: Vec<(&str, Share)> = vec![
        ("sparse over zeros", zeros_and_sparse),
        ("quantised", quantised),
        ("positions that are the normals too", |_, primitive, _| {
            primitive["attributes"]["NORMAL"] = primitive["attributes"]["POSITION"].clone();
            primitive.clone()
        }),
        ("two accessors over the same bytes", |maker, primitive, _| {
            let position = primitive["attributes"]["POSITION"].as_u64().unwrap() as usize;
            let twin = maker.root["accessors"][position].clone();
            let mut other = primitive.clone();
            other["attributes"]["POSITION"] = maker.accessor(twin).into();
            other
        }),
        ("a morph target over the same accessor", |_, primitive, _| {
            primitive["targets"] = json!([{ "POSITION": primitive["attributes"]["POSITION"] }]);
            primitive.clone()
        }),
    ];
    let shape = sphere(4);
    for (_, share) in cases {
        for moves_second in [false, true] {
            let mut maker = Maker::default();
            let mut first = maker.primitive(&shape);
            let second = share(&mut maker, &mut first, &shape);
            maker.mesh_of(vec![first]);
            maker.mesh_of(vec![second]);
            maker.node(json!({ "mesh": 0 }));
            maker.node(json!({ "mesh": 1, "translation": [5, 0, 0] }));
            let opened = open(&maker.glb());
            let count = shape.positions.len();
            let positions = moved(&opened, |v| v < count || moves_second, bent);
            let after = saved_glb(&opened, &positions);
            assert_near(&open(&after).drawn.positions, &positions, 20.0);
            assert_bounds(&after);
        }
    }
}

#[test]
fn sparse_values_over_a_base_are_patched_where_they_stand() {
    let shape = grid(2);
    let mut maker = Maker::of(&shape);
    let (indices, values) = (maker.view(&[1, 3]), maker.view(&[0; 24]));
    let position = maker.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        .as_u64()
        .unwrap() as usize;
    maker.root["accessors"][position]["sparse"] = json!({
        "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values },
    });
    let opened = open(&maker.glb());
    let positions = moved(&opened, |v| v < 3, |p| p + DVec3::new(0.25, 0.5, 1.0));
    let after = saved_glb(&opened, &positions);
    assert_near(&open(&after).drawn.positions, &positions, 2.0);
    assert_eq!(split(&after).1.len(), split(&maker.glb()).1.len());
}

#[test]
fn lines_over_a_surface_follow_it() {
    let shape = grid(2);
    let mut maker = Maker::default();
    let primitive = maker.primitive(&shape);
    let lines = json!({ "attributes": { "POSITION": primitive["attributes"]["POSITION"] }, "mode": 1 });
    maker.mesh_of(vec![primitive, lines]);
    maker.node(json!({ "mesh": 0 }));
    let opened = open(&maker.glb());
    let after = saved_glb(&opened, &moved(&opened, |_| true, bent));
    let root: Value = serde_json::from_str(&split(&after).0).unwrap();
    assert_eq!(
        root["accessors"].as_array().unwrap().len(),
        maker.root["accessors"].as_array().unwrap().len()
    );
}

#[test]
fn neighbours_go_where_out_goes_and_never_outside() {
    let shape = grid(2);
    let maker = Maker::of(&shape);
    let mut root = maker.root.clone();
    root["images"] = json!([{ "uri": "textures/skin%201.png" }]);
    let png = b"\x89PNG\r\n\x1a\nnot really".to_vec();
    let gltf = |uri: &str| {
        let mut root = root.clone();
        root["buffers"][0]["uri"] = uri.into();
        root.to_string().into_bytes()
    };
    let mut folder = Folder::default();
    for name in ["out.bin", "sub/a.bin", "../a.bin"] {
        folder.0.insert(name.to_owned(), maker.bin.clone());
    }
    folder.0.insert("textures/skin 1.png".to_owned(), png.clone());
    let names =
        |saved: &pliant_io::Saved| -> Vec<String> { saved.files.iter().map(|file| file.name.clone()).collect() };

    let opened = try_open(&gltf("sub/a.bin"), Format::Gltf, &folder).unwrap();
    let positions = moved(&opened, |_| true, bent);
    let save = |name, placement| try_save(&opened, &positions, name, placement).unwrap();
    let other = save("out.gltf", Placement::OtherFolder);
    assert_eq!(names(&other), ["out.gltf", "sub/a.bin", "textures/skin 1.png"]);
    // Another file may need a buffer with another name than this one's.
    let over_itself = names(&save("test.gltf", Placement::SameFile));
    assert_eq!(over_itself, ["test.gltf", "test.bin"]);
    for (own, is_kept) in [
        ("test.bin", true),
        ("test_2.bin", true),
        ("test-0.bin", true),
        ("test3.bin", true),
        ("testing.bin", false),
        ("test_data.bin", false),
        ("sub/test.bin", false),
    ] {
        let mut folder = folder.clone();
        folder.0.insert(own.to_owned(), maker.bin.clone());
        let opened = try_open(&gltf(own), Format::Gltf, &folder).unwrap();
        let saved = try_save(&opened, &positions, "test.gltf", Placement::SameFile).unwrap();
        assert_eq!(names(&saved)[1] == own, is_kept, "{own}: {:?}", names(&saved));
    }
    assert_eq!(names(&save("out.gltf", Placement::SameFolder)), ["out.gltf", "out.bin"]);
    for saved in [&other, &save("out.gltf", Placement::SameFolder)] {
        let mut beside = folder.clone();
        beside
            .0
            .extend(saved.files.iter().map(|file| (file.name.clone(), file.bytes.clone())));
        let again = try_open(&saved.files[0].bytes, Format::Gltf, &beside).unwrap();
        assert_near(&again.drawn.positions, &positions, 4.0);
        assert_eq!(*again.scene.appearance().images[0].encoded, *png);
    }

    let clash = try_open(&gltf("out.bin"), Format::Gltf, &folder).unwrap();
    let saved = try_save(&clash, &positions, "out.gltf", Placement::SameFolder).unwrap();
    assert_eq!(
        names(&saved),
        ["out.gltf", "out_2.bin"],
        "FILE's own buffer stays as it is"
    );

    let outside = try_open(&gltf("../a.bin"), Format::Gltf, &folder).unwrap();
    for placement in [Placement::SameFile, Placement::OtherFolder] {
        let refused = try_save(&outside, &positions, "out.gltf", placement);
        assert!(
            matches!(&refused, Err(SaveError::NeighbourOutside { uri }) if uri == "../a.bin"),
            "{refused:?}"
        );
    }
    assert_eq!(
        names(&try_save(&outside, &positions, "out.gltf", Placement::SameFolder).unwrap()).len(),
        2
    );
    let packed = try_save(&outside, &positions, "out.glb", Placement::OtherFolder).unwrap();
    assert_eq!(names(&packed), ["out.glb"]);
    let again = open(&packed.files[0].bytes);
    assert_near(&again.drawn.positions, &positions, 4.0);
    assert_eq!(*again.scene.appearance().images[0].encoded, *png);
}

#[test]
fn packing_and_unpacking_keep_every_number() {
    for (name, shape) in shapes() {
        let maker = Maker::of(&shape);
        let packed = try_open(&maker.embedded(), Format::Gltf, &Folder::default()).unwrap();
        let rest = &packed.drawn.positions;
        let glb = try_save(&packed, rest, "out.glb", Placement::SameFolder).unwrap();
        let opened = open(&glb.files[0].bytes);
        assert_eq!(&opened.drawn.positions, rest, "{name}");
        assert_eq!(opened.scene.summary(), packed.scene.summary());
        let (text, bin) = split(&glb.files[0].bytes);
        assert!(!text.contains("uri") && bin.starts_with(&maker.bin));
        let positions = moved(&opened, |_| true, bent);
        let unpacked = try_save(&opened, &positions, "o%.gltf", Placement::OtherFolder).unwrap();
        assert_eq!(unpacked.files[1].name, "o%.bin");
        let mut folder = Folder::default();
        folder.0.insert("o%.bin".to_owned(), unpacked.files[1].bytes.clone());
        let again = try_open(&unpacked.files[0].bytes, Format::Gltf, &folder).unwrap();
        assert_near(&again.drawn.positions, &positions, 4.0);
    }
}

#[test]
fn an_embedded_buffer_is_patched_too() {
    let maker = Maker::of(&grid(3));
    let opened = try_open(&maker.embedded(), Format::Gltf, &Folder::default()).unwrap();
    let positions = moved(&opened, |v| v > 4, bent);
    let saved = try_save(&opened, &positions, "out.gltf", Placement::OtherFolder).unwrap();
    assert_eq!(saved.files.len(), 1);
    let again = try_open(&saved.files[0].bytes, Format::Gltf, &Folder::default()).unwrap();
    assert_near(&again.drawn.positions, &positions, 4.0);
}

#[test]
fn what_is_no_number_is_never_saved() {
    let opened = open(&Maker::of(&grid(1)).glb());
    for bad in [f64::NAN, f64::INFINITY, 1e39] {
        let positions = moved(&opened, |v| v == 2, |_| DVec3::splat(bad));
        let refused = try_save(&opened, &positions, "out.glb", Placement::SameFolder);
        assert_eq!(refused, Err(SaveError::NotFinite { file_vertex: 2 }));
    }
    let refused = try_save(&opened, &opened.drawn.positions[1..], "out.glb", Placement::SameFolder);
    assert_eq!(refused, Err(SaveError::OtherScene { given: 3, wanted: 4 }));
}

#[test]
fn morph_targets_keep_their_deltas_with_a_warning() {
    let shape = grid(2);
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(&shape);
    primitive["targets"] = json!([{ "POSITION": maker.floats(&shape.positions) }]);
    maker.mesh_of(vec![primitive]);
    maker.node(json!({ "mesh": 0 }));
    let opened = open(&maker.glb());
    let turned = moved(&opened, |_| true, |p| DQuat::from_rotation_z(0.4) * p);
    let saved = try_save(&opened, &turned, "out.glb", Placement::SameFolder).unwrap();
    assert!(
        saved.warnings.len() == 1 && saved.warnings[0].contains("did not turn"),
        "{:?}",
        saved.warnings
    );
    assert_eq!(open(&saved.files[0].bytes).scene.summary().morph_targets, 1);
}
