//! Compressed glTF: meshopt and Draco files are read as their originals, come back byte for byte, and an edit
//! decompresses no more than it must.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{
    Folder, Maker, Shape, assert_near, bent, grid, moved, open, refusal, saved_glb, sphere, split, try_open, try_save,
};
use glam::DVec3;
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    ExpMode, IndexEncoding, VertexEncoding, encode_filter_color, encode_filter_exp, encode_filter_oct,
    encode_filter_quat, encode_index_buffer, encode_index_sequence, encode_vertex_buffer,
};
use pliant_io::{Format, Placement};
use serde_json::{Value, json};

/// A file of `shape` in which every view is compressed and replaces a buffer without bytes.
fn with_meshopt(shape: &Shape, extension: &str, version: u8) -> Maker {
    let plain = Maker::of(shape);
    let mut out = plain.clone();
    out.bin.clear();
    let mut workspace = Workspace::default();
    let mut offset = 0;
    for (number, view) in plain.root["bufferViews"].as_array().unwrap().iter().enumerate() {
        let whole = |key: &str| view[key].as_u64().unwrap() as usize;
        let bytes = &plain.bin[whole("byteOffset")..][..whole("byteLength")];
        let accessor = &plain.root["accessors"][number];
        let count = accessor["count"].as_u64().unwrap() as usize;
        let stride = bytes.len() / count;
        let (mode, packed) = if accessor["type"] == "SCALAR" {
            let indices: Vec<u32> = bytes
                .chunks(4)
                .map(|b| u32::from_le_bytes(b.try_into().unwrap()))
                .collect();
            let encoding = IndexEncoding::default();
            let packed = encode_index_buffer(&indices, encoding, &mut workspace);
            ("TRIANGLES", packed.unwrap())
        } else {
            let encoding = VertexEncoding::new(version, 2).unwrap();
            (
                "ATTRIBUTES",
                encode_vertex_buffer(bytes, count, stride, encoding, &mut workspace).unwrap(),
            )
        };
        let start = out.bin.len();
        out.bin.extend(&packed);
        out.bin.resize(out.bin.len().next_multiple_of(4), 0);
        let mut view = json!({
            "buffer": 1, "byteOffset": offset, "byteLength": bytes.len(),
            "extensions": { extension: {
                "buffer": 0, "byteOffset": start, "byteLength": packed.len(), "byteStride": stride, "count": count, "mode": mode,
            } },
        });
        if mode == "ATTRIBUTES" {
            view["byteStride"] = stride.into();
        }
        out.root["bufferViews"][number] = view;
        offset += bytes.len();
    }
    out.root["buffers"] = json!([
        { "byteLength": out.bin.len() }, { "byteLength": offset, "extensions": { extension: { "fallback": true } } },
    ]);
    out.root["extensionsUsed"] = json!([extension]);
    out.root["extensionsRequired"] = json!([extension]);
    out
}

/// Corners as positions, each triangle turned so that its least corner comes first.
fn triangles(opened: &pliant_io::SceneAndDrawn) -> Vec<[[u64; 3]; 3]> {
    let drawn = &opened.drawn;
    let of_triangle = |corners: &[pliant_mesh::DrawnVertex; 3]| {
        let mut corners = corners.map(|v| drawn.positions[v.index()].to_array().map(f64::to_bits));
        let least = (0..3).min_by_key(|&k| corners[k]).unwrap();
        corners.rotate_left(least);
        corners
    };
    drawn.triangles.iter().map(of_triangle).collect()
}

fn json_of(glb: &[u8]) -> Value {
    serde_json::from_str(&split(glb).0).unwrap()
}

#[test]
fn meshopt_reads_as_what_it_was_made_from() {
    for shape in [grid(4), sphere(9)] {
        let plain = open(&Maker::of(&shape).glb());
        for (extension, version) in [
            ("EXT_meshopt_compression", 0),
            ("KHR_meshopt_compression", 0),
            ("KHR_meshopt_compression", 1),
        ] {
            let compressed = with_meshopt(&shape, extension, version).glb();
            let opened = open(&compressed);
            assert_eq!(opened.drawn.positions, plain.drawn.positions);
            assert_eq!(triangles(&opened), triangles(&plain), "{extension} {version}");
            let looks = [opened.scene.appearance(), plain.scene.appearance()];
            assert_eq!(looks[0].normals, looks[1].normals);
            assert_eq!(looks[0].uvs, looks[1].uvs);
        }
    }
}

