//! Laws of a sequence's frames: each is shown as it was read, showing frames is a step that undo takes back to the bit,
//! and a frame that can't be read changes nothing. Keys spread to the frames of their span as in the exported edit.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::project::opened;
use crate::rig::{CENTRE_PX, Fingerprint, Rig};
use glam::{DQuat, DVec2, DVec3};
use pliant_deform::Role;
use pliant_editor::{
    Beginning, Command, EditError, EditFile, Event, FollowedFrame, FollowedHandle, HandleFilter, HandleId, HandlePlace,
    HandleTransform, KeyId, KeySpace, SequenceEdit, ToolMode, middle_of,
};
use pliant_mesh::{Drawn, SurfaceVertex, shapes};

/// The number of frames.
pub const COUNT: usize = 40;

/// The displacements of a frame of a ball that wanders, turns and ripples.
pub fn frame(rig: &Rig, frame: usize) -> Arc<Vec<DVec3>> {
    let t = frame as f64 / COUNT as f64;
    let turn = DQuat::from_rotation_y(1.5 * t);
    let way = DVec3::new(0.3 * t, 0.05 * (9.0 * t).sin(), 0.1 * t);
    let place = |p: &DVec3| turn * (*p * (1.0 + 0.05 * (7.0 * p.x + 20.0 * t).sin() * t)) + way - *p;
    Arc::new(rig.model.surface.positions.iter().map(place).collect())
}

pub fn open(drawn: Drawn) -> Rig {
    let mut rig = Rig::open(drawn);
    give_frames(&mut rig);
    rig
}

/// Opens the sequence beside the document, and shows its frame.
pub fn give_frames(rig: &mut Rig) {
    rig.send(Event::OpenedSequence {
        count: COUNT,
        shown: None,
        fps: None,
    });
    deliver(rig);
}

/// Reads the frames that are wanted, and runs all jobs.
pub fn deliver(rig: &mut Rig) {
    while let Some(wanted) = rig.editor.view().wanted_frame {
        assert!(!rig.editor.is_settled());
        let shape = frame(rig, wanted);
        rig.send(Event::Frame(wanted, Ok(shape)));
    }
    rig.drain();
}

/// The shape in a frame.
pub fn shape(rig: &Rig, number: usize) -> Vec<DVec3> {
    let file = rig.model.surface.positions.iter();
    file.zip(&**frame(rig, number))
        .map(|(place, way)| *place + *way)
        .collect()
}

/// Follows the body and the handles through the sequence, and reads the frames that are wanted then.
pub fn follow(rig: &mut Rig) {
    assert!(rig.editor.view().wants_following);
    let following = rig.editor.following();
    let file = &rig.model.surface.positions;
    let of_frame = |number: usize| {
        let shape = shape(rig, number);
        let at = |vertices: &[SurfaceVertex], positions: &[DVec3]| -> Vec<DVec3> {
            vertices.iter().map(|vertex| positions[vertex.index()]).collect()
        };
        let handles = following.handles.iter();
        FollowedFrame {
            middle: middle_of(&shape),
            handles: handles
                .map(|(_, vertices)| FollowedHandle::of(&at(vertices, file), &at(vertices, &shape)))
                .collect(),
        }
    };
    let frames = (0..COUNT).map(of_frame).collect();
    rig.send(Event::Followed(following, Ok(frames)));
    deliver(rig);
    assert!(!rig.editor.view().wants_following);
}

