//! Files in, new shapes out.
#![allow(clippy::unwrap_used, reason = "a test that can't go on fails")]

use std::fs;
use std::path::{Path, PathBuf};

use pliant_engine::files::Staging;
use pliant_engine::stitching::{Cut, Fill, Holes, Merge, Replace, cut, fill, merge};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, load};
use pliant_io::Format;
use pliant_mesh::{Model, WeldOptions, shapes};

/// A sphere as an OBJ with texture coordinates, normals and two materials, without the faces whose middle is above
/// `height`.
fn textured_sphere(path: &Path, height: f64) {
    let sphere = shapes::uv_sphere(24, 36);
    let mut text = String::from("mtllib two.mtl\no ball\n");
    for p in &sphere.positions {
        text += &format!(
            "v {} {} {}\nvt {} {}\nvn {} {} {}\n",
            p.x,
            p.y,
            p.z,
            0.5 + 0.4 * p.x,
            0.5 + 0.4 * p.y,
            p.x,
            p.y,
            p.z
        );
    }
    for half in [false, true] {
        text += if half { "usemtl one\n" } else { "usemtl other\n" };
        for corners in &sphere.triangles {
            let middle = corners.iter().map(|v| sphere.positions[v.index()]).sum::<glam::DVec3>() / 3.0;
            if middle.z <= height && (middle.x > 0.0) == half {
                let [a, b, c] = corners.map(|v| v.0 + 1);
                text += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n");
            }
        }
    }
    fs::write(path, text).unwrap();
    let library = "newmtl one\nKd 1 0 0\nnewmtl other\nKd 0 0 1\n";
    fs::write(path.with_file_name("two.mtl"), library).unwrap();
}

fn filled(file: &Path, output: &Path, holes: Holes, replace: Replace) -> Result<Vec<String>, EngineError> {
    let report = output.with_extension("json");
    let job = Fill {
        file,
        holes,
        output,
        report: Some(&report),
        replace,
        weld: WeldOptions::default(),
    };
    let stitched = fill(&job, &Watch::default(), &Staging::default())?;
    let warnings = stitched.warnings.clone();
    stitched.commit(None)?;
    Ok(warnings)
}

fn model(path: &Path) -> std::sync::Arc<Model> {
    load(path, &WeldOptions::default(), &Watch::default()).unwrap().model
}

fn is_closed(model: &Model) -> bool {
    let topology = &model.topology;
    topology.is_closed() && topology.non_manifold_edges() + topology.misoriented_edges() == 0
}

fn paths<const N: usize>(names: [&str; N]) -> (tempfile::TempDir, [PathBuf; N]) {
    let folder = tempfile::tempdir().unwrap();
    let paths = names.map(|name| folder.path().join(name));
    (folder, paths)
}

