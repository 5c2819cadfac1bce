//! The frames of a glTF's own animation of morph targets.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_engine::OpenSequence;
use pliant_engine::watch::Watch;
use pliant_tests::{Ended, diagonal, largest_distance, open, run};
use serde_json::{Value, json};

use super::take::{Take, bar, bilaplacian, edit, key, turned};

const FRAMES: usize = 7;

/// A bar that waves in a glTF, and in a folder of frames.
fn waving() -> Take {
    let take = Take::of(|_| bar());
    let keys = json!([
        { "time": 0.0, "handles": { "top": {} } },
        { "time": 0.25, "handles": { "top": turned(0.6, [0.1, 0.0, 0.0]) } },
        { "time": 0.5, "handles": { "top": turned(-0.4, [0.0, 0.2, 0.0]) } },
    ]);
    take.folder.write("wave.json", edit(&bilaplacian(), keys).to_string());
    std::fs::create_dir(take.folder.at("frames")).unwrap();
    for out in ["wave.glb", "frames/wave-####.off"] {
        let mesh = take.folder.at("in/walk-0.off");
        of(&take, "animate", mesh, "wave.json", out, &["--fps", "12"]).done();
    }
    take
}

fn of(take: &Take, command: &str, file: PathBuf, edit: &str, out: &str, more: &[&str]) -> Ended {
    let words = [command.into(), file.into_os_string(), "--edit".into()];
    let rest = [
        take.folder.at(edit).into(),
        "--output".into(),
        take.folder.at(out).into_os_string(),
    ];
    run(words.into_iter().chain(rest).chain(more.iter().map(Into::into)))
}

fn edited(take: &Take, file: &str, keys: Value, out: &str, more: &[&str]) -> Ended {
    take.folder.write("edit.json", edit(&bilaplacian(), keys).to_string());
    of(take, "sequence", take.folder.at(file), "edit.json", out, more)
}

fn shape(take: &Take, name: &str, frame: usize) -> Vec<DVec3> {
    open(&take.folder.at(&format!("{name}{frame:04}.off")))
        .model
        .rest_positions()
}

#[test]
fn a_gltfs_animation_is_edited_like_a_folder_of_its_frames_and_edited_again() {
    let take = waving();
    let keys = || json!([key(3, [1, 5], turned(0.8, [0.2, 0.0, 0.1]))]);
    let rate = ["--fps", "12"];
    edited(&take, "frames", keys(), "lifted", &[]).done();
    edited(&take, "wave.glb", keys(), "lifted-####.off", &rate).done();
    edited(&take, "wave.glb", keys(), "lifted.glb", &rate).done();
    // The edit is the last animation, so it is the one that goes on.
    let again = edited(&take, "lifted.glb", json!([]), "again-####.off", &rate).done();
    assert!(again.err.contains("2 animations"), "{}", again.err);
    let bound = 3e-5 * diagonal(&bar().positions);
    for frame in 0..FRAMES {
        let wanted = shape(&take, "lifted/wave-", frame);
        for name in ["lifted-", "again-"] {
            let away = largest_distance(&shape(&take, name, frame), &wanted);
            assert!(away < bound, "{name}{frame}: {away}");
        }
    }
    let moved = largest_distance(&shape(&take, "lifted-", 3), &shape(&take, "frames/wave-", 3));
    assert!(moved > 0.1, "{moved}");
    // A point cache is one of the file's vertices.
    edited(&take, "wave.glb", keys(), "lifted.pc2", &rate).done();
    let cache = std::fs::read(take.folder.at("lifted.pc2")).unwrap();
    assert_eq!(cache.len(), 32 + FRAMES * bar().positions.len() * 12);
}

#[test]
fn an_edit_without_keys_gives_the_gltf_back_and_others_are_refused_in_words() {
    let take = waving();
    edited(&take, "wave.glb", json!([]), "same.glb", &[]).done();
    let bytes = |name: &str| std::fs::read(take.folder.at(name)).unwrap();
    assert!(bytes("same.glb") == bytes("wave.glb"));
    let names = take.folder.names();
    let one = || json!([key(3, [1, 5], turned(0.4, [0.0; 3]))]);
    let refused = |out: &str, more: &[&str], status: u8, words: &[&str]| {
        edited(&take, "wave.glb", one(), out, more).refused(status, words);
    };
    refused("no.off", &[], 2, &["no.off", "-####"]);
    refused("wave.glb", &[], 2, &["wave.glb"]);
    refused("no.glb", &["--mesh", "x.off"], 2, &["--mesh", "leave it out"]);
    refused("no.glb", &["--fps", "2"], 1, &["keys[0].span is 5", "0 to 1"]);
    assert_eq!(take.folder.names(), names);
    edited(&take, "wave.glb", one(), "lifted-####.off", &[]).done();
    refused("lifted-####.off", &[], 2, &["lifted-0000.off", "--replace"]);
    edited(&take, "wave.glb", one(), "lifted-####.off", &["--replace"]).done();
    // A file without an animation.
    let still = take.folder.at("still.glb");
    let mut apply = edit(&bilaplacian(), json!([]));
    apply["handles"][0]["transform"] = turned(0.3, [0.0; 3]);
    take.folder
        .apply(&take.folder.at("in/walk-0.off"), &apply, &still, &[])
        .done();
    edited(&take, "still.glb", one(), "no.glb", &[]).refused(1, &["still.glb", "no animation of morph targets"]);
}

