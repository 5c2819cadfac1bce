//! `pliant animate`: an edit with keys over time.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_editor::Beginning;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;
use pliant_engine::{
    Animate, EditJob, EngineError, ExistingFrames, MORPH_TOLERANCE, animate as animate_files, memory, read_edit,
    stage_animation,
};
use pliant_mesh::{Cancel, Drawn, shapes};
use pliant_tests::morphs::Glb;
use pliant_tests::{Ended, Folder, diagonal, largest_distance, open, run};
use serde_json::{Value, json};

fn bar() -> Drawn {
    shapes::turned(40, 16, |share| {
        let cap = (share * (1.0 - share) * 40.0).clamp(0.0, 1.0).sqrt();
        glam::DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { 0.3 * cap }, 4.0 * share)
    })
}

/// An edit that holds one end of the bar and moves the other.
fn edit(method: &str, transform: &Value, keys: &Value) -> Value {
    let mut edit = json!({
        "version": 1,
        "method": { "name": method },
        "fixed": { "slab": { "axis": "z", "from": 0.0, "to": 0.15 } },
        "handles": [
            { "name": "top", "select": { "slab": { "axis": "z", "from": 0.85, "to": 1.0 } }, "transform": transform },
        ],
    });
    if !keys.is_null() {
        edit["keys"] = keys.clone();
    }
    edit
}

fn lifted() -> Value {
    json!({ "translation": [0.5, 0.0, 0.2], "rotation": [0.0, 0.3, 0.0, 0.95], "scale": [1.2, 1.0, 1.0] })
}

fn bent() -> Value {
    json!({ "translation": [-0.4, 0.3, 0.0], "rotation": [0.2, 0.0, 0.1, 0.97] })
}

fn keys() -> Value {
    json!([
        { "time": 0.0, "handles": { "top": {} } },
        { "time": 0.25, "handles": { "top": lifted() } },
        { "time": 0.5, "ease": "hold", "handles": { "top": bent() } },
    ])
}

/// The animation of an edit, by the engine itself.
fn animation<'a>(file: &'a Path, (edit, edit_path): (&'a Beginning, &'a Path), output: &'a Path) -> Animate<'a> {
    Animate {
        job: EditJob {
            file,
            edit,
            edit_path,
            output,
            report: None,
            weld: None,
            budget: memory::budget(),
        },
        name: "f",
        tolerance: MORPH_TOLERANCE,
        fps: 8.0,
        frames: ExistingFrames::Keep,
    }
}

fn animate(folder: &Folder, edit: &Value, out: &str, more: &[&str]) -> Ended {
    let (file, edit_at) = (folder.at("bar.off"), folder.write("edit.json", edit.to_string()));
    let words = ["animate".into(), file.into_os_string(), "--edit".into(), edit_at.into()];
    let rest = ["--output".into(), folder.at(out).into_os_string()];
    run(words.into_iter().chain(rest).chain(more.iter().map(Into::into)))
}

fn shape(path: &Path) -> Vec<DVec3> {
    open(path).model.rest_positions()
}

#[test]
fn a_frame_at_a_keys_time_is_the_shape_of_that_keys_transforms() {
    for (method, tolerance) in [("bilaplacian", 1e-9), ("poisson", 1e-9), ("arap", 1e-4)] {
        let folder = Folder::new();
        let file = folder.write_mesh("bar.off", &bar());
        animate(
            &folder,
            &edit(method, &json!({}), &keys()),
            "f-####.off",
            &["--fps", "8"],
        )
        .done();
        let frames: Vec<String> = folder
            .names()
            .into_iter()
            .filter(|name| name.starts_with("f-"))
            .collect();
        assert_eq!(
            frames,
            ["f-0000.off", "f-0001.off", "f-0002.off", "f-0003.off", "f-0004.off"]
        );
        let size = diagonal(&bar().positions);
        assert_eq!(
            fs::read(folder.at("f-0000.off")).unwrap(),
            fs::read(&file).unwrap(),
            "{method}: at rest the file stays as it is"
        );
        for (frame, transform) in [("f-0002.off", lifted()), ("f-0004.off", bent())] {
            let out = folder.at("pose.off");
            folder
                .apply(&file, &edit(method, &transform, &Value::Null), &out, &[])
                .done();
            let away = largest_distance(&shape(&folder.at(frame)), &shape(&out));
            assert!(away <= tolerance * size, "{method}, {frame}: {away}");
        }
        let between = largest_distance(&shape(&folder.at("f-0001.off")), &shape(&file));
        assert!(between > 0.05, "{method}: {between}");
    }
}

