//! Curves drawn in the view: on the surface and through a limb, bent by their points, divided, undone.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use crate::rig::{Fingerprint, Rig, VIEWPORT_PX};
use glam::{DAffine3, DVec2, DVec3};
use pliant_editor::{Command, EditFile, HandleCurve, JobKind, Key, NamedView, Paint, StrokeShape, Symmetry, ToolMode};
use pliant_mesh::shapes;

/// A tube along the view's horizontal axis that bends by ARAP.
fn tube() -> Rig {
    let mut drawn = shapes::tube(24, 60, 10.0);
    for p in &mut drawn.positions {
        *p = DVec3::new(p.z, p.x, p.y);
    }
    let mut rig = Rig::open(drawn);
    rig.choose("arap");
    rig.command(Command::View(NamedView::Front));
    rig.drain();
    rig
}

/// The place of a point in world space on the screen.
pub fn px(rig: &Rig, point: DVec3) -> DVec2 {
    rig.editor.view().camera.project(point, VIEWPORT_PX).unwrap()
}

/// A stroke along the middle of the tube, between these shares of its length.
fn stroke(rig: &mut Rig, shape: StrokeShape, from: f64, to: f64) {
    stroke_beside(rig, shape, [from, to], 0.0);
}

/// The same so far above the middle.
fn stroke_beside(rig: &mut Rig, shape: StrokeShape, [from, to]: [f64; 2], above: f64) {
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.command(Command::SetStrokeShape(shape));
    let bounds = rig.model.bounds().unwrap();
    let at = |share: f64| {
        let middle = bounds.centre();
        DVec3::new(bounds.min.x + share * bounds.extent().x, middle.y + above, middle.z)
    };
    let way: Vec<DVec2> = (0..=20)
        .map(|step| px(rig, at(from + (to - from) * f64::from(step) / 20.0)))
        .collect();
    rig.swipe(&way);
    rig.drain();
}

/// The curve of the last handle.
pub fn curve(rig: &Rig) -> HandleCurve {
    let handle = rig.editor.document().handles().last().unwrap();
    handle.line.as_ref().unwrap().curve().unwrap().clone()
}

fn lengths(points: &[DVec3]) -> Vec<f64> {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).collect()
}

#[test]
fn a_spine_runs_through_the_middle_of_the_limb_which_follows_its_end_as_a_chain() {
    let mut rig = tube();
    stroke(&mut rig, StrokeShape::Spine, 0.4, 0.97);
    assert_eq!(rig.editor.view().problem, None);
    let at_rest = curve(&rig);
    let middle = rig.model.bounds().unwrap().centre();
    for point in at_rest.rest().points() {
        let off = DVec2::new(point.y - middle.y, point.z - middle.z).length();
        assert!(off < 0.1, "{point}");
    }
    assert!(at_rest.is_rest() && rig.largest_displacement() == 0.0);
    assert!(rig.editor.view().chain);

    let before = Fingerprint::of(rig.editor.document());
    let end = *at_rest.moved().last().unwrap();
    let from_px = px(&rig, end);
    let to_px = from_px + DVec2::new(-60.0, -110.0);
    rig.press(from_px);
    rig.move_to(from_px.lerp(to_px, 0.5));
    rig.move_to(to_px);
    let waiting = rig.jobs.waiting();
    assert!(
        waiting.contains(&JobKind::Solve) && !waiting.contains(&JobKind::Bind),
        "{waiting:?}"
    );
    rig.release(to_px);
    rig.drain();
    let moved = curve(&rig);
    assert_eq!(moved.rest(), at_rest.rest());
    assert!(px(&rig, *moved.moved().last().unwrap()).distance(to_px) < 1.0);
    assert_eq!(moved.moved()[0], at_rest.moved()[0], "the first point stays");
    for (now, then) in lengths(moved.moved()).into_iter().zip(lengths(at_rest.moved())) {
        assert!((now - then).abs() < 1e-9 * then, "{now} {then}");
    }
    assert!(rig.largest_displacement() > 1.0, "{}", rig.largest_displacement());
    assert!(rig.editor.document().is_settled());

    let after = Fingerprint::of(rig.editor.document());
    rig.undo();
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
    rig.redo();
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), after);
}