#[test]
fn a_filled_file_of_every_format_is_closed_and_looks_as_before() {
    let (_folder, [file]) = paths(["holey.obj"]);
    textured_sphere(&file, 0.8);
    let before = load(&file, &WeldOptions::default(), &Watch::default()).unwrap();
    for format in Format::ALL {
        let output = file.with_file_name(format!("filled.{}", format.extension()));
        filled(&file, &output, Holes::Every, Replace::Never).unwrap();
        let after = load(&output, &WeldOptions::default(), &Watch::default()).unwrap();
        assert!(is_closed(&after.model), "{format}");
        let look = after.scene.appearance();
        if matches!(format, Format::Glb | Format::Gltf | Format::Obj) {
            let own: Vec<&str> = look.materials.iter().map(|material| &*material.name).collect();
            assert!(
                ["one", "other"].iter().all(|name| own.contains(name)),
                "{format}: {own:?}"
            );
            let (uvs, normals) = (look.uvs.unwrap(), look.normals.unwrap());
            let positions = after.model.rest_positions();
            for v in after
                .model
                .drawn_triangles()
                .into_iter()
                .flatten()
                .map(|corner| corner.index())
            {
                let position = positions[v];
                // The rim's coordinates and normals go on over the patch.
                let wanted = [0.5 + 0.4 * position.x, 0.5 - 0.4 * position.y];
                let off = (f64::from(uvs[v][0]) - wanted[0])
                    .abs()
                    .max((f64::from(uvs[v][1]) - wanted[1]).abs());
                assert!(off < 0.05, "{format}: {position} {:?} {wanted:?}", uvs[v]);
                let normal = glam::Vec3::from(normals[v]).as_dvec3();
                assert!(normal.dot(position.normalize()) > 0.97, "{format}: {position} {normal}");
            }
        }
        if format == Format::Obj {
            let old = before.model.rest_positions();
            assert!(after.model.surface.positions.len() > before.model.surface.positions.len());
            assert_eq!(after.model.rest_positions()[..2], old[..2]);
        }
    }
    let report = fs::read_to_string(file.with_file_name("filled.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(
        (&report["holes_filled"], &report["after"]["borders"]),
        (&1.into(), &0.into())
    );
    assert_eq!(report["self_intersections_added"], 0);
}

#[test]
fn a_file_is_replaced_only_on_request_and_refusals_are_words() {
    let (_folder, [file, closed, out]) = paths(["holey.obj", "closed.off", "out.off"]);
    textured_sphere(&file, 0.8);
    let bytes = fs::read(&file).unwrap();
    let said = filled(&file, &file, Holes::Every, Replace::Never).unwrap_err();
    assert!(said.to_string().contains("--replace"), "{said}");
    assert_eq!((said.status(), fs::read(&file).unwrap() == bytes), (2, true));
    let at = filled(&file, &out, Holes::At(800), Replace::Never)
        .unwrap_err()
        .to_string();
    assert!(at.contains("vertex 800"), "{at}");
    let far = filled(&file, &out, Holes::At(1_000_000), Replace::Never)
        .unwrap_err()
        .to_string();
    assert!(far.contains("no vertex 1000000"), "{far}");
    filled(&file, &closed, Holes::Largest(5), Replace::Never).unwrap();
    let none = filled(&closed, &out, Holes::Every, Replace::Never)
        .unwrap_err()
        .to_string();
    assert!(none.contains("no border") && !out.exists(), "{none}");
    filled(&file, &file, Holes::Every, Replace::WithOriginalKept).unwrap();
    assert!(is_closed(&model(&file)));
}

#[test]
fn a_cut_file_and_the_rest_of_it_merge() {
    let (_folder, [file, selector, upper, joins, whole]) =
        paths(["ball.obj", "cut.json", "upper.ply", "joins.json", "whole.glb"]);
    textured_sphere(&file, 2.0);
    fs::write(&selector, r#"{"slab": {"axis": "z", "from": 0, "to": 0.4}}"#).unwrap();
    let job = Cut {
        file: &file,
        delete: &selector,
        output: &upper,
        report: None,
        replace: Replace::Never,
        weld: WeldOptions::default(),
    };
    let (watch, staging) = (Watch::default(), Staging::default());
    cut(&job, &watch, &staging).unwrap().commit(None).unwrap();
    let left = model(&upper);
    assert_eq!(left.topology.boundary_loops().len(), 1);
    assert!(left.surface.positions.iter().all(|p| p.z > -0.2001));

    let request = r#"{"version": 1, "a": {"delete": {"slab": {"axis": "z", "from": 0.55, "to": 1}}},
        "b": {"transform": {"translation": [0, 0, 0.5], "scale": [1.1, 0.9, 1]}}}"#;
    fs::write(&joins, request).unwrap();
    let job = Merge {
        first: &file,
        second: &upper,
        joins: &joins,
        output: &whole,
        report: None,
        replace: Replace::Never,
        weld: WeldOptions::default(),
    };
    let (watch, staging) = (Watch::default(), Staging::default());
    merge(&job, &watch, &staging).unwrap().commit(None).unwrap();
    let joined = model(&whole);
    assert!(is_closed(&joined));
    assert_eq!(joined.topology.components().len(), 1);

    fs::write(&joins, r#"{"version": 1, "pairs": [[0, 5]]}"#).unwrap();
    let (watch, staging) = (Watch::default(), Staging::default());
    let said = merge(&job, &watch, &staging).unwrap_err().to_string();
    assert!(said.contains("ball.obj") && said.contains("no border"), "{said}");
}

/// The corners of an OBJ whose normal points against their face.
fn normals_against_faces(path: &Path) -> usize {
    let text = fs::read_to_string(path).unwrap();
    let (mut points, mut normals, mut against) = (Vec::new(), Vec::new(), 0);
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let kind = words.next();
        let mut vector = || {
            let [x, y, z] = [(); 3].map(|()| words.next().unwrap().parse().unwrap());
            glam::DVec3::new(x, y, z)
        };
        match kind {
            Some("v") => points.push(vector()),
            Some("vn") => normals.push(vector()),
            Some("f") => {
                let corners = words.map(|corner| {
                    let mut numbers = corner.split('/').map(|number| number.parse::<usize>().unwrap_or(0));
                    (numbers.next().unwrap() - 1, numbers.nth(1).unwrap() - 1)
                });
                let corners: Vec<(usize, usize)> = corners.collect();
                let [a, b, c] = [0, 1, 2].map(|k| points[corners[k].0]);
                let face = (b - a).cross(c - a);
                against += corners
                    .iter()
                    .filter(|corner| normals[corner.1].dot(face) < 0.0)
                    .count();
            }
            _ => {}
        }
    }
    assert!(!normals.is_empty());
    against
}

/// Normals go along with a part that is placed by a transform.
#[test]
fn normals_of_a_placed_part_turn_with_it() {
    let (_folder, [half, joins, output]) = paths(["half.obj", "joins.json", "whole.obj"]);
    textured_sphere(&half, 0.0);
    let placed =
        r#"{"version": 1, "b": {"placement": "kept", "transform": {"rotation": [1, 0, 0, 0], "pivot": [0, 0, 0]}}}"#;
    fs::write(&joins, placed).unwrap();
    let job = Merge {
        first: &half,
        second: &half,
        joins: &joins,
        output: &output,
        report: None,
        replace: Replace::Never,
        weld: WeldOptions::default(),
    };
    let merged = merge(&job, &Watch::default(), &Staging::default()).unwrap();
    merged.commit(None).unwrap();
    assert!(is_closed(&model(&output)));
    assert_eq!(normals_against_faces(&output), 0);
}

/// Triangles that belong to no surface are named.
#[test]
fn triangles_with_broken_coordinates_are_named() {
    let (_folder, [file, output]) = paths(["ball.obj", "filled.obj"]);
    textured_sphere(&file, 2.0);
    let text = fs::read_to_string(&file).unwrap();
    let start = text.match_indices("v ").nth(200).unwrap().0;
    let end = start + text[start..].find('\n').unwrap();
    fs::write(&file, format!("{}v nan 0 0{}", &text[..start], &text[end..])).unwrap();
    let warnings = filled(&file, &output, Holes::Every, Replace::Never).unwrap();
    let named = warnings.iter().any(|warning| warning.contains("not numbers"));
    assert!(named, "{warnings:?}");
}
