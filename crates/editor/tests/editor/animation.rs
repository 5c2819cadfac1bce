//! Laws of the edit over time: keys are met, each change of them is one step, a frame depends on nothing but its moment,
//! and edits and projects store everything.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::rig::{CENTRE_PX, Fingerprint, Rig, VIEWPORT_PX};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use pliant_deform::Budget;
use pliant_editor::{
    Beginning, Command, Ease, EditFile, Event, HandleId, HandleTransform, InlineExecutor, Key, KeyId, MeshReference,
    Modifiers, Start, geometry_hash,
};
use pliant_mesh::{Cancel, Progress, shapes};

pub fn trs(translation: DVec3, turn_rad: f64) -> HandleTransform {
    HandleTransform::Trs {
        translation,
        rotation: DQuat::from_rotation_z(turn_rad),
        scale: DVec3::ONE,
        pivot: None,
    }
}

pub fn put(rig: &mut Rig, id: HandleId, transform: HandleTransform) {
    rig.command(Command::SetHandleTransform(id, transform));
    rig.drain();
}

pub fn go_to(rig: &mut Rig, time: f64) {
    rig.command(Command::GoToTime(time));
    rig.drain();
}

pub fn affines(rig: &Rig) -> Vec<DAffine3> {
    let handles = rig.editor.document().handles().iter();
    handles.map(|handle| handle.affine()).collect()
}

pub fn shape(rig: &Rig) -> Vec<DVec3> {
    rig.editor.document().from_file().to_vec()
}

/// The largest distance of two shapes.
pub fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// The times of the keys.
pub fn times(rig: &Rig) -> Vec<f64> {
    rig.editor
        .document()
        .animation()
        .keys()
        .iter()
        .map(|key| key.time)
        .collect()
}

/// The keys of a handle at these times.
fn ids(handle: HandleId, times: &[f64]) -> Vec<KeyId> {
    times.iter().map(|time| KeyId::new(handle, *time)).collect()
}

/// A ball with two handles and keys at 0, 0.5 and 1 s, which shows the last of them, and the transforms at the keys.
pub fn keyed(method: &str) -> (Rig, [HandleId; 2], [[HandleTransform; 2]; 3]) {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose(method);
    rig.paint_handle();
    rig.drain();
    rig.command(Command::NewHandle);
    rig.swipe(&[CENTRE_PX + DVec2::new(-110.0, 40.0)]);
    rig.drain();
    let handles = rig.editor.document().handles();
    let ids = [handles[0].id, handles[1].id];
    let rest = HandleTransform::IDENTITY;
    let keys = [
        [rest, rest],
        [trs(DVec3::Z * 0.4, 0.9), trs(DVec3::X * 0.1, 0.0)],
        [trs(DVec3::new(0.1, 0.3, 0.2), -0.6), rest],
    ];
    for (number, transforms) in keys.iter().enumerate() {
        go_to(&mut rig, 0.5 * number as f64);
        put(&mut rig, ids[0], transforms[0]);
        put(&mut rig, ids[1], transforms[1]);
        rig.command(Command::KeyHere);
    }
    (rig, ids, keys)
}

#[test]
fn at_a_keys_time_handles_and_surface_are_those_of_the_pose_that_was_keyed() {
    for (method, tolerance) in [("bilaplacian", 1e-12), ("arap", 1e-4)] {
        let (mut rig, ids, keys) = keyed(method);
        for (number, transforms) in keys.iter().enumerate() {
            go_to(&mut rig, 0.5 * number as f64);
            let (at_key, frame) = (affines(&rig), shape(&rig));
            assert!(rig.editor.document().is_settled());
            // The same transforms without keys, from rest.
            rig.command(Command::SelectAllKeys);
            rig.command(Command::DeleteKeys);
            put(&mut rig, ids[0], HandleTransform::IDENTITY);
            put(&mut rig, ids[1], HandleTransform::IDENTITY);
            put(&mut rig, ids[0], transforms[0]);
            put(&mut rig, ids[1], transforms[1]);
            assert_eq!(affines(&rig), at_key, "{method} at key {number}");
            let far = apart(&shape(&rig), &frame);
            assert!(far <= tolerance, "{method} at key {number}: {far}");
            for _ in 0..7 {
                if times(&rig).is_empty() {
                    rig.undo();
                }
            }
            rig.drain();
        }
    }
}