#[test]
fn a_spine_begun_or_crossing_on_a_part_before_the_limb_goes_on_through_the_limb_behind_it() {
    for ball_at in [0.2, 0.6] {
        let mut limb = shapes::tube(24, 60, 10.0);
        for p in &mut limb.positions {
            *p = DVec3::new(p.z, p.x, p.y);
        }
        let length = limb.positions.iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
        let low = limb.positions.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
        let before = DVec3::new(low + ball_at * (length - low), 0.0, 5.0);
        let ball = shapes::moved(&shapes::icosphere(3), DAffine3::from_translation(before));
        let mut rig = Rig::open(shapes::together(&[limb, ball]));
        rig.command(Command::View(NamedView::Front));
        rig.drain();
        rig.command(Command::SetTool(ToolMode::PaintHandle));
        rig.command(Command::SetStrokeShape(StrokeShape::Spine));
        let at = |share: f64| DVec3::new(low + share * (length - low), 0.0, 0.0);
        let way: Vec<DVec2> = (0..=20)
            .map(|step| px(&rig, at(0.2 + 0.7 * f64::from(step) / 20.0)))
            .collect();
        rig.swipe(&way);
        rig.drain();
        let spine = curve(&rig);
        assert!((spine.rest().points()[0].x - at(0.2).x).abs() < 0.3, "{ball_at}");
        for point in spine.rest().points() {
            let off = DVec2::new(point.y, point.z).length();
            assert!(off < 0.1, "{ball_at}: {point}");
        }
        let handles = rig.editor.document().handles().to_vec();
        let paint = rig.editor.document().paint();
        let of_handle = paint.iter().zip(&rig.model.surface.positions);
        let painted: Vec<DVec3> = of_handle
            .filter(|(own, _)| **own == Paint::Handle(handles[0].id))
            .map(|(_, p)| *p)
            .collect();
        assert!(painted.len() > 500 && painted.iter().all(|p| p.z < 2.0), "{ball_at}");
    }
}

#[test]
fn a_press_a_little_beside_a_curve_s_point_takes_the_point_and_draws_no_second_line() {
    let mut rig = tube();
    stroke(&mut rig, StrokeShape::Spine, 0.4, 0.97);
    let end_px = px(&rig, *curve(&rig).moved().last().unwrap());
    let (beside, pull) = (DVec2::new(-9.0, 11.0), DVec2::new(-30.0, -90.0));
    rig.swipe(&[end_px + beside, end_px + beside + 0.5 * pull, end_px + beside + pull]);
    rig.drain();
    assert_eq!(rig.editor.document().handles().len(), 1);
    let now_px = px(&rig, *curve(&rig).moved().last().unwrap());
    assert!(now_px.distance(end_px + pull) < 1.0, "{now_px}");
}

#[test]
fn a_pinned_point_stays_while_the_end_is_pulled_and_pins_are_undone_and_kept() {
    let mut rig = tube();
    stroke(&mut rig, StrokeShape::Spine, 0.4, 0.97);
    let at_rest = curve(&rig);
    let elbow = at_rest.rest().points().len() / 2;
    let elbow_px = px(&rig, at_rest.moved()[elbow]);
    rig.swipe(&[elbow_px]);
    rig.command(Command::PinCurvePoints);
    rig.drain();
    assert_eq!(curve(&rig).pinned(), [elbow as u32]);
    assert_eq!(rig.largest_displacement(), 0.0);

    let from_px = px(&rig, *at_rest.moved().last().unwrap());
    rig.swipe(&[
        from_px,
        from_px + DVec2::new(-20.0, -50.0),
        from_px + DVec2::new(-30.0, -90.0),
    ]);
    rig.drain();
    let moved = curve(&rig);
    assert_eq!(
        moved.moved()[..=elbow],
        at_rest.moved()[..=elbow],
        "all up to the pin stays"
    );
    assert_ne!(moved.moved()[elbow + 1..], at_rest.moved()[elbow + 1..]);
    for (now, then) in lengths(moved.moved()).into_iter().zip(lengths(at_rest.moved())) {
        assert!((now - then).abs() < 1e-9 * then, "{now} {then}");
    }
    let edit = EditFile::parse(&rig.editor.edit_file().unwrap().to_json()).unwrap();
    assert_eq!(edit.handles[0].curve.as_ref().unwrap().pinned(), [elbow as u32]);

    rig.undo();
    assert_eq!(curve(&rig).pinned(), [elbow as u32]);
    rig.undo();
    assert!(curve(&rig) == at_rest);
    rig.redo();
    rig.drain();
    assert_eq!(curve(&rig).pinned(), [elbow as u32]);
    rig.swipe(&[elbow_px]);
    rig.command(Command::PinCurvePoints);
    assert_eq!(rig.editor.view().problem, None);
    assert!(curve(&rig).pinned().is_empty(), "the same command unpins it");
}

