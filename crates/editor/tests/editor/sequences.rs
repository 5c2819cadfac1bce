//! Laws of a sequence's frames: each is shown as it was read, showing frames is a step that undo takes back to the bit,
//! and a frame that can't be read changes nothing.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use crate::rig::{Fingerprint, Rig};
use glam::{DQuat, DVec3};
use pliant_editor::{Command, Event};
use pliant_mesh::{Drawn, shapes};

/// The number of frames.
const COUNT: usize = 40;

/// The displacements of a frame of a ball that wanders, turns and ripples.
fn frame(rig: &Rig, frame: usize) -> Arc<Vec<DVec3>> {
    let t = frame as f64 / COUNT as f64;
    let turn = DQuat::from_rotation_y(1.5 * t);
    let way = DVec3::new(3.0 * t, 0.2 * (9.0 * t).sin(), t);
    let place = |p: &DVec3| turn * (*p * (1.0 + 0.05 * (7.0 * p.x + 20.0 * t).sin() * t)) + way - *p;
    Arc::new(rig.model.surface.positions.iter().map(place).collect())
}

fn open(drawn: Drawn) -> Rig {
    let mut rig = Rig::open(drawn);
    rig.send(Event::OpenedSequence {
        count: COUNT,
        shown: None,
    });
    deliver(&mut rig);
    rig
}

/// Reads the frames that are wanted, and runs all jobs.
fn deliver(rig: &mut Rig) {
    while let Some(wanted) = rig.editor.view().wanted_frame {
        assert!(!rig.editor.is_settled());
        let shape = frame(rig, wanted);
        rig.send(Event::Frame(wanted, Ok(shape)));
    }
    rig.drain();
}

fn go_to(rig: &mut Rig, frame: usize) {
    let fps = rig.editor.document().animation().fps();
    rig.command(Command::GoToTime(frame as f64 / fps));
    deliver(rig);
}

#[test]
fn frames_are_shown_as_they_were_read_and_undo_restores_the_one_before() {
    let mut rig = open(shapes::icosphere(2));
    assert!(!rig.editor.view().unsaved && rig.editor.view().undo.is_none());
    let at_first = Fingerprint::of(rig.editor.document());
    assert!(rig.editor.view().look.timeline);
    for number in [7, 39, 12] {
        go_to(&mut rig, number);
        assert_eq!(*rig.editor.document().from_file(), frame(&rig, number));
        assert_eq!(rig.editor.document().animation().frame(), number);
    }
    // Steps to frames that follow each other are one.
    let at_last = Fingerprint::of(rig.editor.document());
    assert_eq!(rig.editor.history().names(), (vec!["Go to frame"], 1));
    rig.undo();
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), at_first);
    rig.redo();
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), at_last);
    // No frame is beyond the last one.
    go_to(&mut rig, 1000);
    assert_eq!(rig.editor.document().animation().frame(), COUNT - 1);
}

#[test]
fn only_the_wanted_frame_is_shown_and_one_that_cannot_be_read_changes_nothing() {
    let mut rig = open(shapes::icosphere(2));
    rig.command(Command::GoToTime(0.5));
    rig.command(Command::GoToTime(1.0));
    let before = Fingerprint::of(rig.editor.document());
    let (late, wanted) = (frame(&rig, 12), rig.editor.view().wanted_frame.unwrap());
    rig.send(Event::Frame(12, Ok(late)));
    assert_eq!((Fingerprint::of(rig.editor.document()), wanted), (before.clone(), 24));
    rig.send(Event::Frame(24, Err("walk-24.obj is gone: put it back".to_owned())));
    assert_eq!(rig.editor.view().wanted_frame, None);
    assert!(rig.editor.view().problem.unwrap().contains("walk-24.obj"));
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
    rig.command(Command::StepFrames(1));
    deliver(&mut rig);
    assert_eq!(*rig.editor.document().from_file(), frame(&rig, 1));
}

#[test]
fn play_shows_every_frame_and_is_one_step() {
    let mut rig = open(shapes::icosphere(1));
    rig.command(Command::PlayKeys);
    let mut shown = Vec::new();
    for _ in 0..=COUNT {
        rig.send(Event::Tick);
        // The next one waits for it.
        rig.send(Event::Tick);
        deliver_one(&mut rig);
        shown.push(rig.editor.document().animation().frame());
    }
    let frames: Vec<usize> = (1..COUNT).chain([0, 1]).collect();
    assert_eq!(shown, frames);
    rig.command(Command::PlayKeys);
    rig.drain();
    assert_eq!(rig.editor.history().names().0, ["Play"]);
}

fn deliver_one(rig: &mut Rig) {
    let wanted = rig.editor.view().wanted_frame.unwrap();
    let shape = frame(rig, wanted);
    rig.send(Event::Frame(wanted, Ok(shape)));
    rig.drain();
}
