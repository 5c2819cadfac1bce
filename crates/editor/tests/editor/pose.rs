//! The pose brush: from an untouched surface to a bent limb in one gesture, which is one step and a handle like any other.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig;
use crate::rig::{Rig, VIEWPORT_PX};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use pliant_deform::Role;
use pliant_editor::{
    Axis, Button, Command, EditFile, Event, JobKind, Key, Modifiers, NamedView, Paint, PivotPlace, Pointer, Reach,
    Selector, Symmetry, ToolMode,
};
use pliant_mesh::{Drawn, Model, shapes};
use serde_json::{Value, json};

/// The narrowest places of both arms of [`body_with_arms`].
const JOINT: f64 = 1.45;

/// A ball of radius 1.3 about the origin with two arms along x, to 5 and -5; each is narrowest at its beginning.
fn body_with_arms() -> Drawn {
    let profile = |share: f64| {
        let x: f64 = 5.0 * (1.0 - 2.0 * share);
        let ball = (1.3 * 1.3 - x * x).max(0.0).sqrt();
        let arm = 0.28 + 0.12 * ((x.abs() - JOINT) / 3.0).clamp(-1.0, 1.0).powi(2);
        let cap = (1.0 - ((x.abs() - 4.6) / 0.4).max(0.0).powi(2)).max(0.0).sqrt();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { ball.max(arm * cap) }, x)
    };
    let along_x = DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X));
    shapes::moved(&shapes::turned(100, 24, profile), along_x)
}

pub fn open() -> Rig {
    let mut rig = Rig::open(body_with_arms());
    rig.command(Command::SetTool(ToolMode::Pose));
    rig
}

/// The place on the screen of the middle of the surface's vertices with x between these.
pub fn seen(rig: &Rig, x: std::ops::Range<f64>) -> DVec2 {
    let view = rig.editor.view();
    let vertices = rig.model.surface.positions.iter().zip(view.displacements.iter());
    let within: Vec<DVec3> = vertices
        .filter(|(p, _)| x.contains(&p.x))
        .map(|(p, d)| *p + *d)
        .collect();
    let middle = within.iter().sum::<DVec3>() / within.len() as f64;
    view.camera.project(middle, VIEWPORT_PX).unwrap()
}

pub fn pointer(position_px: DVec2, modifiers: Modifiers) -> Pointer {
    Pointer { position_px, modifiers }
}

/// Drags with these modifiers, from one point by a number of points.
pub fn drag(rig: &mut Rig, from_px: DVec2, by_px: DVec2, modifiers: Modifiers) {
    rig.send(Event::PointerMoved(pointer(from_px, modifiers)));
    rig.drain();
    rig.send(Event::PointerPressed(pointer(from_px, modifiers), Button::Primary));
    for step in 1..=4 {
        let to_px = from_px + by_px * (f64::from(step) / 4.0);
        rig.send(Event::PointerMoved(pointer(to_px, modifiers)));
    }
    let to_px = from_px + by_px;
    rig.send(Event::PointerReleased(pointer(to_px, modifiers), Button::Primary));
    rig.drain();
}