#[test]
fn a_limited_joint_stops_a_pull_and_limits_are_undone_kept_and_refused_in_words() {
    let mut rig = tube();
    stroke(&mut rig, StrokeShape::Spine, 0.4, 0.97);
    let at_rest = curve(&rig);
    let joints = 1..at_rest.rest().points().len() - 1;
    assert_eq!(rig.editor.selected_bend_deg(), None);
    for joint in joints.clone() {
        rig.swipe(&[px(&rig, at_rest.moved()[joint])]);
        assert_eq!(rig.editor.selected_bend_deg(), Some([0.0, 180.0]));
        rig.command(Command::SetBendRange([0.0, 12.0]));
        assert_eq!(rig.editor.selected_bend_deg(), Some([0.0, 12.0]));
    }
    rig.command(Command::SetBendRange([20.0, 10.0]));
    let problem = rig.editor.view().problem.map(|problem| problem.to_string());
    assert!(problem.is_some_and(|problem| problem.contains("0° to 180°")));
    rig.drain();
    assert_eq!(rig.largest_displacement(), 0.0, "limits alone bend nothing");

    let from_px = px(&rig, *at_rest.moved().last().unwrap());
    rig.swipe(&[
        from_px,
        from_px + DVec2::new(-60.0, -110.0),
        from_px + DVec2::new(-160.0, -200.0),
    ]);
    rig.drain();
    let moved = curve(&rig);
    assert_ne!(moved.moved(), at_rest.moved());
    for joint in joints.clone() {
        let [before, at, after] = [joint - 1, joint, joint + 1].map(|point| moved.moved()[point]);
        let bend_deg = (at - before).angle_between(after - at).to_degrees();
        assert!(bend_deg < 12.0 + 1e-6, "{joint}: {bend_deg}");
    }
    let limits = moved.bends_deg().to_vec();
    assert_eq!(
        limits.iter().filter(|range| **range == [0.0, 12.0]).count(),
        joints.len()
    );

    let text = rig.editor.edit_file().unwrap().to_json();
    let edit = EditFile::parse(&text).unwrap();
    assert_eq!(edit.handles[0].curve.as_ref().unwrap().bends_deg(), limits);
    let number = text.replace("12.0", "-12.0");
    assert_ne!(number, text);
    let refused = EditFile::parse(&number).unwrap_err().to_string();
    assert!(refused.contains("`bends` at point 1"), "{refused}");

    rig.undo();
    assert_eq!(curve(&rig).bends_deg(), limits);
    for _ in joints {
        rig.undo();
    }
    assert!(curve(&rig) == at_rest);
}

#[test]
fn a_spine_is_cancelled_while_its_limb_is_searched_for() {
    let mut rig = tube();
    let before = rig.fingerprint();
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.command(Command::SetStrokeShape(StrokeShape::Spine));
    let middle = rig.model.bounds().unwrap().centre();
    let way: Vec<DVec2> = (0..=8)
        .map(|step| px(&rig, middle + DVec3::X * 0.5 * f64::from(step)))
        .collect();
    rig.swipe(&way);
    assert_eq!(rig.jobs.waiting(), [JobKind::Enclose]);
    rig.key(Key::Escape);
    rig.drain();
    assert!(rig.editor.document().handles().is_empty());
    assert_eq!(rig.fingerprint(), before);
}

