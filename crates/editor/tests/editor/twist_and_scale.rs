//! The pose tool's twists and scales, by Ctrl and Shift while it drags.

use crate::pose::{drag, open, pointer, seen};
use crate::rig::VIEWPORT_PX;
use glam::{DVec2, DVec3};
use pliant_editor::{Button, Command, Event, Modifiers, NamedView};

#[test]
fn ctrl_twists_and_shift_scales_and_each_goes_on_from_where_the_other_ended() {
    let twisted = |modifiers| {
        let mut rig = open();
        let hand_px = seen(&rig, 3.4..4.0);
        drag(&mut rig, hand_px, DVec2::new(0.0, 40.0), modifiers);
        rig
    };
    let rig = twisted(Modifiers::CTRL);
    assert_eq!(rig.editor.history().undo_name(), Some("Twist handle 1"));
    let affine = rig.editor.document().handles()[0].affine();
    let axis = affine.transform_vector3(DVec3::X);
    assert!(axis.distance(DVec3::X) < 0.05, "the limb's axis stays: {axis}");
    assert!(affine.transform_vector3(DVec3::Y).angle_between(DVec3::Y) > 0.5);

    let rig = twisted(Modifiers::SHIFT);
    assert_eq!(rig.editor.history().undo_name(), Some("Scale handle 1"));
    let handle = &rig.editor.document().handles()[0];
    assert_eq!(handle.turn_deg, DVec3::ZERO);
    let factor = handle.affine().transform_vector3(DVec3::X).x;
    assert!((factor - 1.0).abs() > 0.01, "{factor}");

    // First a turn, then a twist from there.
    let mut rig = open();
    let from_px = seen(&rig, 4.0..4.6);
    rig.move_to(from_px);
    rig.drain();
    rig.send(Event::PointerPressed(
        pointer(from_px, Modifiers::NONE),
        Button::Primary,
    ));
    let mid_px = from_px + DVec2::new(-10.0, -70.0);
    rig.move_to(mid_px);
    let turned = rig.editor.document().handles()[0].affine();
    rig.send(Event::PointerMoved(pointer(mid_px, Modifiers::CTRL)));
    let same = rig.editor.document().handles()[0].affine();
    assert!(same.abs_diff_eq(turned, 1e-9), "the modifier alone moves nothing");
    rig.send(Event::PointerMoved(pointer(
        mid_px + DVec2::new(-40.0, 0.0),
        Modifiers::CTRL,
    )));
    let after = rig.editor.document().handles()[0].affine();
    let [was, is] = [turned, after].map(|affine| affine.transform_vector3(DVec3::X));
    assert!(was.distance(is) < 0.05, "{was} {is}");
    assert!(!after.abs_diff_eq(turned, 1e-3));
    rig.release(mid_px + DVec2::new(-40.0, 0.0));
    rig.drain();
}

#[test]
fn a_scale_grows_with_the_path_alike_wherever_the_limb_is_grabbed() {
    let factor = |x| {
        let mut rig = open();
        let hand_px = seen(&rig, x);
        let joint_px = seen(&rig, 0.0..0.2);
        let outwards = (hand_px - joint_px).normalize();
        drag(&mut rig, hand_px, outwards * 60.0, Modifiers::SHIFT);
        let handle = &rig.editor.document().handles()[0];
        handle.affine().transform_vector3(DVec3::X).x
    };
    let factors = [1.7..1.9, 2.4..2.8, 3.4..4.0, 4.4..4.8].map(factor);
    for grown in factors {
        let last = factors[3];
        assert!(last > 1.1 && (grown - last).abs() < 0.25 * (last - 1.0), "{factors:?}");
    }
}

#[test]
fn a_scale_that_a_twist_interrupts_ends_where_one_without_a_break_does() {
    let factor = |is_interrupted: bool| {
        let mut rig = open();
        let hand_px = seen(&rig, 3.4..4.0);
        let outwards = (hand_px - seen(&rig, 0.0..0.2)).normalize();
        let at = |way_px: f64, modifiers| pointer(hand_px + way_px * outwards, modifiers);
        rig.move_to(hand_px);
        rig.drain();
        rig.send(Event::PointerPressed(at(0.0, Modifiers::SHIFT), Button::Primary));
        rig.send(Event::PointerMoved(at(150.0, Modifiers::SHIFT)));
        if is_interrupted {
            rig.send(Event::PointerMoved(at(150.0, Modifiers::CTRL)));
            rig.send(Event::PointerMoved(at(150.0, Modifiers::SHIFT)));
        }
        rig.send(Event::PointerMoved(at(300.0, Modifiers::SHIFT)));
        rig.release(hand_px + 300.0 * outwards);
        rig.drain();
        let handle = &rig.editor.document().handles()[0];
        handle.affine().transform_vector3(DVec3::X).x
    };
    let [whole, interrupted] = [false, true].map(factor);
    assert!(
        whole > 1.5 && (interrupted / whole - 1.0).abs() < 0.01,
        "{whole} {interrupted}"
    );
}

#[test]
fn a_twist_follows_the_pointer_from_all_sides() {
    // The arm is across the view, points at the viewer, and nearly does.
    for (view, orbit_px) in [
        (NamedView::Front, 0.0),
        (NamedView::Top, 0.0),
        (NamedView::Right, 0.0),
        (NamedView::Right, 60.0),
        (NamedView::Right, 160.0),
    ] {
        let mut rig = open();
        rig.command(Command::View(view));
        let centre_px = 0.5 * VIEWPORT_PX;
        rig.send(Event::PointerPressed(
            pointer(centre_px, Modifiers::NONE),
            Button::Middle,
        ));
        rig.move_to(centre_px + DVec2::new(orbit_px, 0.0));
        rig.send(Event::PointerReleased(
            pointer(centre_px + DVec2::new(orbit_px, 0.0), Modifiers::NONE),
            Button::Middle,
        ));
        let from_px = seen(&rig, 4.0..4.6);
        let mut turned = |by_px: DVec2| {
            drag(&mut rig, from_px, by_px, Modifiers::CTRL);
            let turn_deg = rig.editor.document().handles()[0].turn_deg.length();
            rig.command(Command::Undo);
            turn_deg
        };
        // One of both ways is across the arm, and twice as far turns about twice as much.
        let ways = [DVec2::X, DVec2::Y].map(|way| [30.0, 60.0].map(|px| turned(px * way)));
        let [half, whole] = if ways[0][1] > ways[1][1] { ways[0] } else { ways[1] };
        assert!(whole > 30.0 && whole < 180.0, "{view:?} {orbit_px}: {ways:?}");
        assert!((0.4..0.6).contains(&(half / whole)), "{view:?} {orbit_px}: {ways:?}");
    }
}
