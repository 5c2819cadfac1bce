//! Control points of cages and lattices in the window's program: shown, picked, boxed, moved, undone.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Fingerprint, Rig, VIEWPORT_PX, at};
use glam::{DVec2, DVec3};
use pliant_deform::{Attachment, ControlMesh, Method};
use pliant_editor::{Button, Command, Event, GizmoPart, JobKind, Modifiers, Pointer, StrokeShape, ToolMode};
use pliant_mesh::shapes;

/// A ball without handles that bends by this method.
fn ball(method: &str) -> Rig {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose(method);
    rig.command(Command::SetTool(ToolMode::Select));
    rig.drain();
    rig
}

/// The control points' places on the screen, unselected ones first.
fn points_px(rig: &Rig) -> Vec<DVec2> {
    let view = rig.editor.view();
    // After the edges at the back and in front, the frames of pinned points and the rims.
    let squares = view.controls[4..].iter().flat_map(|shape| shape.triangles.chunks(2));
    let middles = squares.map(|square| (square[0][0] + square[0][2]) * 0.5);
    middles.map(|p| view.camera.project(p, VIEWPORT_PX).unwrap()).collect()
}

/// A point beside the ball, the nearest to it: at its place on the screen nothing else can be taken.
fn beside(rig: &Rig) -> DVec2 {
    let points = points_px(rig).into_iter().filter(|p| rig.editor.pick(*p).is_none());
    let distance = |p: &DVec2| p.distance(CENTRE_PX);
    points.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
}

fn with(position_px: DVec2, modifiers: Modifiers) -> Pointer {
    Pointer { position_px, modifiers }
}

fn selected(rig: &Rig) -> usize {
    rig.editor.view().control_points.unwrap().selected
}

fn is_own(rig: &Rig) -> bool {
    rig.editor.view().control_points.unwrap().is_own
}

#[test]
fn a_point_of_the_made_cage_or_lattice_is_dragged_undone_and_redone_to_the_bit() {
    for method in ["cage", "lattice"] {
        let mut rig = ball(method);
        assert!(!is_own(&rig) && rig.largest_displacement() == 0.0, "{method}");
        let before = Fingerprint::of(rig.editor.document());
        let from_px = beside(&rig);
        rig.swipe(&[
            from_px,
            from_px + DVec2::new(20.0, 10.0),
            from_px + DVec2::new(60.0, 30.0),
        ]);
        rig.drain();
        assert!(is_own(&rig) && selected(&rig) == 1, "{method}");
        let problem = rig.editor.view().problem;
        assert!(
            rig.largest_displacement() > 1e-3,
            "{method}: {} {problem:?}",
            rig.largest_displacement()
        );
        assert!(rig.editor.document().is_settled());
        let name = rig.editor.view().undo.unwrap().to_owned();
        assert!(name.starts_with("Move point") && name.contains(method), "{name}");
        // The point is where the pointer has left it.
        let to_px = from_px + DVec2::new(60.0, 30.0);
        let nearest = points_px(&rig)
            .iter()
            .map(|p| p.distance(to_px))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1.0, "{method}: {nearest}");
        let after = Fingerprint::of(rig.editor.document());
        let attachments = rig.editor.document().attachments().clone();
        rig.command(Command::Undo);
        rig.drain();
        assert_eq!(Fingerprint::of(rig.editor.document()), before, "{method}");
        assert!(rig.editor.document().attachments().is_empty() && !is_own(&rig));
        rig.command(Command::Redo);
        rig.drain();
        assert_eq!(Fingerprint::of(rig.editor.document()), after, "{method}");
        assert_eq!(*rig.editor.document().attachments(), attachments, "{method}");
        let nearest = points_px(&rig)
            .iter()
            .map(|p| p.distance(to_px))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1.0, "{method}: {nearest}");
    }
}

#[test]
fn once_the_cage_is_the_documents_moving_its_points_binds_nothing_anew() {
    let mut rig = ball("cage");
    let from_px = beside(&rig);
    rig.swipe(&[from_px, from_px + DVec2::X * 20.0]);
    rig.drain();
    let from_px = beside(&rig);
    rig.swipe(&[from_px, from_px + DVec2::Y * 15.0, from_px + DVec2::Y * 30.0]);
    let waiting = rig.jobs.waiting();
    assert!(
        waiting.contains(&JobKind::Solve) && !waiting.contains(&JobKind::Bind),
        "{waiting:?}"
    );
    rig.drain();
    // Other coordinates are another binding of the same cage.
    let method = Method::from_name("cage").unwrap();
    let green = method
        .with([("coordinates", pliant_deform::OptionValue::Name("green"))])
        .unwrap();
    let cage = rig.editor.document().attachments().clone();
    rig.command(Command::SetMethod(green));
    rig.drain();
    assert_eq!(*rig.editor.document().attachments(), cage);
    assert_eq!(rig.editor.view().problem, None);
    assert!(rig.editor.document().is_settled());
    assert!(rig.largest_displacement() > 1e-3, "{}", rig.largest_displacement());
}