#[test]
fn a_frame_is_the_same_to_the_byte_whatever_comes_before_it() {
    for method in ["bilaplacian", "arap", "shells", "embedded"] {
        let folder = Folder::new();
        folder.write_mesh("bar.off", &bar());
        animate(
            &folder,
            &edit(method, &json!({}), &keys()),
            "f-####.off",
            &["--fps", "8"],
        )
        .done();
        let alone = json!([{ "time": 0.0, "handles": { "top": bent() } }]);
        animate(&folder, &edit(method, &json!({}), &alone), "a-####.off", &[]).done();
        let bytes = |name: &str| fs::read(folder.at(name)).unwrap();
        assert!(bytes("f-0004.off") == bytes("a-0000.off"), "{method}");
    }
}

#[test]
fn caches_have_the_numbered_files_positions_and_bytes_do_not_depend_on_threads() {
    let folder = Folder::new();
    folder.write_mesh("bar.off", &bar());
    let edit = edit("arap", &json!({}), &keys());
    animate(&folder, &edit, "f-####.off", &["--fps", "8"]).done();
    for threads in ["1", "2", "3"] {
        let out = format!("{threads}.pc2");
        animate(&folder, &edit, &out, &["--fps", "8", "--threads", threads]).done();
    }
    animate(&folder, &edit, "a.mdd", &["--fps", "8"]).done();
    let bytes = |name: &str| fs::read(folder.at(name)).unwrap();
    let pc2 = bytes("1.pc2");
    assert!(pc2 == bytes("2.pc2") && pc2 == bytes("3.pc2"));
    let vertices = shape(&folder.at("f-0000.off")).len();
    let (pc2, mdd) = (&pc2[32..], &bytes("a.mdd")[8 + 4 * 5..]);
    assert_eq!([pc2.len(), mdd.len()], [5 * 12 * vertices; 2]);
    let little = |at: usize| f32::from_le_bytes(std::array::from_fn(|byte| pc2[4 * at + byte]));
    let big = |at: usize| f32::from_be_bytes(std::array::from_fn(|byte| mdd[4 * at + byte]));
    for frame in 0..5 {
        for (vertex, position) in shape(&folder.at(&format!("f-000{frame}.off"))).iter().enumerate() {
            for (axis, number) in position.to_array().into_iter().enumerate() {
                let at = 3 * (frame * vertices + vertex) + axis;
                assert!(
                    (f64::from(little(at)) - number).abs() < 1e-6,
                    "frame {frame}, vertex {vertex}"
                );
                assert_eq!(little(at), big(at));
            }
        }
    }
}

#[test]
fn handles_without_keys_keep_their_own_transform_and_keys_come_in_any_order() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let mut two = edit("bilaplacian", &json!({}), &Value::Null);
    let middle = json!({ "slab": { "axis": "z", "from": 0.45, "to": 0.55 } });
    let still = json!({ "name": "middle", "select": middle, "transform": { "translation": [0.3, 0, 0] } });
    two["handles"].as_array_mut().unwrap().push(still);
    let out = folder.at("pose.off");
    let mut posed = two.clone();
    posed["handles"][0]["transform"] = lifted();
    folder.apply(&file, &posed, &out, &[]).done();
    two["keys"] = json!([
        { "time": 0.5, "handles": { "top": lifted() } },
        { "time": 0.25, "ease": "linear", "handles": {} },
        { "time": 0.125, "ease": "linear", "handles": { "top": {} } },
    ]);
    animate(&folder, &two, "f-#.off", &["--fps", "4"]).done();
    let last = largest_distance(&shape(&folder.at("f-2.off")), &shape(&out));
    assert!(last < 1e-9, "{last}");
    // Before its first key the top rests, and the middle is where it is.
    let mut first = two.clone();
    first.as_object_mut().unwrap().remove("keys");
    folder.apply(&file, &first, &out, &[]).done();
    let away = largest_distance(&shape(&folder.at("f-0.off")), &shape(&out));
    assert!(away < 1e-9, "{away}");
}

