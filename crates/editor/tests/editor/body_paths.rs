//! Laws of the bent path of a sequence's body: it goes through the places to which a pointer drags it, every change is a
//! step that undo takes back, a frame is shown where the exported edit carries it, the camera stays in the world, and
//! projects bring it back.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_editor::{Beginning, BodyMotion, BodyPath, Command, Event, ToolMode, middle_of};
use pliant_mesh::shapes;

use crate::project::{reopened, saved};
use crate::rig::{Rig, VIEWPORT_PX};
use crate::sequences::{COUNT, deliver, follow, frame, go_to, open, shape};

/// The middle of the body in a frame.
fn middle(rig: &Rig, number: usize) -> DVec3 {
    middle_of(&shape(rig, number))
}

/// A sequence with its path shown.
fn shown() -> Rig {
    let mut rig = open(shapes::icosphere(2));
    assert!(!rig.editor.view().wants_following);
    rig.command(Command::SetTool(ToolMode::Select));
    rig.command(Command::TogglePath);
    follow(&mut rig);
    rig
}

fn path(rig: &Rig) -> Option<BodyPath> {
    rig.editor.document().animation().path().map(|path| (**path).clone())
}

/// The body's motions by the exported edit, read as a file.
fn exported(rig: &Rig) -> Vec<BodyMotion> {
    let text = rig.editor.edit_file().unwrap().to_json();
    let Beginning::Edit(edit) = Beginning::parse(&text).unwrap() else {
        panic!("{text}");
    };
    let trajectory: Vec<DVec3> = (0..COUNT).map(|number| middle(rig, number)).collect();
    edit.body_motions(&trajectory)
}

/// The place on the screen of a point of the world.
fn on_screen(rig: &Rig, world: DVec3) -> DVec2 {
    let view = rig.editor.view();
    let seen = view
        .camera
        .project(view.body_motion.before(world), VIEWPORT_PX)
        .unwrap();
    let in_world = view.world_camera.project(world, VIEWPORT_PX).unwrap();
    assert!(seen.distance(in_world) < 1e-6, "{seen} {in_world}");
    seen
}

/// The point on the ground under the body in a frame.
fn ground(rig: &Rig, number: usize) -> DVec3 {
    let middle = middle(rig, number);
    let motion = exported(rig).get(number).copied();
    let place = motion.map_or(middle, |motion| motion.moved(middle));
    DVec3::new(place.x, -1.0, place.z)
}

fn drag(rig: &mut Rig, number: usize, by_px: DVec2) {
    let from = on_screen(rig, ground(rig, number));
    rig.swipe(&[from, from + 0.4 * by_px, from + by_px]);
    deliver(rig);
}

#[test]
fn a_drag_takes_the_way_along_on_the_ground_and_every_change_is_a_step() {
    let mut rig = shown();
    assert_eq!(path(&rig), None);
    let target = on_screen(&rig, ground(&rig, 20)) + DVec2::new(-90.0, 60.0);
    drag(&mut rig, 20, DVec2::new(-90.0, 60.0));
    let first = path(&rig).unwrap();
    let frames: Vec<usize> = first.shifts().map(|(frame, _)| frame).collect();
    assert_eq!(frames, [0, 20, COUNT - 1], "both ends stay");
    assert!(
        first
            .shifts()
            .all(|(frame, shift)| (frame == 20) != (shift == DVec3::ZERO))
    );
    assert!(first.shifts().all(|(_, shift)| shift.y.abs() < 1e-12), "it stays level");
    assert!(on_screen(&rig, ground(&rig, 20)).distance(target) < 1e-6);
    // A click adds a place that moves nothing there; dragging moves it again; Ctrl and a click remove it.
    let before = exported(&rig)[30].moved(middle(&rig, 30));
    drag(&mut rig, 30, DVec2::ZERO);
    assert_eq!(path(&rig).unwrap().shifts().count(), 4);
    assert!(exported(&rig)[30].moved(middle(&rig, 30)).distance(before) < 1e-12);
    let clicked = path(&rig);
    drag(&mut rig, 30, DVec2::new(30.0, 10.0));
    assert_ne!(path(&rig), clicked);
    rig.command(Command::FreePath(30));
    assert!(!path(&rig).unwrap().has(30));
    assert_eq!(
        rig.editor.history().names().0,
        ["Bend path", "Bend path", "Bend path", "Remove path point"]
    );
    rig.undo();
    rig.undo();
    assert_eq!(path(&rig), clicked);
    rig.undo();
    assert_eq!(path(&rig), Some(first));
    rig.undo();
    assert_eq!(path(&rig), None);
    assert!(!rig.editor.view().body_motion.moves());
    rig.redo();
    rig.command(Command::FreePath(20));
    rig.command(Command::FreePath(0));
    assert_eq!(path(&rig), None, "a single place is no path");
}

