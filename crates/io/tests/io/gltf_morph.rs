//! An edit saved as a morph target: the shape stays, the target leads to the edited one, and every list of weights gets
//! one more.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{
    Folder, Maker, assert_near, bent, grid, moved, open, saved_glb, shapes, split, try_open, try_save,
};
use glam::{DQuat, DVec3};
use pliant_io::{Format, MorphDeltas, MorphTarget, Placement, Save, SaveError, Saved, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};
use serde_json::{Value, json};

fn try_morph(opened: &SceneAndDrawn, positions: &[DVec3], name: &str, weight: f64) -> Result<Saved, SaveError> {
    opened.scene.save_as_morph(
        &Save {
            deltas: MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions,
            format: Format::of_name(name).unwrap(),
            name,
            placement: Placement::OtherFolder,
        },
        &MorphTarget { name: "smile", weight },
        &Progress::new(),
        &Cancel::new(),
    )
}

fn morphed(opened: &SceneAndDrawn, positions: &[DVec3], weight: f64) -> Vec<u8> {
    let mut saved = try_morph(opened, positions, "out.glb", weight).unwrap();
    assert_eq!(saved.warnings, Vec::<String>::new());
    saved.files.remove(0).bytes
}

fn json_of(glb: &[u8]) -> Value {
    serde_json::from_str(&split(glb).0).unwrap()
}

#[test]
fn the_target_leads_from_the_shape_to_the_edited_one() {
    for (name, shape) in shapes() {
        let mut maker = Maker::of(&shape);
        maker.root["nodes"][0]["rotation"] = json!([0.5, 0.5, 0.5, 0.5]);
        let before = maker.glb();
        let opened = open(&before);
        let positions = moved(&opened, |v| v % 3 != 0, bent);
        let (shown, hidden) = (morphed(&opened, &positions, 1.0), morphed(&opened, &positions, 0.0));
        assert!(
            split(&shown).1.starts_with(&split(&before).1),
            "{name}: the shape's own bytes stay"
        );
        assert_eq!(open(&hidden).drawn.positions, opened.drawn.positions, "{name}");
        let again = open(&shown);
        assert_near(&again.drawn.positions, &positions, 4.0);
        assert_eq!(again.scene.summary().morph_targets, 1);
        // The normals move to those of the edited shape.
        let edited = open(&saved_glb(&opened, &positions))
            .scene
            .appearance()
            .normals
            .unwrap();
        let shown_normals = again.scene.appearance().normals.unwrap();
        for (found, wanted) in shown_normals.iter().zip(&edited) {
            assert!((0..3).all(|k| (found[k] - wanted[k]).abs() < 1e-5), "{name}");
        }
        let root = json_of(&shown);
        assert_eq!(root["meshes"][0]["weights"], json!([1]));
        assert_eq!(root["meshes"][0]["extras"]["targetNames"], json!(["smile"]));
        assert!(root["meshes"][0]["primitives"][0]["targets"][0]["TANGENT"].is_number());
        // A second edit adds a second one.
        let third = moved(&again, |v| v % 2 == 0, |p| p + DVec3::Y);
        let twice = open(&morphed(&again, &third, 1.0));
        assert_near(&twice.drawn.positions, &third, 8.0);
        assert_eq!(twice.scene.summary().morph_targets, 2);
    }
}