#[test]
fn an_edit_of_meshopt_adds_what_changed_and_leaves_the_rest_compressed() {
    let maker = with_meshopt(&sphere(9), "EXT_meshopt_compression", 0);
    let before = maker.glb();
    let opened = open(&before);
    assert!(saved_glb(&opened, &opened.drawn.positions) == before);
    let positions = moved(&opened, |v| v % 2 == 0, bent);
    let after = saved_glb(&opened, &positions);
    let again = open(&after);
    assert_near(&again.drawn.positions, &positions, 4.0);
    assert_eq!(again.scene.appearance().uvs, opened.scene.appearance().uvs);
    let (old, new) = (json_of(&before), json_of(&after));
    let views = old["bufferViews"].as_array().unwrap().len();
    assert_eq!(
        old["bufferViews"].as_array().unwrap(),
        &new["bufferViews"].as_array().unwrap()[..views]
    );
    assert_eq!(old["extensionsRequired"], new["extensionsRequired"]);
    for (accessor, changes) in [(0, true), (1, true), (2, true), (3, false), (4, false)] {
        assert_eq!(
            old["accessors"][accessor] != new["accessors"][accessor],
            changes,
            "{accessor}"
        );
    }
    let (old_bin, new_bin) = (split(&before).1, split(&after).1);
    assert!(new_bin.starts_with(&old_bin), "new bytes stand behind the others");
    // Geometry that was edited once is edited again in place.
    let twice = moved(&again, |v| v % 3 == 0, bent);
    let third = saved_glb(&again, &twice);
    assert_eq!(split(&third).1.len(), new_bin.len());
    assert_near(&open(&third).drawn.positions, &twice, 4.0);
}

#[test]
fn meshopt_is_packed_and_unpacked_with_its_placeholder() {
    let maker = with_meshopt(&grid(4), "EXT_meshopt_compression", 0);
    let opened = open(&maker.glb());
    for positions in [opened.drawn.positions.clone(), moved(&opened, |_| true, bent)] {
        let gltf = try_save(&opened, &positions, "out.gltf", Placement::OtherFolder).unwrap();
        let folder = Folder(
            gltf.files
                .iter()
                .map(|file| (file.name.clone(), file.bytes.clone()))
                .collect(),
        );
        let unpacked = try_open(&gltf.files[0].bytes, Format::Gltf, &folder).unwrap();
        assert_near(&unpacked.drawn.positions, &positions, 4.0);
        let packed = try_save(
            &unpacked,
            &unpacked.drawn.positions,
            "again.glb",
            Placement::OtherFolder,
        )
        .unwrap();
        let again = open(&packed.files[0].bytes);
        assert_eq!(again.drawn.positions, unpacked.drawn.positions);
        assert_eq!(again.drawn.triangles, opened.drawn.triangles);
    }
}

/// Lets `accessor` read a compressed view, which replaces a buffer without bytes.
fn compress(maker: &mut Maker, accessor: usize, packed: &[u8], layout: (usize, usize), mode: &str, filter: &str) {
    let (count, stride) = layout;
    let view = maker.view(packed);
    let place = maker.root["bufferViews"][view]["byteOffset"].clone();
    maker.root["bufferViews"][view] = json!({
        "buffer": 1, "byteOffset": 0, "byteLength": stride * count,
        "extensions": { "KHR_meshopt_compression": {
            "buffer": 0, "byteOffset": place, "byteLength": packed.len(), "byteStride": stride, "count": count,
            "mode": mode, "filter": filter,
        } },
    });
    maker.root["accessors"][accessor]["bufferView"] = view.into();
    if maker.root["buffers"].as_array().unwrap().len() == 1 {
        let placeholder = json!({ "byteLength": stride * count });
        maker.root["buffers"].as_array_mut().unwrap().push(placeholder);
    }
}

/// The bytes of filtered attributes under the codec.
fn packed_attributes(bytes: &[u8], (count, stride): (usize, usize)) -> Vec<u8> {
    let encoding = VertexEncoding::new(0, 2).unwrap();
    encode_vertex_buffer(bytes, count, stride, encoding, &mut Workspace::default()).unwrap()
}

fn assert_all_near<const N: usize>(found: &[[f32; N]], wanted: &[[f32; N]], tolerance: f32) {
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.iter().zip(wanted) {
        let off = (0..N).map(|k| (found[k] - wanted[k]).abs()).fold(0.0, f32::max);
        assert!(off < tolerance, "{found:?} {wanted:?}");
    }
}

