//! Normals and tangents are carried along: exactly under rigid motion, alike for twins, close to recomputed ones.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{Maker, bent, cube, grid, moved, open, saved_glb, shapes, sphere, split};
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use pliant_mesh::geometry::face_normal;
use serde_json::{Value, json};

/// An attribute of mesh 0's first primitive, as stored.
fn stored<const N: usize>(glb: &[u8], attribute: &str) -> Vec<[f32; N]> {
    let (text, bin) = split(glb);
    let root: Value = serde_json::from_str(&text).unwrap();
    let accessor = root["meshes"][0]["primitives"][0]["attributes"][attribute]
        .as_u64()
        .unwrap() as usize;
    let accessor = &root["accessors"][accessor];
    let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    let number = |k: usize| f32::from_le_bytes(bin[start + 4 * k..start + 4 * k + 4].try_into().unwrap());
    (0..accessor["count"].as_u64().unwrap() as usize)
        .map(|element| std::array::from_fn(|lane| number(element * N + lane)))
        .collect()
}

fn nodes() -> Vec<(&'static str, Value, DAffine3)> {
    let turn = DQuat::from_xyzw(0.6, 0.0, 0.0, 0.8);
    let trs = |s: [f64; 3], r: DQuat, t: [f64; 3]| {
        let node = json!({ "mesh": 0, "scale": s, "rotation": r.to_array(), "translation": t });
        (node, DAffine3::from_scale_rotation_translation(s.into(), r, t.into()))
    };
    let named = |name, (node, world)| (name, node, world);
    vec![
        named("identity", trs([1.0; 3], DQuat::IDENTITY, [0.0; 3])),
        named("turned and shifted", trs([1.0; 3], turn, [3.0, -2.0, 1.0])),
        named("stretched", trs([1.0, 3.0, 0.25], turn, [0.0; 3])),
        named("mirrored", trs([-1.0, 2.0, 1.0], turn, [0.0; 3])),
    ]
}

#[test]
fn a_rigid_motion_turns_normals_and_tangents_rigidly_whatever_the_node() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 1.3);
    for (mesh, shape) in shapes() {
        for (node, json, world) in nodes() {
            let mut maker = Maker::default();
            maker.mesh(&shape);
            maker.node(json);
            let before = maker.glb();
            let opened = open(&before);
            let after = saved_glb(
                &opened,
                &moved(&opened, |_| true, |p| turn * p + DVec3::new(7.0, 8.0, 9.0)),
            );
            // World normals are transformed by the inverse transpose of the node's matrix, tangents by the matrix.
            let to_world = world.matrix3.inverse().transpose();
            let used: Vec<usize> = used_with_area(&opened);
            let pairs = stored::<3>(&before, "NORMAL")
                .into_iter()
                .zip(stored::<3>(&after, "NORMAL"));
            for (v, (old, new)) in pairs.enumerate().filter(|(v, _)| used.contains(v)) {
                let [old, new] = [old, new].map(|n| (to_world * Vec3::from(n).as_dvec3()).normalize());
                assert!(
                    (turn * old).distance(new) < 5e-7,
                    "{mesh}, {node}, vertex {v}: {old} became {new}"
                );
            }
            if node == "stretched" || node == "mirrored" {
                continue; // There stored tangents and normals aren't perpendicular in the world.
            }
            let pairs = stored::<4>(&before, "TANGENT")
                .into_iter()
                .zip(stored::<4>(&after, "TANGENT"));
            for (v, (old, new)) in pairs.enumerate().filter(|(v, _)| used.contains(v)) {
                assert_eq!(old[3], new[3]);
                let [old, new] = [old, new].map(|t| world.matrix3 * Vec3::from_slice(&t).as_dvec3());
                assert!((turn * old).distance(new) < 5e-7, "{mesh}, {node}, vertex {v}");
            }
        }
    }
}

/// Vertices of at least one triangle with an area.
fn used_with_area(opened: &pliant_io::SceneAndDrawn) -> Vec<usize> {
    let drawn = &opened.drawn;
    let has_area = |t: &&[pliant_mesh::DrawnVertex; 3]| {
        face_normal(t.map(|corner| drawn.positions[corner.index()])).length() > 0.5
    };
    let mut used: Vec<usize> = drawn
        .triangles
        .iter()
        .filter(has_area)
        .flatten()
        .map(|corner| corner.index())
        .collect();
    used.sort_unstable();
    used.dedup();
    used
}

#[test]
fn a_translation_leaves_normals_and_tangents_as_stored() {
    for (name, shape) in shapes() {
        let before = Maker::of(&shape).glb();
        let opened = open(&before);
        let after = saved_glb(&opened, &moved(&opened, |_| true, |p| p + DVec3::new(0.1, -2.3, 4.7)));
        assert_eq!(stored::<3>(&before, "NORMAL"), stored::<3>(&after, "NORMAL"), "{name}");
        assert_eq!(
            stored::<4>(&before, "TANGENT"),
            stored::<4>(&after, "TANGENT"),
            "{name}"
        );
    }
}