#[test]
fn one_drag_bends_an_untouched_limb_about_its_joint_in_one_step() {
    let mut rig = open();
    let before = rig.fingerprint();
    let hand_px = seen(&rig, 4.0..4.6);
    rig.move_to(hand_px);
    rig.drain();
    assert!(
        !rig.editor.view().shapes.is_empty(),
        "the joint is shown before anything is pressed"
    );
    assert_eq!(rig.fingerprint(), before, "looking changes nothing");
    drag(&mut rig, hand_px, DVec2::new(-40.0, -120.0), Modifiers::NONE);

    let document = rig.editor.document();
    let handle = document.handles()[0].clone();
    assert_eq!(document.handles().len(), 1);
    assert_eq!(rig.editor.view().selected, Some(handle.id));
    assert_eq!(handle.pivot_place, PivotPlace::Picked);
    assert!(handle.pivot.distance(DVec3::X * JOINT) < 0.15, "{}", handle.pivot);
    assert!(handle.centre().distance(handle.pivot) < 1e-12, "the joint stays");
    assert!(handle.turn_deg.length() > 20.0, "{}", handle.turn_deg);
    assert!(rig.editor.is_settled(), "{}", rig.editor.view().status);
    rig.assert_as_meant("one drag");
    let moved = document.from_file();
    for (p, d) in rig.model.surface.positions.iter().zip(&**moved) {
        assert!(p.x < 0.9 || p.x > 1.0 || d.length() < 1e-9, "the body is held at {p}");
        if p.x > 2.2 {
            let rigid = handle.affine().transform_point3(*p);
            assert!(
                (*p + *d).distance(rigid) < 1e-9,
                "the arm's far side goes as one at {p}"
            );
        }
    }
    assert_eq!(rig.editor.history().undo_name(), Some("Turn handle 1"));
    rig.undo();
    rig.drain();
    assert_eq!(rig.fingerprint(), before, "one step takes all of it back");
    rig.redo();
    rig.drain();
    assert_eq!(rig.editor.document().handles().len(), 1);
}

/// The numbers of surface vertices with x between these, and of those among them with a colour.
fn coloured(rig: &Rig, x: std::ops::Range<f64>) -> (usize, usize) {
    let mut colours = Vec::new();
    rig.editor.region_colours(&mut colours);
    let within = rig.model.surface.positions.iter().zip(&colours);
    let within: Vec<_> = within.filter(|(p, _)| x.contains(&p.x)).collect();
    (within.len(), within.iter().filter(|(_, colour)| colour[3] > 0).count())
}

#[test]
fn the_limb_under_the_pointer_is_tinted_until_the_pointer_or_the_tool_goes() {
    let mut rig = open();
    let arm = seen(&rig, 3.0..4.0);
    rig.send(Event::PointerMoved(pointer(arm, Modifiers::NONE)));
    rig.drain();
    // The job's result is shown with the next event.
    rig.send(Event::PointerMoved(pointer(arm, Modifiers::NONE)));
    let (count, tinted) = coloured(&rig, 2.5..5.1);
    assert!(count > 100 && tinted == count, "{tinted} of {count}");
    assert_eq!(
        coloured(&rig, -5.1..0.5).1,
        0,
        "the body and the other arm stay as they are"
    );
    rig.send(Event::PointerLeft);
    rig.drain();
    assert_eq!(coloured(&rig, -5.1..5.1).1, 0);
    rig.send(Event::PointerMoved(pointer(arm, Modifiers::NONE)));
    rig.drain();
    rig.command(Command::SetTool(ToolMode::PaintFixed));
    assert_eq!(coloured(&rig, -5.1..5.1).1, 0);
}

#[test]
fn a_press_before_the_joint_is_found_loses_nothing_of_the_drag() {
    let mut patient = open();
    let from_px = seen(&patient, 4.0..4.6);
    let by_px = DVec2::new(-30.0, -90.0);
    drag(&mut patient, from_px, by_px, Modifiers::NONE);
    let mut hasty = open();
    hasty.swipe(&[from_px, from_px + by_px * 0.5, from_px + by_px]);
    assert!(
        hasty.editor.document().handles().is_empty(),
        "its joint is not known yet"
    );
    assert!(hasty.editor.view().status.contains("Finding the joint"));
    hasty.drain();
    let [patient, hasty] = [&patient, &hasty].map(|rig| rig.editor.document().handles()[0].clone());
    assert_eq!(hasty.pivot, patient.pivot);
    assert!(hasty.turn_deg.distance(patient.turn_deg) < 1e-9);
}

#[test]
fn the_limb_follows_alone_until_it_is_bound_and_the_surface_catches_up() {
    let mut rig = open();
    let from_px = seen(&rig, 4.0..4.6);
    rig.move_to(from_px);
    rig.drain();
    rig.send(Event::PointerPressed(
        pointer(from_px, Modifiers::NONE),
        Button::Primary,
    ));
    rig.move_to(from_px + DVec2::new(0.0, -60.0));
    assert!(
        rig.largest_displacement() > 0.3,
        "nothing has run, and the limb is there"
    );
    assert!(rig.editor.view().readout.is_some());
    rig.run(JobKind::Region);
    rig.run(JobKind::Bind);
    rig.move_to(from_px + DVec2::new(0.0, -80.0));
    assert!(rig.run(JobKind::Solve), "while it is dragged it is solved");
    rig.release(from_px + DVec2::new(0.0, -80.0));
    rig.drain();
    rig.assert_as_meant("after catching up");
}

