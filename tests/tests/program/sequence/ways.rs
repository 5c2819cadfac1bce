//! Ways through the frames: filters, footprints, a bent path, and another sequence that leads.

use std::fs;

use glam::DVec3;
use pliant_mesh::Drawn;
use pliant_tests::{largest_distance, open};
use serde_json::{Value, json};

use super::take::{FRAMES, Take, bilaplacian, edit, key, posed, turned};

#[test]
fn a_filter_calms_or_exaggerates_a_handles_way_and_keeps_the_ends_of_its_span() {
    let shake = |frame: usize| DVec3::new(0.0, 0.1 * f64::from(u8::from(frame % 2 == 1)), 0.02 * frame as f64);
    let take = Take::of(|frame| posed(|p| p + shake(frame) * (p.z / 4.0)));
    let centre = |folder: &str, frame: usize| take.shape(folder, frame)[300..=349].iter().sum::<DVec3>() / 50.0;
    let unrest = |folder: &str| -> f64 {
        let at = |frame: usize| centre(folder, frame);
        (2..FRAMES - 2)
            .map(|frame| (at(frame - 1) - 2.0 * at(frame) + at(frame + 1)).length())
            .sum()
    };
    for (kind, range) in [("smooth", 0.0..0.3), ("exaggerate", 1.5..3.0)] {
        let mut edit = edit(&bilaplacian(), json!([]));
        edit["filter"] = json!([{ "handle": "top", "span": [1, FRAMES - 2], "kind": kind, "width": 1.5 }]);
        take.edited(&edit, "out", &[]).done();
        for frame in [0, 1, FRAMES - 2, FRAMES - 1] {
            assert!(take.bytes("out", frame) == take.bytes("in", frame), "{kind}: {frame}");
        }
        let ratio = unrest("out") / unrest("in");
        assert!(range.contains(&ratio), "{kind}: {ratio}");
        // The handle keeps its shape.
        let (before, after) = (take.shape("in", 4), take.shape("out", 4));
        let shift = after[300] - before[300];
        assert!((300..=349).all(|v| (after[v] - before[v]).distance(shift) < 1e-9) && shift.length() > 1e-3);
        edit["filter"][0]["handle"] = json!("topp");
        take.edited(&edit, "no", &[])
            .refused(1, &["filter[0].handle", "did you mean `top`?"]);
        edit["filter"] = json!([{ "handle": "top", "span": [5, 2], "kind": kind }]);
        take.edited(&edit, "no", &[]).refused(1, &["filter[0].span is [5, 2]"]);
        take.folder
            .apply(&take.folder.at("in/walk-0.off"), &edit, &take.folder.at("no.off"), &[])
            .refused(1, &["filter"]);
    }
}

