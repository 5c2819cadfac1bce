//! Files in, new shapes out: formats, refusals and warnings.

use std::fs;
use std::path::Path;

use pliant_engine::load;
use pliant_engine::stitching::{CutAlong, Holes, Keep, Plane, Replace};
use pliant_engine::watch::Watch;
use pliant_io::Format;
use pliant_mesh::WeldOptions;

use crate::made::{cut_along, cut_out, filled, is_closed, merged, model, paths, textured_sphere};

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
    assert!(none.contains("no hole to fill") && !out.exists(), "{none}");
    filled(&file, &file, Holes::Every, Replace::WithOriginalKept).unwrap();
    assert!(is_closed(&model(&file)));
}

#[test]
fn a_cut_file_and_the_rest_of_it_merge() {
    let (_folder, [file, selector, upper, joins, whole]) =
        paths(["ball.obj", "cut.json", "upper.ply", "joins.json", "whole.glb"]);
    textured_sphere(&file, 2.0);
    fs::write(&selector, r#"{"slab": {"axis": "z", "from": 0, "to": 0.4}}"#).unwrap();
    cut_out(&file, &selector, &upper).unwrap();
    let left = model(&upper);
    assert_eq!(left.topology.boundary_loops().len(), 1);
    assert!(left.surface.positions.iter().all(|p| p.z > -0.2001));

    let request = r#"{"version": 1, "a": {"delete": {"slab": {"axis": "z", "from": 0.55, "to": 1}}},
        "b": {"transform": {"translation": [0, 0, 0.5], "scale": [1.1, 0.9, 1]}}}"#;
    fs::write(&joins, request).unwrap();
    merged([&file, &upper], &joins, &whole).unwrap();
    let joined = model(&whole);
    assert!(is_closed(&joined));
    assert_eq!(joined.topology.components().len(), 1);

    fs::write(&joins, r#"{"version": 1, "pairs": [[0, 5]]}"#).unwrap();
    let said = merged([&file, &upper], &joins, &whole).unwrap_err().to_string();
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
    merged([&half, &half], &joins, &output).unwrap();
    assert!(is_closed(&model(&output)));
    assert_eq!(normals_against_faces(&output), 0);
}

/// Triangles that belong to no surface go, and are counted.
#[test]
fn triangles_with_broken_coordinates_go_with_a_warning() {
    let (_folder, [file, output, selector, cut]) = paths(["ball.obj", "filled.obj", "cut.json", "cut.obj"]);
    textured_sphere(&file, 2.0);
    let text = fs::read_to_string(&file).unwrap();
    let start = text.match_indices("v ").nth(200).unwrap().0;
    let end = start + text[start..].find('\n').unwrap();
    fs::write(&file, format!("{}v nan 0 0{}", &text[..start], &text[end..])).unwrap();
    fs::write(&selector, r#"{"slab": {"axis": "z", "from": 0.9, "to": 1}}"#).unwrap();
    let broken = model(&file).findings.non_finite_triangles.count;
    assert!(broken > 0);
    for (output, warnings) in [
        (&output, filled(&file, &output, Holes::Every, Replace::Never).unwrap()),
        (&cut, cut_out(&file, &selector, &cut).unwrap()),
    ] {
        let sentence =
            format!("{broken} triangles with coordinates that are not numbers were left out of the new shape");
        assert!(warnings.contains(&sentence), "{warnings:?}");
        assert_eq!(model(output).findings.non_finite_triangles.count, 0);
    }
    assert!(is_closed(&model(&output)));
}

/// A transform that flattens a part, or takes it beyond the numbers of a surface, is the culprit.
#[test]
fn a_transform_that_leaves_no_surface_is_refused_in_words() {
    let (_folder, [half, joins, output]) = paths(["half.obj", "joins.json", "whole.obj"]);
    textured_sphere(&half, 0.0);
    for transform in [
        r#"{"translation": [1e300, 0, 0]}"#,
        r#"{"translation": [0, 1e30, 0]}"#,
        r#"{"scale": [1e90, 1e90, 1e90]}"#,
    ] {
        fs::write(
            &joins,
            format!(r#"{{"version": 1, "b": {{"transform": {transform}}}}}"#),
        )
        .unwrap();
        let said = merged([&half, &half], &joins, &output).unwrap_err().to_string();
        assert!(said.contains("the transform of B"), "{transform}: {said}");
        assert!(!output.exists());
    }
}

/// An iterative method that ends before it settles is named.
#[test]
fn a_part_that_did_not_settle_is_named() {
    let (_folder, [half, joins, output]) = paths(["half.obj", "joins.json", "whole.obj"]);
    textured_sphere(&half, 0.0);
    for (steps, is_named) in [(1, true), (400, false)] {
        let request = format!(
            r#"{{"version": 1, "method": {{"name": "arap", "max_iterations": {steps}}},
            "b": {{"transform": {{"scale": [1.2, 0.8, 1], "rotation": [1, 0, 0, 0]}}}}}}"#
        );
        fs::write(&joins, request).unwrap();
        let warnings = merged([&half, &half], &joins, &output).unwrap();
        let named = warnings.iter().any(|warning| warning.contains("had not settled"));
        assert_eq!(named, is_named, "{warnings:?}");
    }
}

/// Texture coordinates, normals and materials go on to the plane, in every format that has them.
#[test]
fn a_file_that_is_cut_along_a_plane_looks_as_before() {
    let (_folder, [file]) = paths(["ball.obj"]);
    textured_sphere(&file, 2.0);
    let plane = Plane::of(glam::DVec3::new(0.1, 0.2, 1.0), 0.33).unwrap();
    for format in Format::ALL {
        let output = file.with_file_name(format!("half.{}", format.extension()));
        cut_along(&file, CutAlong::Plane(plane, Keep::Negative), &output).unwrap();
        let after = load(&output, &WeldOptions::default(), &Watch::default()).unwrap();
        assert_eq!(after.model.topology.boundary_loops().len(), 1, "{format}");
        let positions = after.model.rest_positions();
        assert!(positions.iter().all(|&p| plane.distance(p) < 1e-6), "{format}");
        let look = after.scene.appearance();
        if matches!(format, Format::Glb | Format::Gltf | Format::Obj) {
            assert_eq!(look.groups.len(), 2, "{format}");
            let (uvs, normals) = (look.uvs.unwrap(), look.normals.unwrap());
            for (v, position) in positions.iter().enumerate() {
                let wanted = [0.5 + 0.4 * position.x, 0.5 - 0.4 * position.y];
                let off = [0, 1].map(|k| (f64::from(uvs[v][k]) - wanted[k]).abs());
                assert!(
                    off[0].max(off[1]) < 1e-6,
                    "{format}: {position} {:?} {wanted:?}",
                    uvs[v]
                );
                let normal = glam::Vec3::from(normals[v]).as_dvec3();
                assert!(normal.dot(position.normalize()) > 0.99, "{format}: {position} {normal}");
            }
        }
    }
}

/// A sphere with two holes becomes a ring, and the texture coordinates of each border go on over its half of the tube.
#[test]
fn two_borders_of_a_file_are_joined_by_a_tube() {
    let (_folder, [file, selector, open, output]) = paths(["ball.obj", "cut.json", "open.obj", "ring.glb"]);
    textured_sphere(&file, 2.0);
    let ends =
        r#"{"union": [{"slab": {"axis": "z", "from": 0, "to": 0.1}}, {"slab": {"axis": "z", "from": 0.9, "to": 1}}]}"#;
    fs::write(&selector, ends).unwrap();
    cut_out(&file, &selector, &open).unwrap();
    let before = model(&open);
    let loops = before.topology.boundary_loops();
    let ends = [0, 1].map(|k| before.first_file_vertex(loops[k][0]).0);
    filled(&open, &output, Holes::Between(ends), Replace::Never).unwrap();
    assert!(is_closed(&model(&output)));
    let report = fs::read_to_string(output.with_extension("json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(
        (&report["after"]["genus"], &report["after"]["components"]),
        (&1.into(), &1.into())
    );
    let looks = load(&output, &WeldOptions::default(), &Watch::default())
        .unwrap()
        .scene
        .appearance();
    assert!(
        looks
            .uvs
            .unwrap()
            .iter()
            .flatten()
            .all(|number| (0.0..=1.0).contains(number))
    );
}