#[test]
fn a_limb_that_was_posed_is_taken_again_and_its_handle_is_one_like_any_other() {
    let mut rig = open();
    let hand_px = seen(&rig, 4.0..4.6);
    drag(&mut rig, hand_px, DVec2::new(0.0, -80.0), Modifiers::NONE);
    let once = rig.editor.document().handles()[0].clone();
    let hand_px = seen(&rig, 4.0..4.6);
    drag(&mut rig, hand_px, DVec2::new(0.0, -40.0), Modifiers::NONE);
    let twice = rig.editor.document().handles()[0].clone();
    assert_eq!(rig.editor.document().handles().len(), 1);
    assert!(twice.turn_deg.length() > once.turn_deg.length() + 5.0);
    assert!(twice.centre().distance(once.centre()) < 1e-9);
    // The joint's falloff is the handle's reach, and the pivot can be moved.
    let Reach::Length(reach) = twice.reach else {
        panic!("the falloff is a length")
    };
    assert!(reach > 0.3 && reach < 1.5, "{reach}");
    rig.command(Command::SetReach(twice.id, Reach::Length(1.5 * reach)));
    rig.command(Command::SetPivot(twice.id, DVec3::X));
    rig.drain();
    assert!(rig.editor.document().handles()[0].centre().distance(DVec3::X) < 1e-9);
    // Beside the far side the arm still belongs to the same handle.
    let elbow_px = seen(&rig, 1.75..1.85);
    drag(&mut rig, elbow_px, DVec2::new(0.0, 30.0), Modifiers::NONE);
    assert_eq!(rig.editor.document().handles().len(), 1);
}

#[test]
fn another_limb_of_a_bent_surface_gets_a_handle_of_its_own_and_nothing_jumps() {
    let mut rig = open();
    let hand_px = seen(&rig, 4.0..4.6);
    drag(&mut rig, hand_px, DVec2::new(0.0, -80.0), Modifiers::NONE);
    let bent = rig.drawn();
    let other_px = seen(&rig, -4.6..-4.0);
    rig.move_to(other_px);
    rig.drain();
    rig.press(other_px);
    assert_eq!(rig.drawn(), bent, "a press moves nothing");
    rig.release(other_px);
    rig.drain();
    assert_eq!(rig.drawn(), bent, "nor does a click");
    assert_eq!(rig.editor.document().handles().len(), 2, "which makes a handle");
    assert_eq!(rig.editor.history().undo_name(), Some("Make handle 2"));
    let handle = rig.editor.document().handles()[1].clone();
    assert!(
        handle.centre().distance(DVec3::X * -JOINT) < 0.15,
        "{}",
        handle.centre()
    );
    drag(&mut rig, other_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    assert_eq!(rig.editor.document().handles().len(), 2);
    assert!(rig.editor.document().handles()[1].turn_deg.length() > 10.0);
}

#[test]
fn escape_leaves_no_trace_whether_the_joint_is_known_or_not() {
    let mut rig = open();
    let before = rig.fingerprint();
    let hand_px = seen(&rig, 4.0..4.6);
    rig.press(hand_px);
    rig.move_to(hand_px + DVec2::new(0.0, -50.0));
    rig.key(Key::Escape);
    rig.drain();
    assert_eq!(rig.fingerprint(), before);
    rig.press(hand_px);
    rig.move_to(hand_px + DVec2::new(0.0, -50.0));
    rig.drain();
    assert_eq!(rig.editor.document().handles().len(), 1);
    rig.key(Key::Escape);
    rig.drain();
    assert_eq!(rig.fingerprint(), before);
    rig.release(hand_px);
    assert!(!rig.editor.is_acting() && rig.editor.view().undo.is_none());
}

#[test]
fn where_there_is_no_joint_a_sentence_says_so_and_nothing_changes() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.command(Command::SetTool(ToolMode::Pose));
    let before = rig.fingerprint();
    drag(&mut rig, rig::CENTRE_PX, DVec2::new(30.0, 0.0), Modifiers::NONE);
    assert!(rig.editor.view().problem.is_some_and(|why| why.contains("No joint")));
    assert_eq!(rig.fingerprint(), before);
    assert!(!rig.editor.is_acting());
}

