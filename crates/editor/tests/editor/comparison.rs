//! The methods' results for the present edit, against each method's result alone.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig;
use std::sync::Arc;

use crate::rig::{ITERATED, Rig};
use glam::DVec3;
use pliant_deform::{Budget, METHODS, Method, Solve};
use pliant_editor::{Alternative, Command, Editor, Event, Executor, InlineExecutor, Job, JobKind, Key};
use pliant_mesh::shapes;

fn tube() -> Rig {
    Rig::open(shapes::tube(16, 24, 3.0))
}

fn alternatives(rig: &Rig) -> &[Alternative] {
    rig.editor.comparison().expect("they are compared").alternatives()
}

fn shapes_of(rig: &Rig) -> Vec<Arc<Vec<DVec3>>> {
    let shapes = alternatives(rig)
        .iter()
        .map(|alternative| Arc::clone(&alternative.shape));
    shapes.collect()
}

/// The number of waiting jobs of the comparison.
fn waiting(rig: &Rig) -> usize {
    let jobs = rig.jobs.waiting().into_iter();
    jobs.filter(|kind| *kind == JobKind::Compare).count()
}

fn turn(rig: &mut Rig, keys: &str) {
    rig.type_keys(keys);
    rig.key(Key::Enter);
}

#[test]
fn each_method_shows_what_it_makes_of_the_edit_alone() {
    let mut rig = tube();
    rig.paint_handle();
    rig.drain();
    rig.command(Command::CompareMethods);
    for keys in ["rx30", "gz.2", ""] {
        match keys {
            "" => rig.undo(),
            keys => turn(&mut rig, keys),
        }
        for _ in 0..1000 {
            assert!(waiting(&rig) <= 1, "one after the other");
            let Some(done) = rig.jobs.run_next() else { break };
            rig.send(Event::JobDone(done));
        }
        assert!(rig.editor.comparison().unwrap().is_current());
        assert_eq!(alternatives(&rig).len(), METHODS.len());
        for alternative in alternatives(&rig) {
            let name = alternative.method.name();
            let mut alone = tube();
            alone.command(Command::SetMethod(alternative.method.clone()));
            alone.paint_handle();
            alone.drain();
            turn(&mut alone, "rx30");
            alone.drain();
            if keys == "gz.2" {
                turn(&mut alone, keys);
                alone.drain();
            }
            assert_eq!(alternative.refusal, None, "{name}");
            let meant = alone.editor.view().displacements;
            if alternative.method.solve() == Solve::Direct {
                assert!(alternative.shape == *meant, "{name} after {keys:?}");
            } else {
                let apart = alternative.shape.iter().zip(meant.iter()).map(|(a, b)| a.distance(*b));
                let size = alone.model.bounds().unwrap().diagonal();
                assert!(apart.fold(0.0, f64::max) < ITERATED * size, "{name} after {keys:?}");
            }
            let figures = alternative.figures.expect("it was solved");
            assert!(1.0 <= figures.edge_stretch_mean && figures.edge_stretch_mean <= figures.edge_stretch_max);
        }
    }
}

#[test]
fn taking_a_method_is_one_step_and_binds_no_other_anew() {
    let mut rig = tube();
    rig.paint_handle();
    turn(&mut rig, "rx30");
    rig.command(Command::CompareMethods);
    rig.drain();
    let shown = shapes_of(&rig);
    let own = rig.editor.document().method().clone();
    let undo = |rig: &Rig| rig.editor.view().undo.map(str::to_owned);
    let before = undo(&rig);
    for declaration in METHODS {
        let alternative = alternatives(&rig).iter().find(|a| a.method.name() == declaration.name);
        let method = alternative.unwrap().method.clone();
        rig.command(Command::SetMethod(method.clone()));
        rig.drain();
        assert_eq!(*rig.editor.document().method(), method);
        // They are the same allocations: nothing was solved again.
        let kept = shapes_of(&rig);
        assert!(
            kept.iter().zip(&shown).all(|(a, b)| Arc::ptr_eq(a, b)),
            "{}",
            method.name()
        );
        if method != own {
            assert_ne!(undo(&rig), before);
            rig.undo();
            rig.drain();
        }
        assert_eq!((rig.editor.document().method(), undo(&rig)), (&own, before.clone()));
    }
    // Other options of the document's own method are shown, and nothing else changes.
    let other = Method::from_name(own.name()).unwrap();
    assert_ne!(own, other, "a person begins with other options than the defaults");
    rig.command(Command::SetMethod(other.clone()));
    rig.drain();
    for (alternative, shown) in alternatives(&rig).iter().zip(&shown) {
        let is_own = alternative.method == other;
        assert_eq!(
            !Arc::ptr_eq(&alternative.shape, shown),
            is_own,
            "{}",
            alternative.method.name()
        );
    }
}