#[test]
fn footprints_rest_and_other_frames_keep_their_bytes() {
    // The bar stands on its lower end: it creeps, hops and creeps again, and sways above.
    let foot = |frame: usize| match frame {
        0..=2 => DVec3::new(0.01 * frame as f64, 0.0, 0.0),
        3..=5 => DVec3::new(0.3 * frame as f64, 0.0, 0.4),
        _ => DVec3::new(2.0, 0.01 * frame as f64, 0.0),
    };
    let take = Take::of(|frame| posed(|p| p + foot(frame) + DVec3::X * 0.02 * frame as f64 * p.z));
    let mut edit = json!({
        "version": 1,
        "fixed": { "ranges": [[200, 349]] },
        "handles": [{ "name": "foot", "select": { "ranges": [[0, 49]] } }],
        "footprints": [{ "handle": "foot", "up": "z", "height": 0.05, "speed": 0.1, "fade": 1 }],
    });
    for method in ["bilaplacian", "arap"] {
        edit["method"] = json!({ "name": method });
        let report_at = take.folder.at("report.json").to_string_lossy().into_owned();
        take.edited(&edit, "out", &["--report", &report_at]).done();
        let report: Value = serde_json::from_slice(&fs::read(&report_at).unwrap()).unwrap();
        assert_eq!(report["footprints"], 2, "{report}");
        for run in [0..=2, 6..=8] {
            let held = take.shape("in", (run.start() + run.end()) / 2);
            for frame in run {
                let away = largest_distance(&take.shape("out", frame)[..50], &held[..50]);
                assert!(away < 1e-6, "{method} at {frame}: {away}");
                assert_eq!(take.shape("out", frame)[200..], take.shape("in", frame)[200..]);
            }
        }
        // One frame beside each fades, and the frame in the middle of a footprint is its place.
        for frame in 0..FRAMES {
            let is_same = take.bytes("out", frame) == take.bytes("in", frame);
            assert_eq!(is_same, [1, 4, 7].contains(&frame), "{method} at {frame}");
        }
    }
    edit["method"] = json!({ "name": "primo" });
    take.edited(&edit, "no", &[])
        .refused(1, &["footprints", "`primo` moves a handle as a whole", "`arap`"]);
    edit["method"] = json!({ "name": "arap" });
    edit["keys"] = json!([{ "frame": 1, "span": [0, 2], "handles": { "foot": {} } }]);
    take.edited(&edit, "no", &[])
        .refused(1, &["footprints[0]", "keep one of them"]);
    edit["footprints"][0]["speed"] = json!(0);
    take.edited(&edit, "no", &[])
        .refused(1, &["footprints[0].speed is 0", "above 0"]);
    assert!(!take.folder.at("no").exists());
}

/// A body that walks straight ahead in x, sways and bobs.
fn walk(frame: usize) -> Drawn {
    let sway = DVec3::new(
        0.3 * frame as f64,
        0.05 * (1.3 * frame as f64).sin(),
        0.02 * (frame % 2) as f64,
    );
    posed(|p| p + sway + DVec3::Y * 0.1 * p.z * (frame as f64).cos())
}

