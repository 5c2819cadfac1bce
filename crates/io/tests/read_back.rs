//! A save that is read back is held against what was to be saved: as it was written it passes, whatever the kinds, and
//! any other shape is found out.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::DVec3;
use pliant_io::{Format, MorphTarget, Placement, Save, Saved, SceneAndDrawn, read};
use pliant_mesh::{Cancel, DrawnVertex, Progress, shapes};

fn back(saved: &Saved, format: Format) -> SceneAndDrawn {
    let bytes = saved.files[0].bytes.clone();
    read(bytes, format, "back", saved, &Progress::new(), &Cancel::new()).unwrap()
}

/// A mesh as OFF, with quads among its faces, far from the origin and hardly larger than there are digits for in f32.
fn source(at: DVec3) -> SceneAndDrawn {
    let grid = shapes::grid(6, 5);
    let mut text = format!("OFF\n{} {} 0\n", grid.positions.len(), grid.triangles.len() - 1);
    for p in &grid.positions {
        text += &format!(
            "{:?} {:?} {:?}\n",
            p.x + at.x,
            p.y + at.y,
            0.3 * (p.x * p.y).sin() + at.z
        );
    }
    let [first, second] = [grid.triangles[0], grid.triangles[1]];
    let [a, b, c] = first.map(|corner| corner.0);
    let fourth = second
        .map(|corner| corner.0)
        .into_iter()
        .find(|corner| ![a, b, c].contains(corner))
        .unwrap();
    // The two triangles share an edge: between its ends lies the fourth corner.
    let shared = |corner: &u32| second.iter().any(|other| other.0 == *corner);
    let ring = match (shared(&a), shared(&b), shared(&c)) {
        (true, true, false) => [a, fourth, b, c],
        (false, true, true) => [a, b, fourth, c],
        _ => [a, b, c, fourth],
    };
    text += &format!("4 {} {} {} {}\n", ring[0], ring[1], ring[2], ring[3]);
    for triangle in &grid.triangles[2..] {
        let [a, b, c] = triangle.map(|corner| corner.0);
        text += &format!("3 {a} {b} {c}\n");
    }
    let empty = Saved {
        files: Vec::new(),
        warnings: Vec::new(),
        triangles: None,
    };
    read(
        text.into_bytes(),
        Format::Off,
        "source.off",
        &empty,
        &Progress::new(),
        &Cancel::new(),
    )
    .unwrap()
}

fn bent(positions: &[DVec3]) -> Vec<DVec3> {
    positions
        .iter()
        .map(|p| *p + DVec3::new(0.1, 0.0, 0.7) * (p.x - positions[0].x).powi(2))
        .collect()
}

#[test]
fn what_was_saved_passes_and_anything_else_is_found_out() {
    for at in [DVec3::ZERO, DVec3::new(4.5e6, 5.1e6, 300.0)] {
        let off = source(at);
        for first in Format::ALL {
            let save = |of: &SceneAndDrawn, positions: &[DVec3], format: Format| {
                let save = Save {
                    turned: &[],
                    drawn: &of.drawn,
                    positions,
                    format,
                    name: "out",
                    placement: Placement::OtherFolder,
                };
                of.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap()
            };
            // The mesh as each kind, and that saved as each kind again.
            let rest = save(&off, &off.drawn.positions, first);
            let opened = back(&rest, first);
            let new = bent(&opened.drawn.positions);
            for second in Format::ALL {
                let saved = save(&opened, &new, second);
                let found = back(&saved, second);
                let check = |positions: &[DVec3], found: &SceneAndDrawn| {
                    let save = Save {
                        turned: &[],
                        drawn: &opened.drawn,
                        positions,
                        format: second,
                        name: "out",
                        placement: Placement::OtherFolder,
                    };
                    opened
                        .scene
                        .check_read_back(&save, None, saved.triangles.as_deref(), found)
                };
                check(&new, &found).unwrap_or_else(|what| panic!("{first} to {second} at {at}: {what}"));
                // One vertex a thousandth off.
                let mut other = new.clone();
                let used = opened.drawn.triangles[7][1].index();
                other[used].y += 1e-3 * at.length().max(1.0).sqrt();
                assert!(
                    check(&other, &found).unwrap_err().contains("instead of"),
                    "{first} to {second}"
                );
                assert!(check(&opened.drawn.positions, &found).is_err());
                // A face that joins other vertices, and one that is gone.
                let mut turned = back(&saved, second);
                turned.drawn.triangles.pop();
                let is_by_faces = !matches!(second, Format::Glb | Format::Gltf | Format::Stl) && first != second;
                assert!(is_by_faces || check(&new, &turned).is_err(), "{first} to {second}");
                if matches!(second, Format::Glb | Format::Gltf) {
                    let mut turned = back(&saved, second);
                    // Far away single precision leaves some triangles no extent: one that has it.
                    let positions = &turned.drawn.positions;
                    let reach = |triangle: &[DrawnVertex; 3]| {
                        let ways = triangle.map(|v| positions[v.index()].distance(positions[0]));
                        ways.into_iter().fold(0.0, f64::max)
                    };
                    let triangles = turned.drawn.triangles.iter().enumerate();
                    let farthest = triangles.max_by(|a, b| reach(a.1).total_cmp(&reach(b.1)));
                    let farthest = farthest.unwrap().0;
                    turned.drawn.triangles[farthest] = [DrawnVertex(0); 3];
                    assert!(check(&new, &turned).is_err(), "{first} to {second}");
                }
            }
        }
    }
}

