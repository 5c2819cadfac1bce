//! Parts of another file: their handle moves them alone, they are mirrored, and a merge asks for the right ones.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use pliant_editor::{
    Command, Event, KeptSide, Key, MergeSettings, MeshChange, ObjectAction, Paint, Placement, REACH_RANGE, RimUse,
};
use pliant_mesh::{Object, SurfaceVertex, shapes};

use crate::rig::new_mesh::{answer, answer_with, bowl, state, used};
use crate::rig::{Rig, VIEWPORT_PX, weld};

/// A bowl with another one appended, whose handle is selected.
fn appended() -> Rig {
    let mut rig = Rig::open(bowl());
    rig.command(Command::ChangeMesh(MeshChange::Append("lid".to_owned())));
    answer(&mut rig);
    rig
}

#[test]
fn an_appended_part_gets_a_handle_that_moves_it_alone_wherever_it_touches() {
    let mut rig = appended();
    let count = used(bowl()).positions.len();
    let handle = rig.editor.document().handles()[0].clone();
    assert_eq!((&*handle.name, rig.editor.view().selected), ("lid", Some(handle.id)));
    assert_eq!(rig.count(Paint::Handle(handle.id)), count);
    assert!(
        rig.editor.document().paint()[..count]
            .iter()
            .all(|paint| *paint == Paint::Bare)
    );
    // Far into the other bowl, and on through it: each is a step, and the first bowl rests to the bit.
    let before = state(&rig);
    for _ in 0..2 {
        rig.move_by('x', "-1.7");
        rig.drain();
        let ways = rig.editor.document().from_file();
        assert!(ways[..count].iter().all(|way| *way == DVec3::ZERO));
        assert!(
            ways[count..]
                .iter()
                .all(|way| (way.x % 1.7).abs() < 1e-9 && way.x < -1.0)
        );
    }
    rig.undo();
    rig.undo();
    rig.drain();
    assert!(state(&rig) == before);
    rig.undo();
    assert_eq!(rig.editor.view().model.unwrap().surface.positions.len(), count);
    assert!(rig.editor.document().handles().is_empty());
}

#[test]
fn a_mirrored_part_is_turned_so_that_it_still_faces_outwards_and_undo_takes_both_back() {
    let mut rig = appended();
    let before = rig.fingerprint();
    let count = used(bowl()).positions.len();
    for axis in 0..3 {
        rig.command(Command::MirrorPart(axis));
        rig.drain();
        let document = rig.editor.document();
        let turned: Vec<u32> = document.inside_out().iter().copied().collect();
        let component = rig.model.topology.component(SurfaceVertex(count as u32));
        assert_eq!(turned, [component]);
        assert!(document.handles()[0].affine().matrix3.determinant() < 0.0);
        rig.command(Command::MirrorPart(axis));
        rig.drain();
        assert!(
            rig.editor.document().inside_out().is_empty(),
            "a second time mirrors it back"
        );
        rig.undo();
        rig.undo();
        rig.drain();
        assert_eq!(rig.fingerprint(), before);
    }
}

#[test]
fn a_merge_asks_for_the_part_of_the_selected_handle_and_sorts_the_picked_places() {
    let mut rig = Rig::open(bowl());
    rig.paint_handle();
    rig.drain();
    let why = rig.editor.unavailable_because(&Command::Merge).unwrap_or_default();
    assert!(why.contains("holds no whole part"), "{why}");

    let mut rig = appended();
    let count = used(bowl()).positions.len();
    let part: Vec<SurfaceVertex> = (count as u32..2 * count as u32).map(SurfaceVertex).collect();
    let settings = MergeSettings {
        reach: 7.0,
        placement: Placement::Fitted,
        ..MergeSettings::default()
    };
    rig.command(Command::SetMerge(settings));
    let settings = rig.editor.view().merge.clone();
    assert_eq!(
        (settings.reach, settings.placement),
        (*REACH_RANGE.end(), Placement::Fitted)
    );
    rig.command(Command::Merge);
    let asked = |rig: &mut Rig| {
        let request = rig.editor.take_stitch().unwrap();
        rig.send(Event::Stitched(Err("not now".to_owned())));
        match request.change {
            MeshChange::Merge(change) => change,
            other => panic!("{other:?}"),
        }
    };
    let change = asked(&mut rig);
    assert_eq!(
        (change.part, change.pairs, change.settings),
        (part.clone(), Vec::new(), settings.clone())
    );

    let rims = rig.model.topology.boundary_loops();
    let model = Arc::clone(&rig.model);
    let px = |rig: &Rig, vertex: SurfaceVertex| {
        let position = model.surface.positions[vertex.index()];
        rig.editor.view().camera.project(position, VIEWPORT_PX).unwrap()
    };
    rig.command(Command::FrameAll);
    let of_part = |held: bool| rims.iter().find(|rim| part.contains(&rim[0]) == held).unwrap()[0];
    for order in [[true, false], [false, true]] {
        rig.command(Command::MergePairs);
        for held in order {
            let at = px(&rig, of_part(held));
            rig.press(at);
            rig.release(at);
        }
        assert!(rig.editor.take_stitch().is_none(), "more pairs may follow");
        rig.key(Key::Enter);
        let change = asked(&mut rig);
        rig.key(Key::Escape);
        let [[a, b]] = change.pairs[..] else {
            panic!("{:?}", change.pairs)
        };
        assert!(!part.contains(&a) && part.contains(&b), "A comes first");
    }
    // Several pairs, of which Undo takes places back one by one.
    let places = |held: bool, place: usize| {
        let rim = rims.iter().find(|rim| part.contains(&rim[0]) == held).unwrap();
        rim[place * rim.len() / 3]
    };
    let steps = rig.editor.view().undo.map(str::to_owned);
    rig.command(Command::MergePairs);
    let click = |rig: &mut Rig, vertex: SurfaceVertex| {
        let at = px(rig, vertex);
        rig.press(at);
        rig.release(at);
    };
    let numbers = |rig: &Rig| {
        rig.editor
            .view()
            .pair_numbers
            .iter()
            .map(|number| number.text.clone())
            .collect::<String>()
    };
    click(&mut rig, places(false, 0));
    click(&mut rig, places(true, 0));
    click(&mut rig, places(true, 1));
    assert_eq!(numbers(&rig), "112");
    for left in ["11", "1", "", "1", "11"] {
        match left {
            "1" if numbers(&rig).is_empty() => click(&mut rig, places(false, 0)),
            "11" if numbers(&rig) == "1" => click(&mut rig, places(true, 0)),
            _ => rig.command(Command::Undo),
        }
        assert_eq!(numbers(&rig), left);
    }
    click(&mut rig, places(false, 2));
    click(&mut rig, places(true, 2));
    assert_eq!(
        rig.editor.view().undo.map(str::to_owned),
        steps,
        "the document's steps are left alone"
    );
    rig.key(Key::Enter);
    let change = asked(&mut rig);
    assert_eq!(change.pairs.len(), 2);
    assert!(
        change.pairs.iter().all(|[a, b]| !part.contains(a) && part.contains(b)),
        "A comes first"
    );
    assert_eq!(numbers(&rig), "1122", "a refused merge leaves the places");
    rig.key(Key::Escape);
    assert!(rig.editor.view().wants_rim.is_none() && numbers(&rig).is_empty());
    rig.command(Command::MergePairs);
    for _ in 0..2 {
        let at = px(&rig, of_part(true));
        rig.press(at);
        rig.release(at);
    }
    assert!(rig.editor.take_stitch().is_none());
    let wanted = rig.editor.view().wants_rim;
    let still = matches!(wanted, Some(RimUse::Merge { first: Some(_) }));
    assert!(still, "only a border on the other side is the second: {wanted:?}");
}