#[test]
fn a_bent_path_carries_the_whole_body_upright_and_keys_act_on_it() {
    let take = Take::of(walk);
    let mut bent = edit(&bilaplacian(), json!([]));
    bent["path"] = json!({
        "handle": "top",
        "frames": [0, 4, 8],
        "translations": [[0, 0, 0], [0, 0.4, 0], [0, 1.5, 0.2]],
        "up": "z",
    });
    let report = take.folder.at("report.json").to_string_lossy().into_owned();
    take.edited(&bent, "out", &["--report", &report]).done();
    let report: Value = serde_json::from_slice(&fs::read(&report).unwrap()).unwrap();
    let mut last_heading = 0.0;
    for frame in 0..FRAMES {
        let (before, after) = (take.shape("in", frame), take.shape("out", frame));
        // The motion is rigid and keeps what is upright.
        let arm = |shape: &[DVec3]| shape[345] - shape[10];
        assert!((arm(&before).z - arm(&after).z).abs() < 1e-6);
        for other in [40, 170, 349] {
            let lengths = [&before, &after].map(|shape| shape[other].distance(shape[10]));
            assert!((lengths[0] - lengths[1]).abs() < 1e-6, "{frame}");
        }
        let heading = |shape: &[DVec3]| (shape[160] - shape[155]).truncate();
        let turn = heading(&before).angle_to(heading(&after));
        // It turns steadily.
        assert!(
            (turn - last_heading).abs() < 0.3,
            "{frame}: {turn} after {last_heading}"
        );
        last_heading = turn;
        let middle = |shape: &[DVec3]| shape[300..=349].iter().sum::<DVec3>() / 50.0;
        if let Some(place) = [0, 4, 8].iter().position(|own| *own == frame) {
            let way: Vec<f64> = serde_json::from_value(bent["path"]["translations"][place].clone()).unwrap();
            assert!((middle(&after) - middle(&before)).distance(DVec3::from_slice(&way)) < 1e-6);
        }
    }
    assert!(last_heading > 0.5, "{last_heading}");
    assert_eq!(report["frames"], FRAMES);
    // A key is the same to the handle, wherever the path takes it.
    let keys = json!([key(4, [2, 6], turned(0.8, [0.2, 0.0, 0.1]))]);
    bent["keys"] = keys.clone();
    take.edited(&bent, "both", &[]).done();
    take.edited(&edit(&bilaplacian(), keys), "keyed", &[]).done();
    let own = |folder: &str| {
        let shape = take.shape(folder, 4);
        shape[300..=349]
            .iter()
            .map(|place| place.distance(shape[10]))
            .collect::<Vec<f64>>()
    };
    for (both, keyed) in own("both").iter().zip(own("keyed")) {
        assert!((both - keyed).abs() < 1e-5, "{both} {keyed}");
    }
    // Without a handle's name the path is that of the whole body, which needs no handle at all.
    let mut whole = bent.clone();
    whole["path"].as_object_mut().unwrap().remove("handle");
    whole["handles"] = json!([]);
    whole["keys"] = json!([]);
    take.edited(&whole, "whole", &[]).done();
    for (frame, way) in [
        (0, DVec3::ZERO),
        (4, DVec3::new(0.0, 0.4, 0.0)),
        (8, DVec3::new(0.0, 1.5, 0.2)),
    ] {
        let middle = |folder: &str| {
            let shape = take.shape(folder, frame);
            shape.iter().sum::<DVec3>() / shape.len() as f64
        };
        assert!((middle("whole") - middle("in")).distance(way) < 1e-6, "{frame}");
    }
    // A foot that rests on its own way rests on the bent one, too.
    let hop = Take::of(|frame| {
        let way = [0.0, 0.01, 0.02, 0.5, 1.0, 1.5, 1.5, 1.51, 1.52][frame];
        let height = if (3..=5).contains(&frame) { 0.4 } else { 0.0 };
        posed(|p| p + DVec3::new(way + 0.1 * frame as f64 * p.z, 0.0, height))
    });
    let mut held = bent.clone();
    held["keys"] = json!([]);
    held["fixed"] = json!({ "ranges": [[200, 349]] });
    let select = json!({ "ranges": [[0, 49]] });
    held["handles"] = json!([{ "name": "foot", "select": select }, held["handles"][0]]);
    held["footprints"] = json!([{ "handle": "foot", "up": "z", "height": 0.05, "speed": 0.1, "fade": 1 }]);
    hop.edited(&held, "out", &[]).done();
    for run in [0..=2, 6..=8] {
        let middle = hop.shape("out", (run.start() + run.end()) / 2);
        for frame in run {
            let away = largest_distance(&hop.shape("out", frame)[..50], &middle[..50]);
            assert!(away < 1e-6, "{frame}: {away}");
        }
    }
    // At rest every byte stays.
    bent["keys"] = json!([]);
    let whole = bent["path"]["translations"].clone();
    for (translations, strength) in [(json!([[0, 0, 0], [0, 0, 0], [0, 0, 0]]), 1.0), (whole, 0.0)] {
        bent["strength"] = json!(strength);
        bent["path"]["translations"] = translations;
        take.edited(&bent, "rest", &[]).done();
        assert!((0..FRAMES).all(|frame| take.bytes("rest", frame) == take.bytes("in", frame)));
    }
    for (member, value, words) in [
        ("handle", json!("topp"), ["path.handle", "did you mean `top`?"]),
        ("frames", json!([0, 4, 9]), ["path.frames is 9", "from 0 to 8"]),
        ("frames", json!([0, 4, 4]), ["path", "ascending"]),
        (
            "frames",
            json!([0, 4]),
            ["2 frames and 3 translations", "one translation for each"],
        ),
    ] {
        let mut wrong = bent.clone();
        wrong["path"][member] = value;
        take.edited(&wrong, "no", &[]).refused(1, &words);
        assert!(!take.folder.at("no").exists());
    }
}

