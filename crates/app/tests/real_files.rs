//! A day with files in the real window, by pointer and keys: strangers under the names that saves use, another program
//! that writes the open file, a project, and unsaved work when the window is closed.
//!
//! The tests are skipped by name if Xvfb, xdotool or a graphics device is missing.

#![cfg(target_os = "linux")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

mod desktop;

use std::fs;
use std::path::Path;
use std::thread::sleep;

use desktop::{Desktop, PAUSE, SIZE};
use serde_json::Value;

/// The middle of the 3D view, which takes the window except the panel.
const MIDDLE: (i32, i32) = ((SIZE.0 - 270) / 2, SIZE.1 / 2 + 20);

fn project(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap_or_default()).unwrap_or_default()
}

#[test]
fn a_day_with_files_loses_neither_the_artist_s_work_nor_anybody_s_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/bar.glb");
    let (scan, stranger) = (fs::read(sample).unwrap(), b"somebody's".to_vec());
    fs::write(at("scan.glb"), &scan).unwrap();
    for name in ["scan.original.glb", "day.source.glb"] {
        fs::write(at(name), &stranger).unwrap();
    }
    let Some(mut desktop) = Desktop::open(&at("scan.glb")) else {
        return;
    };
    desktop.wait_for_title("scan.glb");
    sleep(8 * PAUSE);
    let (x, y) = MIDDLE;
    desktop.drag((x - 6, y), (x + 6, y + 4));
    sleep(4 * PAUSE);
    let move_up = || {
        desktop.move_to(x + 100, y);
        desktop.keys(&["g", "y", "period", "1", "Return"]);
    };

    // Over the scan, whose original is kept under the next free name.
    move_up();
    desktop.key("ctrl+s");
    desktop.wait_for_title("Save over the source");
    desktop.shoot("save-over");
    desktop.key("Return");
    desktop.wait_until(&at("scan.glb"), |path| fs::read(path).unwrap() != scan);
    assert_eq!(fs::read(at("scan.original-2.glb")).unwrap(), scan);
    sleep(4 * PAUSE);

    // Another program writes it: nothing is lost without a question, and a free name is beside it.
    fs::write(at("scan.glb"), &scan).unwrap();
    move_up();
    desktop.key("ctrl+s");
    desktop.wait_for_title("The file has changed");
    desktop.shoot("changed");
    desktop.key("Escape");
    sleep(2 * PAUSE);
    assert_eq!(fs::read(at("scan.glb")).unwrap(), scan);
    desktop.key("ctrl+s");
    desktop.wait_for_title("The file has changed");
    desktop.key("Return");
    desktop.wait_for_title("Save the model as");
    sleep(4 * PAUSE);
    desktop.shoot("beside");
    desktop.key("Return");
    desktop.wait_for_file(&at("scan-2.glb"));
    assert_eq!(fs::read(at("scan.glb")).unwrap(), scan);
    desktop.wait_for_title("scan-2.glb");

    // Closed with unsaved work: the open project is saved.
    desktop.answer_with("ctrl+alt+s", "Save the project as", &at("day.pliant"));
    sleep(4 * PAUSE);
    let saved = project(&at("day.pliant"));
    assert!(saved["handles"].is_array(), "{saved}");
    move_up();
    sleep(4 * PAUSE);
    if !desktop.close() {
        return;
    }
    desktop.wait_for_title("There is unsaved work");
    desktop.shoot("unsaved");
    desktop.key("Return");
    desktop.wait_for_end();
    let closed = project(&at("day.pliant"));
    assert_ne!(closed["handles"], saved["handles"], "the last move is in the project");
    for name in ["scan.original.glb", "day.source.glb"] {
        assert_eq!(fs::read(at(name)).unwrap(), stranger, "{name}");
    }
    assert!(desktop.left_behind().is_empty());

    // It can be opened again.
    desktop.start(&at("day.pliant"));
    desktop.wait_for_title("scan");
    let again = desktop.project(folder.path(), "again");
    assert_eq!(again["handles"], closed["handles"]);
    desktop.shoot("again");
}
