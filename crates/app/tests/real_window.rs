//! The real window under a virtual display, driven by real pointer and key events: paint, drag, save, and compare with
//! the shape that the command line makes from the exported edit.
//!
//! The tests are skipped by name if Xvfb, xdotool or a graphics device is missing.

#![cfg(target_os = "linux")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

mod desktop;

use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use desktop::{Desktop, PATIENCE, PAUSE, PLIANT, SIZE, sample_in};
use pliant_deform::Method;
use pliant_engine::Loaded;
use pliant_engine::watch::Watch;
use pliant_mesh::WeldOptions;

impl Desktop {
    /// Saves the model and exports the edit: the command line must get the same shape from the edit, to `tolerance`
    /// diagonals.
    fn saves_what_the_engine_makes(&self, sample: &Path, folder: &Path, name: &str, tolerance: f64) {
        let [saved, edit, applied] =
            ["saved.glb", "edit.json", "applied.glb"].map(|end| folder.join(format!("{name}-{end}")));
        self.answer_with("ctrl+shift+s", "Save the model as", &saved);
        self.wait_for_title(&format!("{name}-saved.glb"));
        self.answer_with("ctrl+e", "Export the edit", &edit);
        sleep(PAUSE);
        let exported = std::fs::read_to_string(&edit).unwrap();
        assert!(exported.contains(&format!("\"{name}\"")), "{exported}");
        let status = Command::new(PLIANT)
            .args([
                "apply".as_ref(),
                sample.as_os_str(),
                "--edit".as_ref(),
                edit.as_os_str(),
                "--output".as_ref(),
                applied.as_os_str(),
            ])
            .status()
            .unwrap();
        assert!(status.success());
        let (rest, saved, applied) = (load(sample), load(&saved), load(&applied));
        let size = rest.model.bounds().unwrap().diagonal();
        assert!(farthest(&rest, &saved) > 0.01 * size, "{name}: the drag bent nothing");
        let apart = farthest(&saved, &applied) / size;
        assert!(
            apart <= tolerance,
            "{name}: the window's shape is {apart} from the engine's"
        );
    }
}

/// The middle of the 3D view, which takes the window except the panel.
const MIDDLE: (i32, i32) = ((SIZE.0 - 270) / 2, SIZE.1 / 2 + 20);

fn load(path: &Path) -> Loaded {
    pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap()
}

/// The largest distance between two files' drawn vertices.
fn farthest(a: &Loaded, b: &Loaded) -> f64 {
    let positions = |loaded: &Loaded| loaded.model.rest_positions();
    positions(a)
        .iter()
        .zip(positions(b))
        .map(|(a, b)| a.distance(b))
        .fold(0.0, f64::max)
}

#[test]
fn pointer_and_keys_make_the_shape_that_the_engine_says() {
    let folder = tempfile::tempdir().unwrap();
    let sample = sample_in(folder.path());
    let Some(desktop) = Desktop::open(&sample) else { return };
    desktop.wait_for_title("bar.glb");
    sleep(8 * PAUSE);

    let (middle_x, middle_y) = MIDDLE;
    desktop.drag((middle_x - 6, middle_y), (middle_x + 6, middle_y + 4));
    sleep(4 * PAUSE);
    desktop.key("g");
    for step in 1..=6 {
        desktop.move_to(middle_x + 6 + 10 * step, middle_y - 12 * step);
        sleep(Duration::from_millis(120));
    }
    desktop.xdotool(&["click", "1"]);
    sleep(8 * PAUSE);

    // ARAP, the method of a new document: the window's descent followed the hand, the command line's starts at rest.
    desktop.saves_what_the_engine_makes(&sample, folder.path(), "arap", 1e-3);
    // A linear method has one result, on any way to it.
    desktop.key("F1");
    desktop.type_text(&format!("Method: {}", Method::default().declaration().title));
    desktop.key("Return");
    sleep(8 * PAUSE);
    desktop.saves_what_the_engine_makes(&sample, folder.path(), "bilaplacian", 1e-6);
}