#[test]
fn another_tool_forgets_the_joint_and_a_locked_limb_is_left_alone() {
    let mut rig = open();
    let hand_px = seen(&rig, 4.0..4.6);
    rig.move_to(hand_px);
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.drain();
    assert!(rig.editor.view().shapes.is_empty());
    rig.command(Command::SetTool(ToolMode::Pose));
    drag(&mut rig, hand_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::ToggleHandleLocked(id));
    let before = rig.fingerprint();
    let hand_px = seen(&rig, 4.0..4.6);
    drag(&mut rig, hand_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    assert_eq!(rig.fingerprint(), before);
    assert!(rig.editor.view().problem.is_some_and(|why| why.contains("locked")));
    assert!(rig.count(Paint::Handle(id)) > 0);
}

#[test]
fn with_symmetry_the_other_limb_is_posed_in_a_mirror_and_one_step_takes_both_back() {
    let mut rig = open();
    rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
    rig.drain();
    let before = rig.fingerprint();
    let hand_px = seen(&rig, 4.0..4.6);
    drag(&mut rig, hand_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 2);
    let twin = handles[0].twin.unwrap();
    assert_eq!((twin.handle, twin.plane.axis()), (handles[1].id, Some(0)));
    let point = DVec3::new(3.0, 0.2, -0.1);
    let [moved, other] = [
        handles[0].affine().transform_point3(point),
        handles[1].affine().transform_point3(twin.plane.mirrored(point)),
    ];
    assert!(moved.distance(point) > 0.1);
    assert!(twin.plane.mirrored(moved).distance(other) < 1e-12);
    let count = |handle: usize| {
        let paint = rig.editor.document().paint().iter();
        paint
            .filter(|paint| **paint == Paint::Handle(handles[handle].id))
            .count()
    };
    assert_eq!(count(0), count(1));
    rig.command(Command::Undo);
    rig.drain();
    assert_eq!(rig.fingerprint(), before);
}

#[test]
fn a_limb_across_the_plane_of_symmetry_has_no_twin() {
    let mut rig = open();
    // Each arm is on both sides of y = 0.
    rig.command(Command::SetSymmetry(Symmetry::Axis(1)));
    rig.drain();
    let hand_px = seen(&rig, 4.0..4.6);
    drag(&mut rig, hand_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    let handles = rig.editor.document().handles();
    assert_eq!((handles.len(), handles[0].twin), (1, None));
}

/// A leg: a shaft of three parts along x from a large ball, with narrow places at `HIP` and `KNEE`.
fn body_with_a_leg_of_two_parts() -> Drawn {
    let profile = |share: f64| {
        let x: f64 = 6.0 - 8.0 * share;
        let ball = (1.6 * 1.6 - x * x).max(0.0).sqrt();
        let narrow = |at: f64| 1.0 - 0.5 * (-((x - at) / 0.35).powi(2)).exp();
        let leg = if x > 0.0 {
            0.55 * narrow(HIP) * narrow(KNEE)
        } else {
            0.0
        };
        let cap = (1.0 - ((x - 5.5) / 0.5).max(0.0).powi(2)).max(0.0).sqrt();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { ball.max(leg * cap) }, x)
    };
    let along_x = DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X));
    shapes::moved(&shapes::turned(140, 28, profile), along_x)
}

const HIP: f64 = 1.9;
const KNEE: f64 = 3.8;

fn open_leg() -> Rig {
    let mut rig = Rig::open(body_with_a_leg_of_two_parts());
    rig.command(Command::SetTool(ToolMode::Pose));
    rig
}