#[test]
fn a_spine_that_is_drawn_beside_the_middle_is_moved_into_it() {
    let mut rig = tube();
    let middle = rig.model.bounds().unwrap().centre();
    stroke_beside(&mut rig, StrokeShape::Spine, [0.3, 0.9], 0.6);
    for point in curve(&rig).rest().points() {
        let off = DVec2::new(point.y - middle.y, point.z - middle.z).length();
        assert!(off < 0.1, "{point}");
    }
}

#[test]
fn more_points_do_not_move_the_surface_and_can_be_removed_again() {
    let mut rig = tube();
    stroke(&mut rig, StrokeShape::Spine, 0.4, 0.97);
    let at_rest = curve(&rig);
    rig.command(Command::DivideCurve);
    rig.drain();
    let count = at_rest.rest().points().len();
    assert_eq!(curve(&rig).rest().points().len(), 2 * count - 1);
    assert_eq!(rig.largest_displacement(), 0.0);
    // The second of them, which was added.
    let added = curve(&rig).moved()[1];
    let at_px = px(&rig, added);
    rig.swipe(&[at_px]);
    rig.command(Command::RemoveCurvePoints);
    rig.drain();
    assert_eq!(curve(&rig).rest().points().len(), 2 * count - 2);
    assert!(!curve(&rig).rest().points().contains(&added));
}

#[test]
fn a_curve_on_the_surface_takes_what_is_under_it_and_other_strokes_are_refused_in_words() {
    let mut rig = tube();
    stroke(&mut rig, StrokeShape::Curve, 0.3, 0.7);
    let drawn = curve(&rig);
    assert!(!drawn.rest().is_closed() && !rig.editor.view().chain);
    let members = rig.count(Paint::Handle(rig.editor.document().handles()[0].id));
    assert!((20..400).contains(&members), "{members}");
    // On the surface, not inside.
    let middle = rig.model.bounds().unwrap().centre();
    assert!(drawn.rest().points().iter().all(|p| (p.z - middle.z).abs() > 0.5));
    // A click is no curve.
    let count = rig.editor.document().handles().len();
    let at_px = px(&rig, middle) + DVec2::new(0.0, 25.0);
    rig.swipe(&[at_px]);
    assert!(rig.editor.view().problem.unwrap().contains("too short"));
    assert_eq!(rig.editor.document().handles().len(), count);
    rig.command(Command::SetTool(ToolMode::PaintFixed));
    rig.swipe(&[at_px]);
    assert!(rig.editor.view().problem.unwrap().contains("choose the Handle tool"));
}

/// A ball, and a line over a part of its outline, given by two angles in degrees, that is a fifth of the radius farther
/// out in its middle.
fn ball_and_bump([from, to]: [f64; 2]) -> (Rig, Vec<DVec2>) {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.choose("bilaplacian");
    rig.command(Command::View(NamedView::Front));
    rig.drain();
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.command(Command::SetStrokeShape(StrokeShape::Sketch));
    let centre = rig.model.bounds().unwrap().centre();
    let centre_px = px(&rig, centre);
    let radius_px = px(&rig, centre + DVec3::Y).distance(centre_px);
    let line = |share: f64| {
        let angle = (from + (to - from) * share).to_radians();
        let bump = 0.2 * (share * std::f64::consts::PI).sin();
        centre_px + DVec2::new(angle.cos(), -angle.sin()) * radius_px * (1.0 + bump)
    };
    let way = (0..=24).map(|step| line(f64::from(step) / 24.0)).collect();
    (rig, way)
}