/// Plays so many frames.
fn play(rig: &mut Rig, frames: usize) {
    rig.command(Command::PlayKeys);
    for _ in 0..frames {
        rig.send(Event::Tick);
        rig.drain();
    }
    rig.command(Command::PlayKeys);
    rig.drain();
}

#[test]
fn a_frame_does_not_depend_on_where_playing_began() {
    for method in ["bilaplacian", "arap"] {
        let (mut rig, _, _) = keyed(method);
        let fps = rig.editor.document().animation().fps();
        go_to(&mut rig, 9.0 / fps);
        let at_once = shape(&rig);
        go_to(&mut rig, 0.0);
        play(&mut rig, 9);
        assert_eq!(rig.editor.document().animation().time(), 9.0 / fps);
        assert!(shape(&rig) == at_once, "{method} from the beginning");
        // Beyond the end, and from the beginning again.
        go_to(&mut rig, 20.0 / fps);
        play(&mut rig, 14);
        assert_eq!(rig.editor.document().animation().time(), 9.0 / fps);
        assert!(shape(&rig) == at_once, "{method} over the end");
        // A drag along the ruler goes on from shape to shape, and ends like every other frame.
        go_to(&mut rig, 0.0);
        for frame in [3.0, 17.0, 9.0] {
            rig.send(Event::Adjust(Command::GoToTime(frame / fps)));
            rig.drain();
        }
        rig.send(Event::Adjusted);
        rig.drain();
        assert!(shape(&rig) == at_once, "{method} after a drag");
    }
}

/// The frame at a time as the engine solves it: the written edit, bound afresh.
pub fn engine_frame(rig: &Rig, edit: &EditFile, time: f64) -> Vec<DVec3> {
    let setup = edit.resolve(&rig.model).unwrap();
    let timeline = edit.timeline(&setup).unwrap();
    let (problem, cancel) = (setup.problem(&rig.model), Cancel::new());
    let progress = Progress::new();
    let ordering = problem
        .ordering_within(Budget::of_most(None), &progress, &cancel)
        .unwrap();
    let mut bound = problem.bind(ordering.as_ref(), &progress, &cancel).unwrap();
    let start = Start::Shape(Arc::new(vec![DVec3::ZERO; rig.model.surface.positions.len()]));
    let targets = setup.targets_during(&timeline, time);
    let bent = start.bend_anew(&mut bound, &targets, &cancel).unwrap();
    bent.shown.to_vec()
}

#[test]
fn a_written_edit_has_the_keys_and_its_frames_are_those_of_the_window() {
    for method in ["bilaplacian", "arap"] {
        let (mut rig, _, _) = keyed(method);
        let edit = rig.editor.edit_file().unwrap();
        assert_eq!(edit.keys.len(), 3);
        for time in [0.0, 0.25, 0.5, 0.79, 1.0] {
            go_to(&mut rig, time);
            let far = apart(&shape(&rig), &engine_frame(&rig, &edit, time));
            assert!(far < 1e-9, "{method} at {time}: {far}");
        }
    }
}

#[test]
fn an_edit_with_keys_opens_and_is_written_again_with_the_same_keys() {
    let (rig, _, _) = keyed("bilaplacian");
    let edit = rig.editor.edit_file().unwrap();
    let (jobs, model) = (InlineExecutor::new(), Arc::clone(&rig.model));
    let mut again = Rig::of(
        pliant_editor::Editor::new(Box::new(jobs.clone())),
        jobs,
        Arc::clone(&model),
    );
    again.send(Event::Viewport { size_px: VIEWPORT_PX });
    again.send(Event::Opened {
        model,
        name: "ball".to_owned(),
        beginning: Some(Beginning::Edit(Box::new(edit.clone()))),
    });
    again.drain();
    assert_eq!(again.editor.view().problem, None);
    assert!(again.editor.view().look.timeline, "keys are shown");
    assert!(!again.editor.view().unsaved);
    assert_eq!(times(&again), times(&rig));
    // It shows its beginning.
    assert!(affines(&again).iter().all(|map| *map == DAffine3::IDENTITY));
    let written = again.editor.edit_file().unwrap();
    assert_eq!(written.keys, edit.keys);
}