#[test]
fn octahedral_normals_are_read() {
    let shape = sphere(9);
    let mut maker = Maker::of(&shape);
    let lanes: Vec<f32> = shape.normals.iter().flat_map(|&[x, y, z]| [x, y, z, 0.0]).collect();
    let count = shape.normals.len();
    let filtered = encode_filter_oct(count, 8, 16, &lanes, &mut Workspace::default()).unwrap();
    let packed = packed_attributes(&filtered, (count, 8));
    compress(&mut maker, 1, &packed, (count, 8), "ATTRIBUTES", "OCTAHEDRAL");
    maker.root["accessors"][1]["componentType"] = 5122.into();
    maker.root["accessors"][1]["normalized"] = true.into();
    let normals = open(&maker.glb()).scene.appearance().normals.unwrap();
    assert_all_near(&normals, &shape.normals, 1e-3);
}

#[test]
fn exponential_positions_are_read_and_edited() {
    let shape = sphere(9);
    let mut maker = Maker::of(&shape);
    let count = shape.positions.len();
    let lanes = shape.positions.as_flattened();
    let mode = ExpMode::SharedVector;
    let filtered = encode_filter_exp(count, 12, 15, lanes, mode, &mut Workspace::default()).unwrap();
    let packed = packed_attributes(&filtered, (count, 12));
    compress(&mut maker, 0, &packed, (count, 12), "ATTRIBUTES", "EXPONENTIAL");
    let opened = open(&maker.glb());
    let found: Vec<[f32; 3]> = opened.drawn.positions.iter().map(|p| p.as_vec3().to_array()).collect();
    assert_all_near(&found, &shape.positions, 2e-4);
    let positions = moved(&opened, |_| true, bent);
    assert_near(&open(&saved_glb(&opened, &positions)).drawn.positions, &positions, 4.0);
}

#[test]
fn unit_vectors_of_four_and_colours_are_read_through_their_filters() {
    let shape = grid(4);
    let count = shape.positions.len();
    let unit = |k: usize| glam::Vec4::new(1.0 + k as f32, 2.0, 3.0, 9.0).normalize().to_array();
    let vectors: Vec<[f32; 4]> = (0..count).map(unit).collect();
    let mut workspace = Workspace::default();
    let as_quaternions = encode_filter_quat(count, 8, 16, vectors.as_flattened(), &mut workspace).unwrap();
    let as_colours = encode_filter_color(count, 8, 16, vectors.as_flattened(), &mut workspace).unwrap();
    for (filter, filtered, component) in [("QUATERNION", as_quaternions, 5122), ("COLOR", as_colours, 5123)] {
        let mut maker = Maker::of(&shape);
        let accessor = json!({ "componentType": component, "normalized": true, "count": count, "type": "VEC4" });
        let colour = maker.accessor(accessor);
        compress(
            &mut maker,
            colour,
            &packed_attributes(&filtered, (count, 8)),
            (count, 8),
            "ATTRIBUTES",
            filter,
        );
        maker.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colour.into();
        let found = open(&maker.glb()).scene.appearance().colours.unwrap();
        let found: Vec<[f32; 4]> = found
            .iter()
            .map(|c| c.map(|light| f32::from(light) / 65535.0))
            .collect();
        assert_all_near(&found, &vectors, 0.6 / 255.0);
    }
}

#[test]
fn sequences_of_indices_are_read_in_order() {
    let shape = grid(4);
    let plain = open(&Maker::of(&shape).glb());
    let corners = shape.triangles.as_flattened();
    let encoding = IndexEncoding::default();
    let packed = encode_index_sequence(corners, encoding, &mut Workspace::default()).unwrap();
    for (stride, component) in [(2, 5123), (4, 5125)] {
        let mut maker = Maker::of(&shape);
        compress(&mut maker, 4, &packed, (corners.len(), stride), "INDICES", "NONE");
        maker.root["accessors"][4]["componentType"] = component.into();
        assert_eq!(open(&maker.glb()).drawn.triangles, plain.drawn.triangles, "{stride}");
    }
}

const DRACO: [&[u8]; 2] = [
    include_bytes!("../corpus/curved-square-edgebreaker.drc"),
    include_bytes!("../corpus/curved-square-sequential.drc"),
];

