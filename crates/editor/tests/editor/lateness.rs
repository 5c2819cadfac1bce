//! Jobs that end late, twice or never: the results that are kept, and those that are dropped.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::cell::Cell;

use crate::rig::{CENTRE_PX, Rig, weld};
use glam::DVec2;
use pliant_editor::{
    Command, Event, Executor, GizmoPart, InlineExecutor, Job, JobKind, Key, Paint, StrokeShape, ToolMode, Unfinished,
};
use pliant_mesh::shapes;

/// A sphere for bending by this method.
fn open(method: &str) -> Rig {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose(method);
    rig
}

/// A direct method, and an iterative one that continues from its present shape.
const METHODS: [&str; 2] = ["bilaplacian", "arap"];

#[test]
fn an_early_drag_moves_the_handle_alone_and_catches_up_with_a_late_one() {
    for method in METHODS {
        let mut late = open(method);
        late.paint_handle();
        late.drain();
        late.move_by('x', ".3");
        late.drain();

        let mut early = open(method);
        early.paint_handle();
        early.move_by('x', ".3");
        let document = early.editor.document();
        assert!(!document.is_settled());
        for (paint, displacement) in document.paint().iter().zip(document.from_file().iter()) {
            let expected = if matches!(paint, Paint::Handle(_)) { 0.3 } else { 0.0 };
            assert!(
                (displacement.length() - expected).abs() < 1e-12,
                "the handle moves alone"
            );
        }
        early.drain();
        early.assert_as_meant("early");
        late.assert_as_meant("late");
        let (early_shape, late_shape) = (early.drawn(), late.drawn());
        for rig in [&mut early, &mut late] {
            rig.undo();
            assert_eq!(rig.largest_displacement(), 0.0);
            rig.redo();
        }
        assert!(early.drawn() == early_shape && late.drawn() == late_shape, "{method}");
    }
}

#[test]
fn a_drag_that_was_undone_before_it_settled_settles_when_it_is_redone() {
    for method in METHODS {
        let mut rig = open(method);
        rig.paint_handle();
        rig.move_by('z', ".2");
        rig.undo();
        rig.drain();
        assert_eq!(rig.largest_displacement(), 0.0);
        rig.redo();
        rig.drain();
        rig.assert_as_meant(method);
        let settled = rig.fingerprint();
        rig.undo();
        assert_eq!(rig.largest_displacement(), 0.0);
        rig.redo();
        assert_eq!(settled, rig.fingerprint(), "the second time without a job");
    }
}

/// Solves are cut into shapes worth showing: after undo between two of them, redo continues the drag.
#[test]
fn a_descent_that_was_undone_on_its_way_goes_on_when_it_is_redone() {
    let mut rig = Rig::open(shapes::icosphere(5));
    rig.paint_handle();
    rig.drain();
    rig.type_keys("rx150");
    rig.key(Key::Enter);
    while !rig.run(JobKind::Solve) {
        assert!(!rig.jobs.waiting().is_empty());
    }
    assert!(!rig.editor.document().is_settled(), "the first shape is not the last");
    assert!(
        rig.editor.view().status.contains("Settling"),
        "{}",
        rig.editor.view().status
    );
    let on_its_way = rig.drawn();
    rig.undo();
    assert_eq!(rig.largest_displacement(), 0.0);
    rig.redo();
    assert!(on_its_way == rig.drawn());
    rig.drain();
    assert!(
        rig.editor.view().status.contains("Settled"),
        "{}",
        rig.editor.view().status
    );
    rig.assert_as_meant("redone");
}

#[test]
fn binding_starts_when_a_stroke_ends_and_is_cancelled_by_the_next() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.press(CENTRE_PX);
    rig.move_to(CENTRE_PX + DVec2::new(20.0, 0.0));
    rig.run(JobKind::Pick);
    assert!(
        rig.jobs.waiting().is_empty(),
        "not while the stroke lasts: {:?}",
        rig.jobs.waiting()
    );
    rig.release(CENTRE_PX);
    assert!(rig.run(JobKind::Region));
    let bind = rig.jobs.take(JobKind::Bind).expect("the stroke has ended");
    assert!(!bind.cancel.is_cancelled());
    rig.press(CENTRE_PX + DVec2::new(60.0, 0.0));
    assert!(bind.cancel.is_cancelled());
    // Its result is ignored for every outcome.
    rig.editor.handle(Event::JobDone(bind.run()));
    rig.release(CENTRE_PX + DVec2::new(60.0, 0.0));
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    assert!(rig.editor.document().is_settled());
}

