//! A new glTF from the other formats: it contains everything that glTF can hold, and is sound.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{Folder, assert_near, bent, moved, open, split, try_open, try_save};
use glam::{DVec3, Vec3};
use pliant_io::{Format, Placement, SaveError, Saved, SceneAndDrawn};
use serde_json::Value;

/// A quad and a triangle in two materials, one with a texture, with normals, texture coordinates and colours.
const OBJ: &str = "mtllib m.mtl\no thing\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nv 0.5 2 0 0 0 0\n\
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 2\nvn 0 0 1\nusemtl skin\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl plain\nf 4/4/1 3/3/1 5/5/1\n";
const MTL: &str = "newmtl skin\nKd 1 1 1\nmap_Kd skin.png\nnewmtl plain\nKd 1 0 0\nd 0.5\n";

fn folder() -> Folder {
    let mut folder = Folder::default();
    folder.0.insert("m.mtl".to_owned(), MTL.as_bytes().to_vec());
    folder
        .0
        .insert("skin.png".to_owned(), b"\x89PNG\r\n\x1a\nnot really".to_vec());
    folder
}

fn save(opened: &SceneAndDrawn, positions: &[DVec3], name: &str) -> Saved {
    try_save(opened, positions, name, Placement::SameFolder).unwrap()
}

fn colours(opened: &SceneAndDrawn) -> Vec<[u16; 4]> {
    opened.scene.appearance().colours.unwrap()
}

#[test]
fn an_obj_becomes_a_glb_with_its_looks() {
    let opened = try_open(OBJ.as_bytes(), Format::Obj, &folder()).unwrap();
    let positions = moved(&opened, |_| true, bent);
    let saved = save(&opened, &positions, "out.glb");
    let again = open(&saved.files[0].bytes);
    assert_near(&again.drawn.positions, &positions, 4.0);
    assert_eq!(again.drawn.triangles.len(), 3);
    let (old, new) = (opened.scene.appearance(), again.scene.appearance());
    assert_eq!(old.uvs, new.uvs);
    assert_eq!(colours(&opened), colours(&again));
    assert_eq!(new.images.len(), 1);
    assert_eq!(new.images[0].encoded, old.images[0].encoded);
    let names: Vec<&str> = new.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["skin", "plain"]);
    assert_eq!(new.materials[0].base_colour_image, Some(0));
    for normal in new.normals.unwrap() {
        assert!((Vec3::from(normal).length() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_gltf_and_its_buffer_say_what_the_glb_says() {
    let opened = try_open(OBJ.as_bytes(), Format::Obj, &folder()).unwrap();
    let rest = &opened.drawn.positions;
    let glb = save(&opened, rest, "out.glb");
    let gltf = save(&opened, rest, "out.gltf");
    assert_eq!(gltf.files[1].name, "out.bin");
    let mut beside = Folder::default();
    beside.0.insert("out.bin".to_owned(), gltf.files[1].bytes.clone());
    let again = try_open(&gltf.files[0].bytes, Format::Gltf, &beside).unwrap();
    assert_eq!(again.drawn.positions, open(&glb.files[0].bytes).drawn.positions);
}

#[test]
fn far_from_the_origin_the_node_carries_the_way() {
    let far = DVec3::new(4_500_000.0, 5_200_000.0, 300.0);
    let lines: String = (0..4)
        .map(|k| {
            format!(
                "v {} {} {}\n",
                far.x + f64::from(k % 2) * 0.001,
                far.y + f64::from(k / 2) * 0.001,
                far.z
            )
        })
        .collect();
    let opened = try_open(
        format!("{lines}f 1 2 4 3\n").as_bytes(),
        Format::Obj,
        &Folder::default(),
    )
    .unwrap();
    let saved = save(&opened, &opened.drawn.positions, "out.glb");
    let again = open(&saved.files[0].bytes);
    for (found, wanted) in again.drawn.positions.iter().zip(&opened.drawn.positions) {
        assert!(found.distance(*wanted) < 2e-9, "{found} for {wanted}");
    }
}

#[test]
fn normals_are_made_where_the_file_has_none_and_what_is_no_number_is_left_out() {
    let off = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nnan 0 0\n3 0 2 1\n3 0 1 3\n3 0 1 4\n";
    let opened = try_open(off.as_bytes(), Format::Off, &Folder::default()).unwrap();
    let saved = save(&opened, &opened.drawn.positions, "out.glb");
    assert_eq!(saved.warnings.len(), 1, "{:?}", saved.warnings);
    let again = open(&saved.files[0].bytes);
    assert_eq!(again.drawn.positions.len(), 5);
    assert_eq!(again.drawn.triangles.len(), 2);
    assert!(again.drawn.positions.iter().all(|position| position.is_finite()));
    let normals = again.scene.appearance().normals.unwrap();
    assert!(
        normals
            .iter()
            .all(|&normal| (Vec3::from(normal).length() - 1.0).abs() < 1e-6)
    );
    let root: Value = serde_json::from_str(&split(&saved.files[0].bytes).0).unwrap();
    assert_eq!(root["asset"]["version"], "2.0");
}

#[test]
fn a_cloud_of_points_is_refused_in_words() {
    let opened = try_open(b"v 0 0 0\nv 1 0 0\n", Format::Obj, &Folder::default()).unwrap();
    let refused = try_save(&opened, &opened.drawn.positions, "out.glb", Placement::SameFolder);
    assert!(matches!(refused, Err(SaveError::CannotHold { .. })), "{refused:?}");
}

#[test]
fn named_parts_become_nodes_that_keep_their_names_and_triangles() {
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 9 9 9\ng left\nf 1 2 3 4\n\
               g right\nf 2 5 6 3\ng left\nf 1 3 6\n";
    let opened = try_open(obj.as_bytes(), Format::Obj, &Folder::default()).unwrap();
    let positions = moved(&opened, |_| true, bent);
    let saved = save(&opened, &positions, "out.glb");
    let again = open(&saved.files[0].bytes);
    let triangles_of = |opened: &SceneAndDrawn, positions: &[DVec3], name: &str| -> Vec<[DVec3; 3]> {
        let looks = opened.scene.appearance();
        let groups = looks.groups.iter().filter(|group| group.node_name == name);
        groups
            .flat_map(|group| group.triangles.clone())
            .map(|t| opened.drawn.triangles[t as usize].map(|v| positions[v.index()]))
            .collect()
    };
    for (name, count) in [("left", 3), ("right", 2)] {
        let before = triangles_of(&opened, &positions, name);
        let after = triangles_of(&again, &again.drawn.positions, name);
        assert_eq!((before.len(), after.len()), (count, count), "{name}");
        assert_near(after.as_flattened(), before.as_flattened(), 4.0);
    }
    assert_eq!(again.scene.summary().nodes, 2);
    // Two vertices are on the rim between the parts, and one is unused.
    assert_eq!(again.drawn.positions.len(), 9);
    assert!(
        saved
            .warnings
            .iter()
            .any(|warning| warning.contains("no triangle uses (1)"))
    );
}
