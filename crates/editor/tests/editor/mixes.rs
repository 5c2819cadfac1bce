//! Laws of another sequence that leads handles of the open one: every frame shows a led handle where the exported edit has
//! it, changes are steps, projects bring them back, and a sequence that can't be read leaves the frames as they are.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DQuat, DVec3};
use pliant_editor::{Beginning, Command, Event, HandleId, HandleMix, HandlePlace, MixEntry};
use pliant_mesh::shapes;

use crate::project::{reopened, saved};
use crate::rig::Rig;
use crate::sequences::{COUNT, deliver, frame, give_frames, go_to, open};

/// The displacements of a frame of the other sequence: a ball that turns about another axis on its way upwards.
fn other(rig: &Rig, number: usize) -> Vec<DVec3> {
    let t = number as f64 / COUNT as f64;
    let turn = DQuat::from_rotation_x(0.8 * t + 0.1);
    let place = |p: &DVec3| turn * *p + DVec3::new(0.0, 0.4 * t, 0.1) - *p;
    rig.model.surface.positions.iter().map(place).collect()
}

/// Reads the frames of both sequences.
fn deliver_both(rig: &mut Rig) {
    deliver(rig);
    while let Some((sequence, number)) = rig.editor.view().wanted_mix {
        assert!(!rig.editor.is_settled());
        let (sequence, shape) = (sequence.to_owned(), other(rig, number));
        rig.send(Event::MixFrame(sequence, number, Ok(Arc::new(shape))));
        deliver(rig);
    }
}

fn go(rig: &mut Rig, number: usize) {
    go_to(rig, number);
    deliver_both(rig);
}

fn mix(id: HandleId, share: f64) -> HandleMix {
    HandleMix {
        sequence: "/other".to_owned(),
        handles: BTreeSet::from([id]),
        share,
    }
}

fn mixed(share: f64) -> (Rig, HandleId) {
    let mut rig = open(shapes::icosphere(2));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetMix(Some(mix(id, share))));
    deliver_both(&mut rig);
    (rig, id)
}

/// The largest distance of the shown handle from where the exported edit, read as a file, moves it.
fn away(rig: &Rig, number: usize) -> f64 {
    let text = rig.editor.edit_file().unwrap().to_json();
    let Beginning::Edit(edit) = Beginning::parse(&text).unwrap() else {
        panic!("{text}");
    };
    let setup = edit.resolve(&rig.model).unwrap();
    let file = &rig.model.surface.positions;
    let vertices: Vec<usize> = (0..file.len())
        .filter(|v| setup.roles[*v] == pliant_deform::Role::Handle(0))
        .collect();
    let place = |way: &[DVec3]| {
        let (first, now): (Vec<DVec3>, Vec<DVec3>) = vertices.iter().map(|v| (file[*v], file[*v] + way[*v])).unzip();
        HandlePlace::of(&first, &now)
    };
    let own = place(&frame(rig, number));
    let led = (0..COUNT).map(|number| place(&other(rig, number))).collect();
    let at_rest = place(&vec![DVec3::ZERO; file.len()]);
    let timeline = edit.sequence_timeline(&setup, &[at_rest], |_, _| own, BTreeMap::from([(0, led)]));
    let map = timeline.unwrap().maps_at(number, &[own]).unwrap()[0];
    let (shown, way) = (rig.editor.document().from_file(), frame(rig, number));
    let distance = |v: &usize| (file[*v] + shown[*v]).distance(map.transform_point3(file[*v] + way[*v]));
    vertices.iter().map(distance).fold(0.0, f64::max)
}

#[test]
fn every_frame_shows_a_led_handle_where_the_exported_edit_has_it() {
    for share in [1.0, 0.4] {
        let (mut rig, _) = mixed(share);
        for number in [0, 7, 30, COUNT - 1] {
            go(&mut rig, number);
            assert!(rig.editor.document().is_settled());
            assert!(away(&rig, number) < 1e-9, "{number}: {}", away(&rig, number));
            let (shown, own) = (rig.editor.document().from_file(), frame(&rig, number));
            assert!(shown.iter().zip(&*own).any(|(a, b)| a.distance(*b) > 0.02));
        }
        // What was read is not read again.
        go_to(&mut rig, 7);
        assert_eq!(rig.editor.view().wanted_mix, None);
    }
}

#[test]
fn a_mix_is_a_step_nothing_else_moves_its_handles_and_edits_and_projects_have_it() {
    let (mut rig, id) = mixed(0.5);
    go(&mut rig, 9);
    let shown = rig.editor.document().from_file().clone();
    rig.command(Command::KeyHere);
    deliver_both(&mut rig);
    assert!(rig.editor.document().animation().keys().is_empty());
    let filter = pliant_editor::HandleFilter::of_all(COUNT);
    assert!(
        rig.editor
            .unavailable_because(&Command::SetFilter(id, Some(filter)))
            .is_some()
    );
    let named = rig.editor.edit_file().unwrap().mix;
    let handles = vec![rig.editor.document().handles()[0].name.clone()];
    let (sequence, share) = ("/other".to_owned(), 0.5);
    assert_eq!(
        named,
        Some(MixEntry {
            sequence,
            handles,
            share
        })
    );
    rig.command(Command::SetMix(None));
    deliver_both(&mut rig);
    assert_eq!(**rig.editor.document().from_file(), *frame(&rig, 9));
    assert_eq!(rig.editor.edit_file().unwrap().mix, None);
    rig.undo();
    rig.drain();
    assert_eq!(*rig.editor.document().from_file(), shown);
    let mut again = reopened(&rig, &saved(&rig));
    give_frames(&mut again);
    deliver_both(&mut again);
    assert_eq!(again.editor.document().animation(), rig.editor.document().animation());
    assert!(away(&again, 9) < 1e-9);
}

#[test]
fn a_sequence_that_cannot_be_read_says_so_and_leaves_the_frames_as_they_are() {
    let (mut rig, id) = mixed(1.0);
    go(&mut rig, 9);
    rig.command(Command::GoToTime(20.0 / rig.editor.document().animation().fps()));
    deliver(&mut rig);
    let sentence = "run is gone: put it back";
    rig.send(Event::MixFrame("/other".to_owned(), 20, Err(sentence.to_owned())));
    deliver(&mut rig);
    assert!(rig.editor.view().problem.unwrap().contains(sentence));
    assert_eq!(rig.editor.document().animation().frame(), 20);
    assert_eq!(**rig.editor.document().from_file(), *frame(&rig, 20));
    assert_eq!(rig.editor.view().wanted_mix, None);
    // Another choice reads it again.
    rig.command(Command::SetMix(Some(mix(id, 0.9))));
    deliver_both(&mut rig);
    assert!(away(&rig, 20) < 1e-9);
}
