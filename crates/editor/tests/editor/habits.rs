//! The habits of artists: sizing the brush, the wheel, the right button, A, snapped turns, the original while a key is
//! held.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Rig, VIEWPORT_PX, at};
use glam::{DVec2, DVec3};
use pliant_editor::{Button, Command, Cursor, Event, Key, Modifiers, NamedView, Paint, Pointer, ToolMode};
use pliant_mesh::shapes;

fn wheel(rig: &mut Rig, modifiers: Modifiers, lines: f64) {
    let pointer = Pointer {
        position_px: CENTRE_PX,
        modifiers,
    };
    rig.send(Event::Wheel { pointer, lines });
}

#[test]
fn f_sizes_the_brush_by_the_pointer_and_escape_takes_it_back() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.move_to(CENTRE_PX);
    let before = rig.editor.view().brush_radius_px;
    rig.type_keys("f");
    let circle = rig.editor.view().outline_px.clone();
    let middle = circle.iter().sum::<DVec2>() / circle.len() as f64;
    assert!(
        (middle.distance(CENTRE_PX) - before).abs() < 1e-9,
        "the pointer is on the rim"
    );
    rig.move_to(CENTRE_PX + DVec2::X * 50.0);
    assert!((rig.editor.view().brush_radius_px - before - 50.0).abs() < 1e-9);
    rig.key(Key::Escape);
    assert_eq!(rig.editor.view().brush_radius_px, before);
    rig.move_to(CENTRE_PX);
    rig.type_keys("f");
    rig.swipe(&[CENTRE_PX + DVec2::X * 30.0]);
    assert!((rig.editor.view().brush_radius_px - before - 30.0).abs() < 1e-9);
    assert!(
        rig.editor.document().handles().is_empty(),
        "the click that keeps it paints nothing"
    );
    assert!(!rig.editor.is_acting());
    rig.command(Command::SetTool(ToolMode::Select));
    assert!(!rig.editor.is_enabled(&Command::SizeBrush));
}

#[test]
fn the_wheel_sizes_with_ctrl_softens_with_shift_and_zooms_otherwise() {
    let mut rig = Rig::open(shapes::icosphere(3));
    let distance = |rig: &Rig| rig.editor.view().camera.distance;
    let (radius, far) = (rig.editor.view().brush_radius_px, distance(&rig));
    wheel(&mut rig, Modifiers::CTRL, 1.0);
    assert!(rig.editor.view().brush_radius_px > radius);
    wheel(&mut rig, Modifiers::CTRL, -1.0);
    assert!((rig.editor.view().brush_radius_px - radius).abs() < 1e-9);
    assert_eq!(distance(&rig), far);
    rig.command(Command::SetTool(ToolMode::PaintStiffness));
    let falloff = rig.editor.view().stiffness_brush.falloff;
    wheel(&mut rig, Modifiers::SHIFT, -1.0);
    assert!(rig.editor.view().stiffness_brush.falloff < falloff);
    wheel(&mut rig, Modifiers::SHIFT, 1e9);
    assert_eq!(rig.editor.view().stiffness_brush.falloff, 1.0);
    assert_eq!(distance(&rig), far);
    wheel(&mut rig, Modifiers::NONE, 1.0);
    assert!(distance(&rig) < far);
    rig.command(Command::SetTool(ToolMode::Select));
    let near = distance(&rig);
    wheel(&mut rig, Modifiers::CTRL, -1.0);
    assert!(distance(&rig) > near, "without a brush it zooms");
}

#[test]
fn the_right_button_moves_the_camera_and_a_click_of_it_nothing() {
    let mut rig = Rig::open(shapes::icosphere(3));
    let before = (*rig.editor.view().camera, rig.fingerprint());
    let press = |rig: &mut Rig, to_px: DVec2| {
        rig.send(Event::PointerPressed(at(CENTRE_PX), Button::Secondary));
        rig.send(Event::PointerMoved(at(to_px)));
        rig.send(Event::PointerReleased(at(to_px), Button::Secondary));
    };
    press(&mut rig, CENTRE_PX);
    assert_eq!(*rig.editor.view().camera, before.0);
    press(&mut rig, CENTRE_PX + DVec2::X * 60.0);
    assert_ne!(*rig.editor.view().camera, before.0);
    assert_eq!(rig.fingerprint(), before.1);
    assert!(!rig.editor.is_acting());
}

