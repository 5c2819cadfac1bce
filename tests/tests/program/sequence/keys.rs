//! Keys that spread over the frames around them.

use std::fs;

use glam::{DQuat, DVec3};
use pliant_mesh::shapes;
use pliant_tests::{diagonal, largest_distance, open, run};
use serde_json::{Value, json};

use super::take::{FRAMES, Take, bar, bilaplacian, edit, key, posed, rigid, swaying, turned};

#[test]
fn an_edit_without_keys_and_frames_outside_of_spans_give_the_bytes_back() {
    let take = Take::of(swaying);
    take.edited(&edit(&bilaplacian(), json!([])), "same", &[]).done();
    let names = |folder: &str| {
        let entries = fs::read_dir(take.folder.at(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(names("same"), names("in"));
    let keys = json!([key(3, [1, 5], turned(0.8, [0.2, 0.0, 0.1]))]);
    take.edited(&edit(&bilaplacian(), keys), "out", &[]).done();
    assert_eq!(names("out"), names("in"));
    for frame in 0..FRAMES {
        assert!(take.bytes("same", frame) == take.bytes("in", frame), "{frame}");
        // The ends of the span are at rest.
        let is_inside = (2..=4).contains(&frame);
        let away = largest_distance(&take.shape("out", frame), &take.shape("in", frame));
        assert!(if is_inside { away > 0.02 } else { away == 0.0 }, "{frame}: {away}");
        assert_eq!(
            take.bytes("out", frame) == take.bytes("in", frame),
            !is_inside,
            "{frame}"
        );
    }
}

#[test]
fn handles_meet_their_keys_and_fixed_vertices_keep_each_frames_own_motion() {
    let take = Take::of(swaying);
    let transforms = [turned(0.8, [0.2, 0.0, 0.1]), turned(-0.5, [0.0, 0.3, 0.0])];
    for method in [bilaplacian(), json!({ "name": "arap" }), json!({ "name": "frames" })] {
        let keys = json!([
            key(2, [0, 8], transforms[0].clone()),
            key(6, [0, 8], transforms[1].clone())
        ]);
        take.edited(&edit(&method, keys), "out", &[]).done();
        for (frame, transform) in [(2, &transforms[0]), (6, &transforms[1])] {
            let (before, after) = (take.shape("in", frame), take.shape("out", frame));
            let centre = before[300..=349].iter().sum::<DVec3>() / 50.0;
            let numbers = |member: &str| -> Vec<f64> { serde_json::from_value(transform[member].clone()).unwrap() };
            let turn = DQuat::from_slice(&numbers("rotation"));
            for vertex in 300..=349 {
                let wanted = centre + DVec3::from_slice(&numbers("translation")) + turn * (before[vertex] - centre);
                assert!(after[vertex].distance(wanted) < 1e-9, "{method} at {frame}");
            }
        }
        for frame in 0..FRAMES {
            assert_eq!(take.shape("out", frame)[..=80], take.shape("in", frame)[..=80]);
        }
    }
}

#[test]
fn a_local_key_bends_a_shape_that_moves_rigidly_as_if_it_were_still() {
    let take = Take::of(|frame| posed(|p| rigid(frame).transform_point3(p)));
    let size = diagonal(&bar().positions);
    // The handle bases are stored in single precision.
    for (method, tolerance) in [("bilaplacian", 1e-7), ("poisson", 1e-7), ("arap", 1e-4)] {
        let mut keys = json!([key(4, [0, 8], turned(1.0, [0.2, 0.0, 0.1]))]);
        keys[0]["ease"] = json!("hold");
        take.edited(&edit(&json!({ "name": method }), keys.clone()), "local", &[])
            .done();
        let own = |frame: usize| -> Vec<DVec3> {
            let back = rigid(frame).inverse();
            take.shape("local", frame)
                .iter()
                .map(|p| back.transform_point3(*p))
                .collect()
        };
        for frame in 0..FRAMES {
            let away = largest_distance(&own(frame), &own(4));
            assert!(away < tolerance * size, "{method} at {frame}: {away}");
        }
        // By the world's axes the edit turns against the shape.
        keys[0]["space"] = json!("world");
        take.edited(&edit(&json!({ "name": method }), keys), "world", &[])
            .done();
        let between = largest_distance(&take.shape("world", 0), &take.shape("local", 0));
        assert!(between > 0.1, "{method}: {between}");
        let at_key = largest_distance(&take.shape("world", 4), &take.shape("local", 4));
        assert!(at_key < tolerance * size, "{method}: {at_key}");
    }
}

#[test]
fn an_edited_still_sequence_moves_as_smoothly_as_the_ease() {
    let take = Take::of(|_| bar());
    let way = DVec3::new(0.4, 0.0, 0.2);
    let keys = json!([key(3, [0, 8], json!({ "translation": way.to_array() }))]);
    take.edited(&edit(&bilaplacian(), keys), "out", &[]).done();
    let shapes: Vec<Vec<DVec3>> = (0..FRAMES).map(|frame| take.shape("out", frame)).collect();
    let eased = |frame: usize| {
        let part = if frame < 3 {
            frame as f64 / 3.0
        } else {
            (8 - frame) as f64 / 5.0
        };
        part * part * (3.0 - 2.0 * part)
    };
    for frame in 1..FRAMES - 1 {
        let bend = (eased(frame - 1) - 2.0 * eased(frame) + eased(frame + 1)).abs() * way.length();
        for vertex in 0..shapes[0].len() {
            let bent = shapes[frame - 1][vertex] - 2.0 * shapes[frame][vertex] + shapes[frame + 1][vertex];
            assert!(
                bent.length() <= bend + 1e-9,
                "vertex {vertex} at {frame}: {} {bend}",
                bent.length()
            );
        }
    }
}

#[test]
fn an_arm_on_its_way_to_120_degrees_keeps_the_lengths_of_its_edges() {
    let take = Take::of(|_| posed(|p| DVec3::new(0.4 * p.x, 0.4 * p.y, p.z)));
    let turn = DQuat::from_rotation_y(120.0_f64.to_radians());
    let keys = json!([key(
        4,
        [0, 8],
        json!({ "rotation": turn.to_array(), "pivot": [0, 0, 2] })
    )]);
    let method = json!({ "name": "arap", "energy": "smooth" });
    take.edited(&edit(&method, keys), "out", &[]).done();
    let (rest, target) = (take.shape("out", 0), take.shape("out", 4));
    let triangles = open(&take.folder.at("in/walk-0.off")).model.drawn_triangles();
    let stretched = |shape: &[DVec3]| {
        let edges = triangles.iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
        let lengths = edges.map(|(a, b)| {
            let length = |shape: &[DVec3]| shape[a.index()].distance(shape[b.index()]);
            ((length(shape) - length(&rest)).abs(), length(&rest))
        });
        let (off, all) = lengths.fold((0.0, 0.0), |(off, all), (a, b)| (off + a, all + b));
        off / all
    };
    // The worst of the in-betweens counts: near the key a blend is nearly the key's own shape.
    let (mut own, mut of_blend) = (0.0_f64, 0.0_f64);
    for frame in [1, 2, 3] {
        let part = frame as f64 / 4.0;
        let share = part * part * (3.0 - 2.0 * part);
        let blended: Vec<DVec3> = rest.iter().zip(&target).map(|(a, b)| a.lerp(*b, share)).collect();
        own = own.max(stretched(&take.shape("out", frame)));
        of_blend = of_blend.max(stretched(&blended));
    }
    assert!(own <= of_blend / 5.0, "{own} {of_blend}");
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let take = Take::of(swaying);
    let keys = json!([key(3, [0, 8], turned(0.8, [0.2, 0.0, 0.1]))]);
    let edit = edit(&json!({ "name": "arap" }), keys);
    for threads in ["1", "2", "3"] {
        take.edited(&edit, threads, &["--threads", threads]).done();
        for frame in 0..FRAMES {
            assert!(
                take.bytes(threads, frame) == take.bytes("1", frame),
                "{threads} threads, frame {frame}"
            );
        }
    }
}

#[test]
fn sequences_that_can_not_be_edited_are_refused_in_words_and_nothing_is_written() {
    let take = Take::of(swaying);
    let with = |keys: Value| edit(&bilaplacian(), keys);
    let lifted = || turned(0.4, [0.0; 3]);
    let one = || json!([key(3, [1, 5], lifted())]);
    let mut unkeyed = with(json!([]));
    unkeyed["handles"][0]["transform"] = lifted();
    let two = |first: [usize; 2], second: [usize; 2]| with(json!([key(2, first, lifted()), key(3, second, lifted())]));
    for (edit, out, words) in [
        (with(json!([{ "time": 1.0 }])), "out", ["keys[0]", "pliant animate"]),
        (with(json!([{ "frame": 1 }])), "out", ["keys[0]", "`span`"]),
        (
            with(json!([key(9, [1, 9], lifted())])),
            "out",
            ["keys[0].frame is 9", "0 to 8"],
        ),
        (
            with(json!([key(6, [1, 5], lifted())])),
            "out",
            ["keys[0].span is [1, 5]", "6"],
        ),
        (two([1, 4], [3, 6]), "out", ["keys[1]", "overlaps with [1, 4]"]),
        (two([0, 4], [0, 5]), "out", ["keys[1]", "overlaps with [0, 4]"]),
        (unkeyed, "out", ["handles[0]", "no key"]),
        (with(one()), "in", ["--output", "outside of it"]),
        (with(one()), "in/out", ["--output", "outside of it"]),
        (with(one()), "edit.json", ["edit.json", "it is a file"]),
        (with(one()), "no/out", ["no/out", "no such file or folder"]),
    ] {
        let ended = take.edited(&edit, out, &[]);
        assert!(ended.status == 1 || ended.status == 2, "{out}: {ended:?}");
        let status = ended.status;
        ended.refused(status, &words);
        assert_eq!(take.folder.names(), ["edit.json", "in"], "{words:?}");
    }
    // A frame with other faces, in the middle: the frames before it were solved.
    let mut other = swaying(5);
    other.triangles.pop();
    take.folder.write_mesh("in/walk-5.off", &other);
    take.edited(&with(one()), "out", &[])
        .refused(1, &["walk-5.off", "695 triangles", "696 triangles"]);
    assert_eq!(take.folder.names(), ["edit.json", "in"]);
    // The program names the frames whose numbers are shifted by a missing one.
    fs::remove_file(take.folder.at("in/walk-5.off")).unwrap();
    let told = take.edited(&with(json!([key(3, [1, 5], lifted())])), "out", &[]).done();
    assert!(
        told.err.contains("numbered from 5 to 5: walk-6.off is frame 5"),
        "{}",
        told.err
    );
    fs::write(take.folder.at("in/other.obj"), "v 0 0 0\n").unwrap();
    take.edited(&with(one()), "out2", &[])
        .refused(1, &["in", "different formats"]);
}

#[test]
fn a_point_cache_is_edited_like_a_folder() {
    let take = Take::of(swaying);
    for extension in ["pc2", "mdd"] {
        let at = |name: &str| take.folder.at(&format!("{name}.{extension}"));
        let animated = json!([
            { "time": 0.0, "handles": { "top": {} } },
            { "time": 0.375, "handles": { "top": turned(0.5, [0.0, 0.3, 0.0]) } },
        ]);
        let edit_at = take
            .folder
            .write("edit.json", edit(&bilaplacian(), animated).to_string());
        let mesh = take.folder.at("in/walk-0.off");
        let words = [
            "animate".into(),
            mesh.clone().into_os_string(),
            "--edit".into(),
            edit_at.clone().into(),
        ];
        run(words.into_iter().chain(["--output".into(), at("in").into_os_string()])).done();
        let edited = |keys: Value, out: &str, mesh: Option<&std::path::Path>| {
            take.folder.write("edit.json", edit(&bilaplacian(), keys).to_string());
            let words = [
                "sequence".into(),
                at("in").into_os_string(),
                "--edit".into(),
                edit_at.clone().into(),
            ];
            let mesh = mesh.map(|mesh| ["--mesh".into(), mesh.as_os_str().to_owned()]);
            let out = ["--output".into(), take.folder.at(out).into_os_string()];
            run(words.into_iter().chain(out).chain(mesh.into_iter().flatten()))
        };
        let name = |name: &str| format!("{name}.{extension}");
        edited(json!([]), &name("same"), Some(&mesh)).done();
        assert!(fs::read(at("same")).unwrap() == fs::read(at("in")).unwrap());
        let keys = || json!([key(5, [3, 7], turned(0.8, [0.2, 0.0, 0.1]))]);
        edited(keys(), &name("out"), Some(&mesh)).done();
        let (before, after) = (fs::read(at("in")).unwrap(), fs::read(at("out")).unwrap());
        let vertices = bar().positions.len();
        let header = before.len() - 10 * 12 * vertices;
        assert!(after.len() == before.len() && after[..header] == before[..header]);
        for frame in 0..10 {
            let part = header + frame * 12 * vertices..header + (frame + 1) * 12 * vertices;
            let is_inside = (4..=6).contains(&frame);
            assert_eq!(
                before[part.clone()] == after[part],
                !is_inside,
                "{extension}, frame {frame}"
            );
        }
        edited(keys(), &name("no"), None).refused(2, &["--mesh"]);
        edited(keys(), "no.obj", Some(&mesh)).refused(2, &["no.obj", "same extension"]);
        let other = take.folder.write_mesh("other.off", &shapes::icosphere(1));
        edited(keys(), &name("no"), Some(&other)).refused(1, &["points", "42 vertices"]);
        let cut = &before[..before.len() - 5];
        fs::write(at("in"), cut).unwrap();
        edited(keys(), &name("no"), Some(&mesh)).refused(1, &["cut off"]);
        assert!(!at("no").exists());
    }
}