#[test]
fn a_mix_has_the_handles_of_one_sequence_and_the_details_of_the_other() {
    // One bends far and is smooth, the other bends little and has ripples.
    let bend = |frame: usize, p: DVec3| p + DVec3::X * 0.08 * frame as f64 * (p.z / 4.0).powi(2);
    let ripple = |frame: usize, p: DVec3| p + DVec3::Y * 0.03 * (9.0 * p.z + frame as f64).sin();
    let take = Take::of(|frame| posed(|p| ripple(frame, p)));
    fs::create_dir(take.folder.at("other")).unwrap();
    for frame in 0..FRAMES {
        take.folder
            .write_mesh(&format!("other/bend-{frame}.off"), &posed(|p| bend(frame, p)));
    }
    let mut mixed = edit(&bilaplacian(), json!([]));
    mixed["mix"] = json!({ "sequence": "other" });
    for threads in ["1", "3"] {
        take.edited(&mixed, threads, &["--threads", threads]).done();
    }
    let middle = |shape: &[DVec3]| shape[300..=349].iter().sum::<DVec3>() / 50.0;
    for frame in 0..FRAMES {
        assert!(take.bytes("1", frame) == take.bytes("3", frame), "{frame}");
        let other = open(&take.folder.at(&format!("other/bend-{frame}.off")))
            .model
            .rest_positions();
        let (own, after) = (take.shape("in", frame), take.shape("1", frame));
        // The handle is where the other sequence has it, in its own shape.
        assert!(middle(&after).distance(middle(&other)) < 1e-6, "{frame}");
        for vertex in [305, 320, 349] {
            let lengths = [&own, &after].map(|shape| shape[vertex].distance(shape[300]));
            assert!((lengths[0] - lengths[1]).abs() < 1e-6, "{frame}");
        }
        // The fixed end keeps its own motion, and the ripples stay between both.
        assert_eq!(after[..=80], own[..=80]);
        let rough = |shape: &[DVec3]| -> f64 {
            let rings = |v: usize| (shape[v] - 2.0 * shape[v + 12] + shape[v + 24]).y.abs();
            (120..240).map(rings).sum()
        };
        assert!(
            rough(&after) > 0.8 * rough(&own) && rough(&after) > 5.0 * rough(&other),
            "{frame}"
        );
    }
    // A share of the way is half of it.
    mixed["mix"]["share"] = json!(0.5);
    take.edited(&mixed, "half", &[]).done();
    for frame in 0..FRAMES {
        let [own, all, half] = ["in", "1", "half"].map(|folder| middle(&take.shape(folder, frame)));
        assert!(half.distance(0.5 * (own + all)) < 1e-6, "{frame}");
    }
    mixed["mix"]["share"] = json!(1.5);
    take.edited(&mixed, "no", &[])
        .refused(1, &["mix.share is 1.5", "from 0 to 1"]);
    mixed["mix"]["share"] = json!(1);
    let two = |sequence: &str| {
        let mut edit = mixed.clone();
        edit["mix"]["sequence"] = json!(sequence);
        edit
    };
    take.edited(&two("none"), "no", &[]).refused(1, &["none"]);
    take.edited(&mixed, "other", &[])
        .refused(2, &["--output", "other", "outside of it"]);
    let mut keyed = mixed.clone();
    keyed["keys"] = json!([key(4, [2, 6], json!({}))]);
    take.edited(&keyed, "no", &[])
        .refused(1, &["mix", "leads `top`", "mix.handles"]);
    fs::remove_file(take.folder.at("other/bend-8.off")).unwrap();
    take.edited(&mixed, "no", &[])
        .refused(1, &["other has 8 frames", "has 9"]);
    take.folder
        .apply(&take.folder.at("in/walk-0.off"), &mixed, &take.folder.at("no.off"), &[])
        .refused(1, &["mix", "pliant sequence"]);
    assert!(!take.folder.at("no").exists());
}