/// An edit whose handle follows a curve along the bar's upper end, by `bilaplacian`, of which `strength` is made.
fn curved(curve: &Value, transform: &Value, strength: &Value) -> Value {
    let mut edit = edit("bilaplacian", transform, &Value::Null);
    let mut own = json!({ "points": [[0, 0, 3.4], [0, 0, 3.7], [0, 0, 4.0]] });
    own.as_object_mut().unwrap().extend(curve.as_object().unwrap().clone());
    edit["handles"][0]["curve"] = own;
    edit["strength"] = strength.clone();
    edit
}

#[test]
fn curves_and_the_strength_meet_their_keys_and_rest_between_equal_ones() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let size = diagonal(&bar().positions);
    let bent_curve =
        json!({ "moved": [[0, 0, 3.4], [0.3, 0, 3.7], [0.9, 0, 3.8]], "twist": [0, 20, 60], "scale": [1, 1, 1.3] });
    let at_rest = json!({});
    // The curve, the strength and the transform at each key; the strength of the whole edit.
    let keyed = [
        (&at_rest, 1.0, json!({})),
        (&bent_curve, 0.4, lifted()),
        (&bent_curve, 0.4, lifted()),
        (&bent_curve, 1.0, lifted()),
    ];
    for (own, has_strengths) in [(1.0, true), (0.6, false)] {
        let mut over_time = curved(&at_rest, &json!({}), &json!(own));
        let key = |(place, (curve, strength, transform)): (usize, &(&Value, f64, Value))| {
            let mut key =
                json!({ "time": 0.25 * place as f64, "curves": { "top": curve }, "handles": { "top": transform } });
            if has_strengths {
                key["strength"] = json!(strength);
            }
            key
        };
        over_time["keys"] = keyed.iter().enumerate().map(key).collect();
        animate(&folder, &over_time, "f-##.off", &["--fps", "8", "--replace"]).done();
        let out = folder.at("pose.off");
        for (place, (curve, strength, transform)) in keyed.iter().enumerate() {
            let strength = if has_strengths { *strength } else { own };
            folder
                .apply(&file, &curved(curve, transform, &json!(strength)), &out, &[])
                .done();
            let frame = folder.at(&format!("f-{:02}.off", 2 * place));
            let away = largest_distance(&shape(&frame), &shape(&out));
            assert!(away <= 1e-9 * size, "key {place} of strength {strength}: {away}");
        }
        let bytes = |frame: u32| fs::read(folder.at(&format!("f-{frame:02}.off"))).unwrap();
        assert!(
            bytes(2) == bytes(3) && bytes(3) == bytes(4),
            "between two equal keys nothing moves"
        );
        assert_ne!(bytes(0), bytes(1));
        assert_eq!(bytes(4) == bytes(5), !has_strengths);
    }
}

#[test]
fn weights_of_examples_meet_their_keys() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let mut wide = bar();
    wide.positions.iter_mut().for_each(|position| position.x *= 1.5);
    folder.write_mesh("wide.off", &wide);
    let with = |weight: f64| {
        let mut edit = edit("shells", &json!({}), &Value::Null);
        edit["method"]["examples"] = json!([{ "file": "wide.off", "weight": weight }]);
        edit
    };
    let mut over_time = with(0.0);
    over_time["keys"] = json!([
        { "time": 0.0, "weights": [0.0] },
        { "time": 0.5, "weights": [0.8] },
        { "time": 1.0, "weights": [0.8] },
    ]);
    animate(&folder, &over_time, "f-#.off", &["--fps", "2"]).done();
    let out = folder.at("pose.off");
    folder.apply(&file, &with(0.8), &out, &[]).done();
    let away = largest_distance(&shape(&folder.at("f-1.off")), &shape(&out));
    assert!(away <= 1e-6, "{away}");
    assert!(largest_distance(&shape(&folder.at("f-0.off")), &shape(&out)) > 0.01);
    assert_eq!(
        fs::read(folder.at("f-1.off")).unwrap(),
        fs::read(folder.at("f-2.off")).unwrap()
    );
}

