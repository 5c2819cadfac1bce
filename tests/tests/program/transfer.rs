//! `pliant transfer`: a pose of one mesh on another.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::fs;
use std::path::Path;

use glam::{DAffine3, DQuat, DVec3};
use pliant_mesh::{Drawn, DrawnVertex, shapes};
use pliant_tests::{Ended, Folder, assets, diagonal, largest_distance, open, run};
use serde_json::json;

/// A bar along x, wider where `girth` is larger.
fn bar(girth: f64) -> Drawn {
    let mut bar = shapes::bar(16, 3, 3);
    for p in &mut bar.positions {
        let middle = DVec3::new(p.x, 1.5, 1.5);
        *p = middle + (*p - middle) * (1.0 + (girth - 1.0) * (p.x / 16.0));
    }
    bar
}

/// The far half turned about an elbow in the middle.
fn bent(shape: &Drawn, angle_rad: f64) -> Drawn {
    let mut bent = shape.clone();
    for p in &mut bent.positions {
        let elbow = DVec3::new(8.0, 1.5, 1.5);
        let share = ((p.x - 6.0) / 4.0).clamp(0.0, 1.0);
        *p = elbow + DQuat::from_rotation_y(-angle_rad * share) * (*p - elbow);
    }
    bent
}

fn transfer(folder: &Folder, names: [&str; 3], out: &Path, more: &[&str]) -> Ended {
    let files = names.map(|name| folder.at(name).into_os_string());
    let output = ["--output".into(), out.as_os_str().to_owned()];
    let more = more.iter().map(Into::into);
    run(std::iter::once("transfer".into())
        .chain(files)
        .chain(output)
        .chain(more))
}

fn positions(path: &Path) -> Vec<DVec3> {
    open(path).model.rest_positions()
}

/// The positions relative to their mean.
fn centred(positions: &[DVec3]) -> Vec<DVec3> {
    let middle = positions.iter().sum::<DVec3>() / positions.len() as f64;
    positions.iter().map(|p| *p - middle).collect()
}

#[test]
fn a_mesh_takes_on_its_own_pose_and_a_larger_one_a_larger_pose() {
    let folder = Folder::new();
    let (rest, pose) = (bar(1.0), bent(&bar(1.0), 1.2));
    folder.write_mesh("rest.off", &rest);
    let posed = folder.write_mesh("pose.off", &pose);
    let out = folder.at("out.off");
    transfer(&folder, ["rest.off", "pose.off", "rest.off"], &out, &[]).done();
    let size = diagonal(&rest.positions);
    assert!(largest_distance(&positions(&out), &positions(&posed)) < 1e-6 * size);

    let twice = DAffine3::from_scale(DVec3::splat(2.0));
    folder.write_mesh("twice.off", &shapes::moved(&rest, twice));
    let expected = folder.write_mesh("expected.off", &shapes::moved(&pose, twice));
    transfer(&folder, ["rest.off", "pose.off", "twice.off"], &out, &[]).done();
    assert!(largest_distance(&positions(&out), &positions(&expected)) < 2e-6 * size);
}

#[test]
fn another_shape_of_the_same_triangles_bends_by_the_same_angle() {
    let folder = Folder::new();
    folder.write_mesh("rest.off", &bar(1.0));
    folder.write_mesh("pose.off", &bent(&bar(1.0), 1.2));
    folder.write_mesh("thick.off", &bar(2.0));
    let expected = folder.write_mesh("expected.off", &bent(&bar(2.0), 1.2));
    let out = folder.at("out.off");
    transfer(&folder, ["rest.off", "pose.off", "thick.off"], &out, &[]).done();
    let (found, expected) = (centred(&positions(&out)), centred(&positions(&expected)));
    let size = diagonal(&expected);
    assert!(largest_distance(&found, &expected) < 0.03 * size);
}

#[test]
fn a_rigid_motion_turns_any_shape_as_a_whole() {
    let folder = Folder::new();
    let motion = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.3);
    for (name, shape) in shapes::classes() {
        if shape.triangles.is_empty() {
            continue;
        }
        folder.write_mesh("rest.off", &shape);
        folder.write_mesh("pose.off", &shapes::moved(&shape, motion));
        let target = shapes::moved(&shape, DAffine3::from_scale(DVec3::new(1.0, 1.3, 0.8)));
        folder.write_mesh("target.off", &target);
        let expected = folder.write_mesh("expected.off", &shapes::moved(&target, motion));
        let out = folder.at("out.off");
        let ended = transfer(&folder, ["rest.off", "pose.off", "target.off"], &out, &[]);
        ended.done();
        // Each part is compared separately: its displacement depends on the surfaces' sizes.
        let model = open(&out).model.clone();
        let missed: Vec<DVec3> = positions(&out)
            .iter()
            .zip(positions(&expected))
            .map(|(found, wanted)| *found - wanted)
            .collect();
        let part_of = |vertex: usize| {
            let vertex = model.drawn.surface_vertex(DrawnVertex(vertex as u32))?;
            Some(model.topology.component(vertex))
        };
        let size = diagonal(&target.positions);
        for part in 0..model.topology.components().len() as u32 {
            let own = (0..missed.len()).filter(|&vertex| part_of(vertex) == Some(part));
            let own: Vec<DVec3> = own.map(|vertex| missed[vertex]).collect();
            let turned = centred(&own).iter().map(|missed| missed.length()).fold(0.0, f64::max);
            assert!(turned < 1e-5 * size, "{name}, part {part}: {turned}");
        }
    }
}