#[test]
fn a_stroke_that_is_aborted_binds_what_was_there_before() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.run(JobKind::Region);
    rig.press(CENTRE_PX + DVec2::new(60.0, 0.0));
    rig.key(Key::Escape);
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    assert!(rig.editor.document().is_settled());
}

#[test]
fn stale_shapes_are_dropped() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.move_by('x', ".2");
    let solve = rig.jobs.take(JobKind::Solve).expect("a drag is solved").run();
    rig.undo();
    rig.editor.handle(Event::JobDone(solve));
    assert_eq!(rig.largest_displacement(), 0.0, "it was made for what is undone");
    rig.drain();
    assert_eq!(rig.largest_displacement(), 0.0);

    rig.redo();
    let solve = rig.jobs.take(JobKind::Solve).expect("it had not settled").run();
    let before = rig.drawn();
    rig.run(JobKind::Pick);
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX + DVec2::new(-90.0, 40.0)]);
    assert!(rig.count(Paint::Fixed) > 0);
    rig.editor.handle(Event::JobDone(solve));
    assert!(before == rig.drawn(), "a stroke has made the shape the rest shape");
    rig.drain();
    assert!(before == rig.drawn());
}

#[test]
fn a_shape_that_was_asked_for_by_an_aborted_drag_is_dropped() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.move_by('x', ".2");
    let first = rig.jobs.take(JobKind::Solve).expect("a drag is solved");
    rig.type_keys("gy.4");
    rig.editor.handle(Event::JobDone(first.run()));
    let second = rig
        .jobs
        .take(JobKind::Solve)
        .expect("the newest target was pending")
        .run();
    rig.key(Key::Escape);
    let before = rig.drawn();
    rig.editor.handle(Event::JobDone(second));
    assert!(before == rig.drawn(), "nobody wants that shape any more");
    rig.drain();
    rig.assert_as_meant("what was committed settles");
}

#[test]
fn a_shape_that_comes_during_a_stroke_waits_for_its_end() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.move_by('x', ".2");
    let solve = rig.jobs.take(JobKind::Solve).expect("a drag is solved").run();
    while rig.run(JobKind::Pick) {}
    rig.command(Command::SetTool(ToolMode::Erase));
    let bare_px = CENTRE_PX + DVec2::new(-90.0, 40.0);
    rig.press(bare_px);
    let before = rig.drawn();
    rig.editor.handle(Event::JobDone(solve));
    assert!(before == rig.drawn(), "the surface lies still under the brush");
    rig.release(bare_px);
    assert_eq!(
        rig.editor.view().undo,
        Some("Move handle 1"),
        "the stroke has changed nothing"
    );
    rig.drain();
    rig.assert_as_meant("after the stroke");
    assert!(before != rig.drawn());
}

#[test]
fn the_newest_target_replaces_the_pending_one_and_the_last_one_wins() {
    let mut rig = open("bilaplacian");
    rig.paint_handle();
    rig.drain();
    let from_px = rig.grip(GizmoPart::Arrow(1)).unwrap();
    rig.press(from_px);
    for step in 1..=20 {
        rig.move_to(from_px - DVec2::new(0.0, f64::from(step) * 3.0));
        assert!(
            rig.jobs
                .waiting()
                .iter()
                .filter(|kind| **kind == JobKind::Solve)
                .count()
                <= 1
        );
    }
    rig.release(from_px - DVec2::new(0.0, 60.0));
    let mut solves = 0;
    while rig.run(JobKind::Solve) {
        solves += 1;
    }
    assert_eq!(solves, 2, "the first target and the last");
    let document = rig.editor.document();
    let handle = &document.handles()[0];
    let moved = handle.centre() - handle.pivot;
    for (paint, displacement) in document.paint().iter().zip(document.from_file().iter()) {
        if matches!(paint, Paint::Handle(_)) {
            assert!((*displacement - moved).length() < 1e-12);
        }
    }
}

#[test]
fn a_failed_job_is_said_once_and_not_tried_again_until_something_changes() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.run(JobKind::Region);
    let mut done = rig.jobs.take(JobKind::Bind).unwrap().run();
    done.outcome = Err(Unfinished::Failed("the plate is broken: mend it".to_owned()));
    rig.editor.handle(Event::JobDone(done));
    assert_eq!(rig.editor.view().problem, Some("the plate is broken: mend it"));
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    assert!(!rig.editor.document().is_settled(), "the handle moved alone");
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX + DVec2::new(-90.0, 40.0)]);
    rig.drain();
    rig.move_by('y', ".1");
    rig.drain();
    assert!(rig.editor.document().is_settled());
}