#[test]
fn a_project_gives_keys_moment_and_shape_back() {
    let (mut rig, _, _) = keyed("arap");
    rig.command(Command::SetFps(30.0));
    rig.command(Command::SelectAllKeys);
    rig.command(Command::SetKeyEase(Ease::Linear));
    go_to(&mut rig, 0.7);
    let snapshot = rig.editor.snapshot().unwrap();
    let mesh = MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    };
    let project = snapshot.project(mesh);
    let text = project.to_json();
    let read = pliant_editor::Project::parse(&text).unwrap();
    let (jobs, model) = (InlineExecutor::new(), Arc::clone(&rig.model));
    let mut again = Rig::of(
        pliant_editor::Editor::new(Box::new(jobs.clone())),
        jobs,
        Arc::clone(&model),
    );
    again.send(Event::Viewport { size_px: VIEWPORT_PX });
    again.send(Event::Opened {
        model,
        name: "ball".to_owned(),
        beginning: Some(read.into()),
    });
    again.drain();
    assert_eq!(again.editor.document().animation(), rig.editor.document().animation());
    assert_eq!(again.editor.document_hash(), rig.editor.document_hash());
    assert!(again.drawn() == rig.drawn());
    for rig in [&mut rig, &mut again] {
        go_to(rig, 0.3);
    }
    assert!(again.drawn() == rig.drawn());
}

#[test]
fn each_change_of_the_keys_is_one_step_that_undo_takes_back_to_the_bit() {
    let (mut rig, ids_of, _) = keyed("bilaplacian");
    let second = ids(ids_of[0], &[0.5]);
    go_to(&mut rig, 0.25);
    rig.command(Command::KeepPose);
    let steps = [
        (Command::MoveKeys(0.25), vec![0.0, 0.5, 0.75, 1.0]),
        (Command::MoveKeys(-9.0), vec![0.0, 0.5, 1.0]),
        (Command::DeleteKeys, vec![0.0, 0.5, 1.0]),
        (Command::SetKeyEase(Ease::Hold), vec![0.0, 0.5, 1.0]),
        (Command::KeyHere, vec![0.0, 0.25, 0.5, 1.0]),
        (Command::KeySelected, vec![0.0, 0.25, 0.5, 1.0]),
        (Command::KeyPose(0), vec![0.0, 0.25, 0.5, 1.0]),
        (Command::GoToKey(true), vec![0.0, 0.5, 1.0]),
        (Command::StepFrames(1), vec![0.0, 0.5, 1.0]),
        (Command::SetFps(25.0), vec![0.0, 0.5, 1.0]),
    ];
    for (command, expected) in steps {
        rig.command(Command::SelectKeys(second.clone()));
        let (before, animation) = (
            Fingerprint::of(rig.editor.document()),
            rig.editor.document().animation().clone(),
        );
        rig.command(command.clone());
        rig.drain();
        assert_eq!(times(&rig), expected, "{command:?}");
        assert!(*rig.editor.document().animation() != animation, "{command:?}");
        let after = Fingerprint::of(rig.editor.document());
        rig.undo();
        rig.drain();
        assert_eq!(*rig.editor.document().animation(), animation, "{command:?}");
        assert!(Fingerprint::of(rig.editor.document()) == before, "{command:?}");
        rig.redo();
        rig.drain();
        assert!(Fingerprint::of(rig.editor.document()) == after, "{command:?}");
        rig.undo();
        rig.drain();
    }
}

#[test]
fn moved_keys_replace_those_they_come_upon_and_the_surface_follows_at_once() {
    let (mut rig, [first, second], keys) = keyed("bilaplacian");
    go_to(&mut rig, 0.0);
    rig.command(Command::SelectKeys(ids(first, &[0.5])));
    rig.command(Command::MoveKeys(-0.5));
    rig.drain();
    let animation = rig.editor.document().animation();
    let named: Vec<Vec<HandleId>> = animation.keys().iter().map(|key| key.handles().collect()).collect();
    assert_eq!(named, [vec![first, second], vec![second], vec![first, second]]);
    // The moved key is at the shown moment now.
    let moved = &rig.editor.document().handles()[0];
    assert_eq!(moved.transform, keys[1][0]);
    let selected: Vec<KeyId> = rig.editor.view().selected_keys.iter().copied().collect();
    assert_eq!(selected, ids(first, &[0.0]));
    // A handle without its last key stays.
    let stays = affines(&rig)[0];
    rig.command(Command::SelectKeys(ids(first, &[0.0, 1.0])));
    rig.command(Command::DeleteKeys);
    go_to(&mut rig, 1.0);
    assert_eq!(affines(&rig)[0], stays);
}