/// Holds that the leg hangs together as a thigh and a shank: its two handles have their joints at hip and knee, and the
/// shank is the thigh's child.
fn assert_two_joints(rig: &Rig, thigh: usize, shank: usize) {
    let handles = rig.editor.document().handles();
    assert_eq!(handles.len(), 2);
    assert!(
        handles[thigh].pivot.distance(DVec3::X * HIP) < 0.2,
        "{}",
        handles[thigh].pivot
    );
    assert!(
        handles[shank].pivot.distance(DVec3::X * KNEE) < 0.2,
        "{}",
        handles[shank].pivot
    );
    assert_eq!(
        (handles[shank].parent, handles[thigh].parent),
        (Some(handles[thigh].id), None)
    );
}

#[test]
fn a_knee_and_then_its_hip_are_posed_by_one_drag_each_and_the_shank_rides_along() {
    let mut rig = open_leg();
    let shank_px = seen(&rig, 4.6..5.2);
    drag(&mut rig, shank_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    let knee = rig.editor.document().handles()[0].clone();
    assert!(knee.pivot.distance(DVec3::X * KNEE) < 0.2, "{}", knee.pivot);
    let before = rig.fingerprint();
    let thigh_px = seen(&rig, 2.7..2.9);
    drag(&mut rig, thigh_px, DVec2::new(0.0, 50.0), Modifiers::NONE);
    assert_two_joints(&rig, 1, 0);
    let [shank, thigh] = [0, 1].map(|handle: usize| rig.editor.document().handles()[handle].clone());
    assert!(thigh.turn_deg.length() > 10.0);
    let composed = thigh.affine() * knee.affine();
    assert!(shank.affine().abs_diff_eq(composed, 1e-9), "turns compose");
    rig.assert_as_meant("hip after knee");
    rig.undo();
    rig.drain();
    assert_eq!(rig.fingerprint(), before, "one step");
    rig.redo();
    rig.drain();

    // The shank alone turns about the knee where that is now, and the thigh takes it along again.
    let shank_px = seen(&rig, 4.6..5.2);
    drag(&mut rig, shank_px, DVec2::new(20.0, 30.0), Modifiers::NONE);
    let after = rig.editor.document().handles().to_vec();
    assert_eq!((after.len(), after[1].transform), (2, thigh.transform));
    assert!(after[0].centre().distance(shank.centre()) < 1e-9);
    assert_ne!(after[0].transform, shank.transform);
    let thigh_px = seen(&rig, 2.7..2.9);
    drag(&mut rig, thigh_px, DVec2::new(0.0, -30.0), Modifiers::NONE);
    let last = rig.editor.document().handles();
    assert_eq!(last.len(), 2);
    let motion = last[1].affine() * after[1].affine().inverse();
    assert!(last[0].affine().abs_diff_eq(motion * after[0].affine(), 1e-9));
}

#[test]
fn a_hip_and_then_its_knee_are_posed_by_one_drag_each_and_nothing_jumps() {
    let mut rig = open_leg();
    let thigh_px = seen(&rig, 2.7..2.9);
    drag(&mut rig, thigh_px, DVec2::new(0.0, 50.0), Modifiers::NONE);
    assert_eq!(rig.editor.document().handles().len(), 1);
    let bent = rig.editor.document().from_file().to_vec();
    let shank_px = seen(&rig, 4.6..5.2);
    rig.move_to(shank_px);
    rig.drain();
    rig.press(shank_px);
    rig.release(shank_px);
    rig.drain();
    let now = rig.editor.document().from_file();
    let moved = now.iter().zip(&bent).map(|(now, was)| now.distance(*was));
    let moved = moved.fold(0.0, f64::max);
    assert!(moved < 1e-6, "a click makes the knee and moves nothing: {moved}");
    drag(&mut rig, shank_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    assert_two_joints(&rig, 0, 1);
    let handles = rig.editor.document().handles();
    assert!(handles[1].turn_deg.distance(handles[0].turn_deg) > 10.0);
    rig.assert_as_meant("knee after hip");
}

#[test]
fn parents_are_kept_by_files_and_circles_of_them_are_refused() {
    let mut rig = open_leg();
    for (from, by) in [(4.6..5.2, -60.0), (2.7..2.9, 50.0)] {
        let from_px = seen(&rig, from);
        drag(&mut rig, from_px, DVec2::new(0.0, by), Modifiers::NONE);
    }
    let [shank, thigh] = [0, 1].map(|handle: usize| rig.editor.document().handles()[handle].id);
    rig.command(Command::SetParent(thigh, Some(shank)));
    assert!(
        rig.editor
            .view()
            .problem
            .is_some_and(|why| why.contains("rides along with"))
    );
    let edit = rig.editor.edit_file().unwrap();
    let text = edit.to_json();
    let read = EditFile::parse(&text).unwrap();
    let parents: Vec<_> = read.handles.iter().map(|handle| handle.parent).collect();
    assert_eq!(parents.iter().flatten().count(), 1, "{text}");
    let place = parents.iter().position(Option::is_some).unwrap();
    let other = 1 - place;
    let circle = text.replace(&format!("\"parent\": {other}"), &format!("\"parent\": {place}"));
    let refusal = EditFile::parse(&circle).unwrap_err().to_string();
    assert!(refusal.contains(&format!("handles[{place}].parent")), "{refusal}");
    rig.command(Command::SetParent(shank, None));
    assert_eq!(rig.editor.document().handles()[0].parent, None);
    rig.undo();

    // A thigh that is deleted away from rest becomes a pin: its child neither moves with it nor is lost.
    rig.command(Command::SelectHandle(thigh));
    rig.command(Command::DeleteHandle);
    rig.drain();
    let handles = rig.editor.document().handles();
    assert!(handles.iter().any(|handle| handle.id == thigh && handle.is_pin));
    let shank_before = handles[0].transform;
    let shank_px = seen(&rig, 4.6..5.2);
    drag(&mut rig, shank_px, DVec2::new(0.0, 20.0), Modifiers::NONE);
    let handles = rig.editor.document().handles();
    assert_eq!(handles.len(), 2);
    assert_ne!(handles[0].transform, shank_before);
}

/// An edit with these handles.
fn edit_of(handles: &Value) -> EditFile {
    EditFile::from_value(&json!({"version": 1, "method": {"name": "bilaplacian"}, "handles": handles})).unwrap()
}

#[test]
fn an_edit_finds_the_limb_that_a_drag_makes_a_handle() {
    let mut rig = open();
    let (right_px, left_px) = (seen(&rig, 4.0..4.6), seen(&rig, -4.6..-4.0));
    drag(&mut rig, right_px, DVec2::new(-40.0, -120.0), Modifiers::NONE);
    drag(&mut rig, left_px, DVec2::new(40.0, -120.0), Modifiers::NONE);
    let dragged = rig.editor.edit_file().unwrap().resolve(&rig.model).unwrap();
    let transform = |number: usize| json!(dragged.handles[number].transform);
    // Far from the surface: its nearest point counts.
    let edit = edit_of(&json!([
        {"pose": {"at": [4.3, 0.0, 9.0]}, "transform": transform(0)},
        {"pose": {"at": [-4.3, 0.0, 9.0]}, "transform": transform(1)},
    ]));
    let found = edit.resolve(&rig.model).unwrap();
    assert!(
        found.roles == dragged.roles,
        "the handles, what is free and what is fixed"
    );
    for (found, dragged) in found.handles.iter().zip(&dragged.handles) {
        assert!(
            found.pivot.distance(dragged.pivot) < 1e-12,
            "{} {}",
            found.pivot,
            dragged.pivot
        );
    }
    assert_eq!(EditFile::parse(&edit.to_json()).unwrap(), edit);
    // Another region replaces the one around the joints.
    let wide = EditFile {
        region: Selector::Slab {
            axis: Axis::X,
            from: 0.0,
            to: 1.0,
        },
        ..edit
    };
    assert_eq!(
        wide.resolve(&rig.model)
            .unwrap()
            .roles
            .iter()
            .filter(|role| **role == Role::Fixed)
            .count(),
        0
    );
}

/// A ball of radius 1.3 about the origin with an arm along x that is narrowest at 1.6 and at 3.4 and ends at 5.
fn body_with_an_elbow() -> Drawn {
    let profile = |share: f64| {
        let x: f64 = 1.85 + 3.15 * (1.0 - 2.0 * share);
        let ball = (1.3 * 1.3 - x * x).max(0.0).sqrt();
        let waist = |at: f64| (-((x - at) / 0.35).powi(2)).exp();
        let arm = 0.42 - 0.16 * (waist(1.6) + waist(3.4));
        let cap = (1.0 - ((x - 4.6) / 0.4).max(0.0).powi(2)).max(0.0).sqrt();
        let arm = if x < 0.0 { 0.0 } else { arm * cap };
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { ball.max(arm) }, x)
    };
    let along_x = DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X));
    shapes::moved(&shapes::turned(120, 32, profile), along_x)
}