#[test]
fn a_closed_part_that_faces_inwards_is_turned_when_it_is_appended() {
    for faces_inwards in [false, true] {
        let mut rig = Rig::open(bowl());
        rig.command(Command::ChangeMesh(MeshChange::Append("ball".to_owned())));
        let mut ball = shapes::moved(&shapes::icosphere(2), DAffine3::from_translation(DVec3::X * 3.0));
        if faces_inwards {
            ball.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        let whole = shapes::together(&[bowl(), ball]);
        answer_with(&mut rig, |_| (*weld(whole)).clone());
        let document = rig.editor.document();
        let is_held = |paint: &Paint| *paint == Paint::Handle(document.handles()[0].id);
        let held = document.paint().iter().position(is_held).unwrap() as u32;
        let part = rig.model.topology.component(SurfaceVertex(held));
        let turned: Vec<u32> = document.inside_out().iter().copied().collect();
        assert_eq!(turned, if faces_inwards { vec![part] } else { vec![] });
    }
}

/// The vertices that a cut along a line across the whole view spares, and the sentence that comes with the line.
fn spared(rig: &mut Rig) -> (Vec<SurfaceVertex>, String) {
    rig.command(Command::FrameAll);
    rig.drain();
    rig.command(Command::CutAlongLine(KeptSide::Positive));
    rig.press(DVec2::new(5.0, 290.0));
    rig.move_to(DVec2::new(790.0, 310.0));
    let said = rig.editor.view().status.clone();
    rig.release(DVec2::new(790.0, 310.0));
    let request = rig.editor.take_stitch().unwrap();
    rig.send(Event::Stitched(Err("not now".to_owned())));
    match request.change {
        MeshChange::Cut(_, _, spared) => (spared, said),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_line_cuts_the_part_of_the_selected_handle_alone_and_no_hidden_or_locked_one() {
    let mut rig = appended();
    let count = used(bowl()).positions.len() as u32;
    let [first, second] = [0..count, count..2 * count].map(|of| of.map(SurfaceVertex).collect::<Vec<_>>());
    let (whole, said) = spared(&mut rig);
    assert!(whole == first && said.contains("Only lid is cut"), "{said}");
    rig.command(Command::Deselect);
    assert!(spared(&mut rig).0.is_empty(), "without a selected part, all are cut");

    let triangles = bowl().triangles.len() as u32;
    let object = |triangles| Object {
        triangles: vec![triangles],
        ..Object::default()
    };
    let objects = vec![object(0..triangles), object(triangles..2 * triangles)];
    let two = || {
        shapes::together(&[
            used(bowl()),
            shapes::moved(&used(bowl()), DAffine3::from_translation(DVec3::X * 2.2)),
        ])
    };
    for action in [ObjectAction::Hide, ObjectAction::Lock] {
        let mut rig = Rig::open_with_objects(two(), objects.clone());
        rig.command(Command::Objects(action, vec![1]));
        rig.drain();
        assert!(spared(&mut rig).0 == second, "{action:?}");
        rig.command(Command::Objects(action, vec![0]));
        rig.drain();
        rig.command(Command::CutAlongLine(KeptSide::Positive));
        rig.press(DVec2::new(5.0, 290.0));
        rig.release(DVec2::new(790.0, 310.0));
        assert!(rig.editor.take_stitch().is_none());
        let problem = rig.editor.view().problem.unwrap_or_default().to_owned();
        assert!(problem.contains("hidden or locked"), "{action:?}: {problem}");
    }
}