/// A point that the gizmo of another one covers can still be taken.
#[test]
fn the_square_of_another_point_is_before_the_gizmo() {
    let mut rig = ball("lattice");
    let points = points_px(&rig);
    let mut covered = 0;
    for first in points.iter().step_by(5) {
        rig.command(Command::DeselectControls);
        rig.swipe(&[*first]);
        let view = rig.editor.view();
        let is_under = |px: &DVec2| pliant_editor::hit_gizmo(view.gizmo, *px, view.camera, VIEWPORT_PX).is_some();
        let others = points.iter().filter(|px| px.distance(*first) > 20.0);
        let under: Vec<DVec2> = others.copied().filter(is_under).collect();
        for px in under {
            covered += 1;
            let before = Fingerprint::of(rig.editor.document());
            rig.swipe(&[px]);
            assert_eq!(selected(&rig), 1);
            let now = rig.editor.view();
            let places = now.gizmo.iter().flat_map(|shape| shape.lines.iter().flatten());
            let middle = places.clone().sum::<DVec3>() / places.count() as f64;
            let away = now.camera.project(middle, VIEWPORT_PX).unwrap().distance(px);
            assert!(away < 60.0, "the gizmo is {away} px from the point that was clicked");
            assert!(
                Fingerprint::of(rig.editor.document()) == before,
                "a click moves nothing"
            );
            rig.swipe(&[*first]);
        }
    }
    assert!(covered > 0);
}

#[test]
fn points_are_added_boxed_and_moved_together_in_one_step() {
    let mut rig = ball("cage");
    let points = points_px(&rig);
    let first = beside(&rig);
    rig.swipe(&[first]);
    assert_eq!((selected(&rig), is_own(&rig)), (1, false), "a click moves nothing");
    let far = |p: &&DVec2| points.iter().all(|q| q == *p || q.distance(**p) > 20.0);
    let second = *points.iter().filter(far).find(|p| p.distance(first) > 20.0).unwrap();
    let shift = with(second, Modifiers::SHIFT);
    rig.send(Event::PointerMoved(shift));
    rig.send(Event::PointerPressed(shift, Button::Primary));
    rig.send(Event::PointerReleased(shift, Button::Primary));
    assert_eq!(selected(&rig), 2);
    // Everything visible, in a box drawn with Ctrl.
    let [from, to] = [DVec2::splat(1.0), VIEWPORT_PX - 1.0].map(|p| with(p, Modifiers::CTRL));
    rig.send(Event::PointerMoved(from));
    rig.send(Event::PointerPressed(from, Button::Primary));
    rig.send(Event::PointerMoved(to));
    assert_eq!(rig.editor.view().outline_px.len(), 4);
    rig.send(Event::PointerReleased(to, Button::Primary));
    let seen = selected(&rig);
    assert!(
        seen > 2 && seen < points.len(),
        "what the ball hides is left: {seen} of {}",
        points.len()
    );
    rig.command(Command::SelectControls);
    assert_eq!(selected(&rig), points.len());
    rig.move_by('x', "0.5");
    rig.drain();
    // All points have the same displacement: so does the ball.
    for displacement in rig.editor.document().from_file().iter() {
        assert!(displacement.distance(DVec3::X * 0.5) < 1e-9);
    }
    assert_eq!(rig.editor.history().names().0.len(), 2);
    assert!(
        rig.editor
            .view()
            .gizmo
            .iter()
            .any(|shape| shape.part == GizmoPart::Ring(1))
    );
    // The gizmo moves the points further.
    assert!(rig.drag(GizmoPart::Arrow(1), DVec2::new(0.0, -40.0)));
    rig.drain();
    assert!(rig.editor.document().from_file().iter().all(|d| d.y > 0.01));
    rig.command(Command::ResetControls);
    rig.drain();
    assert!(is_own(&rig) && rig.largest_displacement() == 0.0);
    assert!(!rig.editor.is_enabled(&Command::ResetControls));
    rig.command(Command::MakeControls);
    rig.drain();
    assert!(!is_own(&rig) && rig.largest_displacement() == 0.0);
    rig.command(Command::DeselectControls);
    assert_eq!(selected(&rig), 0);
}