#[test]
fn numbered_files_replace_others_only_on_request() {
    let folder = Folder::new();
    folder.write_mesh("bar.off", &bar());
    let edit = edit("bilaplacian", &json!({}), &keys());
    folder.write("f-0003.off", "somebody's");
    let names = folder.names();
    animate(&folder, &edit, "f-####.off", &["--fps", "8"]).refused(2, &["1 numbered file,", "f-0003.off", "--replace"]);
    let edit_too: Vec<String> = folder.names().into_iter().filter(|name| name != "edit.json").collect();
    assert_eq!(edit_too, names);
    assert_eq!(fs::read(folder.at("f-0003.off")).unwrap(), b"somebody's");
    animate(&folder, &edit, "f-####.off", &["--fps", "8", "--replace"]).done();
    assert_ne!(fs::read(folder.at("f-0003.off")).unwrap(), b"somebody's");
    animate(&folder, &edit, "f-####.off", &["--fps", "8"]).refused(2, &["5 numbered files,", "f-0000.off"]);
    // Those of a longer animation stay, and are named.
    let shorter = animate(&folder, &edit, "f-####.off", &["--fps", "4", "--replace"]).done();
    assert!(
        shorter.err.contains("2 files from f-0003.off to f-0004.off"),
        "{}",
        shorter.err
    );
    assert!(folder.at("f-0004.off").exists());
}

#[test]
fn an_animation_that_is_stopped_anywhere_leaves_the_folder_as_it_was() {
    for out in ["f-#.off", "f.glb", "f.pc2"] {
        let folder = Folder::new();
        let file = folder.write_mesh("bar.off", &bar());
        let edit_at = folder.write("edit.json", edit("bilaplacian", &json!({}), &keys()).to_string());
        let edit = read_edit(&edit_at, &Watch::default()).unwrap();
        let output = folder.at(out);
        let animation = animation(&file, (&edit, &edit_at), &output);
        let mut stops = 0;
        for looks in (0..100).map(|step| step + step * step / 2) {
            let watch = Watch::cancelled_by(&Cancel::after_looks(looks));
            match animate_files(&animation, &watch, &Staging::default()) {
                Ok(_) => break,
                Err(EngineError::Interrupted) => stops += 1,
                Err(other) => panic!("{out} after {looks} looks: {other}"),
            }
            assert_eq!(folder.names(), ["bar.off", "edit.json"], "{out} after {looks} looks");
        }
        assert!((3..100).contains(&stops), "{out}: {stops}");
        assert!(folder.names().len() > 2, "{out}");
    }
}

#[test]
fn kept_dye_is_in_every_frame_and_in_a_gltf_and_named_where_it_can_not_be() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let edit_at = folder.write("edit.json", edit("bilaplacian", &json!({}), &keys()).to_string());
    let edit = read_edit(&edit_at, &Watch::default()).unwrap();
    let Beginning::Edit(with_keys) = &edit else { panic!() };
    let loaded = open(&file);
    let heights = loaded.model.surface.positions.iter().map(|at| at.z);
    let red = |height: f64| if height < 1.0 { [1.0, 0.0, 0.0, 1.0] } else { [0.0; 4] };
    let dye: Vec<[f32; 4]> = heights.map(red).collect();
    for (out, written) in [
        ("f-#.off", Some("f-1.off")),
        ("f.glb", Some("f.glb")),
        ("g-#.glb", Some("g-0.glb")),
        ("f-#.stl", None),
    ] {
        let output = folder.at(out);
        let animation = animation(&file, (&edit, &edit_at), &output);
        let (watch, staging) = (Watch::default(), Staging::default());
        let animated = stage_animation(&animation, &loaded, (with_keys, Some(&dye)), &watch, &staging).unwrap();
        let said = animated.report.warnings.join(" ");
        animated.staged.commit().unwrap();
        assert_eq!(
            said.contains("kept dye is not in it"),
            written.is_none(),
            "{out}: {said}"
        );
        let Some(written) = written else { continue };
        let colours = open(&folder.at(written)).scene.appearance().colours.unwrap();
        let is_red = |colour: &&[u16; 4]| colour[0] == u16::MAX && colour[1] == 0;
        let red = colours.iter().filter(is_red).count();
        assert!((1..colours.len()).contains(&red), "{out}: {red} of {}", colours.len());
    }
}

