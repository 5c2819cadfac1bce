//! `pliant flow`: dye along a surface, saved as vertex colours.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_engine::Loaded;
use pliant_engine::files::Staging;
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::watch::Watch;
use pliant_mesh::{Cancel, Progress, WeldOptions, shapes};
use pliant_tests::{Ended, Folder, open, run};
use serde_json::{Value, json};

fn flow(folder: &Folder, file: &str, flow: &Value, out: &Path, more: &[&str]) -> Ended {
    fs::write(folder.at("flow.json"), flow.to_string()).unwrap();
    let words = ["flow".into(), folder.at(file).into_os_string(), "--flow".into()];
    let rest = [folder.at("flow.json").into_os_string(), "--output".into(), out.into()];
    run(words.into_iter().chain(rest).chain(more.iter().map(Into::into)))
}

/// A red cap on a sphere that turns about z.
fn turning(seconds: f64) -> Value {
    json!({
        "version": 1,
        "dye": [{ "select": { "sphere": { "center": [1, 0, 0], "radius": 0.5 } }, "color": [1, 0, 0] }],
        "velocity": [{ "select": "all", "spin": { "axis": [0, 0, 1], "rate": 2, "center": [0, 0, 0] } }],
        "step": 0.05,
        "seconds": seconds,
    })
}

fn colours(path: &Path) -> Vec<[u16; 4]> {
    open(path).scene.appearance().colours.unwrap()
}

#[test]
fn a_cap_turns_with_its_sphere_in_every_format_and_nothing_else_changes() {
    let folder = Folder::new();
    folder.write_mesh("ball.off", &shapes::icosphere(4));
    for name in ["out.off", "out.glb", "out.ply", "out.obj"] {
        let (out, report) = (folder.at(name), folder.at("report.json"));
        let report_at = report.to_str().unwrap();
        flow(&folder, "ball.off", &turning(0.5), &out, &["--report", report_at]).done();
        let (before, after) = (open(&folder.at("ball.off")), open(&out));
        assert_eq!(
            before.model.surface.triangles.len(),
            after.model.surface.triangles.len()
        );
        let positions = after.model.rest_positions();
        // The cap is now 1 radian further: clear fluid is white, so green tells the dye.
        let mut middle = DVec3::ZERO;
        for (position, [red, green, _, alpha]) in positions.iter().zip(colours(&out)) {
            assert!(red > 65_000 && alpha == u16::MAX, "red over white is red");
            middle += *position * (1.0 - f64::from(green) / f64::from(u16::MAX));
        }
        assert!((middle.y.atan2(middle.x) - 1.0).abs() < 0.06, "{name}: {middle}");
        let report: Value = serde_json::from_slice(&fs::read(&report).unwrap()).unwrap();
        assert_eq!(report["frames"]["count"], 10);
        assert!(report["divergence"].as_f64().unwrap() < 1e-9);
        let dye = |at: &str| report["dye"][at][3].as_f64().unwrap();
        assert!(dye("start") > 0.1 && (dye("end") / dye("start") - 1.0).abs() < 0.01);
    }
}

#[test]
fn number_signs_write_a_file_for_the_start_and_each_step() {
    let folder = Folder::new();
    folder.write_mesh("ball.off", &shapes::icosphere(2));
    flow(&folder, "ball.off", &turning(0.15), &folder.at("ball-####.ply"), &[]).done();
    for step in 0..4 {
        assert!(folder.at(&format!("ball-{step:04}.ply")).exists(), "{step}");
    }
    assert!(!folder.at("ball-0004.ply").exists() && !folder.at("ball-####.ply").exists());
    let dyed = |step: usize| {
        let colours = colours(&folder.at(&format!("ball-{step:04}.ply")));
        colours
            .iter()
            .map(|colour| u64::from(u16::MAX - colour[1]))
            .sum::<u64>()
    };
    assert!(dyed(0) > 0);
    // The file without a number is the last one.
    flow(&folder, "ball.off", &turning(0.15), &folder.at("last.ply"), &[]).done();
    assert_eq!(
        fs::read(folder.at("last.ply")).unwrap(),
        fs::read(folder.at("ball-0003.ply")).unwrap()
    );
}

#[test]
fn the_file_s_own_colours_stay_where_no_dye_is_and_without_dye_the_bytes_stay() {
    let folder = Folder::new();
    let file = "COFF\n5 4 0\n0 0 0 10 20 30 255\n1 0 0 10 20 30 255\n1 1 0 10 20 30 255\n0 1 0 10 20 30 255\n\
                0.5 0.5 0 40 50 60 255\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
    fs::write(folder.at("square.off"), file).unwrap();
    let dyed = json!({ "version": 1, "dye": [{ "select": { "vertices": [2] }, "color": [0, 0, 1] }], "seconds": 0.1 });
    flow(&folder, "square.off", &dyed, &folder.at("out.off"), &[]).done();
    let text = fs::read_to_string(folder.at("out.off")).unwrap();
    assert_eq!(text, file.replace("1 1 0 10 20 30 255", "1 1 0 0 0 255 255"));
    let clear = json!({ "version": 1, "velocity": [{ "select": "all", "push": [1, 0, 0] }], "seconds": 0.1 });
    flow(&folder, "square.off", &clear, &folder.at("clear.off"), &[]).done();
    assert_eq!(fs::read_to_string(folder.at("clear.off")).unwrap(), file);
}