#[test]
fn a_click_waits_for_its_answer() {
    let mut rig = Rig::open_with_jobs_waiting(shapes::icosphere(3));
    rig.paint_handle();
    assert_eq!(rig.editor.view().handles.len(), 0);
    rig.run(JobKind::Pick);
    assert_eq!(
        rig.editor.view().handles.len(),
        1,
        "the stroke was made when the pointer could be answered"
    );
    assert!(rig.editor.view().undo.is_some());
}

/// An executor for which every look at the clock is a second later.
struct Slow(InlineExecutor);

impl Executor for Slow {
    fn start(&mut self, job: Job) {
        self.0.start(job);
    }

    fn clock_ms(&self) -> fn() -> f64 {
        thread_local! {
            static NOW_MS: Cell<f64> = const { Cell::new(0.0) };
        }
        || NOW_MS.replace(NOW_MS.get() + 1000.0)
    }
}

#[test]
fn a_stroke_that_has_waited_is_made_frame_by_frame_and_is_the_same() {
    let way_px: Vec<DVec2> = (0..9)
        .map(|k| CENTRE_PX + DVec2::new(9.0, 5.0) * f64::from(k))
        .collect();
    let mut at_once = Rig::open(shapes::icosphere(4));
    at_once.paint(ToolMode::PaintHandle, &way_px);
    at_once.drain();

    let jobs = InlineExecutor::new();
    let mut slow = Rig::open_on(Box::new(Slow(jobs.clone())), jobs, weld(shapes::icosphere(4)));
    slow.paint(ToolMode::PaintHandle, &way_px);
    slow.run(JobKind::Pick);
    let mut frames = 0;
    while slow.editor.view().is_catching_up {
        // The pointer has left the window in the meantime.
        slow.send(Event::PointerLeft);
        slow.send(Event::Tick);
        frames += 1;
    }
    assert!(frames >= way_px.len(), "{frames} frames");
    slow.drain();
    assert!(slow.fingerprint() == at_once.fingerprint());
}

/// A lasso around this point of the view, let go.
fn lasso(rig: &mut Rig, middle_px: DVec2) {
    let corners = [(-40.0, -40.0), (40.0, -40.0), (40.0, 40.0), (-40.0, 40.0)];
    rig.swipe(&corners.map(|(x, y)| middle_px + DVec2::new(x, y)));
}

#[test]
fn what_is_done_while_a_lasso_looks_waits_and_nothing_is_left_of_one_that_is_stopped() {
    let mut rig = open("arap");
    rig.command(Command::SetTool(ToolMode::PaintFixed));
    rig.command(Command::SetStrokeShape(StrokeShape::Lasso));
    let bare = rig.fingerprint();
    let before = rig.editor.history().names().0.len();
    let fixed = |rig: &Rig| {
        let paint = rig.editor.document().paint();
        paint.iter().filter(|paint| **paint == Paint::Fixed).count()
    };
    for way in ["escape", "stop", "failure", "tool"] {
        lasso(&mut rig, CENTRE_PX);
        assert!(rig.jobs.waiting().contains(&JobKind::Enclose) && fixed(&rig) == 0);
        match way {
            "escape" => rig.key(Key::Escape),
            "stop" => rig.command(Command::CancelJobs),
            "tool" => rig.command(Command::SetTool(ToolMode::PaintFixed)),
            _ => {
                let mut job = rig.jobs.take(JobKind::Enclose).unwrap();
                job.work = Box::new(|| Err(Unfinished::Failed("it broke".to_owned())));
                rig.editor.handle(Event::JobDone(job.run()));
                assert_eq!(rig.editor.view().problem, Some("it broke"));
            }
        }
        rig.drain();
        assert!(rig.fingerprint() == bare && rig.editor.is_settled(), "{way}");
        assert_eq!(rig.editor.history().names().0.len(), before, "{way}");
    }
    lasso(&mut rig, CENTRE_PX);
    lasso(&mut rig, CENTRE_PX + DVec2::new(60.0, 0.0));
    rig.key(Key::Character('2'));
    assert_eq!(fixed(&rig), 0);
    assert!(rig.run(JobKind::Enclose));
    let one = fixed(&rig);
    assert!(one > 0);
    rig.drain();
    assert!(fixed(&rig) > one, "the second was not lost");
    assert_eq!(rig.editor.view().tool, ToolMode::PaintFree, "nor the key after it");
    assert_eq!(rig.editor.history().names().0.len(), before + 2);
}