#[test]
fn on_a_smooth_mesh_carried_normals_are_near_recomputed_ones() {
    for shape in [grid(24), sphere(24)] {
        let before = Maker::of(&shape).glb();
        let opened = open(&before);
        let positions = moved(&opened, |_| true, bent);
        let normals = stored::<3>(&saved_glb(&opened, &positions), "NORMAL");
        let mut sums = vec![DVec3::ZERO; positions.len()];
        let mut rest_sums = sums.clone();
        for t in &opened.drawn.triangles {
            let area_normal = |p: &[DVec3]| {
                let [a, b, c] = t.map(|corner| p[corner.index()]);
                (b - a).cross(c - a)
            };
            for corner in t {
                sums[corner.index()] += area_normal(&positions);
                rest_sums[corner.index()] += area_normal(&opened.drawn.positions);
            }
        }
        for v in 0..positions.len() {
            let own = Vec3::from(shape.normals[v]).as_dvec3();
            // Open rims and poles have no reliable recomputed normal.
            if rest_sums[v] == DVec3::ZERO || own.angle_between(rest_sums[v]) > 0.02 {
                continue;
            }
            let angle = Vec3::from(normals[v]).as_dvec3().angle_between(sums[v]).to_degrees();
            assert!(angle < 5.0, "vertex {v}: {angle} degrees");
        }
    }
}

#[test]
fn twins_across_a_seam_stay_twins_and_hard_edges_stay_hard() {
    let shape = sphere(8);
    let opened = open(&Maker::of(&shape).glb());
    let after = saved_glb(&opened, &moved(&opened, |_| true, bent));
    let (positions, normals) = (stored::<3>(&after, "POSITION"), stored::<3>(&after, "NORMAL"));
    let mut twins = 0;
    for a in 0..shape.positions.len() {
        for b in 0..a {
            if shape.positions[a] == shape.positions[b] && shape.normals[a] == shape.normals[b] {
                assert_eq!(positions[a].map(f32::to_bits), positions[b].map(f32::to_bits));
                assert_eq!(normals[a].map(f32::to_bits), normals[b].map(f32::to_bits));
                twins += 1;
            }
        }
    }
    assert!(twins >= 9);

    let opened = open(&Maker::of(&cube()).glb());
    let sheared = moved(
        &opened,
        |_| true,
        |p| DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z) * p,
    );
    let after = saved_glb(&opened, &sheared);
    let normals = stored::<3>(&after, "NORMAL");
    for t in &opened.drawn.triangles {
        let face = face_normal(t.map(|corner| sheared[corner.index()]));
        for corner in t {
            let normal = Vec3::from(normals[corner.index()]).as_dvec3();
            assert!(normal.distance(face) < 1e-6, "a flat face's normals stay its own");
        }
    }
    let tangents = stored::<4>(&after, "TANGENT");
    for (normal, tangent) in normals.iter().zip(&tangents) {
        let (normal, tangent) = (Vec3::from(*normal), Vec3::from_slice(tangent));
        assert!(normal.dot(tangent).abs() < 1e-6 && (tangent.length() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn custom_normals_keep_their_angle_to_the_surface_and_their_length() {
    let mut shape = grid(6);
    for (v, normal) in shape.normals.iter_mut().enumerate() {
        let tilted = Vec3::new(0.3 * (v % 3) as f32, 0.2, 1.0).normalize() * if v % 2 == 0 { 1.0 } else { 0.5 };
        *normal = tilted.to_array();
    }
    shape.normals[5] = [0.0; 3];
    let before = Maker::of(&shape).glb();
    let opened = open(&before);
    let turn = DQuat::from_rotation_x(1.0);
    let normals = stored::<3>(&saved_glb(&opened, &moved(&opened, |_| true, |p| turn * p)), "NORMAL");
    for (old, new) in shape.normals.iter().zip(&normals) {
        let wanted = (turn * Vec3::from(*old).as_dvec3()).as_vec3();
        assert!(wanted.distance(Vec3::from(*new)) < 1e-6);
    }
}

#[test]
fn no_seam_shows_where_its_sides_differ_by_roundings() {
    let n = 12;
    let ring = 2 * n + 1;
    for (off, turn) in [(0.0, 0.0), (1e-6, 0.001), (6e-5, 0.01)] {
        let mut shape = sphere(n);
        for k in 0..=n {
            let v = (k * ring + 2 * n) as usize;
            let by = Vec3::new(0.7, -0.5, 0.3) * off;
            shape.positions[v] = (Vec3::from(shape.positions[v]) + by).to_array();
            let normal = Vec3::from(shape.normals[v]) + Vec3::new(-0.4, 0.8, 0.2) * turn;
            shape.normals[v] = normal.normalize().to_array();
        }
        let opened = open(&Maker::of(&shape).glb());
        let twist = |p: DVec3| DQuat::from_rotation_z(1.5 * p.z) * (p + DVec3::X * p.z * p.z);
        let after = stored::<3>(&saved_glb(&opened, &moved(&opened, |_| true, twist)), "NORMAL");
        for k in 1..n {
            let first = (k * ring) as usize;
            let [a, b] = [first, first + 2 * n as usize].map(|v| Vec3::from(after[v]).as_dvec3());
            let angle = a.angle_between(b);
            assert!(angle < 2.0 * f64::from(turn) + 1e-5, "ring {k} off by {off}: {angle}");
        }
    }
}