#[test]
fn whatever_tells_weights_tells_one_more() {
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(&grid(2));
    let lift = maker.floats(&[[0.0, 0.0, 0.5]; 9]);
    primitive["targets"] = json!([{ "POSITION": lift }, { "POSITION": lift }]);
    let still = maker.primitive(&grid(1));
    let mut still = still;
    let rise = maker.floats(&[[0.0, 0.1, 0.0]; 4]);
    still["targets"] = json!([{ "POSITION": rise }, { "POSITION": rise }]);
    let mesh = maker.mesh_of(vec![primitive, still]);
    maker.root["meshes"][mesh]["weights"] = json!([0.0, 0.5]);
    maker.root["meshes"][mesh]["extras"] = json!({ "targetNames": ["a", "b"], "kept": true });
    maker.node(json!({ "mesh": 0, "weights": [0.25, 0.0] }));
    maker.node(json!({ "mesh": 0, "translation": [9, 0, 0] }));
    let scalar = |maker: &mut Maker, numbers: &[f32]| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let view = maker.view(&bytes);
        maker.accessor(json!({ "bufferView": view, "componentType": 5126, "count": numbers.len(), "type": "SCALAR" }))
    };
    let times = scalar(&mut maker, &[0.0, 1.0]);
    let linear = scalar(&mut maker, &[0.1, 0.2, 0.3, 0.4]);
    let cubic = scalar(
        &mut maker,
        &[9.0, 9.0, 0.1, 0.2, 8.0, 8.0, 9.0, 9.0, 0.3, 0.4, 8.0, 8.0],
    );
    maker.root["animations"] = json!([{
        "samplers": [{ "input": times, "output": linear }, { "input": times, "output": cubic, "interpolation": "CUBICSPLINE" }],
        "channels": [
            { "sampler": 0, "target": { "node": 0, "path": "weights" } },
            { "sampler": 1, "target": { "node": 0, "path": "weights" } },
            { "sampler": 0, "target": { "node": 1, "path": "weights" } },
        ],
    }]);
    let opened = open(&maker.glb());
    // Only the vertices that the first node shows of the first primitive move, so that the mesh is cloned for it.
    let positions = moved(&opened, |v| v < 9, bent);
    let after = morphed(&opened, &positions, 0.75);
    let root = json_of(&after);
    let again = open(&after);
    assert_eq!(again.drawn.positions.len(), opened.drawn.positions.len());
    let share: Vec<DVec3> = opened
        .drawn
        .positions
        .iter()
        .zip(&positions)
        .map(|(a, b)| *a + (*b - *a) * 0.75)
        .collect();
    assert_near(&again.drawn.positions, &share, 9.0);
    let shown = root["nodes"][0]["mesh"].as_u64().unwrap() as usize;
    let kept = root["nodes"][1]["mesh"].as_u64().unwrap() as usize;
    assert_ne!(shown, kept);
    assert_eq!(root["meshes"][kept], json_of(&maker.glb())["meshes"][0]);
    assert_eq!(root["meshes"][shown]["weights"], json!([0.0, 0.5, 0.75]));
    assert_eq!(
        root["meshes"][shown]["extras"],
        json!({ "targetNames": ["a", "b", "smile"], "kept": true })
    );
    assert_eq!(root["nodes"][0]["weights"], json!([0.25, 0.0, 0.75]));
    for primitive in root["meshes"][shown]["primitives"].as_array().unwrap() {
        assert_eq!(primitive["targets"].as_array().unwrap().len(), 3);
    }
    let animation = &root["animations"][0];
    let bin = split(&after).1;
    let told = |channel: usize| -> Vec<f32> {
        let sampler = &animation["samplers"][animation["channels"][channel]["sampler"].as_u64().unwrap() as usize];
        let accessor = &root["accessors"][sampler["output"].as_u64().unwrap() as usize];
        let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        let count = accessor["count"].as_u64().unwrap() as usize;
        bin[start..start + 4 * count]
            .chunks(4)
            .map(|b| f32::from_le_bytes(b.try_into().unwrap()))
            .collect()
    };
    assert_eq!(told(0), [0.1, 0.2, 0.75, 0.3, 0.4, 0.75]);
    assert_eq!(
        told(1),
        [
            9.0, 9.0, 0.0, 0.1, 0.2, 0.75, 8.0, 8.0, 0.0, 9.0, 9.0, 0.0, 0.3, 0.4, 0.75, 8.0, 8.0, 0.0
        ]
    );
    assert_eq!(told(2), [0.1, 0.2, 0.3, 0.4], "the other node's animation is as it was");
}

#[test]
fn what_can_not_take_a_target_says_why() {
    let mut maker = Maker::of(&grid(2));
    let opened = open(&maker.glb());
    let positions = moved(&opened, |_| true, bent);
    let refused = try_morph(&opened, &positions, "out.ply", 1.0).unwrap_err().to_string();
    assert!(
        refused.contains("a morph target can't be saved as PLY") && refused.contains(".glb"),
        "{refused}"
    );
    maker.root["animations"] = json!([{
        "samplers": [], "channels": [{ "sampler": 0, "target": { "path": "pointer",
            "extensions": { "KHR_animation_pointer": { "pointer": "/meshes/0/weights" } } } }],
    }]);
    let refused = try_morph(&open(&maker.glb()), &positions, "out.glb", 1.0)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("animation 0 of /meshes/0/weights"), "{refused}");
    let mut maker = Maker::of(&grid(2));
    let mut with_target = maker.primitive(&grid(1));
    let rise = maker.floats(&[[0.0, 0.1, 0.0]; 4]);
    with_target["targets"] = json!([{ "POSITION": rise }]);
    maker.root["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(with_target);
    let opened = open(&maker.glb());
    let positions = moved(&opened, |_| true, bent);
    let refused = try_morph(&opened, &positions, "out.glb", 1.0).unwrap_err().to_string();
    assert!(
        refused.contains("mesh 0, whose primitives have different numbers"),
        "{refused}"
    );
}

#[test]
fn nothing_moved_adds_nothing() {
    let before = Maker::of(&grid(2)).glb();
    let opened = open(&before);
    let saved = try_morph(&opened, &opened.drawn.positions, "out.glb", 1.0).unwrap();
    assert!(saved.files[0].bytes == before && saved.warnings.len() == 1);
}

