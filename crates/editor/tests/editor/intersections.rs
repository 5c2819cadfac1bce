//! The warning if a shape passes through itself: found once it rests, never searched for while it moves, and only about
//! crossings that the edit has made.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use crate::rig::{CENTRE_PX, Rig};
use glam::{DQuat, DVec3};
use pliant_editor::{Command, HandleId, HandleTransform, JobKind, Key};
use pliant_mesh::shapes;

fn moved(translation: DVec3) -> HandleTransform {
    HandleTransform::Trs {
        translation,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    }
}

/// A ball with a handle, and the vector from the handle to the ball's middle.
fn ball() -> (Rig, HandleId, DVec3) {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    let handle = &rig.editor.document().handles()[0];
    let (id, inward) = (handle.id, -handle.pivot);
    (rig, id, inward)
}

#[test]
fn a_cap_that_is_pushed_through_the_other_side_is_told_once_it_rests() {
    let (mut rig, id, inward) = ball();
    assert!(rig.editor.intersections().is_none(), "nothing is bent");
    assert!(rig.editor.unavailable_because(&Command::FrameIntersection(0)).is_some());
    rig.command(Command::SetHandleTransform(id, moved(inward * 0.3)));
    rig.drain();
    let found = rig.editor.intersections().expect("it rests");
    assert!(found.is_empty() && found.sentence().is_none(), "{found:?}");
    rig.command(Command::SetHandleTransform(id, moved(inward * 2.5)));
    assert!(rig.editor.intersections().is_none(), "the shape is another");
    rig.drain();
    let found = rig.editor.intersections().expect("it rests").clone();
    assert!(found.are_all && !found.places[0].segments.is_empty());
    assert!(found.sentence().unwrap().contains("passes through itself"));
    assert!(rig.editor.view().status.contains("passes through itself"));
    let lines = rig
        .editor
        .view()
        .shapes
        .iter()
        .map(|shape| shape.lines.len())
        .sum::<usize>();
    let segments = found.places.iter().map(|place| place.segments.len()).sum::<usize>();
    assert_eq!(lines, segments, "each is drawn");
    // These are the places where the cap comes out on the other side.
    for end in found.places[0].segments.as_flattened() {
        assert!(end.dot(inward) > 0.0 && (end.length() - 1.0).abs() < 0.1, "{end}");
    }
    rig.command(Command::FrameIntersection(0));
    assert!(rig.editor.view().camera.target.dot(inward) > 0.5 * inward.length_squared());
    rig.undo();
    rig.drain();
    assert!(rig.editor.intersections().is_some_and(|found| found.is_empty()));
    rig.undo();
    rig.drain();
    assert!(rig.editor.intersections().is_none(), "nothing is bent");
}

#[test]
fn nothing_is_looked_for_while_a_handle_is_dragged() {
    let (mut rig, id, inward) = ball();
    rig.command(Command::SetHandleTransform(id, moved(inward * 2.5)));
    rig.drain();
    assert!(rig.editor.intersections().is_some());
    rig.command(Command::SelectHandle(id));
    rig.type_keys("g");
    for step in 1..4 {
        rig.move_to(CENTRE_PX + glam::DVec2::new(3.0 * f64::from(step), 0.0));
        assert!(!rig.jobs.waiting().contains(&JobKind::Intersect));
        rig.drain();
        assert!(rig.editor.intersections().is_none(), "it moves");
    }
    rig.key(Key::Enter);
    rig.drain();
    assert!(rig.editor.intersections().is_some_and(|found| !found.is_empty()));
    // A late search does not apply to the present shape.
    rig.move_by('x', ".01");
    while !rig.jobs.waiting().contains(&JobKind::Intersect) {
        let done = rig.jobs.run_next().unwrap();
        rig.send(pliant_editor::Event::JobDone(done));
    }
    rig.move_by('x', ".01");
    rig.run(JobKind::Intersect);
    assert!(rig.editor.intersections().is_none());
    rig.drain();
    assert!(rig.editor.intersections().is_some());
}
