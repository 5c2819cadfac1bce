//! Laws of the strength's own keys: they move nothing when the first is set, handles keep theirs, a frame is what the
//! exported edit gives, each change is a step, and edits and projects bring them back.

use std::sync::Arc;

use pliant_editor::{Beginning, Command, Ease, EditFile, Event, KeyId, KeyRow};

use crate::animation::{affines, apart, engine_frame, go_to, keyed, put, shape, times, trs};
use crate::project::{opened, reopened, saved};
use crate::rig::{Fingerprint, Rig};
use glam::DVec3;

/// Shows a share of the edit at a time, and keys it.
fn key_strength(rig: &mut Rig, time: f64, share: f64) {
    go_to(rig, time);
    rig.command(Command::SetStrength(share));
    rig.drain();
    rig.command(Command::KeyStrength);
    rig.drain();
}

/// The times and shares of the strength's keys.
fn shares(rig: &Rig) -> Vec<(f64, f64)> {
    let keys = rig.editor.document().animation().keys().iter();
    keys.filter_map(|key| Some((key.time, key.strength()?))).collect()
}

/// A ball with the keys of two handles, whose edit grows from none to all within the first half second and is three
/// quarters at its end.
fn faded(method: &str) -> Rig {
    let (mut rig, ..) = keyed(method);
    for (time, share) in [(0.1, 0.0), (0.4, 1.0), (0.9, 0.75)] {
        key_strength(&mut rig, time, share);
    }
    rig
}

fn edit_of(rig: &Rig) -> EditFile {
    let text = rig.editor.edit_file().unwrap().to_json();
    match Beginning::parse(&text).unwrap() {
        Beginning::Edit(edit) => *edit,
        _ => panic!("{text}"),
    }
}

#[test]
fn the_first_key_of_the_strength_moves_nothing_and_handles_keep_their_keys() {
    let (mut rig, ids, _) = keyed("bilaplacian");
    go_to(&mut rig, 0.7);
    let (at, whole) = (shape(&rig), edit_of(&rig));
    rig.command(Command::KeyStrength);
    rig.drain();
    assert!(shape(&rig) == at);
    assert_eq!(shares(&rig), [(0.7, 1.0)]);
    assert_eq!(times(&rig), [0.0, 0.5, 0.7, 1.0]);
    let selected: Vec<KeyId> = rig.editor.view().selected_keys.iter().copied().collect();
    assert_eq!(selected, [KeyId::new(KeyRow::Strength, 0.7)]);
    rig.undo();
    rig.command(Command::SetStrength(0.5));
    rig.drain();
    let half = shape(&rig);
    rig.command(Command::KeyStrength);
    rig.drain();
    assert!(apart(&shape(&rig), &half) < 1e-12);
    // The handles' keys are still the whole ones.
    let keyed = edit_of(&rig);
    let of_handles = |edit: &EditFile| -> Vec<_> {
        let keys = edit.keys.iter().filter(|key| !key.handles.is_empty());
        keys.map(|key| key.handles.clone()).collect()
    };
    assert_eq!(of_handles(&keyed), of_handles(&whole));
    // A key of a handle leaves the strength alone, and holds the whole of what is shown.
    go_to(&mut rig, 0.25);
    let between = shape(&rig);
    rig.command(Command::KeyHere);
    rig.drain();
    assert!(apart(&shape(&rig), &between) < 1e-12);
    assert_eq!(shares(&rig), [(0.7, 0.5)]);
    // A moved handle shows its edit in full; so does its key.
    put(&mut rig, ids[0], trs(DVec3::Y * 0.2, 0.1));
    let moved = shape(&rig);
    rig.command(Command::KeySelected);
    rig.drain();
    assert!(apart(&shape(&rig), &moved) < 1e-12);
    assert_eq!(shares(&rig), [(0.25, 1.0), (0.7, 0.5)]);
}

#[test]
fn a_key_of_a_share_makes_that_share_the_whole() {
    let (mut rig, ids, _) = keyed("bilaplacian");
    go_to(&mut rig, 0.7);
    put(&mut rig, ids[0], trs(DVec3::Y * 0.4, 0.2));
    rig.command(Command::SetStrength(0.5));
    rig.drain();
    let half = shape(&rig);
    rig.command(Command::KeyHere);
    rig.drain();
    assert!(apart(&shape(&rig), &half) < 1e-12);
    assert_eq!(rig.editor.document().strength(), 1.0);
    // The share is not taken a second time.
    rig.command(Command::KeyStrength);
    rig.drain();
    assert!(apart(&shape(&rig), &half) < 1e-12);
    assert_eq!(shares(&rig), [(0.7, 1.0)]);
    go_to(&mut rig, 0.2);
    go_to(&mut rig, 0.7);
    assert!(apart(&shape(&rig), &half) < 1e-12);
}

