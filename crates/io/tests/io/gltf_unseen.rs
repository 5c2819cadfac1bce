//! Data that a file's default scene does not show keeps its bytes and its shape: other scenes, nodes of none, and
//! everything that an extension may read. Copies of a node are drawn, and bent separately.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker;
use crate::gltf_maker::{Folder, Maker, assert_near, bent, cube, grid, moved, open, saved_glb, split, try_open};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use pliant_io::{Format, Placement, Save};
use pliant_mesh::{Cancel, Progress};
use serde_json::{Value, json};

fn json_of(glb: &[u8]) -> Value {
    serde_json::from_str(&split(glb).0).unwrap()
}

/// The file with another default scene.
fn with_scene(glb: &[u8], scene: Value) -> Vec<u8> {
    let (text, bin) = split(glb);
    let mut root: Value = serde_json::from_str(&text).unwrap();
    root["scenes"].as_array_mut().unwrap().push(scene);
    root["scene"] = (root["scenes"].as_array().unwrap().len() - 1).into();
    gltf_maker::glb(root.to_string().as_bytes(), &bin)
}

#[test]
fn a_mesh_that_another_scene_shows_too_keeps_its_shape_there() {
    for other_scene in [true, false] {
        let mut maker = Maker::of(&grid(4));
        let unseen = maker.loose_node(json!({ "mesh": 0, "translation": [9, 0, 0] }));
        if other_scene {
            maker.root["scenes"]
                .as_array_mut()
                .unwrap()
                .push(json!({ "nodes": [unseen] }));
        }
        let before = maker.glb();
        let elsewhere = with_scene(&before, json!({ "nodes": [unseen] }));
        let opened = open(&before);
        assert!(
            opened.scene.notes()[0].contains("not drawn"),
            "{:?}",
            opened.scene.notes()
        );
        let positions = moved(&opened, |_| true, bent);
        let after = saved_glb(&opened, &positions);
        assert_near(&open(&after).drawn.positions, &positions, 4.0);
        let kept = open(&with_scene(&after, json!({ "nodes": [unseen] })));
        assert_eq!(kept.drawn.positions, open(&elsewhere).drawn.positions);
    }
}

#[test]
fn a_part_turned_inside_out_is_not_turned_in_another_scene() {
    let mut maker = Maker::of(&grid(3));
    // Without normals only the triangles change.
    let attributes = &mut maker.root["meshes"][0]["primitives"][0]["attributes"];
    *attributes = json!({ "POSITION": attributes["POSITION"] });
    let unseen = maker.loose_node(json!({ "mesh": 0 }));
    let opened = open(&maker.glb());
    let turned = vec![true; opened.drawn.positions.len()];
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &turned,
        drawn: &opened.drawn,
        positions: &opened.drawn.positions,
        format: Format::Glb,
        name: "out.glb",
        placement: Placement::OtherFolder,
    };
    let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
    let after = &saved.files[0].bytes;
    let wound_back: Vec<_> = opened.drawn.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert_eq!(open(after).drawn.triangles, wound_back);
    let kept = open(&with_scene(after, json!({ "nodes": [unseen] })));
    assert_eq!(kept.drawn.triangles, opened.drawn.triangles);
}

/// The bytes of a buffer view.
fn view_bytes(glb: &[u8], view: usize) -> Vec<u8> {
    let (root, bin) = (json_of(glb), split(glb).1);
    let view = &root["bufferViews"][view];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    bin[start..start + view["byteLength"].as_u64().unwrap() as usize].to_vec()
}