#[test]
fn what_is_not_wanted_any_more_is_stopped_and_dropped() {
    let mut rig = tube();
    rig.command(Command::CompareMethods);
    assert!(rig.editor.comparison().is_none(), "nothing bends yet");
    rig.paint_handle();
    turn(&mut rig, "rx30");
    rig.drain();
    rig.command(Command::CompareMethods);
    // Another region: the running binding for the old one is useless.
    let stale = rig
        .jobs
        .take(JobKind::Compare)
        .expect("the first method is being bound");
    rig.command(Command::ClearRegions);
    assert!(stale.cancel.is_cancelled());
    rig.undo();
    rig.send(Event::JobDone(stale.run()));
    rig.drain();
    assert!(rig.editor.comparison().unwrap().is_current());
    let shown = shapes_of(&rig);
    // The newest of many moves is solved, once the running job has ended.
    let mut later = None;
    for _ in 0..5 {
        turn(&mut rig, "rx5");
        later = later.or_else(|| rig.jobs.take(JobKind::Compare));
        assert_eq!(waiting(&rig), 0, "one runs");
    }
    rig.send(Event::JobDone(later.unwrap().run()));
    rig.drain();
    assert!(rig.editor.comparison().unwrap().is_current());
    assert!(shapes_of(&rig).iter().zip(&shown).all(|(now, before)| now != before));
    // Esc closes, and running jobs are stopped.
    turn(&mut rig, "rx5");
    let running = rig.jobs.take(JobKind::Compare).unwrap();
    rig.key(Key::Escape);
    assert!(rig.editor.comparison().is_none() && running.cancel.is_cancelled());
    rig.send(Event::JobDone(running.run()));
    rig.drain();
    assert!(rig.editor.comparison().is_none());
    // A change that leaves nothing to bend closes too.
    rig.command(Command::CompareMethods);
    rig.drain();
    assert!(rig.editor.comparison().unwrap().is_current());
    rig.command(Command::ClearRegions);
    rig.drain();
    assert!(rig.editor.comparison().is_none());
}

/// An executor that gives a binding only this much memory.
struct Poor(InlineExecutor);

impl Executor for Poor {
    fn start(&mut self, job: Job) {
        self.0.start(job);
    }

    fn budget(&self) -> fn(Option<u64>) -> Budget {
        |_| Budget {
            bytes: 200_000,
            ..Budget::default()
        }
    }
}

#[test]
fn a_method_that_is_refused_says_so_in_its_place_and_the_others_go_on() {
    let jobs = InlineExecutor::new();
    let editor = Editor::new(Box::new(Poor(jobs.clone())));
    let model = rig::weld(shapes::tube(16, 24, 3.0));
    let mut rig = Rig::of(editor, jobs, Arc::clone(&model));
    rig.send(Event::Viewport {
        size_px: rig::VIEWPORT_PX,
    });
    rig.send(Event::Opened {
        model,
        name: "a tube".to_owned(),
        beginning: None,
    });
    rig.drain();
    rig.paint_handle();
    rig.command(Command::CompareMethods);
    for keys in ["rx30", "rx10"] {
        turn(&mut rig, keys);
        rig.drain();
        assert!(rig.editor.comparison().unwrap().is_current());
        let (refused, bent): (Vec<_>, Vec<_>) = alternatives(&rig).iter().partition(|a| a.refusal.is_some());
        assert!(!refused.is_empty() && !bent.is_empty(), "{} refused", refused.len());
        for alternative in refused {
            let sentence = alternative.refusal.as_deref().unwrap();
            assert!(sentence.contains("memory"), "{}: {sentence}", alternative.method.name());
        }
        for alternative in bent {
            assert!(alternative.shape.iter().any(|d| *d != DVec3::ZERO));
        }
    }
}
