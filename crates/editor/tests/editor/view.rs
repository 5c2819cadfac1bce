//! Laws of the view: snapping by Ctrl, the number beside a handle, the reach of the brush, and the views of keys.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig;
use crate::rig::{CENTRE_PX, Rig};
use glam::{DVec2, DVec3};
use pliant_editor::{
    BrushMetric, Button, Command, Event, GizmoPart, Key, Modifiers, NamedView, Orbit, Paint, Pointer, Projection,
    StiffnessBrush, ToolMode,
};
use pliant_mesh::shapes;

/// A sphere seen from the front, with a handle on it.
fn with_handle(projection: Projection) -> Rig {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.command(Command::View(NamedView::Front));
    if projection == Projection::Orthographic {
        rig.command(Command::ToggleProjection);
    }
    rig.paint_handle();
    rig.drain();
    rig
}

/// Drags a part of the gizmo with Ctrl held, and stops before letting go.
fn drag_with_ctrl(rig: &mut Rig, part: GizmoPart, by_px: DVec2) {
    let from = rig.grip(part).unwrap();
    rig.press(from);
    let pointer = |position_px| Pointer {
        position_px,
        modifiers: Modifiers::CTRL,
    };
    for share in [0.3, 0.7, 1.0] {
        rig.editor.handle(Event::PointerMoved(pointer(from + by_px * share)));
    }
}

#[test]
fn ctrl_holds_a_move_to_a_power_of_ten_and_a_turn_to_five_degrees() {
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let mut rig = with_handle(projection);
        let centre = rig.editor.view().handles[0].centre();
        let per_px = rig.editor.view().camera.world_per_px(centre, rig::VIEWPORT_PX);
        let step = 10.0_f64.powf((40.0 * per_px).log10().floor());
        drag_with_ctrl(&mut rig, GizmoPart::Arrow(0), DVec2::new(73.0, 5.0));
        let moved = rig.editor.view().handles[0].centre() - centre;
        let steps = moved.x / step;
        assert!((steps - steps.round()).abs() < 1e-9 && steps > 0.5, "{steps}");
        assert!((moved.x - 73.0 * per_px).abs() <= 0.5 * step + 1e-9);
        let readout = rig.editor.view().readout.unwrap();
        assert!(
            (readout.text.parse::<f64>().unwrap() - moved.length()).abs() < 1e-4,
            "{readout:?}"
        );
        assert!(readout.at.distance(rig.editor.view().handles[0].centre()) < 1e-12);
        rig.key(Key::Escape);
        assert_eq!(rig.editor.view().readout, None);

        rig.command(Command::Turn);
        let start = CENTRE_PX + DVec2::new(120.0, 0.0);
        rig.move_to(start);
        for angle in [5.0_f64, 12.0, 21.0] {
            let position_px = CENTRE_PX + 120.0 * DVec2::from_angle(angle.to_radians());
            let modifiers = Modifiers::CTRL;
            rig.editor
                .handle(Event::PointerMoved(Pointer { position_px, modifiers }));
        }
        let text = rig.editor.view().readout.unwrap().text;
        let degrees: f64 = text.strip_suffix('°').unwrap().parse().unwrap();
        assert!(
            (degrees / 5.0 - (degrees / 5.0).round()).abs() < 1e-9 && degrees.abs() > 4.0,
            "{text}"
        );
        rig.key(Key::Escape);
    }
}

#[test]
fn a_brush_that_reaches_through_takes_the_far_side_and_one_that_does_not_leaves_it() {
    for through in [false, true] {
        let mut rig = Rig::open(shapes::icosphere(4));
        rig.command(Command::View(NamedView::Front));
        rig.command(Command::SetTool(ToolMode::PaintFixed));
        if through {
            rig.command(Command::SetBrushMetric(BrushMetric::Through));
        }
        rig.paint(ToolMode::PaintFixed, &[CENTRE_PX, CENTRE_PX + DVec2::new(40.0, 0.0)]);
        let paint = rig.editor.document().paint();
        let side = |sign: f64| {
            let vertices = rig.model.surface.positions.iter().zip(paint);
            vertices
                .filter(|(p, paint)| p.z * sign > 0.5 && **paint == Paint::Fixed)
                .count()
        };
        assert!(side(1.0) > 4, "{}", side(1.0));
        assert_eq!(side(-1.0) > 4, through, "{} on the far side", side(-1.0));
        // Through the model: exactly the vertices that appear under the ring's path.
        if through {
            let view = rig.editor.view();
            for (vertex, paint) in paint.iter().enumerate() {
                let p = rig.model.surface.positions[vertex];
                let seen = view.camera.project(p, view.viewport_px).unwrap() - CENTRE_PX;
                let off = (seen - DVec2::new(seen.x.clamp(0.0, 40.0), 0.0)).length();
                let is_under = off < view.brush_radius_px - 1e-6;
                let is_outside = off > view.brush_radius_px + 1e-6;
                assert!(
                    if *paint == Paint::Fixed { !is_outside } else { !is_under },
                    "{vertex} {off}"
                );
            }
        }
    }
}