#[test]
fn keys_that_can_not_be_followed_are_refused_in_words_and_nothing_is_written() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let with = |keys: Value| edit("bilaplacian", &json!({}), &keys);
    let key = |time: f64, name: &str| json!({ "time": time, "handles": { name: lifted() } });
    for (edit, out, words) in [
        (
            edit("bilaplacian", &json!({}), &Value::Null),
            "f-####.off",
            ["keys", "add it"],
        ),
        (
            with(json!([key(0.0, "topp")])),
            "f-####.off",
            ["keys[0].handles", "did you mean `top`?"],
        ),
        (
            with(json!([key(-1.0, "top")])),
            "f-####.off",
            ["keys[0].time is -1", "at least 0"],
        ),
        (
            with(json!([key(1.0, "top"), key(1.0, "top")])),
            "f-####.off",
            ["keys[1].time is 1", "no other key"],
        ),
        (with(json!([key(1e9, "top")])), "f-####.off", ["--fps 24", "lower it"]),
        (with(keys()), "f.off", ["--output", "-####"]),
        (
            with(json!([{ "frame": 1, "span": [0, 2], "handles": { "top": lifted() } }])),
            "f-####.off",
            ["keys[0]", "pliant sequence"],
        ),
        (with(json!([{ "handles": {} }])), "f.pc2", ["keys[0]", "`time`"]),
        (with(keys()), "f-####.xyz", ["--output", "xyz"]),
        (
            with(json!([{ "time": 0, "curves": { "top": {} } }])),
            "f-####.off",
            ["keys[0].curves", "without a `curve`"],
        ),
        (
            with(json!([{ "time": 0, "strength": 1.5 }])),
            "f-####.off",
            ["keys[0].strength is 1.5", "from 0 to 1"],
        ),
        (
            with(json!([{ "time": 0, "weights": [0.5] }])),
            "f-####.off",
            ["has 1 `weights`", "0 examples"],
        ),
    ] {
        let ended = animate(&folder, &edit, out, &[]);
        assert!(ended.status == 1 || ended.status == 2, "{out}: {}", ended.status);
        let status = ended.status;
        ended.refused(status, &words);
        assert_eq!(folder.names(), ["bar.off", "edit.json"], "{words:?}");
    }
    // One shape is not an animation.
    folder
        .apply(&file, &with(keys()), &folder.at("one.off"), &[])
        .refused(1, &["has `keys`", "pliant animate"]);
}