#[test]
fn copied_keys_come_back_at_the_shown_moment_and_stretched_ones_keep_their_first() {
    let (mut rig, _, _) = keyed("bilaplacian");
    rig.command(Command::SelectAllKeys);
    rig.command(Command::CopyKeys);
    go_to(&mut rig, 2.0);
    rig.command(Command::PasteKeys);
    assert_eq!(times(&rig), [0.0, 0.5, 1.0, 2.0, 2.5, 3.0]);
    go_to(&mut rig, 0.25);
    let early = affines(&rig);
    go_to(&mut rig, 0.5);
    let at_key = affines(&rig);
    go_to(&mut rig, 2.5);
    assert_eq!(affines(&rig), at_key);
    rig.command(Command::SelectKeys(
        rig.editor.view().selected_keys.iter().copied().collect::<Vec<_>>(),
    ));
    rig.command(Command::StretchKeys(2.0));
    rig.drain();
    assert_eq!(times(&rig), [0.0, 0.5, 1.0, 2.0, 3.0, 4.0]);
    let selected: BTreeSet<u64> = rig
        .editor
        .view()
        .selected_keys
        .iter()
        .map(|id| id.time().to_bits())
        .collect();
    assert_eq!(selected.len(), 3);
    // Keys elsewhere pass on no change.
    go_to(&mut rig, 0.25);
    assert_eq!(affines(&rig), early);
}

#[test]
fn a_drag_of_the_moment_and_a_stretch_of_play_are_one_step_each() {
    let (mut rig, _, _) = keyed("bilaplacian");
    go_to(&mut rig, 0.0);
    let (steps, before) = (rig.editor.history().names().1, Fingerprint::of(rig.editor.document()));
    for time in [0.1, 0.2, 0.3] {
        rig.send(Event::Adjust(Command::GoToTime(time)));
        rig.drain();
    }
    rig.send(Event::Adjusted);
    assert_eq!(rig.editor.history().names().1, steps + 1);
    rig.undo();
    rig.drain();
    assert!(Fingerprint::of(rig.editor.document()) == before);
    rig.command(Command::PlayKeys);
    for _ in 0..5 {
        rig.send(Event::Tick);
        rig.drain();
    }
    assert!(rig.editor.view().is_animating);
    // The next change of the document ends the play first.
    rig.command(Command::KeyHere);
    assert!(!rig.editor.view().is_animating);
    assert_eq!(rig.editor.history().names().1, steps + 2);
    rig.undo();
    rig.undo();
    rig.drain();
    assert!(Fingerprint::of(rig.editor.document()) == before);
    rig.command(Command::PlayKeys);
    rig.send(Event::Tick);
    rig.send(Event::Key(Key::Escape, Modifiers::NONE));
    assert!(!rig.editor.view().is_animating);
}

#[test]
fn the_next_frame_waits_until_the_last_one_is_solved() {
    let (mut rig, _, _) = keyed("arap");
    go_to(&mut rig, 0.0);
    rig.command(Command::PlayKeys);
    rig.send(Event::Tick);
    let first = rig.editor.document().animation().time();
    assert!(first > 0.0 && !rig.editor.document().is_settled());
    for _ in 0..3 {
        rig.send(Event::Tick);
    }
    assert_eq!(rig.editor.document().animation().time(), first);
    rig.drain();
    rig.send(Event::Tick);
    assert!(rig.editor.document().animation().time() > first);
}

#[test]
fn an_applied_shape_leaves_every_key_where_it_was() {
    let (mut rig, _, _) = keyed("bilaplacian");
    let all = [0.0, 0.5, 1.0];
    let before: Vec<Vec<DVec3>> = all
        .iter()
        .map(|time| {
            go_to(&mut rig, *time);
            rig.editor
                .document()
                .handles()
                .iter()
                .map(|handle| handle.centre())
                .collect()
        })
        .collect();
    go_to(&mut rig, 0.5);
    rig.command(Command::Apply);
    rig.drain();
    for (time, places) in all.iter().zip(before) {
        go_to(&mut rig, *time);
        let now: Vec<DVec3> = rig
            .editor
            .document()
            .handles()
            .iter()
            .map(|handle| handle.centre())
            .collect();
        assert!(apart(&now, &places) < 1e-12, "at {time}");
    }
}