#[test]
fn a_stroke_however_fast_leaves_no_gap() {
    let mut rig = Rig::open(shapes::icosphere(5));
    rig.command(Command::View(NamedView::Front));
    let [from, to] = [-200.0, 200.0].map(|x| CENTRE_PX + DVec2::new(x, 10.0));
    // Only two events.
    rig.paint(ToolMode::PaintFixed, &[from, to]);
    let view = rig.editor.view();
    let under = rig
        .model
        .surface
        .positions
        .iter()
        .zip(rig.editor.document().paint())
        .filter(|(p, _)| {
            let seen = view.camera.project(**p, view.viewport_px).unwrap();
            // Vertices well within the ring at which the surface is not steep.
            p.z > 0.6 && (seen.y - from.y).abs() < 0.9 * view.brush_radius_px && seen.x > from.x && seen.x < to.x
        });
    let (mut all, mut painted) = (0, 0);
    for (_, paint) in under {
        all += 1;
        painted += usize::from(*paint == Paint::Fixed);
    }
    assert!(all > 100 && painted == all, "{painted} of {all}");
}

#[test]
fn the_numeric_pad_looks_from_where_blender_does_and_types_numbers_during_a_drag() {
    let mut rig = with_handle(Projection::Perspective);
    let forward = |rig: &Rig| rig.editor.view().camera.forward();
    for (digit, expected) in [(1, DVec3::NEG_Z), (3, DVec3::NEG_X), (7, DVec3::NEG_Y)] {
        rig.key(Key::Numpad(digit));
        assert!(forward(&rig).distance(expected) < 1e-9, "{digit}");
        rig.key(Key::Numpad(9));
        assert!(forward(&rig).distance(-expected) < 1e-9, "{digit} and 9");
    }
    rig.editor.handle(Event::Key(Key::Numpad(1), Modifiers::CTRL));
    assert!(forward(&rig).distance(DVec3::Z) < 1e-9);
    rig.key(Key::Numpad(5));
    assert_eq!(rig.editor.view().camera.projection, Projection::Orthographic);
    rig.key(Key::Numpad(6));
    assert!((forward(&rig).angle_between(DVec3::Z).to_degrees() - 15.0).abs() < 1e-6);
    let before = rig.editor.view().handles[0].centre();
    rig.type_keys("gx");
    rig.key(Key::Numpad(2));
    rig.key(Key::Enter);
    assert!((rig.editor.view().handles[0].centre() - before).distance(DVec3::X * 2.0) < 1e-9);
}

#[test]
fn a_trackball_rolls_and_the_turntable_levels_again() {
    let mut rig = Rig::open(shapes::icosphere(2));
    rig.command(Command::SetOrbit(Orbit::Trackball));
    let drag = |rig: &mut Rig, by: DVec2| {
        let pointer = |position_px| Pointer {
            position_px,
            modifiers: Modifiers::NONE,
        };
        rig.editor
            .handle(Event::PointerPressed(pointer(CENTRE_PX), Button::Middle));
        rig.editor.handle(Event::PointerMoved(pointer(CENTRE_PX + by)));
        rig.editor
            .handle(Event::PointerReleased(pointer(CENTRE_PX + by), Button::Middle));
    };
    drag(&mut rig, DVec2::new(80.0, 60.0));
    drag(&mut rig, DVec2::new(-20.0, 70.0));
    assert!(rig.editor.view().camera.roll_rad.abs() > 0.01);
    let forward = rig.editor.view().camera.forward();
    rig.command(Command::SetOrbit(Orbit::Turntable));
    let camera = rig.editor.view().camera;
    assert_eq!(camera.roll_rad, 0.0);
    assert!(
        camera.forward().distance(forward) < 1e-12,
        "levelling looks where one looked"
    );
}

#[test]
fn the_ring_lies_on_the_surface_and_is_as_far_from_its_middle_as_the_brush_reaches() {
    let mut rig = Rig::open(shapes::icosphere(5));
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::SetTool(ToolMode::PaintFree));
    for off_px in [DVec2::ZERO, DVec2::new(90.0, -60.0)] {
        rig.move_to(CENTRE_PX + off_px);
        let view = rig.editor.view();
        let ring = view.brush_ring;
        let middle = ring.iter().sum::<DVec3>() / ring.len() as f64;
        let radius = view.brush_radius_px * view.camera.world_per_px(middle, rig::VIEWPORT_PX);
        for point in ring {
            assert!((point.length() - 1.0).abs() < 0.01, "on the sphere: {}", point.length());
            assert!(
                (point.distance(middle) / radius - 1.0).abs() < 0.1,
                "{} of {radius}",
                point.distance(middle)
            );
        }
    }
}

