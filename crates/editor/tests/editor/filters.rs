//! Laws of filters of handles' ways through a sequence: every frame shows a handle where the exported edit has it, also
//! with keys, changes are steps, and projects bring them back.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use pliant_editor::{Beginning, Command, FilterKind, HandleFilter, HandleId, HandlePlace, HandleTransform};
use pliant_mesh::shapes;

use crate::project::{reopened, saved};
use crate::rig::Rig;
use crate::sequences::{COUNT, deliver, follow, frame, give_frames, go_to, open};

const FILTER: HandleFilter = HandleFilter {
    span: [3, 36],
    kind: FilterKind::Exaggerate,
    width: 1.5,
    amount: 2.0,
};

/// A ball with a handle whose way is filtered, and that is lifted at frame 10.
fn filtered() -> (Rig, HandleId) {
    let mut rig = open(shapes::icosphere(2));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetFilter(id, Some(FILTER)));
    follow(&mut rig);
    (rig, id)
}

fn translation(rig: &Rig) -> DVec3 {
    rig.editor.document().handles()[0].affine().translation
}

/// The maps of the handle in some frames by the exported edit.
fn exported(rig: &Rig) -> BTreeMap<usize, glam::DAffine3> {
    let text = rig.editor.edit_file().unwrap().to_json();
    let Beginning::Edit(edit) = Beginning::parse(&text).unwrap() else {
        panic!("{text}");
    };
    let setup = edit.resolve(&rig.model).unwrap();
    let file = &rig.model.surface.positions;
    let own = &rig.editor.following().handles[0].1;
    let place = |number: usize| {
        let ways = frame(rig, number);
        let [rest, now]: [Vec<DVec3>; 2] = [
            own.iter().map(|v| file[v.index()]).collect(),
            own.iter().map(|v| file[v.index()] + ways[v.index()]).collect(),
        ];
        HandlePlace::of(&rest, &now)
    };
    let at_rest: Vec<DVec3> = own.iter().map(|v| file[v.index()]).collect();
    let at_rest = [HandlePlace::of(&at_rest, &at_rest)];
    let timeline = edit
        .sequence_timeline(&setup, &at_rest, |number, _| place(number), BTreeMap::new())
        .unwrap();
    let map = |number: usize| Some((number, timeline.maps_at(number, &[place(number)])?[0]));
    (0..COUNT).filter_map(map).collect()
}

#[test]
fn every_frame_shows_the_handle_where_the_exported_edit_has_it() {
    let (mut rig, id) = filtered();
    go_to(&mut rig, 10);
    let shift = translation(&rig);
    assert!(shift.length() > 1e-4, "{shift}");
    let lifted = HandleTransform::Trs {
        translation: shift + DVec3::Y * 0.3,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    rig.command(Command::SetHandleTransform(id, lifted));
    rig.command(Command::KeyHere);
    deliver(&mut rig);
    assert!(
        translation(&rig).distance(shift + DVec3::Y * 0.3) < 1e-12,
        "the key has no share of the filter"
    );
    let maps = exported(&rig);
    for number in [0, 2, 3, 5, 10, 14, 25, 36, 37] {
        go_to(&mut rig, number);
        let map = maps.get(&number).copied().unwrap_or_default();
        let found = rig.editor.document().handles()[0].affine();
        assert!(found.abs_diff_eq(map, 1e-12), "frame {number}: {found} {map}");
        assert!(rig.editor.document().is_settled());
    }
    assert!(maps.len() > 20);
}

#[test]
fn a_filter_is_a_step_and_waits_for_the_frames() {
    let (mut rig, id) = filtered();
    go_to(&mut rig, 12);
    let shift = translation(&rig);
    let half = HandleFilter { amount: 1.0, ..FILTER };
    rig.command(Command::SetFilter(id, Some(half)));
    deliver(&mut rig);
    assert!((2.0 * translation(&rig)).distance(shift) < 1e-12, "it is live");
    rig.undo();
    rig.drain();
    assert_eq!(translation(&rig), shift);
    rig.command(Command::SetFilter(id, None));
    deliver(&mut rig);
    assert_eq!(translation(&rig), DVec3::ZERO);
    rig.undo();
    let wide = HandleFilter { width: 1e9, ..FILTER };
    rig.command(Command::SetFilter(id, Some(wide)));
    assert_eq!(rig.editor.document().animation().filters()[&id], FILTER);
    // A project has it, and shows no frame before the handles were followed.
    let text = saved(&rig);
    let mut again = reopened(&rig, &text);
    assert_eq!(
        again.editor.document().animation().filters(),
        rig.editor.document().animation().filters()
    );
    give_frames(&mut again);
    assert_ne!(again.editor.document().animation().frame(), 12);
    follow(&mut again);
    assert_eq!(again.editor.document().animation().frame(), 12);
    assert!(translation(&again).distance(shift) < 1e-12);
}
