//! Laws of smoothing: a stroke with Shift straightens the border of painted regions and paints nothing new; stiffness
//! is blurred, sharpened, grown and shrunk as a whole.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use crate::rig::{CENTRE_PX, Fingerprint, Rig};
use glam::DVec2;
use pliant_editor::{
    Button, Command, Event, Modifiers, Paint, Pointer, STIFFNESS_RANGE, StiffnessAction, StiffnessBrush,
    StiffnessChange, ToolMode,
};
use pliant_mesh::{SurfaceVertex, shapes};

fn swipe_with_shift(rig: &mut Rig, way_px: &[DVec2]) {
    let at = |position_px: DVec2| Pointer {
        position_px,
        modifiers: Modifiers::SHIFT,
    };
    rig.send(Event::PointerMoved(at(way_px[0])));
    rig.send(Event::PointerPressed(at(way_px[0]), Button::Primary));
    for &position_px in &way_px[1..] {
        rig.send(Event::PointerMoved(at(position_px)));
    }
    rig.send(Event::PointerReleased(at(way_px[way_px.len() - 1]), Button::Primary));
    rig.drain();
}

/// Edges between a vertex with this paint and one without it.
fn border(rig: &Rig, paint: Paint) -> usize {
    let all = rig.editor.document().paint();
    let is = |vertex: SurfaceVertex| all[vertex.index()] == paint;
    let vertices = (0..all.len() as u32).map(SurfaceVertex).filter(|&vertex| is(vertex));
    let across = |vertex: SurfaceVertex| {
        rig.model
            .topology
            .neighbours(vertex)
            .iter()
            .filter(|&&v| !is(v))
            .count()
    };
    vertices.map(across).sum()
}

/// A region with a ragged border: strokes of a small brush.
fn ragged() -> Rig {
    let mut rig = Rig::open(shapes::icosphere(5));
    rig.command(Command::SetTool(ToolMode::PaintFree));
    rig.command(Command::SetBrushRadius(12.0));
    for step in 0..6 {
        let from = CENTRE_PX + DVec2::new(-50.0 + 17.0 * f64::from(step), -30.0);
        rig.swipe(&[from, from + DVec2::new(0.0, 60.0)]);
    }
    rig.drain();
    rig.command(Command::SetBrushRadius(40.0));
    rig
}

#[test]
fn a_stroke_with_shift_shortens_the_border_in_one_step_that_undo_takes_back() {
    let mut rig = ragged();
    let before = Fingerprint::of(rig.editor.document());
    let (border_before, camera) = (border(&rig, Paint::Free), *rig.editor.view().camera);
    let way: Vec<DVec2> = (0..=12)
        .map(|step| CENTRE_PX + DVec2::new(-60.0 + 10.0 * f64::from(step), 10.0))
        .collect();
    swipe_with_shift(&mut rig, &way);
    assert_eq!(*rig.editor.view().camera, camera, "it moves no camera");
    assert!(border(&rig, Paint::Free) < border_before, "{border_before}");
    rig.command(Command::Undo);
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
}

#[test]
fn where_all_is_painted_alike_a_stroke_with_shift_changes_nothing() {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.command(Command::SetTool(ToolMode::PaintFree));
    let steps = rig.editor.history().names().1;
    swipe_with_shift(&mut rig, &[CENTRE_PX, CENTRE_PX + DVec2::new(30.0, 0.0)]);
    assert_eq!(rig.editor.history().names().1, steps);
}

#[test]
fn beside_the_surface_shift_still_moves_the_view() {
    let mut rig = ragged();
    let camera = *rig.editor.view().camera;
    swipe_with_shift(&mut rig, &[DVec2::new(5.0, 5.0), DVec2::new(60.0, 40.0)]);
    assert_ne!(*rig.editor.view().camera, camera);
}

fn stiff() -> Rig {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.command(Command::SetTool(ToolMode::PaintStiffness));
    rig.command(Command::SetStiffnessBrush(StiffnessBrush {
        value: 100.0,
        falloff: 0.0,
        ..StiffnessBrush::default()
    }));
    rig.command(Command::SetBrushRadius(60.0));
    rig.swipe(&[CENTRE_PX, CENTRE_PX + DVec2::new(20.0, 0.0)]);
    rig.drain();
    rig
}

fn field(rig: &Rig) -> Vec<f64> {
    rig.editor.document().stiffness().unwrap().to_vec()
}

fn count(field: &[f64]) -> usize {
    field.iter().filter(|own| **own != 1.0).count()
}

#[test]
fn stiffness_grows_and_shrinks_by_a_ring_of_vertices() {
    let mut rig = stiff();
    let first = field(&rig);
    rig.command(Command::ChangeStiffness(StiffnessChange::Grow));
    let grown = field(&rig);
    for (vertex, own) in grown.iter().enumerate() {
        let mut around = rig.model.topology.neighbours(SurfaceVertex(vertex as u32)).iter();
        let expected = first[vertex] != 1.0 || around.any(|v| first[v.index()] != 1.0);
        assert_eq!(*own == 100.0, expected);
    }
    rig.command(Command::ChangeStiffness(StiffnessChange::Shrink));
    assert_eq!(field(&rig), first);
    rig.command(Command::ChangeStiffness(StiffnessChange::Shrink));
    assert!(count(&field(&rig)) < count(&first));
}

#[test]
fn blurring_softens_and_sharpening_hardens_within_what_stiffness_may_be() {
    let steepest = |rig: &Rig, field: &[f64]| {
        let slope = |vertex: usize| {
            let around = rig.model.topology.neighbours(SurfaceVertex(vertex as u32)).iter();
            around
                .map(|v| (field[v.index()].ln() - field[vertex].ln()).abs())
                .fold(0.0, f64::max)
        };
        (0..field.len()).map(slope).fold(0.0, f64::max)
    };
    let mut rig = stiff();
    let first = steepest(&rig, &field(&rig));
    rig.command(Command::ChangeStiffness(StiffnessChange::Blur));
    let blurred = steepest(&rig, &field(&rig));
    rig.command(Command::ChangeStiffness(StiffnessChange::Sharpen));
    let sharpened = steepest(&rig, &field(&rig));
    assert!(
        blurred < 0.7 * first && sharpened > blurred,
        "{first} {blurred} {sharpened}"
    );
    for _ in 0..8 {
        rig.command(Command::ChangeStiffness(StiffnessChange::Sharpen));
    }
    assert!(field(&rig).iter().all(|own| STIFFNESS_RANGE.contains(own)));
}

#[test]
fn what_is_rigid_stays_rigid_under_all_but_shrinking() {
    for (change, is_left) in [
        (StiffnessChange::Blur, true),
        (StiffnessChange::Sharpen, true),
        (StiffnessChange::Grow, true),
        (StiffnessChange::Shrink, false),
    ] {
        let mut rig = stiff();
        rig.command(Command::SetStiffnessBrush(StiffnessBrush {
            action: StiffnessAction::Rigid,
            ..StiffnessBrush::default()
        }));
        rig.swipe(&[CENTRE_PX, CENTRE_PX + DVec2::new(20.0, 0.0)]);
        rig.drain();
        let before = field(&rig);
        rig.command(Command::ChangeStiffness(change));
        let after = field(&rig);
        assert!(after.iter().all(|own| *own > 0.0), "{change:?}");
        let stays = before
            .iter()
            .zip(&after)
            .all(|(b, a)| *b != f64::INFINITY || *a == f64::INFINITY);
        assert_eq!(stays, is_left, "{change:?}");
    }
}