#[test]
fn every_frame_is_that_of_the_exported_edit_which_opens_with_the_same_keys() {
    for method in ["bilaplacian", "arap"] {
        let mut rig = faded(method);
        let edit = edit_of(&rig);
        let mut again = opened(&rig, Beginning::Edit(Box::new(edit.clone())));
        assert_eq!(shares(&again), shares(&rig));
        assert_eq!(edit_of(&again).keys, edit.keys);
        for time in [0.0, 0.1, 0.25, 0.4, 0.65, 1.0] {
            let meant = engine_frame(&rig, &edit, time);
            for rig in [&mut rig, &mut again] {
                go_to(rig, time);
                let far = apart(&shape(rig), &meant);
                assert!(far < 1e-9, "{method} at {time}: {far}");
            }
        }
        go_to(&mut rig, 0.0);
        assert!(affines(&rig).iter().all(|map| map.is_finite()) && rig.editor.document().strength() == 0.0);
        assert!(apart(&shape(&rig), &vec![DVec3::ZERO; shape(&rig).len()]) < 1e-12);
    }
}

#[test]
fn keys_of_the_strength_are_moved_eased_copied_and_deleted_by_themselves() {
    let mut rig = faded("bilaplacian");
    let key = |time: f64| vec![KeyId::new(KeyRow::Strength, time)];
    let handles = |rig: &Rig| -> Vec<f64> {
        let keys = rig.editor.document().animation().keys().iter();
        keys.filter(|key| key.handles().count() > 0)
            .map(|key| key.time)
            .collect()
    };
    let steps = [
        (Command::MoveKeys(0.125), vec![(0.1, 0.0), (0.525, 1.0), (0.9, 0.75)]),
        (Command::MoveKeys(0.5), vec![(0.1, 0.0), (0.9, 1.0)]),
        (Command::DeleteKeys, vec![(0.1, 0.0), (0.9, 0.75)]),
        (
            Command::SetKeyEase(Ease::Hold),
            vec![(0.1, 0.0), (0.4, 1.0), (0.9, 0.75)],
        ),
    ];
    for (command, expected) in steps {
        go_to(&mut rig, 0.25);
        rig.command(Command::SelectKeys(key(0.4)));
        let before = Fingerprint::of(rig.editor.document());
        rig.command(command.clone());
        rig.drain();
        assert_eq!(shares(&rig), expected, "{command:?}");
        assert_eq!(handles(&rig), [0.0, 0.5, 1.0], "{command:?}");
        rig.undo();
        rig.drain();
        assert!(Fingerprint::of(rig.editor.document()) == before, "{command:?}");
    }
    rig.command(Command::SelectKeys(key(0.4)));
    rig.command(Command::CopyKeys);
    go_to(&mut rig, 0.5);
    rig.command(Command::PasteKeys);
    rig.drain();
    assert_eq!(shares(&rig), [(0.1, 0.0), (0.4, 1.0), (0.5, 1.0), (0.9, 0.75)]);
    // Without keys of the strength the shown positions are whole again.
    for (time, _) in shares(&rig) {
        rig.command(Command::SelectKeys(key(time)));
        rig.command(Command::DeleteKeys);
    }
    rig.drain();
    assert_eq!(shares(&rig), []);
    assert_eq!(handles(&rig), [0.0, 0.5, 1.0]);
}

#[test]
fn a_project_brings_the_keys_of_the_strength_back() {
    let mut rig = faded("bilaplacian");
    go_to(&mut rig, 0.25);
    let again = reopened(&rig, &saved(&rig));
    assert_eq!(again.editor.document().animation(), rig.editor.document().animation());
    assert_eq!(again.editor.document().strength(), rig.editor.document().strength());
    assert!(apart(&shape(&again), &shape(&rig)) < 1e-12);
    let wrong = saved(&rig).replace("\"strength\": 0.75", "\"strength\": 7.5");
    rig.send(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "ball".to_owned(),
        beginning: Some(Beginning::parse(&wrong).unwrap()),
    });
    let refused = rig.editor.view().problem;
    assert!(
        refused.is_some_and(|sentence| sentence.contains("strength")),
        "{refused:?}"
    );
}