#[test]
fn what_an_extension_may_read_is_copied_and_not_written_over() {
    type Name = fn(&mut Maker, usize, usize);
    let names: [(&str, Name); 4] = [
        ("an accessor", |maker, accessor, _| {
            maker.root["extensions"] = json!({ "ACME_moss": { "roots": { "at": accessor } } });
        }),
        ("a view, deep in a list", |maker, _, view| {
            maker.root["nodes"][0]["extensions"] = json!({ "ACME_moss": { "roots": [[view]] } });
        }),
        ("an accessor, in a known extension's", |maker, accessor, _| {
            maker.root["materials"] = json!([{ "extensions": {
                "KHR_materials_ior": { "ior": 1.5, "extensions": { "ACME_moss": { "a": accessor } } },
            } }]);
        }),
        ("a view over the same bytes", |maker, _, view| {
            let mut twin = maker.root["bufferViews"][view].clone();
            twin["byteOffset"] = (twin["byteOffset"].as_u64().unwrap() + 8).into();
            twin["byteLength"] = 4.into();
            let views = maker.root["bufferViews"].as_array_mut().unwrap();
            views.push(twin);
            let number = views.len() - 1;
            maker.root["extensions"] = json!({ "ACME_moss": { "view": number } });
        }),
    ];
    for (what, name) in names {
        // Accessors come before those of the mesh, so that numbers of accessors and of views differ.
        let mut maker = Maker::default();
        for _ in 0..7 {
            maker.accessor(json!({ "componentType": 5126, "count": 1, "type": "SCALAR" }));
        }
        maker.mesh(&grid(4));
        maker.node(json!({ "mesh": 0 }));
        let position = &maker.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
        let accessor = position.as_u64().unwrap() as usize;
        let view = maker.root["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
        let plain = saved_glb(&open(&maker.glb()), &moved(&open(&maker.glb()), |_| true, bent));
        assert_ne!(view_bytes(&plain, view), view_bytes(&maker.glb(), view));
        name(&mut maker, accessor, view);
        let before = maker.glb();
        let opened = open(&before);
        let positions = moved(&opened, |_| true, bent);
        let after = saved_glb(&opened, &positions);
        assert_eq!(view_bytes(&after, view), view_bytes(&before, view), "{what}");
        assert_eq!(
            json_of(&after)["accessors"][accessor],
            json_of(&before)["accessors"][accessor]
        );
        assert_near(&open(&after).drawn.positions, &positions, 4.0);
    }
}

/// A scene of a cube with a node of `places` copies and a child.
fn with_copies(places: &[(DVec3, DQuat, DVec3)]) -> Maker {
    let mut maker = Maker::default();
    maker.mesh(&cube());
    let floats = |vector: DVec3| vector.as_vec3().to_array();
    let translations: Vec<[f32; 3]> = places.iter().map(|place| floats(place.0)).collect();
    let rotations: Vec<[f32; 4]> = places.iter().map(|place| place.1.as_quat().to_array()).collect();
    let scales: Vec<[f32; 3]> = places.iter().map(|place| floats(place.2)).collect();
    let attributes = json!({
        "TRANSLATION": maker.floats(&translations), "ROTATION": maker.floats(&rotations), "SCALE": maker.floats(&scales),
    });
    let child = maker.loose_node(json!({ "mesh": 0, "translation": [0, 50, 0] }));
    maker.node(json!({
        "mesh": 0, "translation": [0, 0, 5], "name": "wood", "children": [child],
        "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } },
    }));
    maker.root["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    maker.root["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    maker
}

fn places() -> Vec<(DVec3, DQuat, DVec3)> {
    vec![
        (DVec3::X * 3.0, DQuat::IDENTITY, DVec3::ONE),
        (DVec3::X * 6.0, DQuat::from_rotation_z(0.7), DVec3::new(1.0, 2.0, 0.5)),
        (DVec3::X * 9.0, DQuat::from_rotation_x(2.0), DVec3::new(-1.0, 1.0, 1.0)),
    ]
}

#[test]
fn copies_stand_where_their_node_and_their_own_transforms_put_them() {
    let opened = open(&with_copies(&places()).glb());
    let shape = cube();
    let mut wanted = Vec::new();
    for (translation, rotation, scale) in places() {
        let world = DAffine3::from_translation(DVec3::Z * 5.0)
            * DAffine3::from_scale_rotation_translation(scale, rotation, translation);
        let points = shape.positions.iter().map(|&p| Vec3::from(p).as_dvec3());
        wanted.extend(points.map(|p| world.transform_point3(p)));
    }
    wanted.extend(
        shape
            .positions
            .iter()
            .map(|&p| Vec3::from(p).as_dvec3() + DVec3::new(0.0, 50.0, 5.0)),
    );
    assert_near(&opened.drawn.positions, &wanted, 20.0);
    // None is seen inside out.
    let corner = |v: pliant_mesh::DrawnVertex| opened.drawn.positions[v.index()];
    for copy in opened.drawn.triangles.chunks(shape.triangles.len()) {
        let centre = copy.iter().flatten().map(|&v| corner(v)).sum::<DVec3>() / (3.0 * copy.len() as f64);
        let volume = copy.iter().map(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|v| corner(v) - centre);
            a.dot(b.cross(c))
        });
        assert!(volume.sum::<f64>() > 0.0);
    }
}

#[test]
fn copies_that_an_edit_makes_differ_become_nodes_and_others_stay_copies() {
    let before = with_copies(&places()).glb();
    let opened = open(&before);
    let count = cube().positions.len();
    // Only one of them.
    let positions = moved(
        &opened,
        |v| (count..2 * count).contains(&v),
        |p| p * DVec3::new(1.0, 1.3, 1.0),
    );
    let after = saved_glb(&opened, &positions);
    assert_near(&open(&after).drawn.positions, &positions, 60.0);
    let root = json_of(&after);
    assert_eq!(root["meshes"].as_array().unwrap().len(), 2);
    let wood = &root["nodes"][1];
    assert!(wood.get("mesh").is_none() && wood.get("extensions").is_none(), "{wood}");
    assert_eq!(wood["children"], json!([2, 3, 4, 0]));
    assert_eq!(root["nodes"][3]["mesh"], 1);
    assert!(pliant_io::is_same_document(&before, &after));
    // All of them move the same in their own space: they stay copies of one mesh.
    let nudge = DVec3::new(0.0, 0.25, 0.0);
    let mut positions = opened.drawn.positions.clone();
    for (number, (_, rotation, scale)) in places().into_iter().enumerate() {
        positions[number * count..(number + 1) * count]
            .iter_mut()
            .for_each(|p| *p += rotation * (scale * nudge));
    }
    let after = saved_glb(&opened, &positions);
    assert_near(&open(&after).drawn.positions, &positions, 60.0);
    let root = json_of(&after);
    assert_eq!(root["nodes"].as_array().unwrap().len(), 2);
    assert_eq!(
        root["nodes"][1]["extensions"],
        json_of(&before)["nodes"][1]["extensions"]
    );
}

#[test]
fn copies_that_cannot_be_read_are_one_and_that_is_said() {
    let mut maker = with_copies(&places());
    maker.root["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 99.into();
    let opened = open(&maker.glb());
    assert_eq!(opened.drawn.positions.len(), 2 * cube().positions.len());
    assert!(
        opened.scene.notes()[0].contains("shown once"),
        "{:?}",
        opened.scene.notes()
    );
}

#[test]
fn hidden_nodes_are_drawn_and_named() {
    let mut maker = Maker::of(&grid(2));
    maker.root["nodes"][0]["extensions"] = json!({ "KHR_node_visibility": { "visible": false } });
    let opened = try_open(&maker.glb(), Format::Glb, &Folder::default()).unwrap();
    assert_eq!(opened.drawn.positions.len(), 9);
    assert!(opened.scene.notes()[0].contains("KHR_node_visibility"));
}