#[test]
fn a_morph_target_shows_as_far_as_its_weight() {
    let off = source(DVec3::ZERO);
    let new = bent(&off.drawn.positions);
    for weight in [0.0, 0.25, 1.0] {
        let morph = MorphTarget { name: "bent", weight };
        let save = Save {
            turned: &[],
            drawn: &off.drawn,
            positions: &new,
            format: Format::Glb,
            name: "o.glb",
            placement: Placement::OtherFolder,
        };
        let saved = off
            .scene
            .save_as_morph(&save, &morph, &Progress::new(), &Cancel::new())
            .unwrap();
        let found = back(&saved, Format::Glb);
        let check = |weight| {
            let morph = MorphTarget { name: "bent", weight };
            off.scene
                .check_read_back(&save, Some(&morph), saved.triangles.as_deref(), &found)
        };
        check(weight).unwrap();
        assert!(check(weight + 0.01).is_err());
    }
}

#[test]
fn text_that_names_single_precision_passes_as_it_was_written() {
    let grid = shapes::grid(6, 5);
    for named in ["float", "double"] {
        let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", grid.positions.len());
        text += &["x", "y", "z"]
            .map(|axis| format!("property {named} {axis}\n"))
            .concat();
        text += &format!("element face {}\n", grid.triangles.len());
        text += "property list uchar int vertex_indices\nend_header\n";
        grid.positions
            .iter()
            .for_each(|p| text += &format!("{} {} {}\n", p.x, p.y, p.z));
        for triangle in &grid.triangles {
            let [a, b, c] = triangle.map(|corner| corner.0);
            text += &format!("3 {a} {b} {c}\n");
        }
        let empty = Saved {
            files: Vec::new(),
            warnings: Vec::new(),
            triangles: None,
        };
        let read = |bytes| read(bytes, Format::Ply, "a.ply", &empty, &Progress::new(), &Cancel::new()).unwrap();
        let opened = read(text.into_bytes());
        let mut positions = opened.drawn.positions.clone();
        for (k, p) in positions.iter_mut().enumerate() {
            *p += DVec3::new(1.0, 0.1, 0.001) * (k as f64).sin();
        }
        let mut save = Save {
            turned: &[],
            drawn: &opened.drawn,
            positions: &positions,
            format: Format::Ply,
            name: "b.ply",
            placement: Placement::OtherFolder,
        };
        let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
        let back = read(saved.files[0].bytes.clone());
        assert_eq!(
            opened.scene.check_read_back(&save, None, None, &back),
            Ok(()),
            "{named}"
        );
        let mut other = positions.clone();
        other[7].y += 1e-6;
        save.positions = &other;
        assert!(
            opened.scene.check_read_back(&save, None, None, &back).is_err(),
            "{named}"
        );
    }
}
