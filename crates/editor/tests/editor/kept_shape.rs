//! Strokes on a bent shape: handles keep their transforms, and the next drag begins from the visible shape.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig;
use crate::rig::{CENTRE_PX, Rig};
use glam::{DVec2, DVec3};
use pliant_deform::{HandleFit, METHODS};
use pliant_editor::{Command, GizmoPart, HandleId, HandleTransform, Key, Paint, Reach, ToolMode};
use pliant_mesh::shapes;

/// A sphere with a handle on the side that faces the eye, moved aside.
fn bent(method: &str) -> Rig {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.choose(method);
    rig.paint_handle();
    rig.drain();
    rig.command(Command::SetReach(HandleId(0), Reach::Length(0.7)));
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    assert_eq!(translation(&rig, 0), DVec3::new(0.2, 0.0, 0.0));
    rig
}

fn translation(rig: &Rig, id: u16) -> DVec3 {
    match rig.editor.document().handle(HandleId(id)).unwrap().transform {
        HandleTransform::Trs { translation, .. } => translation,
        HandleTransform::Matrix(map) => map.translation,
    }
}

/// A stroke beside the gizmo.
fn stroke(rig: &mut Rig, mode: ToolMode, from: DVec2, to: DVec2) {
    rig.command(Command::SetTool(mode));
    rig.command(Command::SetBrushRadius(14.0));
    rig.swipe(&[from, to]);
    rig.drain();
}

/// A place above the handle, where the surface bends but is not fixed.
fn beside() -> [DVec2; 2] {
    let middle = rig::VIEWPORT_PX * 0.5;
    [middle + DVec2::new(-70.0, -75.0), middle + DVec2::new(-50.0, -80.0)]
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_second_handle_leaves_the_first_ones_numbers_and_the_first_goes_back_to_where_it_rested() {
    for declaration in METHODS {
        let mut rig = bent(declaration.name);
        let seen = rig.drawn();
        rig.command(Command::NewHandle);
        let [from, to] = beside();
        stroke(&mut rig, ToolMode::PaintHandle, from, to);
        let document = rig.editor.document();
        assert_eq!(document.handles().len(), 2, "{}", declaration.name);
        assert!(!document.is_applied(), "nothing was baked");
        assert_eq!(translation(&rig, 0), DVec3::new(0.2, 0.0, 0.0), "{}", declaration.name);
        assert!(seen == rig.drawn(), "no stroke moves a drawn vertex");
        // The new handle is at its vertices' visible positions.
        let document = rig.editor.document();
        let mut painted = document.paint().iter().zip(document.from_rest());
        let has_moved = painted.any(|(paint, by)| *paint == Paint::Handle(HandleId(1)) && *by != DVec3::ZERO);
        let new = document.handle(HandleId(1)).unwrap();
        assert_eq!(new.is_displaced(), has_moved, "{}", declaration.name);
        // The first is lowered: its vertices are back at rest.
        rig.command(Command::SelectHandle(HandleId(0)));
        rig.command(Command::ResetHandle);
        rig.drain();
        let paint = rig.editor.document().paint().to_vec();
        let from_rest = rig.editor.document().from_rest();
        let own = (0..paint.len()).filter(|&vertex| paint[vertex] == Paint::Handle(HandleId(0)));
        // A method that only fits its handles leaves them at rest only if nothing else moves.
        if (declaration.default)().handle_fit() == HandleFit::LeastSquares {
            continue;
        }
        for vertex in own {
            assert!(
                from_rest[vertex].length() < 1e-6,
                "{}: {}",
                declaration.name,
                from_rest[vertex]
            );
        }
    }
}

#[test]
fn the_drag_after_a_stroke_begins_from_what_is_seen() {
    for declaration in METHODS {
        for mode in [
            ToolMode::PaintFree,
            ToolMode::PaintFixed,
            ToolMode::PaintStiffness,
            ToolMode::Erase,
        ] {
            let mut rig = bent(declaration.name);
            let (drawn, seen) = (rig.drawn(), rig.editor.document().from_rest().to_vec());
            let [from, to] = beside();
            stroke(&mut rig, mode, from, to);
            assert!(drawn == rig.drawn(), "{} {mode:?}", declaration.name);
            rig.command(Command::SelectHandle(HandleId(0)));
            rig.move_by('x', ".001");
            rig.drain();
            let way = farthest(rig.editor.document().from_rest(), &seen);
            assert!(way < 0.02, "{} {mode:?}: it jumps by {way}", declaration.name);
            assert!(way > 1e-5, "{} {mode:?}: it moves", declaration.name);
        }
    }
}

#[test]
fn what_is_painted_fixed_on_a_bent_shape_is_a_pin_that_stays_whatever_is_dragged() {
    let mut rig = bent("arap");
    let [from, to] = beside();
    stroke(&mut rig, ToolMode::PaintFixed, from, to);
    let pin = rig.editor.document().handles().last().unwrap().clone();
    assert!(pin.is_pin && pin.is_displaced(), "{pin:?}");
    let paint = rig.editor.document().paint().to_vec();
    let held: Vec<usize> = (0..paint.len())
        .filter(|&v| paint[v] == Paint::Handle(pin.id))
        .collect();
    let seen: Vec<DVec3> = held.iter().map(|&v| rig.editor.document().from_rest()[v]).collect();
    rig.command(Command::SelectHandle(HandleId(0)));
    rig.move_by('y', ".3");
    rig.drain();
    let now: Vec<DVec3> = held.iter().map(|&v| rig.editor.document().from_rest()[v]).collect();
    assert!(farthest(&seen, &now) < 1e-9, "{}", farthest(&seen, &now));
    // It can't be moved and has no gizmo until it is a handle again.
    rig.command(Command::SelectHandle(pin.id));
    assert!(rig.editor.view().gizmo.is_empty());
    rig.key(Key::Character('g'));
    assert!(!rig.editor.is_acting(), "a pin is not dragged");
    rig.command(Command::PinOrUnpin);
    rig.drain();
    assert!(!rig.editor.view().gizmo.is_empty());
}

#[test]
fn the_gizmo_is_not_over_the_surface_that_a_tool_drags() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    rig.drain();
    for (mode, is_shown) in [
        (ToolMode::Select, true),
        (ToolMode::PaintHandle, true),
        (ToolMode::Pose, false),
        (ToolMode::Correct, false),
        (ToolMode::Flow, false),
    ] {
        rig.command(Command::SetTool(mode));
        assert_eq!(!rig.editor.view().gizmo.is_empty(), is_shown, "{mode:?}");
        // A key that moves the handle shows it with every tool.
        rig.type_keys("g");
        assert!(!rig.editor.view().gizmo.is_empty(), "{mode:?}");
        rig.key(Key::Escape);
    }
}