#[test]
fn a_file_of_another_kind_becomes_a_gltf_with_a_target() {
    let off = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    let opened = try_open(off, Format::Off, &Folder::default()).unwrap();
    let positions = moved(&opened, |v| v > 1, |p| p + DVec3::Z * 2.0);
    for name in ["out.glb", "out.gltf"] {
        let saved = try_morph(&opened, &positions, name, 1.0).unwrap();
        let folder = Folder(
            saved
                .files
                .iter()
                .map(|file| (file.name.clone(), file.bytes.clone()))
                .collect(),
        );
        let again = try_open(&saved.files[0].bytes, Format::of_name(name).unwrap(), &folder).unwrap();
        assert_near(&again.drawn.positions, &positions, 4.0);
        assert_eq!(again.scene.summary().morph_targets, 1);
    }
}

#[test]
fn deltas_turn_with_a_surface_that_turns_far_whatever_is_applied_by_default() {
    let shape = grid(4);
    let lift: Vec<[f32; 3]> = shape.positions.iter().map(|p| [0.1 * p[0], 0.0, 0.3]).collect();
    let turn = DQuat::from_rotation_x(1.2) * DQuat::from_rotation_z(0.4);
    for has_normals in [true, false] {
        for weight in [0.0, 0.75] {
            let mut maker = Maker::default();
            let mut primitive = maker.primitive(&shape);
            if !has_normals {
                primitive["attributes"] = json!({ "POSITION": primitive["attributes"]["POSITION"] });
            }
            primitive["targets"] = json!([{ "POSITION": maker.floats(&lift) }]);
            let mesh = maker.mesh_of(vec![primitive]);
            maker.root["meshes"][mesh]["weights"] = json!([weight]);
            maker.node(json!({ "mesh": mesh, "scale": [2, 2, 2], "rotation": [0, 0.6, 0, 0.8] }));
            let opened = open(&maker.glb());
            let whole = |opened: &SceneAndDrawn| {
                let count = opened.drawn.positions.len();
                let ways = opened
                    .scene
                    .morph_target("a", "target 0", count, &Cancel::new())
                    .unwrap()
                    .unwrap();
                let each = opened.drawn.positions.iter().zip(ways);
                each.map(|(position, way)| *position + way).collect::<Vec<DVec3>>()
            };
            let positions = moved(&opened, |_| true, |p| turn * p + DVec3::Y);
            let saved = try_save(&opened, &positions, "out.glb", Placement::SameFolder).unwrap();
            assert!(
                saved.warnings[0].contains("turned with the edit"),
                "{:?}",
                saved.warnings
            );
            let again = open(&saved.files[0].bytes);
            assert_near(&again.drawn.positions, &positions, 8.0);
            let wanted: Vec<DVec3> = whole(&opened).iter().map(|p| turn * *p + DVec3::Y).collect();
            assert_near(&whole(&again), &wanted, 8.0);
        }
    }
}

#[test]
fn deltas_turn_or_stay_as_a_save_asks() {
    let shape = grid(4);
    let lift: Vec<[f32; 3]> = shape.positions.iter().map(|_| [0.0, 0.0, 0.3]).collect();
    let stored = |file: &[u8]| {
        let (root, bin) = (json_of(file), split(file).1);
        let accessor = &root["meshes"][0]["primitives"][0]["targets"][0]["POSITION"];
        let accessor = &root["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let at = (view["byteOffset"].as_u64().unwrap_or(0) + accessor["byteOffset"].as_u64().unwrap_or(0)) as usize;
        let lane = |lane: usize| f32::from_le_bytes(bin[at + 4 * lane..][..4].try_into().unwrap());
        DVec3::from([0, 1, 2].map(|number| f64::from(lane(number))))
    };
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(&shape);
    primitive["targets"] = json!([{ "POSITION": maker.floats(&lift) }]);
    let mesh = maker.mesh_of(vec![primitive]);
    maker.node(json!({ "mesh": mesh }));
    let file = maker.glb();
    let opened = open(&file);
    let way = DVec3::Z * f64::from(0.3_f32);
    // Turns by a few degrees, and by many.
    for angle in [0.2, 1.2] {
        let turn = DQuat::from_rotation_x(angle);
        let positions = moved(&opened, |_| true, |p| turn * p);
        for deltas in [MorphDeltas::WhereFarOff, MorphDeltas::Turn, MorphDeltas::Stay] {
            let save = Save {
                drawn: &opened.drawn,
                positions: &positions,
                turned: &[],
                deltas,
                format: Format::Glb,
                name: "out.glb",
                placement: Placement::SameFolder,
            };
            let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
            let turns = deltas == MorphDeltas::Turn || deltas == MorphDeltas::WhereFarOff && angle > 1.0;
            let wanted = if turns { turn * way } else { way };
            let found = stored(&saved.files[0].bytes);
            assert!(found.distance(wanted) < 1e-6, "{deltas:?} at {angle}: {found}");
            let says = if turns { "turned with the edit" } else { "did not turn" };
            assert!(saved.warnings[0].contains(says), "{:?}", saved.warnings);
        }
    }
}