#[test]
fn every_frame_is_shown_where_the_exported_edit_carries_it_and_the_camera_stays_in_the_world() {
    let mut rig = shown();
    for (frame, shift) in [(10, DVec3::new(0.4, 0.0, -0.3)), (COUNT - 1, DVec3::new(0.0, 0.0, 2.0))] {
        rig.command(Command::BendPath(frame, shift));
    }
    let camera = *rig.editor.view().world_camera;
    let motions = exported(&rig);
    assert!(
        motions
            .iter()
            .any(|motion| motion.moved(DVec3::X).distance(DVec3::X) > 1.0)
    );
    for number in [0, 5, 10, 25, COUNT - 1, 10] {
        go_to(&mut rig, number);
        let view = rig.editor.view();
        assert_eq!(view.body_motion, motions[number], "{number}");
        // The frame itself is as it was read.
        assert_eq!(**view.displacements, *frame(&rig, number));
        assert_eq!(*view.world_camera, camera, "{number}");
        on_screen(&rig, ground(&rig, number) + DVec3::new(0.2, 0.5, -0.1));
    }
    // Turning the view by hand moves the camera in the world as much.
    let yaw_rad = rig.editor.view().camera.yaw_rad;
    rig.command(Command::FrameAll);
    assert!((rig.editor.view().camera.yaw_rad - yaw_rad).abs() < 1e-12);
}

#[test]
fn a_project_brings_the_path_back_and_shorter_sequences_keep_what_they_have() {
    let mut rig = shown();
    for (frame, shift) in [(10, DVec3::X), (30, DVec3::new(0.1, 0.0, 2.0))] {
        rig.command(Command::BendPath(frame, shift));
    }
    go_to(&mut rig, 25);
    let text = saved(&rig);
    for (count, frames) in [(COUNT, vec![0, 10, 30, COUNT - 1]), (20, vec![0, 10]), (8, Vec::new())] {
        let mut again = reopened(&rig, &text);
        let look = again.editor.view().look;
        assert!(look.timeline && look.path);
        again.send(Event::OpenedSequence {
            count,
            shown: None,
            fps: None,
        });
        deliver(&mut again);
        let kept: Vec<usize> = path(&again)
            .iter()
            .flat_map(|path| path.shifts())
            .map(|own| own.0)
            .collect();
        assert_eq!(kept, frames, "{count}");
        if count == COUNT {
            assert_eq!(path(&again), path(&rig));
            let camera = *again.editor.view().camera;
            follow(&mut again);
            assert_eq!(again.editor.view().body_motion, rig.editor.view().body_motion);
            assert_eq!(
                *again.editor.view().camera,
                camera,
                "the body is already in the picture"
            );
        }
    }
    let handled = text.replacen("\"path\": {\n", "\"path\": {\n      \"handle\": \"hips\",\n", 1);
    assert_ne!(handled, text);
    rig.send(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "handled".to_owned(),
        beginning: Some(Beginning::parse(&handled).unwrap()),
    });
    let sentence = rig.editor.view().problem.unwrap();
    assert!(
        sentence.contains("animation.path") && sentence.contains("remove it"),
        "{sentence}"
    );
}

#[test]
fn frames_that_cannot_be_read_say_so_once() {
    let mut rig = open(shapes::icosphere(1));
    rig.command(Command::TogglePath);
    assert!(rig.editor.view().wants_following);
    let following = rig.editor.following();
    rig.send(Event::Followed(
        following,
        Err("walk-3.obj is gone: put it back".to_owned()),
    ));
    assert!(rig.editor.view().problem.unwrap().contains("walk-3.obj"));
    assert!(!rig.editor.view().wants_following);
    rig.command(Command::TogglePath);
    rig.command(Command::TogglePath);
    follow(&mut rig);
    let mut single = Rig::open(shapes::icosphere(1));
    single.command(Command::TogglePath);
    assert!(!single.editor.view().look.path);
}