#[test]
fn candidates_lead_from_the_elbow_to_the_shoulder_and_a_limb_of_a_limb_takes_its_part() {
    let model = rig::weld(body_with_an_elbow());
    let hand = [4.4, 0.0, 0.4];
    let centre = |up: i32| {
        let edit = edit_of(&json!([{"pose": {"at": hand, "up": up}}]));
        edit.resolve(&model).unwrap().handles[0].pivot
    };
    assert!(centre(0).distance(DVec3::X * 3.4) < 0.15, "{}", centre(0));
    assert!(centre(1).distance(DVec3::X * 1.6) < 0.15, "{}", centre(1));
    let both = [json!({"pose": {"at": hand, "up": 1}}), json!({"pose": {"at": hand}})];
    let roles = |handles: [Value; 2]| edit_of(&json!(handles)).resolve(&model).unwrap().roles;
    let (shoulder_first, elbow_first) = (roles(both.clone()), roles([both[1].clone(), both[0].clone()]));
    for ((one, other), p) in shoulder_first.iter().zip(&elbow_first).zip(&model.surface.positions) {
        let swapped = match one {
            Role::Handle(number) => Role::Handle(1 - number),
            role => *role,
        };
        assert_eq!(swapped, *other, "the order in the list is the same at {p}");
        let wanted = match p.x {
            x if x > 3.9 => Some(Role::Handle(1)),
            x if x > 3.25 && x < 3.5 => Some(Role::Free),
            x if x > 2.3 && x < 2.6 => Some(Role::Handle(0)),
            x if x > 1.5 && x < 1.7 => Some(Role::Free),
            x if x < 0.8 => Some(Role::Fixed),
            _ => None,
        };
        assert!(wanted.is_none_or(|wanted| wanted == *one), "{one:?} at {p}");
    }
}

