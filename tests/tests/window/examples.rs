//! Examples in the whole window: from files and from the file's own morph targets, weighted by their sliders, undone,
//! saved. Skipped by name if there is no graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::path::PathBuf;
use std::sync::Arc;

use crate::window_rig::Session;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{DQuat, DVec3};
use pliant_app::window::{AppDirectories, Source};
use pliant_deform::{Examples, Method};
use pliant_editor::{Command, HandleTransform};
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, assets, largest_distance};
use serde_json::json;

/// A bar along x, and the same with its far part turned about an elbow in its middle.
fn bar() -> Drawn {
    shapes::bar(16, 3, 3)
}

fn bent(angle: f64) -> Drawn {
    let mut bent = bar();
    for p in &mut bent.positions {
        let elbow = DVec3::new(8.0, 1.5, 1.5);
        let share = ((p.x - 6.0) / 4.0).clamp(0.0, 1.0);
        *p = elbow + DQuat::from_rotation_y(-angle * share) * (*p - elbow);
    }
    bent
}

/// A window that is high enough for the whole panel, with `path` open and bent by `method`.
fn begin(path: PathBuf, method: &str) -> Option<Session> {
    let mut session = Session::begin_in(Source::File(path), AppDirectories::default())?;
    session.harness.set_size(vec2(1000.0, 1800.0));
    session.harness.run();
    session.page("Method");
    let method = Method::from_name(method).unwrap();
    session.harness.state_mut().command(Command::SetMethod(method));
    session.settle();
    Some(session)
}

fn examples(session: &Session) -> Option<&Examples> {
    session.harness.state().editor().document().examples()
}

fn names(session: &Session) -> Vec<String> {
    let shapes = examples(session).map_or(&[][..], |examples| &examples.shapes);
    shapes.iter().map(|shape| shape.name.clone()).collect()
}

fn says(session: &Session, words: &[&str]) -> bool {
    let line = session.harness.state().headline();
    line.is_some_and(|line| words.iter().all(|word| line.contains(word)))
}

/// The place in the window of the control with this label and role.
fn place(session: &Session, label: &str, role: Role) -> Rect {
    let mut nodes = session.harness.get_all_by_label(label);
    let node = nodes.find(|node| node.accesskit_node().role() == role);
    node.unwrap_or_else(|| panic!("the window has no {role:?} {label:?}"))
        .rect()
}

/// Drags the slider's knob from `from` to `to`, both shares of its width.
fn slide(session: &mut Session, example: &str, from: f32, to: f32) {
    let place = place(session, example, Role::Slider);
    let at = |share: f32| pos2(place.left() + share * place.width(), place.center().y);
    session.stroke(at(from), at(to));
}

fn shape(session: &Session) -> Vec<DVec3> {
    let view = session.harness.state().editor().view();
    let positions = &view.model.unwrap().surface.positions;
    positions
        .iter()
        .zip(&**view.displacements)
        .map(|(p, d)| *p + *d)
        .collect()
}

fn click(session: &mut Session, label: &str) {
    let at = place(session, label, Role::Button).center();
    for pressed in [true, false] {
        session.pointer(at, Some(pressed));
    }
    session.harness.run_steps(2);
}

#[test]
fn a_file_is_taken_as_an_example_weighed_undone_and_saved() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    let pose = folder.write_mesh("pose.off", &bent(0.9));
    let other = folder.write_mesh("other.off", &shapes::bar(15, 3, 3));
    let Some(mut session) = begin(file, "arap") else { return };
    session.palette("add example from file");
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.get_by_label_contains("takes no examples");
    session.key(Key::Escape, Modifiers::NONE);
    let shells = Method::from_name("shells").unwrap();
    session.harness.state_mut().command(Command::SetMethod(shells));
    session.settle();
    session.harness.get_by_label("Add from file…");
    assert!(session.harness.query_by_label("Add a morph target").is_none());

    // A wrong count and a missing file give messages; nothing is added.
    for (path, words) in [
        (other, ["other.off", "bar.off", "vertices", "same vertices"]),
        (folder.at("none.off"), ["none.off", "", "", ""]),
    ] {
        session.harness.state_mut().load_example(path);
        session.settle_when(|session| says(session, &words));
        assert!(examples(&session).is_none());
    }
    session.harness.state_mut().load_example(pose.clone());
    session.settle_when(|session| examples(session).is_some());
    assert_eq!(names(&session), ["pose"]);
    assert!(session.shape().iter().all(|d| *d == DVec3::ZERO));

    // The knob moves from 0, a quarter of −0.5 to 1.5, to 1.
    slide(&mut session, "pose", 0.25, 0.75);
    let weight = examples(&session).unwrap().weights[0].unwrap();
    assert!((weight - 1.0).abs() < 0.1, "{weight}");
    assert_eq!(
        session.harness.state().editor().view().undo,
        Some("Change example weight")
    );
    session
        .harness
        .state_mut()
        .command(Command::SetExampleWeight(0, Some(1.0)));
    session.settle();
    // It is the pose, at any place, because nothing is held.
    let model = Arc::clone(session.harness.state().editor().view().model.unwrap());
    let example = &examples(&session).unwrap().shapes[0].displacements;
    let places = model.surface.positions.iter().zip(&**example);
    let wanted: Vec<DVec3> = places.map(|(p, d)| *p + *d).collect();
    let along_x = |places: &[DVec3]| {
        let mut along: Vec<f64> = places.iter().map(|p| p.x).collect();
        along.sort_by(f64::total_cmp);
        along
    };
    let pairs = along_x(&wanted).into_iter().zip(along_x(&bent(0.9).positions));
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-4));
    let found = shape(&session);
    for other in 1..found.len() {
        let lengths = [&found, &wanted].map(|places| places[0].distance(places[other]));
        assert!((lengths[0] - lengths[1]).abs() < 1e-3 * 16.0, "{other}: {lengths:?}");
    }

    let project = folder.at("kept.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    session.key(Key::Z, Modifiers::COMMAND);
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(examples(&session).unwrap().weights, [Some(0.0)]);
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert!(examples(&session).is_none());

    let mut again = Session::begin_in(Source::File(project), AppDirectories::default()).unwrap();
    again.settle();
    assert_eq!(names(&again), ["pose"]);
    assert_eq!(examples(&again).unwrap().weights, [Some(1.0)]);
    assert!(largest_distance(&shape(&again), &found) < 1e-3);
}

