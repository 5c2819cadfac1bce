//! A save that is read back is compared with the intended one: the unchanged one passes in every format, and any other
//! shape is detected.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::DVec3;
use pliant_io::{Format, MorphTarget, Placement, Save, Saved, SceneAndDrawn, read};
use pliant_mesh::{Cancel, DrawnVertex, Progress, shapes};

fn back(saved: &Saved, format: Format) -> SceneAndDrawn {
    let bytes = saved.files[0].bytes.clone();
    read(bytes, format, "back", saved, &Progress::new(), &Cancel::new()).unwrap()
}

/// A mesh as OFF, with quads among its faces, far from the origin and hardly larger than the resolution of f32 there.
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
    // The two triangles share an edge, and the fourth corner is between its ends.
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
                    deltas: pliant_io::MorphDeltas::WhereFarOff,
                    turned: &[],
                    drawn: &of.drawn,
                    positions,
                    format,
                    name: "out",
                    placement: Placement::OtherFolder,
                };
                of.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap()
            };
            // The mesh in each format, and that saved in each format again.
            let rest = save(&off, &off.drawn.positions, first);
            let opened = back(&rest, first);
            let new = bent(&opened.drawn.positions);
            for second in Format::ALL {
                let saved = save(&opened, &new, second);
                let found = back(&saved, second);
                let check = |positions: &[DVec3], found: &SceneAndDrawn| {
                    let save = Save {
                        deltas: pliant_io::MorphDeltas::WhereFarOff,
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
                // One vertex wrong by a thousandth.
                let mut other = new.clone();
                let used = opened.drawn.triangles[7][1].index();
                other[used].y += 1e-3 * at.length().max(1.0).sqrt();
                assert!(
                    check(&other, &found).unwrap_err().contains("instead of"),
                    "{first} to {second}"
                );
                assert!(check(&opened.drawn.positions, &found).is_err());
                // A face with other vertices, and a missing one.
                let mut turned = back(&saved, second);
                turned.drawn.triangles.pop();
                let is_by_faces = !matches!(
                    second,
                    Format::Glb | Format::Gltf | Format::Stl | Format::Threemf | Format::Usdz
                ) && first != second;
                assert!(is_by_faces || check(&new, &turned).is_err(), "{first} to {second}");
                if matches!(second, Format::Glb | Format::Gltf) {
                    let mut turned = back(&saved, second);
                    // Far away single precision leaves some triangles no extent: this one has some.
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
            deltas: pliant_io::MorphDeltas::WhereFarOff,
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
            deltas: pliant_io::MorphDeltas::WhereFarOff,
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

/// The grid of [`source`] as text of each format, its coordinates written by `number`.
fn texts(number: impl Fn(f64) -> String) -> Vec<(Format, String)> {
    let grid = shapes::grid(4, 3);
    let vector = |p: DVec3| format!("{} {} {}", number(p.x), number(p.y), number(p.z));
    let points: Vec<String> = (grid.positions.iter())
        .map(|p| vector(DVec3::new(p.x / 3.0, p.y / 7.0, (p.x * 0.7 - p.y).sin())))
        .collect();
    let (vertices, faces) = (points.len(), grid.triangles.len());
    let mut ply = format!("ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n");
    ply += &format!("property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n");
    let (mut obj, mut stl, mut off) = (
        String::new(),
        "solid\n".to_owned(),
        format!("OFF\n{vertices} {faces} 0\n"),
    );
    for point in &points {
        ply += &format!("{point}\n");
        off += &format!("{point}\n");
        obj += &format!("v {point}\n");
    }
    for corners in &grid.triangles {
        let [a, b, c] = corners.map(|corner| corner.index());
        ply += &format!("3 {a} {b} {c}\n");
        off += &format!("3 {a} {b} {c}\n");
        obj += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
        stl += "facet normal 0 0 1\nouter loop\n";
        for v in [a, b, c] {
            stl += &format!("vertex {}\n", points[v]);
        }
        stl += "endloop\nendfacet\n";
    }
    stl += "endsolid\n";
    vec![
        (Format::Ply, ply),
        (Format::Off, off),
        (Format::Obj, obj),
        (Format::Stl, stl),
    ]
}

#[test]
fn text_of_any_number_of_digits_is_saved_and_read_back() {
    type Writer = fn(f64) -> String;
    type Way = fn(DVec3) -> DVec3;
    let writers: [(&str, Writer); 4] = [
        ("three digits", |x| format!("{x:.3}")),
        ("as f32", |x| format!("{}", x as f32)),
        ("nine decimals with an exponent", |x| format!("{x:.9e}")),
        ("as f64", |x| format!("{x}")),
    ];
    let ways: [(&str, Way); 3] = [
        ("turned", |p| {
            p + DVec3::new(0.3 * p.y, -0.2 * p.x, 0.1 * p.x * p.y + 0.01)
        }),
        ("moved along one axis", |p| p + DVec3::Z * 0.123_456_789),
        ("moved by less than f32 resolves", |p| p + p * 1e-12),
    ];
    for (digits, writer) in writers {
        for (format, text) in texts(writer) {
            let read = |bytes: Vec<u8>| {
                let empty = Saved {
                    files: Vec::new(),
                    warnings: Vec::new(),
                    triangles: None,
                };
                read(bytes, format, "a", &empty, &Progress::new(), &Cancel::new()).unwrap()
            };
            let opened = read(text.into_bytes());
            for (named, way) in ways {
                let positions: Vec<DVec3> = opened.drawn.positions.iter().map(|p| way(*p)).collect();
                let mut save = Save {
                    deltas: pliant_io::MorphDeltas::WhereFarOff,
                    turned: &[],
                    drawn: &opened.drawn,
                    positions: &positions,
                    format,
                    name: "b",
                    placement: Placement::OtherFolder,
                };
                let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
                let found = read(saved.files[0].bytes.clone());
                let checked = opened.scene.check_read_back(&save, None, None, &found);
                assert_eq!(checked, Ok(()), "{format} of {digits}, {named}");
                let mut other = positions.clone();
                other[5].y += 1e-6;
                save.positions = &other;
                let checked = opened.scene.check_read_back(&save, None, None, &found);
                assert!(checked.is_err(), "{format} of {digits}, {named}");
            }
        }
    }
}

/// A tube of quads whose diagonals are nearly equal, as OBJ with one `vn` line for all corners.
fn tube() -> (String, usize) {
    let (mut text, rings, sides) = (String::new(), 7, 9);
    for ring in 0..rings {
        for side in 0..sides {
            let (sin, cos) = (side as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
            text += &format!("v {cos} {} {sin}\n", 0.6 * ring as f64);
        }
    }
    text += "vn 0 0 1\n";
    for ring in 0..rings - 1 {
        for side in 0..sides {
            let next = (side + 1) % sides;
            let corners = [(ring, side), (ring, next), (ring + 1, next), (ring + 1, side)];
            let corners = corners.map(|(ring, side)| format!("{}//1", ring * sides + side + 1));
            text += &format!("f {}\n", corners.join(" "));
        }
    }
    (text, sides)
}

#[test]
fn a_bent_file_is_a_pose_of_the_file_whatever_its_polygons_are_cut_by() {
    let empty = Saved {
        files: Vec::new(),
        warnings: Vec::new(),
        triangles: None,
    };
    let read = |bytes: Vec<u8>, format| read(bytes, format, "a", &empty, &Progress::new(), &Cancel::new()).unwrap();
    let obj = read(tube().0.into_bytes(), Format::Obj);
    for format in [Format::Obj, Format::Ply, Format::Off] {
        let save = |of: &SceneAndDrawn, positions: &[DVec3]| {
            let save = Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn: &of.drawn,
                positions,
                format,
                name: "b",
                placement: Placement::OtherFolder,
            };
            let saved = of.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
            read(saved.files[0].bytes.clone(), format)
        };
        let rest = save(&obj, &obj.drawn.positions);
        let twisted = |p: &DVec3| glam::DQuat::from_rotation_y(0.5 * p.y) * *p + DVec3::X * 0.1 * p.y * p.y;
        let positions: Vec<DVec3> = rest.drawn.positions.iter().map(twisted).collect();
        let pose = save(&rest, &positions);
        assert_ne!(
            pose.drawn.triangles, rest.drawn.triangles,
            "{format}: it is cut otherwise, so the test tells something"
        );
        let found = pliant_io::positions_in_pose((&rest.scene, &rest.drawn), (&pose.scene, &pose.drawn)).unwrap();
        assert_eq!(found.len(), positions.len());
        for (found, wanted) in found.iter().zip(&positions) {
            assert!(found.distance(*wanted) < 1e-5, "{format}: {found} is not {wanted}");
        }
        let triangles = |difference: &pliant_io::Difference| difference.place.contains("triangles");
        let differences = rest.scene.differences(&rest.drawn, &pose.scene, &pose.drawn);
        assert!(!differences.iter().any(triangles), "{differences:?}");
        // A file with another face is not a pose.
        let text = tube()
            .0
            .replacen("f 1//1 2//1 11//1 10//1", "f 1//1 2//1 12//1 10//1", 1);
        let other = read(text.into_bytes(), Format::Obj);
        assert!(pliant_io::positions_in_pose((&rest.scene, &rest.drawn), (&other.scene, &other.drawn)).is_none());
    }
}