#[test]
fn a_selects_all_handles_which_then_move_together() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    rig.command(Command::NewHandle);
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX + DVec2::X * 120.0]);
    rig.drain();
    assert_eq!(rig.editor.document().handles().len(), 2);
    rig.type_keys("a");
    assert_eq!(rig.editor.view().companions.len(), 1);
    rig.move_by('y', ".2");
    rig.drain();
    for handle in rig.editor.document().handles() {
        assert!(handle.affine().translation.distance(DVec3::Y * 0.2) < 1e-12);
    }
}

#[test]
fn a_drag_on_the_painted_handle_moves_it_and_one_beside_it_or_with_ctrl_paints() {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.paint_handle();
    rig.drain();
    let (painted, beside_px) = (rig.editor.document().paint().to_vec(), CENTRE_PX + DVec2::X * 120.0);
    rig.move_to(CENTRE_PX);
    assert_eq!(rig.editor.view().cursor, Cursor::Grab);
    assert!(rig.editor.view().brush_ring.is_empty(), "no brush is offered");
    rig.move_to(beside_px);
    assert_ne!(rig.editor.view().cursor, Cursor::Grab);
    rig.swipe(&[CENTRE_PX, CENTRE_PX + DVec2::Y * 30.0, CENTRE_PX + DVec2::Y * 60.0]);
    rig.drain();
    let way = rig.editor.document().handles()[0].affine().translation;
    let to_camera = rig.editor.view().camera.forward();
    assert!(
        way.y < -0.01 && way.dot(to_camera).abs() < 1e-9,
        "{way} is in the picture's plane"
    );
    assert_eq!(rig.editor.document().paint(), painted);
    assert_eq!(rig.editor.history().undo_name(), Some("Move handle 1"));
    rig.undo();
    rig.drain();
    assert_eq!(rig.editor.document().handles()[0].affine().translation, DVec3::ZERO);

    // A click on the handle is no step, and a stroke that begins beside it paints over its rim.
    let steps = rig.editor.history().names().1;
    rig.swipe(&[CENTRE_PX]);
    assert_eq!(rig.editor.history().names().1, steps);
    rig.swipe(&[beside_px, CENTRE_PX + DVec2::X * 60.0, CENTRE_PX]);
    assert_ne!(rig.editor.document().paint(), painted);
    rig.undo();
    let ctrl = Pointer {
        position_px: CENTRE_PX,
        modifiers: Modifiers::CTRL,
    };
    rig.send(Event::PointerMoved(ctrl));
    assert!(!rig.editor.view().brush_ring.is_empty(), "the brush is back");
    rig.send(Event::PointerPressed(ctrl, Button::Primary));
    rig.send(Event::PointerReleased(ctrl, Button::Primary));
    assert_ne!(rig.editor.document().paint(), painted, "Ctrl erases");
    rig.undo();
    assert_eq!(rig.editor.document().paint(), painted);
}

#[test]
fn after_every_tools_stroke_the_editor_rests() {
    let tools = [
        ToolMode::Correct,
        ToolMode::PaintHandle,
        ToolMode::PaintFree,
        ToolMode::PaintFixed,
        ToolMode::PaintStiffness,
        ToolMode::Select,
        ToolMode::Erase,
        ToolMode::Pose,
        ToolMode::Correct,
    ];
    let mut rig = Rig::open(shapes::icosphere(3));
    for tool in tools {
        rig.paint(tool, &[CENTRE_PX, CENTRE_PX + DVec2::new(40.0, 20.0)]);
        rig.drain();
        let view = rig.editor.view();
        assert!(view.settled, "{tool:?}: the picture stays coarse, and frames never end");
        assert!(view.jobs.is_empty(), "{tool:?}: {:?}", rig.jobs.waiting());
    }
}