#[test]
fn a_gltf_plays_every_frame_within_the_bound_by_few_targets_and_is_otherwise_the_file() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    // A file with an animation and targets of its own.
    let own = json!({ "version": 1, "method": { "name": "bilaplacian" } });
    folder.apply(&file, &own, &folder.at("bar.glb"), &[]).done();
    let edit_at = folder.write("first.json", edit("bilaplacian", &json!({}), &keys()).to_string());
    let words = |edit: &Path, from: &str, out: &str| {
        let words = [
            "animate".into(),
            folder.at(from).into_os_string(),
            "--edit".into(),
            edit.into(),
        ];
        words
            .into_iter()
            .chain(["--output".into(), folder.at(out).into_os_string()])
            .collect::<Vec<_>>()
    };
    run(words(&edit_at, "bar.glb", "own.glb")).done();
    for (method, most) in [("bilaplacian", 9), ("arap", 30)] {
        let edit_at = folder.write("second.json", edit(method, &json!({}), &keys()).to_string());
        let report_at = folder.at("report.json");
        let more = [
            ["--report".into(), report_at.clone().into_os_string()],
            ["--fps".into(), "16".into()],
        ];
        run(words(&edit_at, "own.glb", "out.glb")
            .into_iter()
            .chain(more.into_iter().flatten()))
        .done();
        run(words(&edit_at, "own.glb", "f-####.glb").into_iter().chain([
            "--fps".into(),
            "16".into(),
            "--replace".into(),
        ]))
        .done();
        let report: Value = serde_json::from_slice(&fs::read(report_at).unwrap()).unwrap();
        let (bound, error) = (
            report["morph"]["bound"].as_f64().unwrap(),
            &report["morph"]["largest_error"],
        );
        assert!(
            error.as_f64().unwrap() <= bound && report["frames"]["count"] == 9,
            "{report}"
        );
        let [before, after] = ["own.glb", "out.glb"].map(|name| Glb::of(&fs::read(folder.at(name)).unwrap()));
        let new = &after.json["meshes"][0]["primitives"][0]["targets"];
        let added = new.as_array().unwrap().len() - before.json["meshes"][0]["weights"].as_array().unwrap().len();
        assert_eq!(report["morph"]["targets"], added, "{method}");
        assert!(added <= most, "{method}: {added} targets");
        let frame = |frame: usize| {
            let bytes = fs::read(folder.at(&format!("f-{frame:04}.glb"))).unwrap();
            let glb = Glb::of(&bytes);
            let position = glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].clone();
            glb.floats(&position)
                .chunks(3)
                .map(DVec3::from_slice)
                .collect::<Vec<DVec3>>()
        };
        // At frames, and between them, where the shape is interpolated.
        for time in [0.0, 0.0625, 0.1, 0.25, 0.3, 0.375, 0.4375, 0.49, 0.5, 2.0] {
            let at = f64::min(time * 16.0, 8.0);
            let (from, to) = (frame(at.floor() as usize), frame(at.ceil() as usize));
            let pairs = from.iter().zip(&to);
            let wanted: Vec<DVec3> = pairs.map(|(from, to)| from.lerp(*to, at.fract())).collect();
            let away = largest_distance(&after.positions_at(time), &wanted);
            assert!(away <= 1.01 * bound, "{method} at {time}: {away} of {bound}");
            let is_clamped = |weight: &f64| (0.0..=1.0).contains(weight);
            assert!(after.weights_at(1, time).iter().all(is_clamped), "{method} at {time}");
            // The file's own animation is as before; it does not apply the new targets.
            let mut own = before.weights_at(0, time);
            own.resize(own.len() + added, 0.0);
            assert_eq!(after.weights_at(0, time), own);
        }
        // Its accessors are as before.
        let (mut whole, mut kept) = (after.json["accessors"].clone(), before.json["accessors"].clone());
        let count = kept.as_array_mut().unwrap().len();
        whole.as_array_mut().unwrap().truncate(count);
        assert_eq!(whole, kept);
        // A second run would give targets of the same names.
        run(words(&edit_at, "out.glb", "again.glb")).refused(1, &["morph target called second 1", "another name"]);
    }
}

#[test]
fn an_animation_at_rest_gives_a_gltf_back_and_few_moved_vertices_take_few_bytes() {
    let folder = Folder::new();
    folder.write_mesh("bar.off", &bar());
    let none = json!({ "version": 1, "method": { "name": "bilaplacian" } });
    folder
        .apply(&folder.at("bar.off"), &none, &folder.at("bar.glb"), &[])
        .done();
    let length = |name: &str| fs::read(folder.at(name)).unwrap().len();
    let run_with = |edit: &Value, out: &str| {
        let edit_at = folder.write("wave.json", edit.to_string());
        let words = [
            "animate".into(),
            folder.at("bar.glb").into_os_string(),
            "--edit".into(),
            edit_at.into(),
        ];
        run(words
            .into_iter()
            .chain(["--output".into(), folder.at(out).into_os_string()]))
        .done();
    };
    run_with(
        &edit("arap", &json!({}), &json!([{ "time": 0.0 }, { "time": 1.0 }])),
        "rest.glb",
    );
    assert!(fs::read(folder.at("rest.glb")).unwrap() == fs::read(folder.at("bar.glb")).unwrap());
    let whole = edit("bilaplacian", &json!({}), &keys());
    let mut few = whole.clone();
    few["region"] = json!({ "slab": { "axis": "z", "from": 0.8, "to": 1.0 } });
    run_with(&whole, "whole.glb");
    run_with(&few, "few.glb");
    let [rest, whole, few] = ["bar.glb", "whole.glb", "few.glb"].map(length);
    assert!(2 * (few - rest) < whole - rest, "{rest} {whole} {few}");
}
