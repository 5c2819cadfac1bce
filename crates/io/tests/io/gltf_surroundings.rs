//! The surroundings of a glTF's geometry: deep trees, skins, unknown extensions, points, containers without their own
//! chunk. None of it stops a file, and an edit does not change it.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker;
use crate::gltf_maker::{
    Folder, Maker, assert_near, bent, cube, grid, moved, open, saved_glb, split, try_open, try_save,
};
use glam::DVec3;
use pliant_io::{Format, Placement};
use serde_json::{Value, json};

fn json_of(glb: &[u8]) -> Value {
    serde_json::from_str(&split(glb).0).unwrap()
}

/// The bytes of an accessor's buffer view.
fn view_bytes(glb: &[u8], accessor: usize) -> Vec<u8> {
    let (root, bin) = (json_of(glb), split(glb).1);
    let view = &root["bufferViews"][root["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    bin[start..start + view["byteLength"].as_u64().unwrap() as usize].to_vec()
}

/// All of a file's JSON except the parts that an edit of accessors `edited` changes: their bounds.
fn beside_bounds(glb: &[u8], edited: &[usize]) -> Value {
    let mut root = json_of(glb);
    for &accessor in edited {
        let accessor = root["accessors"][accessor].as_object_mut().unwrap();
        accessor.remove("min");
        accessor.remove("max");
    }
    root
}

#[test]
fn a_very_deep_tree_is_walked_to_its_end() {
    let depth = 20_000;
    let mut maker = Maker::default();
    maker.mesh(&cube());
    let mut nodes: Vec<Value> = (1..depth)
        .map(|child| json!({ "children": [child], "translation": [0.5, 0.0, 0.0] }))
        .collect();
    nodes.push(json!({ "mesh": 0 }));
    maker.root["nodes"] = nodes.into();
    maker.root["scenes"][0]["nodes"] = json!([0]);
    let opened = open(&maker.glb());
    let plain = open(&Maker::of(&cube()).glb());
    let away = DVec3::X * 0.5 * f64::from(depth - 1);
    for (found, own) in opened.drawn.positions.iter().zip(&plain.drawn.positions) {
        assert_eq!(*found, *own + away);
    }
    let positions = moved(&opened, |v| v < 8, |p| p + DVec3::Y);
    assert_near(&open(&saved_glb(&opened, &positions)).drawn.positions, &positions, 2e4);
}

#[test]
fn extensions_that_nobody_knows_stop_nothing_and_stay() {
    let mut maker = Maker::of(&grid(4));
    maker.root["extensionsUsed"] = json!(["ACME_moss", "ACME_wind"]);
    maker.root["extensionsRequired"] = json!(["ACME_wind"]);
    maker.root["extensions"] = json!({ "ACME_wind": { "speed": 1.50, "gusts": [1e-3, 200, 3.0] } });
    maker.root["meshes"][0]["primitives"][0]["extensions"] = json!({ "ACME_moss": { "seed": 7 } });
    maker.root["extras"] = json!({ "made by": "hand \u{e9}" });
    let before = maker.glb();
    let opened = open(&before);
    let after = saved_glb(&opened, &moved(&opened, |v| v % 2 == 0, bent));
    let edited = [0, 1, 2];
    assert_eq!(beside_bounds(&before, &edited), beside_bounds(&after, &edited));
    for accessor in [3, 4] {
        assert_eq!(view_bytes(&before, accessor), view_bytes(&after, accessor));
    }
}

#[test]
fn an_edit_leaves_joints_and_weights_as_they_are() {
    let shape = grid(3);
    let count = shape.positions.len();
    let mut maker = Maker::of(&shape);
    let joints = maker.view(&vec![0_u8; 4 * count]);
    let joints = maker.accessor(json!({ "bufferView": joints, "componentType": 5121, "count": count, "type": "VEC4" }));
    let weights = maker.floats(&vec![[1.0_f32, 0.0, 0.0, 0.0]; count]);
    let mut inverse = [0.0_f32; 16];
    [0, 5, 10, 15].into_iter().for_each(|k| inverse[k] = 1.0);
    let bytes: Vec<u8> = inverse.iter().flat_map(|number| number.to_le_bytes()).collect();
    let inverse = maker.view(&bytes);
    let inverse = maker.accessor(json!({ "bufferView": inverse, "componentType": 5126, "count": 1, "type": "MAT4" }));
    let attributes = &mut maker.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints.into();
    attributes["WEIGHTS_0"] = weights.into();
    // The joint has left its bind pose.
    let joint = maker.node(json!({ "translation": [7, 0, 0] }));
    maker.root["skins"] = json!([{ "joints": [joint], "inverseBindMatrices": inverse }]);
    maker.root["nodes"][0]["skin"] = 0.into();
    let before = maker.glb();
    let opened = open(&before);
    assert_eq!(opened.scene.summary().skins, 1);
    let stored: Vec<DVec3> = shape
        .positions
        .iter()
        .map(|&p| glam::Vec3::from(p).as_dvec3() + DVec3::X * 7.0)
        .collect();
    assert_eq!(opened.drawn.positions, stored);
    let positions = moved(&opened, |_| true, bent);
    let after = saved_glb(&opened, &positions);
    assert_near(&open(&after).drawn.positions, &positions, 4.0);
    let edited = [0, 1, 2];
    assert_eq!(beside_bounds(&before, &edited), beside_bounds(&after, &edited));
    for accessor in [joints, weights, inverse] {
        assert_eq!(view_bytes(&before, accessor), view_bytes(&after, accessor));
    }
}

#[test]
fn points_and_lines_of_their_own_are_kept_where_only_the_surface_moves() {
    let mut maker = Maker::default();
    let surface = maker.primitive(&grid(3));
    let dots = maker.floats(&[[9.0_f32, 9.0, 9.0], [8.0, 8.0, 8.0]]);
    let others = [0, 1, 2, 3].map(|mode| json!({ "attributes": { "POSITION": dots }, "mode": mode }));
    maker.mesh_of([surface].into_iter().chain(others).collect());
    maker.node(json!({ "mesh": 0 }));
    let before = maker.glb();
    let opened = open(&before);
    assert_eq!((opened.drawn.positions.len(), opened.drawn.triangles.len()), (18, 18));
    assert_eq!(opened.drawn.file_vertex_count, 18);
    let after = saved_glb(&opened, &moved(&opened, |vertex| vertex < 16, bent));
    let edited = [0, 1, 2];
    assert_eq!(beside_bounds(&before, &edited), beside_bounds(&after, &edited));
    assert_eq!(view_bytes(&before, dots), view_bytes(&after, dots));
}

#[test]
fn a_glb_without_a_chunk_for_buffers_is_read_and_edited() {
    let shape = grid(3);
    let mut text = Maker::of(&shape).embedded();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut file = b"glTF".to_vec();
    for word in [2, 20 + text.len() as u32, text.len() as u32] {
        file.extend(word.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(&text);
    let opened = open(&file);
    assert_eq!(opened.drawn.positions, open(&Maker::of(&shape).glb()).drawn.positions);
    assert!(saved_glb(&opened, &opened.drawn.positions) == file);
    let positions = moved(&opened, |_| true, bent);
    let saved = try_save(&opened, &positions, "out.glb", Placement::SameFolder).unwrap();
    assert_eq!(saved.files.len(), 1);
    let again = try_open(&saved.files[0].bytes, Format::Glb, &Folder::default()).unwrap();
    assert_near(&again.drawn.positions, &positions, 4.0);
}

#[test]
fn what_is_read_all_the_same_is_told() {
    type Change = fn(&mut Maker);
    let changes: [(&str, Change); 8] = [
        ("the unknown extension ACME_wind", |maker| {
            maker.root["extensionsRequired"] = json!(["ACME_wind"])
        }),
        ("The rotation of node 0 (arm)", |maker| {
            maker.root["nodes"][0] = json!({ "mesh": 0, "name": "arm", "rotation": [0, 0, 1] });
        }),
        ("The matrix of node 0", |maker| {
            maker.root["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, "one"]);
        }),
        ("Material 0 is broken", |maker| {
            maker.root["materials"] = json!([{ "pbrMetallicRoughness": { "metallicFactor": "shiny" } }]);
            maker.root["meshes"][0]["primitives"][0]["material"] = 0.into();
        }),
        ("Gaussian splats (KHR_gaussian_splatting)", |maker| {
            let primitive = &mut maker.root["meshes"][0]["primitives"][0];
            primitive["extensions"] = json!({ "KHR_gaussian_splatting": { "kernel": "ellipse" } });
            primitive["attributes"]["KHR_gaussian_splatting:ROTATION"] = 2.into();
        }),
        ("The attribute _WIND_DIRECTION of mesh 0", |maker| {
            maker.root["meshes"][0]["primitives"][0]["attributes"]["_WIND_DIRECTION"] = 1.into();
        }),
        ("hidden by KHR_node_visibility", |maker| {
            maker.root["nodes"][0]["extensions"] = json!({ "KHR_node_visibility": { "visible": false } });
        }),
        ("not drawn", |maker| {
            maker.loose_node(json!({ "mesh": 0 }));
        }),
    ];
    for (what, change) in changes {
        let mut maker = Maker::of(&grid(3));
        assert!(open(&maker.glb()).scene.notes().is_empty());
        change(&mut maker);
        let opened = open(&maker.glb());
        let [note] = opened.scene.notes() else {
            panic!("{what}: {:?}", opened.scene.notes());
        };
        assert!(note.contains(what), "{what}: {note}");
        assert_eq!(opened.drawn.triangles.len(), 18);
    }
    let text = Maker::of(&grid(3)).root.to_string();
    let twice = text.replacen("\"mesh\":0", "\"mesh\":0,\"name\":\"a\",\"name\":\"b\"", 1);
    let opened = open(&gltf_maker::glb(twice.as_bytes(), &Maker::of(&grid(3)).bin));
    assert!(
        opened.scene.notes()[0].contains("'name' more than once"),
        "{:?}",
        opened.scene.notes()
    );
}