/// The curved square of [`grid`], compressed; shown by `nodes` meshes of its own.
fn with_draco(data: &[u8], meshes: usize) -> Maker {
    let mut maker = Maker::default();
    for mesh in 0..meshes {
        let view = maker.view(data);
        let first = 4 * mesh;
        for (kind, component, count) in [
            ("VEC3", 5126, 16),
            ("VEC3", 5126, 16),
            ("VEC2", 5126, 16),
            ("SCALAR", 5123, 54),
        ] {
            maker.accessor(json!({ "componentType": component, "count": count, "type": kind }));
        }
        maker.root["accessors"][first]["min"] = json!([0.0, 0.0, -1.0]);
        maker.root["accessors"][first]["max"] = json!([1.0, 1.0, 1.0]);
        let attributes = json!({ "POSITION": first, "NORMAL": first + 1, "TEXCOORD_0": first + 2 });
        maker.mesh_of(vec![json!({
            "attributes": attributes, "indices": first + 3,
            "extensions": { "KHR_draco_mesh_compression": {
                "bufferView": view, "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 },
            } },
        })]);
        maker.node(json!({ "mesh": mesh }));
    }
    maker.root["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    maker.root["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    maker
}

#[test]
fn draco_reads_as_what_it_was_made_from() {
    let wanted = grid(3);
    for data in DRACO {
        let opened = open(&with_draco(data, 1).glb());
        let looks = opened.scene.appearance();
        assert_eq!(opened.drawn.triangles.len(), wanted.triangles.len());
        // The codec renumbers vertices and quantises to 11 bits or more: each has its original nearby.
        for (v, position) in opened.drawn.positions.iter().enumerate() {
            let near = |k: &usize| DVec3::from(wanted.positions[*k].map(f64::from)).distance(*position) < 2e-3;
            let twin = (0..16).find(near).expect("a vertex that is not the square's");
            let close = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02);
            assert!(close(&looks.normals.as_ref().unwrap()[v], &wanted.normals[twin]));
            assert!(close(&looks.uvs.as_ref().unwrap()[v], &wanted.uvs[twin]));
        }
    }
}

#[test]
fn an_edit_of_draco_writes_its_mesh_out_and_no_other() {
    for data in DRACO {
        for meshes in [1, 2] {
            let before = with_draco(data, meshes).glb();
            let opened = open(&before);
            assert!(saved_glb(&opened, &opened.drawn.positions) == before);
            let positions = moved(&opened, |v| v < 16 && v % 2 == 0, bent);
            let after = saved_glb(&opened, &positions);
            let again = open(&after);
            assert_near(&again.drawn.positions, &positions, 4.0);
            assert_eq!(again.drawn.triangles, opened.drawn.triangles);
            assert_eq!(again.scene.appearance().uvs, opened.scene.appearance().uvs);
            let new = json_of(&after);
            assert!(new["meshes"][0]["primitives"][0].get("extensions").is_none());
            assert_eq!(new.get("extensionsRequired").is_some(), meshes == 2, "{new}");
            assert_eq!(new["meshes"].get(1), json_of(&before)["meshes"].get(1));
            // The data is plain now, so the next edit changes bytes in place.
            let twice = moved(&again, |v| v < 16, bent);
            let third = saved_glb(&again, &twice);
            assert_eq!(split(&third).1.len(), split(&after).1.len());
            assert_near(&open(&third).drawn.positions, &twice, 4.0);
        }
    }
}

/// An accessor without a view may have an offset, which means nothing while Draco fills it.
#[test]
fn an_offset_without_a_view_does_not_reach_into_what_an_edit_writes() {
    for offset in [4, 12, 100_000] {
        let mut maker = with_draco(DRACO[0], 1);
        for accessor in maker.root["accessors"].as_array_mut().unwrap() {
            accessor["byteOffset"] = offset.into();
        }
        let opened = open(&maker.glb());
        let positions = moved(&opened, |v| v % 3 == 0, bent);
        let again = open(&saved_glb(&opened, &positions));
        assert_near(&again.drawn.positions, &positions, 4.0);
        assert_eq!(again.drawn.triangles, opened.drawn.triangles);
        assert_eq!(again.scene.appearance().uvs, opened.scene.appearance().uvs);
    }
}

/// The budget is shared by the sizes of the data, and data that several primitives name is decoded once.
#[test]
fn many_primitives_of_the_same_draco_data_are_read() {
    let mut maker = with_draco(DRACO[0], 1);
    let primitive = maker.root["meshes"][0]["primitives"][0].clone();
    let primitives = vec![primitive; 3000];
    maker.root["meshes"][0]["primitives"] = primitives.into();
    let opened = open(&maker.glb());
    assert_eq!(opened.drawn.positions.len(), 16);
    assert_eq!(opened.drawn.triangles.len(), 3000 * 18);
}