#[test]
fn threads_don_t_change_a_byte() {
    let folder = Folder::new();
    folder.write_mesh("ball.off", &shapes::icosphere(3));
    let mut pulled = turning(0.2);
    pulled["gravity"] = json!([0, 0, -9.81]);
    pulled["viscosity"] = json!(0.001);
    pulled["confinement"] = json!(1);
    let outs: Vec<Vec<u8>> = ["1", "2", "3"]
        .iter()
        .map(|threads| {
            let out = folder.at("out.glb");
            flow(&folder, "ball.off", &pulled, &out, &["--threads", threads]).done();
            fs::read(out).unwrap()
        })
        .collect();
    assert!(outs[0] == outs[1] && outs[0] == outs[2]);
}

#[test]
fn what_can_t_be_done_is_refused_in_words_and_writes_nothing() {
    let folder = Folder::new();
    folder.write_mesh("ball.off", &shapes::icosphere(1));
    fs::write(folder.at("points.off"), "OFF\n2 0 0\n0 0 0\n1 0 0\n").unwrap();
    let with = |member: &str, value: Value| {
        let mut flow = turning(0.1);
        flow[member] = value;
        flow
    };
    for (file, flow_file, out, status, says) in [
        ("ball.off", turning(0.1), "out.stl", 1, "colours"),
        ("ball.off", turning(0.1), "out.txt", 2, "--output"),
        ("points.off", json!({ "version": 1 }), "out.off", 1, "triangle"),
        ("ball.off", with("speed", json!(1)), "out.off", 1, "speed"),
        (
            "ball.off",
            with("dye", json!([{ "select": "none", "color": [1, 1, 1] }])),
            "out.off",
            1,
            "dye[0]",
        ),
        (
            "ball.off",
            with("dye", json!([{ "select": { "vertices": [99] }, "color": [1, 1, 1] }])),
            "out.off",
            1,
            "99",
        ),
        (
            "ball.off",
            with("gravity", json!([0, 1e300, 0])),
            "out.off",
            1,
            "gravity",
        ),
    ] {
        flow(&folder, file, &flow_file, &folder.at(out), &[]).refused(status, &[says]);
        assert!(!folder.at(out).exists());
    }
}

#[test]
fn other_colours_are_saved_together_with_another_shape_and_turned_parts() {
    let folder = Folder::new();
    folder.write_mesh("ball.off", &shapes::icosphere(3));
    let load = |path: &Path| pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap();
    let save = |loaded: &Loaded, what: &SaveAs<'_>| {
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let saved = saving::stage(loaded, what, &Staging::default(), &progress, &cancel).unwrap();
        saved.staged.commit().unwrap();
    };
    for name in ["ball.off", "ball.ply", "ball.obj", "ball.glb"] {
        let original = load(&folder.at("ball.off"));
        let positions = original.model.rest_positions();
        save(&original, &SaveAs::shape(&positions, &folder.at(name)));
        let loaded = load(&folder.at(name));
        let rest = loaded.model.rest_positions();
        let moved: Vec<DVec3> = rest.iter().map(|p| *p * DVec3::new(1.0, 2.0, 1.0)).collect();
        let share = |p: &DVec3| ((0.5 + 0.5 * p.z.clamp(-1.0, 1.0)) * f64::from(u16::MAX)) as u16;
        let colours: Vec<[u16; 4]> = rest.iter().map(|p| [share(p), 0, u16::MAX, u16::MAX]).collect();
        for inside_out in [BTreeSet::new(), BTreeSet::from([0])] {
            for out in [name.replace("ball", "out"), "out.glb".to_owned()] {
                let path = folder.at(&out);
                let coloured = SaveAs {
                    colours: Some(&colours),
                    inside_out: &inside_out,
                    ..SaveAs::shape(&moved, &path)
                };
                save(&loaded, &coloured);
                let back = open(&path);
                let is_turned = !back.model.inside_out.is_empty();
                assert_eq!(is_turned, !inside_out.is_empty(), "{name} to {out}");
                let positions = back.model.rest_positions();
                for (position, [red, green, blue, _]) in positions.iter().zip(self::colours(&path)) {
                    let wanted = share(&(*position * DVec3::new(1.0, 0.5, 1.0)));
                    assert!(red.abs_diff(wanted) < 700, "{name} to {out}: {red} is not {wanted}");
                    assert_eq!([green, blue], [0, u16::MAX]);
                }
                assert!(positions.iter().any(|p| p.y > 1.9), "{name} to {out}");
            }
        }
    }
}