#[test]
fn a_command_that_can_not_be_done_says_why() {
    let mut rig = Rig::open(shapes::icosphere(2));
    for command in [
        Command::KeyHere,
        Command::KeySelected,
        Command::KeyPose(0),
        Command::PlayKeys,
        Command::MoveKeys(1.0),
        Command::DeleteKeys,
        Command::CopyKeys,
        Command::PasteKeys,
        Command::SelectAllKeys,
        Command::GoToKey(true),
        Command::GoToTime(-1.0),
        Command::GoToTime(f64::NAN),
        Command::SetFps(0.0),
    ] {
        assert!(rig.editor.unavailable_because(&command).is_some(), "{command:?}");
        rig.command(command);
    }
    assert!(rig.editor.document().animation().keys().is_empty());
}

/// The shown ghosts: their places and shapes.
fn ghosts(rig: &Rig) -> Vec<(i8, Vec<DVec3>)> {
    let skins = rig.editor.view().skins.iter();
    skins.map(|skin| (skin.place, skin.from_file.to_vec())).collect()
}

#[test]
fn ghosts_are_the_frames_at_their_moments_and_disturb_nothing() {
    for method in ["bilaplacian", "arap"] {
        let (mut rig, ids, _) = keyed(method);
        let fps = rig.editor.document().animation().fps();
        go_to(&mut rig, 9.0 / fps);
        let at_once = shape(&rig);
        let frames: Vec<(i8, Vec<DVec3>)> = [(-2, 1.0), (-1, 5.0), (1, 13.0), (2, 17.0)]
            .into_iter()
            .map(|(place, frame)| {
                go_to(&mut rig, frame / fps);
                (place, shape(&rig))
            })
            .collect();
        go_to(&mut rig, 9.0 / fps);
        assert!(ghosts(&rig).is_empty(), "they are off at first");
        rig.command(Command::ToggleSkins);
        rig.drain();
        assert!(
            rig.editor.view().look.timeline,
            "{method}: the timeline comes with them"
        );
        assert!(ghosts(&rig) == frames, "{method}");
        assert!(shape(&rig) == at_once, "{method}");
        // None lies outside the keys.
        go_to(&mut rig, 0.0);
        let places: Vec<i8> = ghosts(&rig).iter().map(|(place, _)| *place).collect();
        assert_eq!(places, [1, 2], "{method}");
        go_to(&mut rig, 9.0 / fps);
        assert!(ghosts(&rig) == frames && shape(&rig) == at_once, "{method} again");
        // A pose that has no key yet counts as one, so that its effect on the frames around it is seen.
        put(&mut rig, ids[0], trs(DVec3::X * 0.2, 0.3));
        let posed = ghosts(&rig);
        rig.command(Command::KeyHere);
        go_to(&mut rig, 13.0 / fps);
        let far = apart(&shape(&rig), &posed[2].1);
        assert!(far < 1e-12, "{method}: {far}");
        assert!(apart(&posed[2].1, &frames[2].1) > 1e-3, "{method}");
    }
}

#[test]
fn ghosts_follow_a_drag_of_a_linear_method_and_go_while_the_animation_plays() {
    let (mut rig, ids, _) = keyed("bilaplacian");
    let fps = rig.editor.document().animation().fps();
    go_to(&mut rig, 9.0 / fps);
    rig.command(Command::ToggleSkins);
    rig.drain();
    let before = ghosts(&rig);
    rig.send(Event::Adjust(Command::SetHandleTransform(
        ids[0],
        trs(DVec3::Y * 0.3, 0.0),
    )));
    rig.drain();
    assert_eq!(ghosts(&rig).len(), before.len());
    assert!(ghosts(&rig) != before);
    rig.send(Event::Adjusted);
    rig.command(Command::PlayKeys);
    rig.send(Event::Tick);
    rig.drain();
    assert!(ghosts(&rig).is_empty());
    rig.command(Command::PlayKeys);
    rig.drain();
    assert!(!ghosts(&rig).is_empty());
    let most = pliant_editor::Skins {
        before: 200,
        ..rig.editor.view().look.skins
    };
    assert!(rig.editor.unavailable_because(&Command::SetSkins(most)).is_some());
    rig.command(Command::ToggleTimeline);
    rig.drain();
    assert!(ghosts(&rig).is_empty());
}