#[test]
fn ctrl_and_the_wheel_choose_another_joint_until_the_pointer_leaves_the_limb() {
    let mut rig = Rig::open(body_with_an_elbow());
    rig.command(Command::SetTool(ToolMode::Pose));
    let hand_px = seen(&rig, 4.3..4.6);
    let before = rig.fingerprint();
    let wheel = |rig: &mut Rig, lines: f64, modifiers: Modifiers| {
        let pointer = pointer(hand_px, modifiers);
        rig.send(Event::Wheel { pointer, lines });
        rig.drain();
    };
    // The joint about which a drag from here turns.
    let pivot = |rig: &mut Rig| {
        drag(rig, hand_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
        let pivot = rig.editor.document().handles()[0].pivot;
        rig.undo();
        rig.drain();
        rig.move_to(hand_px);
        rig.drain();
        pivot
    };
    rig.move_to(hand_px);
    rig.drain();
    assert!(pivot(&mut rig).distance(DVec3::X * 3.4) < 0.15);
    wheel(&mut rig, 0.5, Modifiers::CTRL);
    assert!(pivot(&mut rig).distance(DVec3::X * 3.4) < 0.15, "half a notch");
    // The second half; two more notches find no further joint.
    for lines in [0.5, 2.0] {
        wheel(&mut rig, lines, Modifiers::CTRL);
    }
    drag(&mut rig, hand_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    let shoulder = rig.editor.document().handles()[0].pivot;
    assert!(shoulder.distance(DVec3::X * 1.6) < 0.15, "{shoulder}");
    rig.undo();
    rig.drain();
    rig.move_to(hand_px);
    rig.drain();
    for lines in [1.0, -1.0] {
        wheel(&mut rig, lines, Modifiers::CTRL);
    }
    assert!(pivot(&mut rig).distance(DVec3::X * 3.4) < 0.15, "there and back");
    wheel(&mut rig, 1.0, Modifiers::CTRL);
    rig.move_to(DVec2::ONE);
    rig.drain();
    rig.move_to(hand_px);
    rig.drain();
    assert!(pivot(&mut rig).distance(DVec3::X * 3.4) < 0.15, "the guess again");
    assert_eq!(rig.fingerprint(), before, "choosing changes nothing");
}

#[test]
fn a_limb_that_is_not_there_is_refused_in_words() {
    let model = rig::weld(body_with_an_elbow());
    let ball = rig::weld(shapes::icosphere(4));
    let refusal = |model: &Model, handles: Value| edit_of(&handles).resolve(model).unwrap_err().to_string();
    let at = [4.4, 0.0, 0.4];
    let cases = [
        (
            refusal(&ball, json!([{"pose": {"at": [0, 0, 1]}}])),
            "handles[0].pose has no joint: give a point on a limb",
        ),
        (
            refusal(&model, json!([{"pose": {"at": at, "up": 7}}])),
            "handles[0].pose.up is 7, which is out of range: give a number from 0 to 1",
        ),
        (
            refusal(&model, json!([{"pose": {"at": at}}, {"pose": {"at": [4.3, 0, 0.4]}}])),
            "handles[0].pose gives a limb that is all part of another handle's: choose another `up`",
        ),
    ];
    for (found, wanted) in cases {
        assert!(found.contains(wanted), "{found}");
    }
    let stored =
        json!({"version": 1, "method": {"name": "bilaplacian"}, "handles": [{"pose": {"at": at}, "select": "all"}]});
    let refused = EditFile::from_value(&stored).unwrap_err().to_string();
    assert!(refused.contains("handles[0] has both `select` and `pose`"), "{refused}");
}

#[test]
fn a_loose_part_that_touches_a_limb_leads_to_the_limb_and_turns_with_it() {
    let place = DVec3::new(4.0, 0.0, 0.42);
    let button = DAffine3::from_scale_rotation_translation(DVec3::splat(0.12), glam::DQuat::IDENTITY, place);
    let button = shapes::moved(&shapes::icosphere(2), button);
    let mut rig = Rig::open(shapes::together(&[body_with_arms(), button]));
    rig.command(Command::SetTool(ToolMode::Pose));
    rig.command(Command::View(NamedView::Front));
    rig.drain();
    let view = rig.editor.view();
    let from_px = view.camera.project(place + DVec3::Z * 0.12, VIEWPORT_PX).unwrap();
    let part = rig.editor.pick(from_px).unwrap().vertex;
    let part = rig.model.topology.component(part);
    let parts = rig.model.topology.components().len();
    assert_eq!(parts, 2);
    assert!(
        rig.model.topology.vertices_of(part).len() < 400,
        "the pointer is on the button"
    );
    drag(&mut rig, from_px, DVec2::new(0.0, -40.0), Modifiers::NONE);
    let document = rig.editor.document();
    assert_eq!(document.handles().len(), 1, "{}", rig.editor.view().status);
    let handle = &document.handles()[0];
    assert!((handle.centre().x - JOINT).abs() < 0.4, "{}", handle.centre());
    let own = |vertex: u32| document.paint()[vertex as usize] == Paint::Handle(handle.id);
    assert!(rig.model.topology.vertices_of(part).all(|vertex| own(vertex.0)));
    let hand = (0..).zip(&rig.model.surface.positions).filter(|(_, p)| p.x > 4.7);
    assert!(hand.map(|(vertex, _)| vertex).all(own));
}
