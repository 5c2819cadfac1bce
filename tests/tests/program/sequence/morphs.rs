//! The frames of a glTF's own animation of morph targets.

use std::path::PathBuf;

use glam::DVec3;
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
