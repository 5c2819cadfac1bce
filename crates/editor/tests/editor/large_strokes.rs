//! Strokes of the brush on a large surface: jobs find the vertices under it, and what is painted depends on the pointer
//! alone, never on when they come.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use crate::rig::{Fingerprint, Rig, VIEWPORT_PX};
use glam::DVec2;
use pliant_editor::{Command, JobKind, Key, NamedView, Paint, Symmetry};
use pliant_mesh::shapes;

fn opened() -> Rig {
    let mut rig = Rig::open(shapes::grid(330, 330));
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::SetBrushRadius(60.0));
    rig.drain();
    rig
}

fn way() -> Vec<DVec2> {
    let middle = VIEWPORT_PX / 2.0;
    (0..=12)
        .map(|step| middle + DVec2::new(-60.0 + 9.0 * f64::from(step), 4.0 * f64::from(step % 3)))
        .collect()
}

/// Strokes along the way, with `after_move` after each move.
fn stroke(rig: &mut Rig, mut after_move: impl FnMut(&mut Rig, usize)) {
    let way = way();
    rig.move_to(way[0]);
    rig.press(way[0]);
    for (number, place) in way.iter().enumerate() {
        rig.move_to(*place);
        after_move(rig, number);
    }
    rig.release(*way.last().unwrap());
    search(rig);
}

/// Runs the searches alone: other jobs on so large a surface would take long.
fn search(rig: &mut Rig) {
    while rig.run(JobKind::Enclose) {}
}

#[test]
fn what_is_painted_does_not_depend_on_when_the_jobs_come() {
    for symmetry in [Symmetry::None, Symmetry::Axis(0)] {
        let painted = |after_move: fn(&mut Rig, usize)| {
            let mut rig = opened();
            rig.command(Command::SetSymmetry(symmetry));
            rig.drain();
            stroke(&mut rig, after_move);
            let handles = rig.editor.document().handles().len();
            (rig.editor.document().paint().to_vec(), handles)
        };
        let (at_once, handles) = painted(|rig, _| search(rig));
        assert_eq!(handles, 1, "a stroke over the middle is one handle");
        assert!(at_once.iter().filter(|paint| **paint != Paint::Bare).count() > 2000);
        assert_eq!(painted(|_, _| ()), (at_once.clone(), 1));
        let now_and_then = painted(|rig, number| {
            if number % 4 == 3 {
                rig.run(JobKind::Enclose);
            }
        });
        assert_eq!(now_and_then, (at_once, 1));
    }
}

#[test]
fn everything_under_the_brush_is_painted_and_nothing_far_from_it() {
    let mut rig = opened();
    stroke(&mut rig, |_, _| ());
    let handle = rig.editor.document().handles()[0].id;
    let camera = *rig.editor.view().camera;
    for (paint, p) in rig.editor.document().paint().iter().zip(&rig.model.surface.positions) {
        let seen_px = camera.project(*p, VIEWPORT_PX).unwrap();
        let off_px = way()
            .iter()
            .map(|place| place.distance(seen_px))
            .fold(f64::INFINITY, f64::min);
        let is_front = p.dot(camera.axes().z_axis) > 0.5;
        assert!(
            *paint == Paint::Handle(handle) || !is_front || off_px > 59.0,
            "{p}: {off_px}"
        );
        assert!(*paint == Paint::Bare || off_px < 61.0, "{p}: {off_px}");
    }
}

#[test]
fn escape_leaves_nothing_while_jobs_run_and_after_the_release_too() {
    for is_released in [false, true] {
        let mut rig = opened();
        let before = Fingerprint::of(rig.editor.document());
        let way = way();
        rig.press(way[0]);
        rig.move_to(way[5]);
        if is_released {
            rig.release(way[5]);
        }
        assert!(rig.jobs.waiting().contains(&JobKind::Enclose), "{is_released}");
        rig.key(Key::Escape);
        search(&mut rig);
        assert_eq!(Fingerprint::of(rig.editor.document()), before, "{is_released}");
        // The next stroke paints.
        stroke(&mut rig, |_, _| ());
        assert_eq!(rig.editor.document().handles().len(), 1, "{is_released}");
    }
}
