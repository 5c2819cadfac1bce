//! Laws of parts that are turned inside out when they are saved: the file that is read back faces the other way and is
//! otherwise the same, turned twice the bytes are the same, and the check of the written file detects a missing turn.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::gltf_maker;
use crate::gltf_maker::{Folder, Maker, bent, cube, moved, shapes, sphere, try_open};
use glam::{DVec3, Vec3};
use pliant_io::{Format, MorphTarget, Placement, Save, SaveError, Saved, SceneAndDrawn};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Progress};
use serde_json::json;

fn request<'a>(of: &'a SceneAndDrawn, positions: &'a [DVec3], turned: &'a [bool], format: Format) -> Save<'a> {
    Save {
        drawn: &of.drawn,
        positions,
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned,
        format,
        name: "out",
        placement: Placement::OtherFolder,
    }
}

fn saved(of: &SceneAndDrawn, positions: &[DVec3], turned: &[bool], format: Format) -> Saved {
    let save = request(of, positions, turned, format);
    of.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap()
}

/// The file that is read back, after the check against the request.
fn back(of: &SceneAndDrawn, positions: &[DVec3], turned: &[bool], format: Format) -> SceneAndDrawn {
    let saved = saved(of, positions, turned, format);
    let back = opened(&saved.files[0].bytes, format, &saved);
    let check = |turned: &[bool]| {
        let save = request(of, positions, turned, format);
        of.scene.check_read_back(&save, None, saved.triangles.as_deref(), &back)
    };
    check(turned).unwrap_or_else(|what| panic!("{} to {format}: {what}", of.scene.format()));
    if turned.contains(&true) {
        assert!(
            check(&[]).is_err(),
            "{} to {format}: nothing was to be turned",
            of.scene.format()
        );
    }
    back
}

fn opened(bytes: &[u8], format: Format, neighbours: &Saved) -> SceneAndDrawn {
    let files = neighbours.files.iter();
    let folder = Folder(files.map(|file| (file.name.clone(), file.bytes.clone())).collect());
    try_open(bytes, format, &folder).unwrap()
}

fn six_volumes(drawn: &Drawn) -> f64 {
    let corners = drawn.triangles.iter();
    corners
        .map(|triangle| {
            let [a, b, c] = triangle.map(|v| drawn.positions[v.index()]);
            a.cross(b).dot(c)
        })
        .sum()
}

/// Two spheres of which the second is inside out: with everything that glTF's triangles carry.
fn spheres() -> (SceneAndDrawn, Vec<bool>) {
    let mut shape = sphere(6);
    let first = shape.positions.len();
    let count = shape.triangles.len();
    shape.join(&sphere(6), Vec3::X * 3.0);
    for triangle in &mut shape.triangles[count..] {
        triangle.swap(1, 2);
    }
    for normal in &mut shape.normals[first..] {
        *normal = normal.map(|number| -number);
    }
    let opened = gltf_maker::open(&Maker::of(&shape).glb());
    let turned = (0..shape.positions.len()).map(|v| v >= first).collect();
    (opened, turned)
}

#[test]
fn what_is_turned_faces_outwards_in_every_format_and_what_is_not_stays() {
    let (glb, _) = spheres();
    for first in Format::ALL {
        let source = back(&glb, &glb.drawn.positions, &[], first);
        let turned: Vec<bool> = source.drawn.positions.iter().map(|p| p.x > 1.5).collect();
        let volume = six_volumes(&source.drawn);
        assert!(volume.abs() < 1e-4, "{first}: the one takes away the other, {volume}");
        for second in Format::ALL {
            let after = back(&source, &source.drawn.positions, &turned, second);
            let volume = six_volumes(&after.drawn);
            assert!((volume / 6.0 - 2.0 * 4.0).abs() < 1.5, "{first} to {second}: {volume}");
            if let Some(normals) = after.scene.appearance().normals {
                // A vertex that only triangles without an area use has no side.
                let position = |v: DrawnVertex| after.drawn.positions[v.index()];
                let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length();
                let triangles = after.drawn.triangles.iter();
                for &v in triangles.filter(|corners| area(corners.map(position)) > 1e-6).flatten() {
                    let centre = if position(v).x > 1.5 {
                        3.0 * DVec3::X
                    } else {
                        DVec3::ZERO
                    };
                    let out = (position(v) - centre).dot(Vec3::from(normals[v.index()]).as_dvec3());
                    assert!(out > 0.9, "{first} to {second}, vertex {}: {out}", v.0);
                }
            }
        }
    }
}

#[test]
fn turned_twice_a_file_is_the_same_bytes() {
    let (glb, turned) = spheres();
    for format in Format::ALL.into_iter().filter(|format| *format != Format::Gltf) {
        let source = back(&glb, &glb.drawn.positions, &[], format);
        let bytes = saved(&source, &source.drawn.positions, &[], format).files[0]
            .bytes
            .clone();
        let turned: Vec<bool> = match format {
            Format::Glb => turned.clone(),
            _ => source.drawn.positions.iter().map(|p| p.x > 1.5).collect(),
        };
        let once = back(&source, &source.drawn.positions, &turned, format);
        let once_bytes = saved(&source, &source.drawn.positions, &turned, format).files[0]
            .bytes
            .clone();
        assert_ne!(once_bytes, bytes, "{format}");
        let twice = saved(&once, &once.drawn.positions, &turned, format).files[0]
            .bytes
            .clone();
        assert!(twice == bytes, "{format}");
    }
}