#[test]
fn morph_targets_of_the_file_are_taken_from_a_list() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &bar());
    folder.write_mesh("pose.off", &bent(0.6));
    let morphed = folder.at("morphed.glb");
    let bow = json!({
        "version": 1,
        "method": { "name": "shells", "examples": [{ "file": "pose.off", "weight": 1.0 }] },
        "fixed": { "slab": { "axis": "x", "from": 0.0, "to": 0.2 } },
    });
    folder.apply(&file, &bow, &morphed, &["--as-morph", "Bow"]).done();
    // The saved file shows its target; here it rests.
    let bytes = std::fs::read(&morphed).unwrap();
    let (shown, resting) = (br#""weights":[1]"#, br#""weights":[0]"#);
    let at = bytes.windows(shown.len()).position(|part| part == shown).unwrap();
    let rested = [&bytes[..at], resting, &bytes[at + shown.len()..]].concat();
    std::fs::write(&morphed, rested).unwrap();
    let Some(mut session) = begin(morphed, "shells") else {
        return;
    };
    for expected in [vec!["Bow"], vec!["Bow", "Bow 1"]] {
        click(&mut session, "Add a morph target");
        click(&mut session, "Bow");
        session.settle_when(|session| names(session).len() == expected.len());
        assert_eq!(names(&session), expected);
    }
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(names(&session), ["Bow"]);
    let example = &examples(&session).unwrap().shapes[0];
    let places = bar().positions;
    let model = Arc::clone(session.harness.state().editor().view().model.unwrap());
    assert_eq!(model.surface.positions.len(), places.len());
    let pulled = example.displacements.iter().map(|d| d.length()).fold(0.0, f64::max);
    assert!(pulled > 1.0, "{pulled}");
}

/// Wrinkles are learnt from the file's targets, and the slider multiplies them.
#[test]
fn the_faces_wrinkles_come_from_its_morph_targets_and_go_by_the_slider() {
    let Some(mut session) = begin(assets().join("face.glb"), "bilaplacian") else {
        return;
    };
    let brow = session.point_of(|positions| {
        let highest = positions.iter().map(|p| p.y).fold(f64::MIN, f64::max);
        let lowest = positions.iter().map(|p| p.y).fold(f64::MAX, f64::min);
        let wanted = lowest + 0.68 * (highest - lowest);
        let near = |p: &&DVec3| (p.y - wanted).abs() + p.x.abs() - p.z;
        *positions.iter().min_by(|a, b| near(a).total_cmp(&near(b))).unwrap()
    });
    session.stroke(brow, brow + vec2(30.0, 0.0));
    let id = session
        .harness
        .state()
        .editor()
        .view()
        .selected
        .expect("a handle was painted");
    let height = session
        .harness
        .state()
        .editor()
        .view()
        .model
        .unwrap()
        .bounds()
        .unwrap()
        .extent()
        .y;
    let up = HandleTransform::Trs {
        translation: DVec3::Y * (0.04 * height),
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    session.harness.state_mut().command(Command::SetHandleTransform(id, up));
    session.settle();
    let plain = session.shape();
    let wrinkles = Method::from_name("wrinkles").unwrap();
    session.harness.state_mut().command(Command::SetMethod(wrinkles));
    session.settle();
    // Nothing is learnt yet.
    assert!(largest_distance(&session.shape(), &plain) < 1e-5 * height);
    click(&mut session, "Add a morph target");
    click(&mut session, "Brows raised");
    session.settle_when(|session| !names(session).is_empty());
    assert_eq!(names(&session), ["Brows raised"]);
    let whole = session.shape();
    assert!(largest_distance(&whole, &plain) > 1e-4 * height);

    // The knob is at 1, the middle of 0 to 2: at the left end there are no wrinkles, and Undo restores them.
    slide(&mut session, "Brows raised", 0.5, -0.1);
    assert_eq!(examples(&session).unwrap().weights, [Some(0.0)]);
    assert!(largest_distance(&session.shape(), &plain) < 1e-5 * height);
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(session.shape(), whole);
}