#[test]
fn triangles_in_another_order_are_paired_and_those_without_a_pair_take_the_nearest_map() {
    let folder = Folder::new();
    let (rest, pose) = (bar(1.0), bent(&bar(1.0), 1.2));
    folder.write_mesh("rest.off", &rest);
    let posed = folder.write_mesh("pose.off", &pose);
    let count = rest.triangles.len();
    let mut shuffled = rest.clone();
    shuffled.triangles.reverse();
    folder.write_mesh("other.off", &shuffled);
    let out = folder.at("out.off");
    transfer(&folder, ["rest.off", "pose.off", "other.off"], &out, &[]).refused(1, &["--correspondences"]);

    let pair = |target: usize| [count - 1 - target, target];
    let size = diagonal(&rest.positions);
    for (step, most) in [(1, 1e-6), (3, 0.05)] {
        let pairs: Vec<_> = (0..count).step_by(step).map(pair).collect();
        folder.write("pairs.json", json!({ "triangles": pairs }).to_string());
        let pairs = folder.at("pairs.json");
        let more = ["--correspondences", pairs.to_str().unwrap()];
        transfer(&folder, ["rest.off", "pose.off", "other.off"], &out, &more).done();
        let (found, wanted) = (centred(&positions(&out)), centred(&positions(&posed)));
        assert!(largest_distance(&found, &wanted) < most * size, "every {step}");
    }
}

#[test]
fn what_does_not_belong_together_is_refused_by_name() {
    let folder = Folder::new();
    folder.write_mesh("rest.off", &bar(1.0));
    folder.write_mesh("pose.off", &shapes::bar(15, 3, 3));
    let out = folder.at("out.off");
    transfer(&folder, ["rest.off", "pose.off", "rest.off"], &out, &[])
        .refused(1, &["pose.off", "vertices", "triangles"]);
    folder.write_mesh("pose.off", &bent(&bar(1.0), 1.2));
    let pairs = folder.at("pairs.json");
    let more = ["--correspondences", pairs.to_str().unwrap()];
    for (text, word) in [
        ("{", "JSON"),
        ("{}", "triangles"),
        (r#"{"triangles": []}"#, "empty"),
        (r#"{"triangles": [[0]]}"#, "triangles[0]"),
        (r#"{"triangles": [[0, 0], [99999, 1]]}"#, "triangles[1]"),
        (r#"{"triangles": [[0, 0], [1, 0]]}"#, "once"),
    ] {
        folder.write("pairs.json", text);
        let ended = transfer(&folder, ["rest.off", "pose.off", "rest.off"], &out, &more);
        ended.refused(1, &["pairs.json", word]);
    }
    let rest = folder.at("rest.off");
    transfer(&folder, ["rest.off", "pose.off", "rest.off"], &rest, &[]).refused(2, &["--output"]);
    assert!(!out.exists());
}

#[test]
fn a_pose_is_saved_as_a_morph_target_of_the_other_mesh() {
    let folder = Folder::new();
    let sample = assets().join("bar.glb");
    let rest = open(&sample).model.rest();
    folder.write_mesh("rest.off", &rest);
    let turn = DAffine3::from_rotation_z(0.7);
    folder.write_mesh("turn.off", &shapes::moved(&rest, turn));
    folder.write("bar.glb", fs::read(&sample).unwrap());
    let out = folder.at("out.glb");
    transfer(&folder, ["rest.off", "turn.off", "bar.glb"], &out, &["--as-morph"]).done();
    let opened = open(&out);
    assert_eq!(opened.scene.morph_targets(), ["turn"]);
    let shape = folder.at("shape.glb");
    transfer(&folder, ["rest.off", "turn.off", "bar.glb"], &shape, &[]).done();
    let expected = shapes::moved(&rest, turn).positions;
    assert!(largest_distance(&positions(&shape), &expected) < 1e-5 * diagonal(&rest.positions));
}