#[test]
fn ctrl_holds_turns_to_fifteen_degrees_and_an_arc_shows_them() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.move_to(CENTRE_PX + DVec2::new(100.0, 20.0));
    rig.type_keys("rz");
    assert!(rig.editor.view().shapes.is_empty(), "nothing is turned yet");
    let ctrl = |position_px| {
        Event::PointerMoved(Pointer {
            position_px,
            modifiers: Modifiers::CTRL,
        })
    };
    rig.send(ctrl(CENTRE_PX + DVec2::new(90.0, -60.0)));
    rig.send(ctrl(CENTRE_PX + DVec2::new(30.0, -110.0)));
    assert!(!rig.editor.view().shapes.is_empty());
    let turn = rig.editor.document().handles()[0].turn_deg.z;
    assert!(
        turn.abs() > 10.0 && (turn / 15.0 - (turn / 15.0).round()).abs() < 1e-9,
        "{turn}"
    );
    rig.key(Key::Enter);
    assert!(rig.editor.view().shapes.is_empty());
    rig.drain();
}

#[test]
fn ctrl_lands_what_is_moved_near_the_ground_on_it_and_nothing_that_is_far_from_it() {
    for constraint in ["", "y"] {
        let mut rig = Rig::open(shapes::icosphere(3));
        rig.command(Command::View(NamedView::Front));
        rig.paint_handle();
        rig.drain();
        let ground = rig.model.bounds().unwrap().min.y;
        let own: Vec<f64> = members(&rig)
            .iter()
            .map(|&v| rig.model.surface.positions[v].y)
            .collect();
        let lowest = own.into_iter().fold(f64::INFINITY, f64::min);
        let camera = *rig.editor.view().camera;
        let per_px = camera.world_per_px(rig.editor.document().handles()[0].centre(), VIEWPORT_PX);
        rig.move_to(CENTRE_PX);
        rig.type_keys(&format!("g{constraint}"));
        let moved_by = |rig: &mut Rig, way: f64| {
            rig.send(Event::PointerMoved(Pointer {
                position_px: CENTRE_PX - DVec2::Y * way / per_px,
                modifiers: Modifiers::CTRL,
            }));
            rig.editor.document().handles()[0].affine().translation.y
        };
        let near = moved_by(&mut rig, ground - lowest + 6.0 * per_px);
        assert!((lowest + near - ground).abs() < 1e-12, "{constraint}: {near}");
        let far = moved_by(&mut rig, 0.5 * (ground - lowest));
        assert!((lowest + far - ground).abs() > 12.0 * per_px, "{constraint}: {far}");
        rig.key(Key::Escape);
        rig.drain();
    }
}

/// The vertices of the first handle.
fn members(rig: &Rig) -> Vec<usize> {
    let id = rig.editor.document().handles()[0].id;
    let paint = rig.editor.document().paint().iter().enumerate();
    paint
        .filter(|(_, paint)| **paint == Paint::Handle(id))
        .map(|(vertex, _)| vertex)
        .collect()
}

#[test]
fn the_original_is_shown_while_its_key_is_held_and_nothing_else_changes() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.move_by('x', ".3");
    rig.drain();
    let before = rig.fingerprint();
    let o = Key::Character('o');
    rig.key(o);
    rig.key(o);
    let view = rig.editor.view();
    assert!(
        view.drawn.iter().all(|d| *d == DVec3::ZERO),
        "a held key repeats and shows it all the same"
    );
    assert!(
        view.displacements.iter().any(|d| *d != DVec3::ZERO),
        "what is saved stays"
    );
    rig.send(Event::KeyReleased(Key::Character('p')));
    assert!(rig.editor.view().look.original, "another key's end means nothing");
    rig.send(Event::KeyReleased(o));
    let view = rig.editor.view();
    assert!(Arc::ptr_eq(view.drawn, view.displacements));
    assert_eq!(rig.fingerprint(), before);
    rig.command(Command::ToggleOriginal);
    assert!(
        rig.editor.view().look.original,
        "the menu shows it until it is chosen again"
    );
    rig.command(Command::ToggleOriginal);
    assert!(!rig.editor.view().look.original);
}