pub fn go_to(rig: &mut Rig, frame: usize) {
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

/// A ball with a handle that is lifted at frame 10 and less at frame 20, which is shown.
pub fn keyed() -> (Rig, HandleId) {
    let mut rig = open(shapes::icosphere(2));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    for (number, lift) in [(10, 0.4), (20, 0.2)] {
        go_to(&mut rig, number);
        rig.command(Command::SetHandleTransform(id, lifted(lift)));
        rig.drain();
        rig.command(Command::KeyHere);
        rig.drain();
    }
    (rig, id)
}

pub fn lifted(lift: f64) -> HandleTransform {
    HandleTransform::Trs {
        translation: DVec3::Y * lift,
        rotation: DQuat::from_rotation_z(lift),
        scale: DVec3::ONE,
        pivot: None,
    }
}

/// The span of the handle's first key, and the frames of its keys.
fn span_and_frames(rig: &Rig, id: HandleId) -> ([usize; 2], Vec<usize>) {
    let animation = rig.editor.document().animation();
    let keys = animation.keys();
    let frames = keys.iter().map(|key| animation.frame_of(key));
    (keys[0].span(id).unwrap(), frames.collect())
}

#[test]
fn every_frame_shows_the_handles_and_the_surface_that_the_exported_edit_gives_it() {
    let (mut rig, id) = keyed();
    // The second key is within the reach of the first.
    assert_eq!(span_and_frames(&rig, id), ([0, 22], vec![10, 20]));
    let edit = rig.editor.edit_file().unwrap();
    let text = edit.to_json();
    let Beginning::Edit(edit) = Beginning::parse(&text).unwrap() else {
        panic!("{text}");
    };
    assert_eq!(edit.frames_with_places(COUNT).unwrap(), [10, 20]);
    let setup = edit.resolve(&rig.model).unwrap();
    let model = Arc::clone(&rig.model);
    let first = &model.surface.positions;
    let own: Vec<usize> = (0..first.len())
        .filter(|v| setup.roles[*v] == Role::Handle(0))
        .collect();
    let place = |rig: &Rig, number: usize| {
        let ways = frame(rig, number);
        let [rest, now]: [Vec<DVec3>; 2] = [
            own.iter().map(|v| first[*v]).collect(),
            own.iter().map(|v| first[*v] + ways[*v]).collect(),
        ];
        HandlePlace::of(&rest, &now)
    };
    let at_rest: Vec<DVec3> = own.iter().map(|v| first[*v]).collect();
    let at_rest = [HandlePlace::of(&at_rest, &at_rest)];
    let timeline = edit.sequence_timeline(&setup, &at_rest, |number, _| place(&rig, number), BTreeMap::new());
    let timeline = timeline.unwrap();
    for number in [0, 1, 5, 10, 13, 20, 21, 22, 23, 30] {
        let maps = timeline.maps_at(number, &[place(&rig, number)]);
        go_to(&mut rig, number);
        let document = rig.editor.document();
        assert!(document.is_settled());
        assert_eq!(rig.editor.roles(), setup.roles, "regions hold for all frames");
        let shape = frame(&rig, number);
        let Some(maps) = maps else {
            assert_eq!(*document.from_file(), shape, "frame {number} is untouched");
            continue;
        };
        let found = document.handles()[0].affine();
        assert!(found.abs_diff_eq(maps[0], 1e-12), "frame {number}: {found} {}", maps[0]);
        for vertex in &own {
            let meant = maps[0].transform_point3(first[*vertex] + shape[*vertex]);
            let shown = first[*vertex] + document.from_file()[*vertex];
            assert!(shown.distance(meant) < 1e-9, "frame {number}");
        }
        let bent = (document.from_file().iter().zip(&**shape)).any(|(shown, own)| shown.distance(*own) > 0.01);
        assert!(bent, "frame {number}");
    }
}

#[test]
fn spans_follow_their_keys_and_every_change_is_a_step() {
    let (mut rig, id) = keyed();
    let key = KeyId::new(id, 20.0 / 24.0);
    rig.command(Command::SetSpan(key, [15, 30]));
    deliver(&mut rig);
    // It goes on to hold both keys.
    assert_eq!(span_and_frames(&rig, id).0, [10, 30]);
    rig.undo();
    assert_eq!(span_and_frames(&rig, id).0, [0, 22]);
    rig.command(Command::SelectKeys(vec![key]));
    rig.command(Command::MoveKeys(15.0 / 24.0));
    deliver(&mut rig);
    // Its own reach has moved with it, and meets that of the first.
    assert_eq!(span_and_frames(&rig, id), ([0, 37], vec![10, 35]));
    assert_eq!(rig.editor.document().animation().frame(), 20);
    let between = rig.editor.document().handles()[0].affine();
    rig.command(Command::DeleteKeys);
    deliver(&mut rig);
    assert_ne!(rig.editor.document().handles()[0].affine(), between);
    assert_eq!(span_and_frames(&rig, id), ([0, 37], vec![10]));
    rig.undo();
    rig.drain();
    assert_eq!(rig.editor.document().handles()[0].affine(), between);
    // Other paint gives the handle another place, for which the frames of keys are read again.
    go_to(&mut rig, 30);
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.swipe(&[CENTRE_PX + DVec2::new(20.0, 0.0)]);
    rig.drain();
    rig.command(Command::GoToTime(25.0 / 24.0));
    let shape = frame(&rig, 25);
    rig.send(Event::Frame(25, Ok(shape)));
    assert_eq!(rig.editor.view().wanted_frame, Some(10));
    deliver(&mut rig);
    assert_eq!(rig.editor.document().animation().frame(), 25);
}

#[test]
fn other_frames_a_second_keep_the_frames_of_keys() {
    let (mut rig, id) = keyed();
    let before = span_and_frames(&rig, id);
    rig.command(Command::SetFps(30.0));
    deliver(&mut rig);
    assert_eq!(span_and_frames(&rig, id), before);
    assert_eq!(rig.editor.document().animation().frame(), 20);
    let edit = rig.editor.edit_file().unwrap();
    assert_eq!(
        edit.keys.iter().map(|key| key.frame).collect::<Vec<_>>(),
        [Some(10), Some(20)]
    );
}

#[test]
fn a_pose_moves_a_handle_as_much_in_every_frame() {
    let (mut rig, id) = keyed();
    rig.command(Command::KeepPose);
    let turned = rig.editor.document().handles()[0].transform;
    go_to(&mut rig, 35);
    assert!(rig.editor.document().handles()[0].transform.is_identity());
    rig.command(Command::TakePose(0));
    rig.drain();
    assert_eq!(rig.editor.document().handles()[0].transform, turned);
    rig.undo();
    rig.command(Command::KeyPose(0));
    deliver(&mut rig);
    assert_eq!(rig.editor.document().handles()[0].transform, turned);
    assert_eq!(rig.editor.document().animation().keys()[2].span(id), Some([23, 39]));
}

/// The document of an edit of the sequence, at a frame.
fn applied(rig: &Rig, edit: &EditFile, number: usize) -> Result<Rig, EditError> {
    let setup = edit.resolve(&rig.model)?;
    let file = rig.model.surface.positions.clone();
    let handle = |way: &[DVec3]| {
        let own = (0..file.len()).filter(|v| setup.roles[*v] == Role::Handle(0));
        let (rest, now): (Vec<DVec3>, Vec<DVec3>) = own.map(|v| (file[v], file[v] + way[v])).unzip();
        HandlePlace::of(&rest, &now)
    };
    let at_rest = handle(&vec![DVec3::ZERO; file.len()]);
    let own = SequenceEdit::of(edit, &setup, &[at_rest], |number, _| handle(&frame(rig, number)))?;
    let mut again = opened(rig, own.into());
    give_frames(&mut again);
    if again.editor.view().wants_following {
        follow(&mut again);
    }
    go_to(&mut again, number);
    Ok(again)
}

#[test]
fn an_exported_edit_on_the_sequence_again_gives_the_same_frames() {
    let (mut rig, id) = keyed();
    rig.command(Command::BendPath(20, DVec3::new(0.3, 0.0, 0.5)));
    let filter = HandleFilter {
        amount: 0.5,
        ..HandleFilter::of_all(COUNT)
    };
    rig.command(Command::SetFilter(id, Some(filter)));
    follow(&mut rig);
    let text = rig.editor.edit_file().unwrap().to_json();
    let Beginning::Edit(mut edit) = Beginning::parse(&text).unwrap() else {
        panic!("{text}");
    };
    let same = |rig: &mut Rig, again: &Rig| {
        assert_eq!(
            again.editor.document().animation().path(),
            rig.editor.document().animation().path()
        );
        assert_eq!(
            again.editor.document().animation().filters(),
            rig.editor.document().animation().filters()
        );
        let shapes = [&*rig, again].map(|rig| rig.editor.document().from_file().clone());
        let apart = shapes[0].iter().zip(&*shapes[1]).map(|(a, b)| a.distance(*b));
        apart.fold(0.0, f64::max)
    };
    for number in [10, 14, 25] {
        go_to(&mut rig, number);
        let again = applied(&rig, &edit, number).unwrap();
        assert_eq!(again.editor.document().animation(), rig.editor.document().animation());
        assert!(same(&mut rig, &again) < 1e-9, "{number}");
        // Without pivots, those of the handles ride along.
        for transform in edit.keys.iter_mut().flat_map(|key| key.handles.values_mut()) {
            if let HandleTransform::Trs { pivot, .. } = transform {
                *pivot = None;
            }
        }
        let again = applied(&rig, &edit, number).unwrap();
        assert!(same(&mut rig, &again) < 1e-9, "{number}");
    }
    edit.strength = 0.5;
    let half = applied(&rig, &edit, 10).unwrap();
    let lift = |rig: &Rig| rig.editor.document().handles()[0].affine().translation;
    go_to(&mut rig, 10);
    assert!(lift(&half).length() < 0.7 * lift(&rig).length());
    // Keys in the world's axes stay so.
    edit.strength = 1.0;
    edit.keys.iter_mut().for_each(|key| key.space = KeySpace::World);
    let mut world = applied(&rig, &edit, 25).unwrap();
    let written = world.editor.edit_file().unwrap();
    assert!(written.keys.iter().all(|key| key.space == KeySpace::World));
    let again = applied(&rig, &written, 25).unwrap();
    assert!(same(&mut world, &again) < 1e-9);
}

#[test]
fn keys_of_a_span_turn_with_their_handle_or_keep_the_worlds_axes_together() {
    let (mut rig, id) = keyed();
    // A handle of one vertex does not turn.
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.swipe(&[-60.0, 0.0, 60.0].map(|x| CENTRE_PX + DVec2::new(x, 40.0)));
    rig.drain();
    rig.command(Command::SelectKeys(vec![KeyId::new(id, 10.0 / 24.0)]));
    let spaces = |rig: &Rig| -> Vec<KeySpace> {
        let keys = rig.editor.document().animation().keys().iter();
        keys.map(|key| key.space(id)).collect()
    };
    go_to(&mut rig, 15);
    let turning = rig.editor.document().handles()[0].affine();
    rig.command(Command::SetKeySpace(KeySpace::World));
    deliver(&mut rig);
    assert_eq!(spaces(&rig), [KeySpace::World; 2], "a span has one space");
    assert_ne!(rig.editor.document().handles()[0].affine(), turning);
    let reopened = crate::project::reopened(&rig, &crate::project::saved(&rig));
    assert_eq!(spaces(&reopened), [KeySpace::World; 2]);
    // A new key in the span takes its axes on.
    rig.command(Command::KeyHere);
    deliver(&mut rig);
    assert_eq!(spaces(&rig), [KeySpace::World; 3]);
    rig.undo();
    rig.undo();
    assert_eq!(rig.editor.document().handles()[0].affine(), turning);
    assert_eq!(spaces(&rig), [KeySpace::Local; 2]);
}