#[test]
fn a_handle_closes_round_a_limb_as_thick_as_the_brush_and_leaves_the_back_of_a_body() {
    // A ball of radius 1 with a rod of radius 0.2 along x.
    let profile = |share: f64| {
        let x: f64 = 3.0 * (1.0 - 2.0 * share);
        let ball = (1.0 - x * x).max(0.0).sqrt();
        let rod = if (0.0..2.9).contains(&x) { 0.2 } else { 0.0 };
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { ball.max(rod) }, x.clamp(-1.0, 2.9))
    };
    let along_x = glam::DAffine3::from_mat3(glam::DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X));
    let mut rig = Rig::open(shapes::moved(&shapes::turned(120, 32, profile), along_x));
    rig.command(Command::View(NamedView::Front));
    rig.drain();
    let px = |rig: &Rig, p: DVec3| rig.editor.view().camera.project(p, rig::VIEWPORT_PX).unwrap();
    let radius_px = 1.3 * px(&rig, DVec3::new(2.0, 0.2, 0.0)).distance(px(&rig, DVec3::new(2.0, 0.0, 0.0)));
    rig.command(Command::SetBrushRadius(radius_px));
    let sides = |rig: &Rig, x: std::ops::Range<f64>| {
        let painted = rig.model.surface.positions.iter().zip(rig.editor.document().paint());
        let painted = painted.filter(|(p, paint)| x.contains(&p.x) && matches!(paint, Paint::Handle(_)));
        let (front, back): (Vec<_>, Vec<_>) = painted.partition(|(p, _)| p.z > 0.0);
        (front.len(), back.len())
    };
    let way = [1.8, 2.0, 2.2].map(|x| px(&rig, DVec3::new(x, 0.0, 0.2)));
    rig.paint(ToolMode::PaintHandle, &way);
    let (front, back) = sides(&rig, 1.5..2.5);
    assert!(front > 30 && back > front / 2, "{front} {back}");
    rig.command(Command::NewHandle);
    let at = px(&rig, DVec3::new(-0.2, 0.0, 1.0));
    rig.paint(ToolMode::PaintHandle, &[at, at + DVec2::new(4.0, 0.0)]);
    let (front, back) = sides(&rig, -1.0..0.5);
    assert!(front > 4 && back == 0, "{front} {back}");
}

#[test]
fn a_soft_brush_shows_where_it_has_half_of_its_strength_and_a_hard_one_does_not() {
    let mut rig = Rig::open(shapes::icosphere(5));
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::SetTool(ToolMode::PaintStiffness));
    let inner = |rig: &mut Rig, falloff: f64| {
        rig.command(Command::SetStiffnessBrush(StiffnessBrush {
            falloff,
            ..StiffnessBrush::default()
        }));
        rig.move_to(CENTRE_PX);
        let view = rig.editor.view();
        let points: Vec<DVec3> = view
            .shapes
            .iter()
            .flat_map(|shape| shape.lines.iter().map(|line| line[0]))
            .collect();
        let radius = view.brush_radius_px * view.camera.world_per_px(DVec3::Z, rig::VIEWPORT_PX);
        points
            .iter()
            .map(|point| point.truncate().length() / radius)
            .collect::<Vec<_>>()
    };
    assert!(inner(&mut rig, 0.0).is_empty());
    for falloff in [0.4, 1.0] {
        let shares = inner(&mut rig, falloff);
        assert!(!shares.is_empty());
        for share in shares {
            assert!((share - (1.0 - falloff / 2.0)).abs() < 0.1, "{share} at {falloff}");
        }
    }
}

#[test]
fn shift_damps_the_pointer_from_where_it_is_held() {
    let moved = |steps: &[(f64, bool)]| {
        let mut rig = with_handle(Projection::Orthographic);
        rig.move_to(CENTRE_PX);
        rig.type_keys("g");
        for &(x, is_fine) in steps {
            let pointer = Pointer {
                position_px: CENTRE_PX + DVec2::X * x,
                modifiers: Modifiers {
                    shift: is_fine,
                    ..Modifiers::NONE
                },
            };
            rig.send(Event::PointerMoved(pointer));
        }
        rig.key(Key::Enter);
        rig.editor.document().handles()[0].affine().translation.x
    };
    let whole = moved(&[(50.0, false)]);
    assert!(whole > 0.0);
    let is_near = |a: f64, b: f64| (a - b).abs() < 1e-9 * whole;
    assert!(is_near(moved(&[(50.0, true)]), 0.1 * whole));
    // Nothing jumps when the key goes up or down.
    assert!(is_near(
        moved(&[(20.0, false), (50.0, true), (70.0, false)]),
        (20.0 + 3.0 + 20.0) / 50.0 * whole
    ));
}

#[test]
fn regions_fade_from_the_beginning_of_a_drag_to_its_end() {
    let mut rig = with_handle(Projection::Perspective);
    assert!(!rig.editor.view().is_dragging);
    drag_with_ctrl(&mut rig, GizmoPart::Arrow(0), DVec2::new(30.0, 0.0));
    assert!(rig.editor.view().is_dragging);
    rig.release(CENTRE_PX);
    rig.drain();
    assert!(!rig.editor.view().is_dragging);
}