#[test]
fn nodes_that_share_a_draco_mesh_part_company() {
    let mut maker = with_draco(DRACO[0], 1);
    maker.node(json!({ "mesh": 0, "translation": [5, 0, 0] }));
    let opened = open(&maker.glb());
    let positions = moved(&opened, |v| v >= 16, bent);
    let again = open(&saved_glb(&opened, &positions));
    assert_near(&again.drawn.positions, &positions, 8.0);
}

#[test]
fn broken_compressed_data_is_refused_in_a_sentence() {
    let mut draco = with_draco(DRACO[0], 1);
    draco.bin[60..].fill(0xa5);
    assert!(refusal(&draco.glb()).contains("mesh 0 primitive 0 has Draco data"));
    let mut draco = with_draco(DRACO[0], 1);
    draco.root["accessors"][3]["count"] = 57.into();
    assert!(refusal(&draco.glb()).contains("18 triangles, but accessor 3 has 57 corners"));
    let mut meshopt = with_meshopt(&grid(3), "EXT_meshopt_compression", 0);
    meshopt.bin[..40].fill(0);
    assert!(refusal(&meshopt.glb()).contains("compressed buffer view 0, which is broken"));
    let mut meshopt = with_meshopt(&grid(3), "EXT_meshopt_compression", 0);
    meshopt.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 4_000_000_000_u64.into();
    assert!(refusal(&meshopt.glb()).contains("more than a file of its size can hold"));
}

/// The curved square again, each vertex with a byte of its own, 7 times its number (modulo 256).
const WITH_BYTES: &[u8] = include_bytes!("../corpus/curved-square-features.drc");

#[test]
fn what_is_written_out_keeps_the_rules_for_attributes_and_tells_its_own_bounds() {
    let mut maker = Maker::default();
    let view = maker.view(WITH_BYTES);
    let (position, feature, indices) = (0, 1, 2);
    for (kind, component, count) in [("VEC3", 5126, 16), ("SCALAR", 5121, 16), ("SCALAR", 5123, 54)] {
        maker.accessor(json!({ "componentType": component, "count": count, "type": kind }));
    }
    for (accessor, least, most) in [
        (position, json!([0, 0, 0]), json!([9, 9, 9])),
        (feature, json!([3]), json!([200])),
    ] {
        maker.root["accessors"][accessor]["min"] = least;
        maker.root["accessors"][accessor]["max"] = most;
    }
    // As many vertices as there were before compression.
    maker.root["accessors"][indices]["min"] = json!([0]);
    maker.root["accessors"][indices]["max"] = json!([9]);
    maker.mesh_of(vec![json!({
        "attributes": { "POSITION": position, "_FEATURE_ID_0": feature }, "indices": indices,
        "extensions": { "KHR_draco_mesh_compression": {
            "bufferView": view, "attributes": { "POSITION": 0, "_FEATURE_ID_0": 1 },
        } },
    })]);
    maker.node(json!({ "mesh": 0 }));
    maker.root["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    maker.root["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let opened = open(&maker.glb());
    let after = saved_glb(&opened, &moved(&opened, |v| v == 5, |p| p + DVec3::Z));
    let (text, bin) = split(&after);
    let root: Value = serde_json::from_str(&text).unwrap();
    let view =
        |accessor: usize| &root["bufferViews"][root["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize];
    let of_feature = view(feature);
    assert_eq!(
        (&of_feature["byteStride"], &of_feature["target"]),
        (&json!(4), &json!(34962))
    );
    assert_eq!(view(indices)["target"], 34963);
    let start = of_feature["byteOffset"].as_u64().unwrap() as usize;
    let mut features: Vec<u8> = (0..16).map(|vertex| bin[start + 4 * vertex]).collect();
    features.sort_unstable();
    assert_eq!(features, (0..16).map(|k| k * 7).collect::<Vec<u8>>());
    assert_eq!(
        (&root["accessors"][feature]["min"], &root["accessors"][feature]["max"]),
        (&json!([0]), &json!([105]))
    );
    assert_eq!(
        (&root["accessors"][indices]["min"], &root["accessors"][indices]["max"]),
        (&json!([0]), &json!([15]))
    );
}