#[test]
fn with_symmetry_a_sketch_beside_the_plane_has_a_twin_and_one_across_it_has_none() {
    for (angles_deg, count) in [([15.0, 70.0], 2), ([50.0, 140.0], 1)] {
        let (mut rig, way) = ball_and_bump(angles_deg);
        rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
        rig.drain();
        rig.swipe(&way);
        rig.drain();
        assert_eq!(
            rig.editor.document().handles().len(),
            count,
            "{:?}",
            rig.editor.view().problem
        );
        let view = rig.editor.view();
        let moved = rig.model.surface.positions.iter().zip(view.displacements.iter());
        let beside = moved.filter(|(p, _)| p.x.abs() > 1e-9);
        let (left, right): (Vec<_>, Vec<_>) = beside.partition(|(p, _)| p.x < 0.0);
        let [left, right] = [left, right].map(|side| side.iter().map(|(_, way)| way.y).sum::<f64>());
        assert!(right > 1.0, "{left} {right}");
        if count == 2 {
            assert!((left / right - 1.0).abs() < 1e-6, "{left} {right}");
            let edit = rig.editor.edit_file().unwrap();
            assert!(edit.handles.iter().all(|handle| handle.sketch.is_some()));
        }
    }
}

#[test]
fn a_sketch_beside_the_outline_moves_it_onto_the_line_and_one_far_from_it_is_refused() {
    let (mut rig, way) = ball_and_bump([45.0, 135.0]);
    let centre_px = px(&rig, rig.model.bounds().unwrap().centre());
    rig.swipe(&way);
    rig.drain();
    assert_eq!(rig.editor.view().problem, None);
    let document = rig.editor.document();
    assert!(document.is_settled() && document.handles()[0].line.as_ref().unwrap().sketch().is_some());
    let highest = (0..rig.model.surface.positions.len())
        .map(|v| rig.model.surface.positions[v] + document.from_file()[v])
        .map(|p| px(&rig, p).distance(way[12]))
        .fold(f64::INFINITY, f64::min);
    assert!(highest < 4.0, "{highest} points from the line");
    // A line far from any outline means none.
    let count = document.handles().len();
    rig.swipe(&[
        centre_px,
        centre_px + DVec2::new(30.0, 0.0),
        centre_px + DVec2::new(60.0, 10.0),
    ]);
    rig.drain();
    assert!(
        rig.editor
            .view()
            .problem
            .unwrap()
            .contains("begin and end it at the edge")
    );
    assert_eq!(rig.editor.document().handles().len(), count);
}

#[test]
fn with_symmetry_a_spine_has_a_twin_that_follows_the_mirrored_curve() {
    let mut rig = tube();
    rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
    rig.drain();
    stroke(&mut rig, StrokeShape::Spine, 0.65, 0.97);
    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 2, "{:?}", rig.editor.view().problem);
    let of = |rig: &Rig, place: usize| {
        let line = rig.editor.document().handles()[place].line.clone();
        line.unwrap().curve().unwrap().clone()
    };
    let middle = rig.model.bounds().unwrap().centre().x;
    let mirrored = |p: &DVec3| DVec3::new(2.0 * middle - p.x, p.y, p.z);
    let end_px = px(&rig, *of(&rig, 0).moved().last().unwrap());
    rig.swipe(&[
        end_px,
        end_px + DVec2::new(-20.0, -40.0),
        end_px + DVec2::new(-40.0, -80.0),
    ]);
    rig.drain();
    assert!(!of(&rig, 0).is_rest());
    for (own, other) in of(&rig, 0).moved().iter().zip(of(&rig, 1).moved()) {
        assert!(mirrored(own).distance(*other) < 1e-9, "{own} {other}");
    }
    // Both halves of the shape are each other's image.
    let view = rig.editor.view();
    let positions = rig.model.surface.positions.iter().zip(view.displacements.iter());
    let heights = positions
        .filter(|(_, way)| way.length() > 0.5)
        .map(|(p, way)| ((p.x - middle).signum(), way.y));
    let (right, left): (Vec<_>, Vec<_>) = heights.partition(|(side, _)| *side > 0.0);
    let highest = |side: &[(f64, f64)]| side.iter().map(|(_, y)| *y).fold(f64::MIN, f64::max);
    assert!(
        right.len() > 50 && right.len() == left.len(),
        "{} {}",
        right.len(),
        left.len()
    );
    assert!((highest(&right) - highest(&left)).abs() < 1e-3);
    rig.undo();
    rig.drain();
    assert!(of(&rig, 0).is_rest() && of(&rig, 1).is_rest());
}