#[test]
fn moved_and_turned_at_once_is_turned_after_it_was_moved() {
    for (class, shape) in shapes() {
        let source = gltf_maker::open(&Maker::of(&shape).glb());
        let all = vec![true; source.drawn.positions.len()];
        let positions = moved(&source, |v| v % 3 > 0, bent);
        let at_once = back(&source, &positions, &all, Format::Glb);
        let bent = back(&source, &positions, &[], Format::Glb);
        let one_by_one = back(&bent, &bent.drawn.positions, &all, Format::Glb);
        let differences = at_once
            .scene
            .differences(&at_once.drawn, &one_by_one.scene, &one_by_one.drawn);
        assert!(differences.is_empty(), "{class}: {differences:?}");
    }
}

#[test]
fn strips_fans_and_corners_without_indices_become_lists_of_triangles() {
    let mut maker = Maker::default();
    let shape = cube();
    let corners: Vec<u32> = shape.triangles.concat();
    let listed = gltf_maker::Shape {
        positions: corners.iter().map(|&v| shape.positions[v as usize]).collect(),
        ..Default::default()
    };
    let position = maker.floats(&listed.positions);
    let strip = maker.floats(&[
        [0.0, 0.0, 2.0],
        [1.0, 0.0, 2.0],
        [0.0, 1.0, 2.0],
        [1.0, 1.0, 2.5],
        [0.0, 2.0, 2.0],
    ]);
    let mesh = maker.mesh_of(vec![
        json!({ "attributes": { "POSITION": position } }),
        json!({ "attributes": { "POSITION": strip }, "mode": 5 }),
        json!({ "attributes": { "POSITION": strip }, "mode": 6 }),
    ]);
    maker.node(json!({ "mesh": mesh }));
    // A mirrored node reverses all windings; turning it works all the same.
    maker.node(json!({ "mesh": mesh, "scale": [-1.0, 1.0, 1.0], "translation": [5.0, 0.0, 0.0] }));
    let source = gltf_maker::open(&maker.glb());
    let all = vec![true; source.drawn.positions.len()];
    let after = back(&source, &source.drawn.positions, &all, Format::Glb);
    assert!((six_volumes(&source.drawn) + six_volumes(&after.drawn)).abs() < 1e-9);
    assert_eq!(after.drawn.positions, source.drawn.positions);
    // In only one of its nodes it can't be turned.
    let half = all.len() / 2;
    let some: Vec<bool> = (0..all.len()).map(|v| v < half).collect();
    let save = request(&source, &source.drawn.positions, &some, Format::Glb);
    let refused = source.scene.save(&save, &Progress::new(), &Cancel::new());
    assert!(matches!(refused, Err(SaveError::CannotHold { .. })));
}

#[test]
fn a_morph_target_bends_what_was_turned() {
    let (source, turned) = spheres();
    let positions = moved(&source, |v| v % 2 == 0, bent);
    let target = MorphTarget {
        name: "bent",
        weight: 1.0,
    };
    let save = request(&source, &positions, &turned, Format::Glb);
    let saved = source
        .scene
        .save_as_morph(&save, &target, &Progress::new(), &Cancel::new());
    let saved = saved.unwrap();
    let back = opened(&saved.files[0].bytes, Format::Glb, &saved);
    let checked = source
        .scene
        .check_read_back(&save, Some(&target), saved.triangles.as_deref(), &back);
    checked.unwrap();
    assert_eq!(back.scene.morph_targets(), ["bent"]);
}

#[test]
fn an_obj_keeps_its_polygons_its_relative_numbers_and_its_comments_when_it_is_turned() {
    let text = "# a scan\nv 0 0 0\nv 1 0 0 # here\nv 1 1 0\nv 0 1 0\nvn 0 0 1.0\nvn 0 +0.0 -1\nf -4//1 -3//1 \\\n -2//1 -1//1 # face\nf 1//2 3//2 2//2\n";
    let source = try_open(text.as_bytes(), Format::Obj, &Folder::default()).unwrap();
    let all = vec![true; source.drawn.positions.len()];
    let after = saved(&source, &source.drawn.positions, &all, Format::Obj).files[0]
        .bytes
        .clone();
    let wanted = "# a scan\nv 0 0 0\nv 1 0 0 # here\nv 1 1 0\nv 0 1 0\nvn -0 -0 -1.0\nvn -0 -0.0 1\nf -4//1 -1//1 \\\n -2//1 -3//1 # face\nf 1//2 2//2 3//2\n";
    assert_eq!(String::from_utf8(after).unwrap(), wanted);
    back(&source, &source.drawn.positions, &all, Format::Obj);
}