#[test]
fn a_stroke_goes_through_the_gizmo_but_on_a_part_that_the_pointer_rests_on() {
    let mut rig = Rig::open(shapes::icosphere(4));
    let aside = DVec2::X * 80.0;
    rig.paint(
        ToolMode::PaintHandle,
        &[CENTRE_PX - aside, CENTRE_PX, CENTRE_PX + aside],
    );
    rig.command(Command::SetTool(ToolMode::PaintFree));
    rig.drain();
    let seen = rig.drawn();
    for part in [GizmoPart::Centre, GizmoPart::Arrow(0), GizmoPart::Ring(1)] {
        let place = rig.place_of(part).unwrap();
        let painted = rig.editor.document().paint().to_vec();
        rig.swipe(&[place, place + DVec2::new(9.0, 7.0)]);
        rig.drain();
        assert!(seen == rig.drawn(), "{part:?}: a stroke moves nothing");
        let others = rig.editor.document().paint() != painted;
        assert!(others || rig.editor.pick(place).is_none(), "{part:?}: it paints");
    }
    let painted = rig.editor.document().paint().to_vec();
    let place = rig.grip(GizmoPart::Centre).unwrap();
    rig.swipe(&[place, place + DVec2::new(-40.0, 30.0)]);
    rig.drain();
    assert!(
        seen == rig.drawn() && rig.editor.document().paint() != painted,
        "the centre lies where a second stroke is painted"
    );
    let colour = |rig: &Rig, part| {
        let shape = rig.editor.view().gizmo.iter().find(|shape| shape.part == part);
        shape.unwrap().colour
    };
    let faded = colour(&rig, GizmoPart::Arrow(0));
    let place = rig.grip(GizmoPart::Arrow(0)).unwrap();
    assert!(colour(&rig, GizmoPart::Arrow(0))[3] > faded[3], "it lights up");
    rig.swipe(&[place, place + DVec2::new(30.0, 0.0)]);
    rig.drain();
    assert!(seen != rig.drawn(), "and is dragged");
}