#[test]
fn handles_are_met_beside_moved_points_and_both_are_undone_step_by_step() {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.choose("cage");
    rig.paint_handle();
    rig.drain();
    rig.command(Command::SetTool(ToolMode::Select));
    rig.move_by('z', "0.1");
    rig.drain();
    let one = Fingerprint::of(rig.editor.document());
    rig.command(Command::SelectControls);
    let count = selected(&rig);
    assert!(count > 8);
    rig.move_by('y', "0.2");
    rig.drain();
    let two = Fingerprint::of(rig.editor.document());
    assert_ne!(one, two);
    rig.command(Command::Undo);
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), one);
    rig.command(Command::Redo);
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), two);
    // A clicked handle takes the gizmo back.
    rig.swipe(&[CENTRE_PX]);
    assert_eq!(selected(&rig), 0);
    rig.command(Command::Apply);
    rig.drain();
    assert!(rig.editor.document().attachments().is_empty() && !is_own(&rig));
}

#[test]
fn the_net_is_shown_and_taken_by_the_select_tool_alone() {
    for method in ["cage", "lattice"] {
        let mut rig = ball(method);
        let shown = points_px(&rig);
        let (over, outside) = (
            *shown.iter().find(|p| p.distance(CENTRE_PX) < 120.0).unwrap(),
            beside(&rig),
        );
        let tools = [
            ToolMode::PaintHandle,
            ToolMode::PaintFree,
            ToolMode::PaintFixed,
            ToolMode::Erase,
            ToolMode::PaintStiffness,
            ToolMode::Pose,
            ToolMode::Correct,
            ToolMode::Flow,
        ];
        for tool in tools {
            rig.command(Command::SetTool(ToolMode::Select));
            rig.command(Command::SelectControls);
            rig.command(Command::SetTool(tool));
            let points = rig.editor.view().control_points.unwrap();
            assert_eq!((points.count, points.selected), (shown.len(), 0), "{method} {tool:?}");
            assert!(rig.editor.view().controls.is_empty(), "{method} {tool:?}");
            rig.swipe(&[outside]);
            assert!(selected(&rig) == 0 && !is_own(&rig), "{method} {tool:?}");
        }
        // All points are selected where they are seen.
        rig.command(Command::SelectControls);
        assert_eq!(rig.editor.view().tool, ToolMode::Select);
        assert_eq!(
            (selected(&rig), points_px(&rig).len()),
            (shown.len(), shown.len()),
            "{method}"
        );
        rig.command(Command::SetTool(ToolMode::PaintHandle));
        rig.swipe(&[over]);
        rig.drain();
        assert_eq!((selected(&rig), rig.editor.document().handles().len()), (0, 1));
    }
}

#[test]
fn what_can_not_be_done_with_points_is_told_with_its_reason() {
    let mut rig = Rig::open(shapes::icosphere(2));
    for command in [Command::MakeControls, Command::ResetControls, Command::SelectControls] {
        let why = rig.editor.unavailable_because(&command).unwrap();
        assert!(why.contains("Cage"), "{why}");
    }
    let rest = Arc::new(vec![DVec3::ZERO; 3]);
    let no_cage = Attachment::Mesh(ControlMesh {
        rest: Arc::clone(&rest),
        triangles: Arc::new(vec![[0, 1, 2]]),
        moved: rest,
    });
    rig.command(Command::BringAttachment(no_cage.clone()));
    assert!(rig.editor.view().problem.unwrap().contains("has no such input"));
    rig.choose("cage");
    rig.command(Command::BringAttachment(no_cage));
    assert!(rig.editor.view().problem.unwrap().starts_with("The cage has 3 points"));
    assert!(rig.editor.document().attachments().is_empty());
    rig.move_to(at(CENTRE_PX).position_px);
}

#[test]
fn with_the_select_tool_a_box_is_for_the_points_that_are_shown() {
    let mut rig = ball("cage");
    rig.command(Command::SetStrokeShape(StrokeShape::Box));
    assert_eq!(rig.editor.view().tool, ToolMode::Select);
    rig.swipe(&[DVec2::splat(1.0), CENTRE_PX, VIEWPORT_PX - 1.0]);
    assert!(selected(&rig) > 2, "{}", selected(&rig));
    // Without points a box paints.
    let mut plain = ball("bilaplacian");
    plain.command(Command::SetStrokeShape(StrokeShape::Box));
    assert_eq!(plain.editor.view().tool, ToolMode::PaintHandle);
}
