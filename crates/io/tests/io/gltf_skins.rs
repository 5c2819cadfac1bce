//! Skinned meshes: they are drawn where their joints put them. An edited and saved one, posed by an evaluation of the
//! skin that shares no code with the program, looks the same as shown.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{Maker, Shape, grid, moved, open, saved_glb, sphere, split};
use glam::{DMat4, DQuat, DVec3, Vec3, Vec4};
use pliant_io::SceneAndDrawn;
use serde_json::{Value, json};

/// The storage of positions.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Stored {
    Floats,
    /// Normalised 16-bit numbers on a grid of the mesh's own, which the inverse bind matrices undo.
    Quantised,
}

/// The parameters of a figure.
#[derive(Clone, Copy, Debug)]
struct Figure {
    stored: Stored,
    /// Scales the root, as in files in centimetres.
    scale: f64,
    /// Binds each vertex by two sets of joints and weights.
    two_sets: bool,
    mirrored: bool,
}

const JOINTS: usize = 6;

/// A mesh bound to a chain of joints, which have left their bind pose; beside it its hat, a child of the last joint.
fn figure(shape: &Shape, figure: Figure) -> Maker {
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(shape);
    let count = shape.positions.len();
    let (low, size) = (Vec3::splat(-1.5), 3.0);
    if figure.stored == Stored::Quantised {
        let bytes: Vec<u8> = (shape.positions.iter())
            .flat_map(|&p| {
                let of_grid = ((Vec3::from(p) - low) / size * 65535.0).round();
                let [x, y, z] = of_grid.to_array().map(|number| (number as u16).to_le_bytes());
                [x, y, z, [0; 2]].concat()
            })
            .collect();
        let view = maker.view(&bytes);
        maker.root["bufferViews"][view]["byteStride"] = 8.into();
        maker.root["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        maker.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        primitive["attributes"]["POSITION"] = maker
            .accessor(json!({
                "bufferView": view, "componentType": 5123, "normalized": true, "count": count, "type": "VEC3",
                "min": [0, 0, 0], "max": [65535, 65535, 65535],
            }))
            .into();
    }
    for set in 0..if figure.two_sets { 2 } else { 1 } {
        let (joints, weights): (Vec<[u8; 4]>, Vec<[f32; 4]>) = (0..count as u8)
            .map(|v| {
                let first = (v + 3 * set) % JOINTS as u8;
                let joints = [first, (first + 1) % JOINTS as u8, 0, 0];
                let part = 0.2 + 0.6 * f32::from(v % 5) / 4.0;
                let share = if figure.two_sets { 0.5 } else { 1.0 };
                (joints, [part, 1.0 - part, 0.0, 0.0].map(|weight| weight * share))
            })
            .unzip();
        let view = maker.view(joints.as_flattened());
        let joints = json!({ "bufferView": view, "componentType": 5121, "count": count, "type": "VEC4" });
        primitive["attributes"][format!("JOINTS_{set}")] = maker.accessor(joints).into();
        primitive["attributes"][format!("WEIGHTS_{set}")] = maker.floats(&weights).into();
    }
    maker.mesh_of(vec![primitive]);
    maker.node(json!({ "mesh": 0, "skin": 0, "translation": [300, 20, 1], "scale": [7, 8, 0] }));
    let sign = if figure.mirrored { -1.0 } else { 1.0 };
    let scale = [figure.scale * sign, figure.scale, figure.scale];
    maker.node(json!({ "scale": scale, "rotation": [-0.5_f64.sqrt(), 0, 0, 0.5_f64.sqrt()], "children": [2] }));
    for joint in 0..JOINTS {
        let turn = DQuat::from_rotation_z(0.15 * joint as f64) * DQuat::from_rotation_x(0.1);
        let children: Vec<usize> = (joint + 1 < JOINTS).then_some(joint + 3).into_iter().collect();
        let mut node = json!({ "rotation": turn.to_array(), "translation": [0.1, 0.4, 0.02 * joint as f64] });
        if !children.is_empty() {
            node["children"] = children.into();
        }
        maker.loose_node(node);
    }
    // From the stored numbers to the joint's bind position.
    let from_grid = match figure.stored {
        Stored::Floats => DMat4::IDENTITY,
        Stored::Quantised => {
            DMat4::from_scale_rotation_translation(DVec3::splat(f64::from(size)), DQuat::IDENTITY, low.as_dvec3())
        }
    };
    let matrices: Vec<f32> = (0..JOINTS)
        .flat_map(|joint| {
            let bound = DMat4::from_translation(DVec3::new(0.0, 0.3 * joint as f64, 0.0));
            (bound.inverse() * from_grid)
                .to_cols_array()
                .map(|number| number as f32)
        })
        .collect();
    let bytes: Vec<u8> = matrices.iter().flat_map(|number| number.to_le_bytes()).collect();
    let view = maker.view(&bytes);
    let matrices = json!({ "bufferView": view, "componentType": 5126, "count": JOINTS, "type": "MAT4" });
    let matrices = maker.accessor(matrices);
    let joints: Vec<usize> = (2..2 + JOINTS).collect();
    maker.root["skins"] = json!([{ "joints": joints, "inverseBindMatrices": matrices }]);
    maker
}

/// An accessor's numbers, read plainly.
fn numbers(root: &Value, bin: &[u8], accessor: &Value) -> Vec<Vec<f64>> {
    let accessor = &root["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let lanes = match accessor["type"].as_str().unwrap() {
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        other => panic!("{other}"),
    };
    let (size, of): (usize, fn(&[u8]) -> f64) = match accessor["componentType"].as_u64().unwrap() {
        5121 => (1, |bytes| f64::from(bytes[0])),
        5123 => (2, |bytes| f64::from(u16::from_le_bytes(bytes[..2].try_into().unwrap()))),
        5126 => (4, |bytes| f64::from(f32::from_le_bytes(bytes[..4].try_into().unwrap()))),
        other => panic!("{other}"),
    };
    let most = match (accessor["normalized"].as_bool(), size) {
        (Some(true), 1) => 255.0,
        (Some(true), _) => 65535.0,
        _ => 1.0,
    };
    let first = ["byteOffset"]
        .iter()
        .map(|key| view[key].as_u64().unwrap_or(0))
        .sum::<u64>()
        + accessor["byteOffset"].as_u64().unwrap_or(0);
    let stride = view["byteStride"].as_u64().unwrap_or((lanes * size) as u64);
    let element = |element: u64| {
        let at = (first + element * stride) as usize;
        (0..lanes).map(|lane| of(&bin[at + lane * size..]) / most).collect()
    };
    (0..accessor["count"].as_u64().unwrap()).map(element).collect()
}

/// The world transform of each node.
fn world_of_nodes(root: &Value) -> Vec<DMat4> {
    let nodes = root["nodes"].as_array().unwrap();
    let list = |value: &Value| -> Option<Vec<f64>> {
        Some(
            value
                .as_array()?
                .iter()
                .map(|number| number.as_f64().unwrap())
                .collect(),
        )
    };
    let own = |node: &Value| {
        let vector = |key: &str, default: f64| match list(&node[key]) {
            Some(numbers) => DVec3::from_slice(&numbers),
            None => DVec3::splat(default),
        };
        let turn = list(&node["rotation"]).map_or(DQuat::IDENTITY, |numbers| DQuat::from_slice(&numbers).normalize());
        DMat4::from_scale_rotation_translation(vector("scale", 1.0), turn, vector("translation", 0.0))
    };
    let mut world = vec![DMat4::IDENTITY; nodes.len()];
    let mut open: Vec<(usize, DMat4)> = vec![(0, DMat4::IDENTITY), (1, DMat4::IDENTITY)];
    while let Some((node, above)) = open.pop() {
        world[node] = above * own(&nodes[node]);
        for child in nodes[node]["children"].as_array().into_iter().flatten() {
            open.push((child.as_u64().unwrap() as usize, world[node]));
        }
    }
    world
}

/// The positions of the vertices of mesh 0 by glTF's formula and the directions of their normals, with morph targets at
/// these weights.
fn posed_with(glb: &[u8], weights: &[f64]) -> (Vec<DVec3>, Vec<DVec3>) {
    let (text, bin) = split(glb);
    let root: Value = serde_json::from_str(&text).unwrap();
    let attributes = &root["meshes"][0]["primitives"][0]["attributes"];
    let world = world_of_nodes(&root);
    let skin = &root["skins"][0];
    let inverse = numbers(&root, &bin, &skin["inverseBindMatrices"]);
    let joints = skin["joints"].as_array().unwrap();
    let of_joint =
        |joint: usize| world[joints[joint].as_u64().unwrap() as usize] * DMat4::from_cols_slice(&inverse[joint]);
    let mut points = numbers(&root, &bin, &attributes["POSITION"]);
    for (number, weight) in weights.iter().enumerate() {
        let target = &root["meshes"][0]["primitives"][0]["targets"][number]["POSITION"];
        for (point, way) in points.iter_mut().zip(numbers(&root, &bin, target)) {
            point
                .iter_mut()
                .zip(way)
                .for_each(|(number, way)| *number += weight * way);
        }
    }
    let normals = numbers(&root, &bin, &attributes["NORMAL"]);
    let mut matrices = vec![DMat4::ZERO; points.len()];
    for set in 0..2 {
        let Some(joints) = attributes.get(format!("JOINTS_{set}")) else {
            continue;
        };
        let joints = numbers(&root, &bin, joints);
        let weights = numbers(&root, &bin, &attributes[format!("WEIGHTS_{set}")]);
        for (matrix, (joints, weights)) in matrices.iter_mut().zip(joints.iter().zip(&weights)) {
            for (joint, weight) in joints.iter().zip(weights) {
                *matrix += of_joint(*joint as usize) * *weight;
            }
        }
    }
    let place = |(matrix, point): (&DMat4, &Vec<f64>)| matrix.transform_point3(DVec3::from_slice(point));
    let turn = |(matrix, normal): (&DMat4, &Vec<f64>)| {
        let normal = matrix
            .inverse()
            .transpose()
            .transform_vector3(DVec3::from_slice(normal));
        normal.normalize_or_zero()
    };
    (
        matrices.iter().zip(&points).map(place).collect(),
        matrices.iter().zip(&normals).map(turn).collect(),
    )
}

fn posed(glb: &[u8]) -> (Vec<DVec3>, Vec<DVec3>) {
    posed_with(glb, &[])
}

fn figures() -> Vec<Figure> {
    let mut all = Vec::new();
    for stored in [Stored::Floats, Stored::Quantised] {
        for scale in [1.0, 0.01] {
            for two_sets in [false, true] {
                for mirrored in [false, true] {
                    all.push(Figure {
                        stored,
                        scale,
                        two_sets,
                        mirrored,
                    });
                }
            }
        }
    }
    all
}

fn size_of(positions: &[DVec3]) -> f64 {
    let low = positions.iter().copied().reduce(DVec3::min).unwrap();
    let high = positions.iter().copied().reduce(DVec3::max).unwrap();
    low.distance(high)
}

fn assert_within(found: &[DVec3], wanted: &[DVec3], most: f64, what: &dyn std::fmt::Debug) {
    assert_eq!(found.len(), wanted.len());
    for (v, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        let apart = found.distance(*wanted);
        assert!(apart <= most, "{what:?}: vertex {v} is {apart:e} away, at {found}");
    }
}

fn bent(p: DVec3, size: f64) -> DVec3 {
    let p = p / size;
    (DQuat::from_rotation_x(0.8 * p.y + 0.3) * p + DVec3::new(0.1 * p.y * p.y, 1.0, 0.2 * p.x)) * size
}

#[test]
fn joints_place_the_mesh_and_its_node_does_not() {
    for kind in figures() {
        let file = figure(&sphere(5), kind).glb();
        let opened = open(&file);
        let (points, normals) = posed(&file);
        assert_within(&opened.drawn.positions, &points, 1e-6 * size_of(&points), &kind);
        let shown = opened.scene.appearance().normals.unwrap();
        let shown: Vec<DVec3> = shown.iter().map(|n| Vec3::from(*n).as_dvec3()).collect();
        assert_within(&shown, &normals, 1e-5, &kind);
        assert_eq!(opened.scene.notes(), &[] as &[String]);
    }
}

#[test]
fn a_mirrored_skin_is_not_seen_inside_out() {
    let volume = |opened: &SceneAndDrawn| {
        let corner = |v: pliant_mesh::DrawnVertex| opened.drawn.positions[v.index()];
        let of = |[a, b, c]: &[pliant_mesh::DrawnVertex; 3]| corner(*a).dot(corner(*b).cross(corner(*c)));
        opened.drawn.triangles.iter().map(of).sum::<f64>()
    };
    for kind in figures() {
        let opened = open(&figure(&sphere(5), kind).glb());
        assert!(volume(&opened) > 0.0, "{kind:?}");
    }
}

#[test]
fn an_edited_figure_looks_posed_as_it_was_shown() {
    for kind in figures() {
        for shape in [sphere(5), grid(4)] {
            let before = figure(&shape, kind).glb();
            let opened = open(&before);
            let size = size_of(&opened.drawn.positions);
            for part in [1, 2] {
                let positions = moved(&opened, |v| v % part == 0, |p| bent(p, size));
                let after = saved_glb(&opened, &positions);
                let (points, _) = posed(&after);
                assert_within(&points, &positions, 1e-5 * size, &kind);
                assert_within(&open(&after).drawn.positions, &positions, 1e-5 * size, &kind);
            }
            assert!(saved_glb(&opened, &opened.drawn.positions) == before);
        }
    }
}

/// A figure with two morph targets; the second is applied by default by this weight.
fn morphed_figure(shape: &Shape, kind: Figure, weight: f64) -> Maker {
    let mut maker = figure(shape, kind);
    // In the unit of the stored numbers.
    let size = if kind.stored == Stored::Quantised { 0.03 } else { 0.1 };
    let ways = |of: &dyn Fn(Vec3) -> Vec3| -> Vec<[f32; 3]> {
        let ways = shape.positions.iter().map(|&p| of(Vec3::from(p)) * size);
        ways.map(|way| way.to_array()).collect()
    };
    let smile = ways(&|p| Vec3::new(1.0, p.x, 0.5 * p.y));
    let frown = ways(&|p| Vec3::new(p.z, -1.0, p.x));
    let targets = json!([{ "POSITION": maker.floats(&smile) }, { "POSITION": maker.floats(&frown) }]);
    maker.root["meshes"][0]["primitives"][0]["targets"] = targets;
    maker.root["meshes"][0]["weights"] = json!([0.0, weight]);
    maker
}

#[test]
fn a_skinned_figure_with_morph_targets_looks_as_it_was_shown_and_its_targets_turn_along() {
    for kind in figures() {
        for weight in [0.0, 0.75] {
            let before = morphed_figure(&grid(5), kind, weight).glb();
            let opened = open(&before);
            let shown = posed_with(&before, &[0.0, weight]).0;
            let size = size_of(&shown);
            assert_within(&opened.drawn.positions, &shown, 1e-6 * size, &kind);
            // The turns are small, so the deltas stay: the shape is the edited one at the default weights.
            let positions = moved(&opened, |v| v % 3 != 0, |p| p + 0.1 * bent(p, size));
            let after = saved_glb(&opened, &positions);
            assert_within(&posed_with(&after, &[0.0, weight]).0, &positions, 1e-5 * size, &kind);
            // Everything turns far, so the deltas turn along: each target shows the turned figure that it showed
            // before.
            let turn = DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(0.4);
            let motion = |p: DVec3| turn * p + DVec3::ONE * size;
            let positions = moved(&opened, |_| true, motion);
            let after = saved_glb(&opened, &positions);
            for weights in [[0.0, weight], [1.0, weight], [1.0, 1.0], [0.0, 0.0]] {
                let wanted: Vec<DVec3> = posed_with(&before, &weights).0.into_iter().map(motion).collect();
                let found = posed_with(&after, &weights).0;
                assert_within(&found, &wanted, 1e-5 * size, &(kind, weights));
            }
        }
    }
}

#[test]
fn normals_turn_with_the_pose_that_is_shown() {
    for kind in figures() {
        let opened = open(&figure(&grid(6), kind).glb());
        let size = size_of(&opened.drawn.positions);
        let turn = DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(0.4);
        let positions = moved(&opened, |_| true, |p| turn * p + DVec3::ONE * size);
        let before = opened.scene.appearance().normals.unwrap();
        let wanted: Vec<DVec3> = before.iter().map(|n| turn * Vec3::from(*n).as_dvec3()).collect();
        let (_, normals) = posed(&saved_glb(&opened, &positions));
        assert_within(&normals, &wanted, 1e-4, &kind);
    }
}

#[test]
fn a_vertex_that_the_skin_flattens_is_named_and_left() {
    let kind = Figure {
        stored: Stored::Floats,
        scale: 1.0,
        two_sets: false,
        mirrored: false,
    };
    let mut maker = figure(&grid(3), kind);
    let attributes = &maker.root["meshes"][0]["primitives"][0]["attributes"];
    let [weights, stored] = ["WEIGHTS_0", "POSITION"].map(|key| attributes[key].as_u64().unwrap() as usize);
    let place = |maker: &Maker, accessor: usize| {
        let view = maker.root["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
        maker.root["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize
    };
    let (at, stored_at) = (place(&maker, weights) + 5 * 16, place(&maker, stored) + 5 * 12);
    maker.bin[at..at + 16].fill(0);
    let before = maker.glb();
    let opened = open(&before);
    let [note] = opened.scene.notes() else {
        panic!("{:?}", opened.scene.notes());
    };
    assert!(note.contains("node 0 flattens 1 vertex"), "{note}");
    let positions = moved(&opened, |_| true, |p| p + Vec4::ONE.truncate().as_dvec3());
    let after = saved_glb(&opened, &positions);
    let bytes = |file: &[u8]| split(file).1[stored_at..stored_at + 12].to_vec();
    assert_eq!(bytes(&before), bytes(&after));
    let again = open(&after).drawn.positions;
    for v in (0..positions.len()).filter(|v| *v != 5) {
        assert!(again[v].distance(positions[v]) < 1e-5, "vertex {v}");
    }
}

#[test]
fn a_skin_that_cannot_be_read_leaves_the_mesh_where_its_node_puts_it() {
    let kind = Figure {
        stored: Stored::Floats,
        scale: 1.0,
        two_sets: false,
        mirrored: false,
    };
    type Break = fn(&mut Value);
    let broken: [(&str, Break); 3] = [
        ("skin", |root| root["nodes"][0]["skin"] = 7.into()),
        ("joint", |root| root["skins"][0]["joints"] = json!([2, 3])),
        ("node", |root| root["skins"][0]["joints"][1] = 99.into()),
    ];
    for (what, change) in broken {
        let mut maker = figure(&grid(3), kind);
        maker.root["nodes"][0] = json!({ "mesh": 0, "skin": 0, "translation": [5, 0, 0] });
        change(&mut maker.root);
        let opened = open(&maker.glb());
        let [note] = opened.scene.notes() else {
            panic!("{:?}", opened.scene.notes());
        };
        assert!(note.contains(what) && note.contains("can't be read"), "{note}");
        let stored = Vec3::from(grid(3).positions[3]).as_dvec3();
        assert_eq!(opened.drawn.positions[3], stored + DVec3::X * 5.0);
    }
}