#[test]
fn every_kind_of_sequence_opens_with_the_same_shapes_frame_by_frame() {
    let take = waving();
    let mesh = take.folder.at("in/walk-0.off");
    of(&take, "animate", mesh, "wave.json", "wave.pc2", &["--fps", "12"]).done();
    let watch = Watch::default();
    let open_sequence = |file: &str, mesh: &str| {
        let mesh = Arc::new(open(&take.folder.at(mesh)));
        OpenSequence::of(&take.folder.at(file), mesh, Some(12.0), &watch).unwrap()
    };
    let folder = open_sequence("frames", "frames/wave-0000.off");
    let others = [
        open_sequence("wave.pc2", "in/walk-0.off"),
        open_sequence("wave.glb", "wave.glb"),
    ];
    assert_eq!(folder.frame_of(&take.folder.at("frames/wave-0003.off")), Some(3));
    let bound = 3e-5 * diagonal(&bar().positions);
    for sequence in others {
        assert_eq!(sequence.count(), folder.count());
        // In any order: no frame depends on another.
        for frame in [6, 0, 3] {
            let (own, wanted) = (
                sequence.displacements(frame, &watch),
                folder.displacements(frame, &watch),
            );
            let away = largest_distance(&own.unwrap(), &wanted.unwrap());
            assert!(away < bound, "{}, frame {frame}: {away}", sequence.path().display());
        }
    }
    let of_file = |name: &str| OpenSequence::beside(&open(&take.folder.at(name)), &watch);
    assert!(of_file("wave.glb").unwrap().contains("wave.pc2"), "the cache beside it");
    std::fs::remove_file(take.folder.at("wave.pc2")).unwrap();
    assert!(of_file("wave.glb").unwrap().contains("morph targets"));
    assert_eq!(of_file("in/walk-0.off"), None);
}

/// The key times of the last animation of a glTF, as they are stored.
fn key_times(take: &Take, name: &str) -> Vec<f64> {
    let file = open(&take.folder.at(name));
    let playback = file.scene.morph_playback(name, &pliant_mesh::Cancel::new()).unwrap();
    playback.unwrap().key_times().to_vec()
}

#[test]
fn a_clip_comes_back_with_its_own_times() {
    let take = waving();
    let mesh = take.folder.at("in/walk-0.off");
    of(&take, "animate", mesh, "wave.json", "wave30.glb", &["--fps", "30"]).done();
    let own = key_times(&take, "wave30.glb");
    assert_eq!(own.len(), 16);
    let keys = || json!([key(3, [1, 5], turned(0.8, [0.2, 0.0, 0.1]))]);
    edited(&take, "wave30.glb", keys(), "lifted30.glb", &[]).done();
    assert_eq!(key_times(&take, "lifted30.glb"), own, "to the bit");
    // Keys that are frames at 24 a second keep that rate.
    edited(&take, "wave.glb", keys(), "lifted24.glb", &[]).done();
    assert_eq!(key_times(&take, "lifted24.glb").len(), 13);
    let own = key_times(&take, "wave.glb");
    assert!(own.iter().all(|time| key_times(&take, "lifted24.glb").contains(time)));
}

#[test]
fn a_clip_whose_shapes_hold_comes_back_with_shapes_that_hold() {
    let take = waving();
    let linear = br#""interpolation":"LINEAR""#;
    let mut bytes = std::fs::read(take.folder.at("wave.glb")).unwrap();
    let places = |bytes: &[u8], what: &[u8]| -> Vec<usize> {
        let windows = bytes.windows(what.len()).enumerate();
        windows
            .filter(|(_, own)| *own == what)
            .map(|(place, _)| place)
            .collect()
    };
    let found = places(&bytes, linear);
    assert_eq!(found.len(), 1);
    bytes[found[0]..][..linear.len()].copy_from_slice(br#""interpolation":"STEP"  "#);
    std::fs::write(take.folder.at("held.glb"), bytes).unwrap();
    let keys = json!([key(3, [1, 5], turned(0.8, [0.2, 0.0, 0.1]))]);
    edited(&take, "held.glb", keys, "lifted.glb", &[]).done();
    let lifted = std::fs::read(take.folder.at("lifted.glb")).unwrap();
    assert!(places(&lifted, b"\"STEP\"").len() >= 2);
    assert!(places(&lifted, linear).is_empty());
}