/// After a kill in the middle of a drag, at random moments, the work is there at the next start. `PLIANT_KILLS` sets
/// the number of kills; it is small by default.
#[test]
fn killed_in_the_middle_of_drags_the_window_recovers_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let sample = sample_in(folder.path());
    let Some(mut desktop) = Desktop::open(&sample) else {
        return;
    };
    let kills = std::env::var("PLIANT_KILLS")
        .ok()
        .and_then(|kills| kills.parse().ok())
        .unwrap_or(2_u32);
    let (x, y) = MIDDLE;
    let mut random = 0x9e37_79b9_u64;
    for kill in 0..kills {
        desktop.wait_for_title("bar.glb");
        sleep(8 * PAUSE);
        desktop.drag((x - 6, y), (x + 6, y + 4));
        desktop.keys(&["g"]);
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let moment = Duration::from_millis(100 + (random >> 33) % 4000);
        let start = std::time::Instant::now();
        let mut step = 0;
        while start.elapsed() < moment {
            step += 1;
            desktop.move_to(x + 6 + 3 * (step % 40), y - 4 * (step % 30));
            sleep(Duration::from_millis(30));
        }
        desktop.kill();
        let left = desktop.left_behind();
        assert_eq!(left.len(), 1, "kill {kill} after {moment:?}: {left:?}");
        let text = std::fs::read_to_string(&left[0]).unwrap();
        let kept: serde_json::Value = serde_json::from_str(&text).expect("it is written whole");
        assert_eq!(kept["handles"].as_array().map(Vec::len), Some(1), "kill {kill}");

        desktop.start(&sample);
        desktop.wait_for_title("Recover unsaved work");
        sleep(4 * PAUSE);
        desktop.shoot("recover");
        desktop.key("Return");
        desktop.wait_for_title("bar.glb");
        sleep(8 * PAUSE);
        desktop.shoot("recovered");
        let recovered = desktop.project(folder.path(), &format!("recovered-{kill}"));
        for member in ["handles", "region", "fixed", "method", "rest"] {
            assert_eq!(recovered[member], kept[member], "kill {kill}: {member}");
        }
        // After a save nothing is left, and the next round begins from scratch.
        let start = std::time::Instant::now();
        while !desktop.left_behind().is_empty() {
            assert!(
                start.elapsed() < Duration::from_secs(20),
                "kill {kill}: saved work is kept on"
            );
            sleep(PAUSE);
        }
        desktop.kill();
        desktop.start(&sample);
    }
}

#[test]
fn text_comes_from_other_programs_and_goes_to_them() {
    let folder = tempfile::tempdir().unwrap();
    let sample = sample_in(folder.path());
    let Some(desktop) = Desktop::open(&sample) else {
        return;
    };
    if !desktop.copy_elsewhere("painted") {
        return;
    }
    // The palette's field.
    desktop.key("F1");
    desktop.key("ctrl+v");
    desktop.type_text(" stiffness");
    desktop.key("ctrl+a");
    desktop.key("ctrl+c");
    desktop.wait_for_clipboard("painted stiffness");
}

/// A window that filled the screen does so when the program starts again; another one has its size.
#[test]
fn a_maximised_window_comes_back_maximised() {
    let folder = tempfile::tempdir().unwrap();
    let sample = sample_in(folder.path());
    let Some(mut desktop) = Desktop::open(&sample) else {
        return;
    };
    desktop.wait_for_title("bar.glb");
    desktop.wait_for_width(|width| width == SIZE.0);
    if !desktop.maximise() {
        return;
    }
    let fills_screen = |width| width > SIZE.0;
    desktop.wait_for_width(fills_screen);
    let start = std::time::Instant::now();
    while desktop.settings()["maximised"] != true {
        assert!(
            start.elapsed() < PATIENCE,
            "it is not remembered: {}",
            desktop.settings()
        );
        sleep(PAUSE);
    }
    desktop.kill();
    desktop.launch(&sample);
    desktop.wait_for_width(fills_screen);
}
