//! A whole session in the real window, by pointer and keys: open, region by distance, two handles, stiffness, a drag
//! with each method, comparing two, apply, undo all, redo all, save, reopen.
//!
//! The tests are skipped by name if Xvfb, xdotool or a graphics device is missing.

#![cfg(target_os = "linux")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

mod desktop;

use std::path::Path;
use std::time::Duration;

use desktop::{Desktop, SIZE, sample_in};
use pliant_engine::Loaded;
use pliant_engine::watch::Watch;
use pliant_mesh::WeldOptions;
use serde_json::Value;

/// The middle of the 3D view, which takes the window except the panel.
const MIDDLE: (i32, i32) = ((SIZE.0 - 270) / 2, SIZE.1 / 2 + 36);

fn load(path: &Path) -> Loaded {
    pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap()
}

fn handles(project: &Value) -> &[Value] {
    project["handles"].as_array().map_or(&[], Vec::as_slice)
}

/// The document's part of the project: without the paths of files and the camera.
fn document(project: &Value) -> Value {
    let mut document = project.clone();
    document["mesh"]["path"] = Value::Null;
    document["camera"] = Value::Null;
    document
}

#[test]
fn a_whole_session_by_pointer_and_keys_comes_back_by_undo_redo_and_reopening() {
    let folder = tempfile::tempdir().unwrap();
    let sample = sample_in(folder.path());
    let Some(desktop) = Desktop::open(&sample) else { return };
    let once = |name: &str, holds: &dyn Fn(&Value) -> bool| desktop.project_once(folder.path(), name, holds);
    let (x, y) = MIDDLE;
    desktop.wait_for_title("bar.glb");
    let first = once("first", &|_| true);
    assert!(handles(&first).is_empty());
    desktop.shoot("opened");

    desktop.command("brush along surface");
    desktop.keys(&["1"]);
    desktop.drag((x - 6, y), (x + 6, y + 4));
    let one = once("one-handle", &|project| handles(project).len() == 1);
    desktop.shoot("one-handle");
    // Its region, by distance: E, away from the handle, a click.
    desktop.move_to(x + 40, y);
    desktop.keys(&["e"]);
    for step in 1..=4 {
        desktop.move_to(x + 40 + 12 * step, y);
        std::thread::sleep(Duration::from_millis(120));
    }
    desktop.shoot("widening");
    desktop.xdotool(&["click", "1"]);
    once("widened", &|project| {
        handles(project)[0]["reach"] != handles(&one)[0]["reach"]
    });
    desktop.shoot("widened");
    desktop.keys(&["shift+n"]);
    desktop.drag((x - 30, y - 210), (x - 24, y - 206));
    once("two-handles", &|project| handles(project).len() == 2);
    desktop.shoot("two-handles");
    desktop.keys(&["6"]);
    desktop.drag((x - 20, y - 120), (x - 10, y - 80));
    once("stiffened", &|project| project["stiffness"].is_object());
    desktop.shoot("stiffness");

    desktop.move_to(x + 100, y);
    desktop.keys(&["5", "Tab", "r", "z", "4", "0", "Return"]);
    let mut shapes: Vec<Value> = Vec::new();
    // ARAP, the method of a new document, then the others by the names in papers.
    for method in ["arap", "bilaplacian", "primo"] {
        if method != "arap" {
            desktop.command(method);
        }
        let bent = once(method, &|project| {
            project["method"]["name"] == method && project["settled"] != false && project["shape"].is_object()
        });
        desktop.shoot(method);
        assert!(!shapes.contains(&bent["shape"]), "{method} bends as another");
        shapes.push(bent["shape"].clone());
    }
    desktop.command("compare");
    once("compared", &|_| true);
    desktop.shoot("compared");
    desktop.command("compare");

    desktop.command("apply shape");
    once("applied", &|project| {
        project["applied"] == true && project["shape"].is_null()
    });
    desktop.keys(&["g", "y", "period", "1", "Return"]);
    let last = once("last", &|project| {
        project["applied"] == true && project["shape"].is_object() && project["settled"] != false
    });
    desktop.shoot("applied-and-moved");

    desktop.keys(&["ctrl+z"; 16]);
    once("undone", &|project| document(project) == document(&first));
    desktop.shoot("undone");
    desktop.keys(&["ctrl+shift+z"; 16]);
    once("redone", &|project| document(project) == document(&last));
    desktop.shoot("redone");

    let saved = folder.path().join("saved.glb");
    desktop.answer_with("ctrl+shift+s", "Save the model as", &saved);
    desktop.wait_for_title("saved.glb");
    desktop.key("ctrl+o");
    desktop.wait_for_title("Open a model");
    desktop.answer(&folder.path().join("redone.pliant"));
    desktop.wait_for_title("bar.glb");
    once("reopened", &|project| document(project) == document(&last));
    desktop.shoot("reopened");
    let (rest, saved) = (load(&sample), load(&saved));
    let moved = rest
        .model
        .rest_positions()
        .into_iter()
        .zip(saved.model.rest_positions());
    assert!(
        moved.filter(|(a, b)| a != b).count() > 100,
        "the saved file has the new shape"
    );
}
