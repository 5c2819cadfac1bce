//! Laws of footprints of handles of a sequence: a held handle rests to the bit of its footprint's middle frame, on a bent
//! path, too; nothing else moves it, changes are steps, and edits and projects have them.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use glam::DVec3;
use pliant_editor::{Beginning, Command, FilterKind, GroundAxis, HandleFilter, HandleFootprints, HandleId, middle_of};
use pliant_mesh::shapes;

use crate::project::{reopened, saved};
use crate::rig::Rig;
use crate::sequences::{COUNT, deliver, follow, frame, give_frames, go_to, open, shape};

/// All frames are one footprint.
const ALL: HandleFootprints = HandleFootprints {
    up: GroundAxis::Y,
    height: 10.0,
    speed: 10.0,
    fade: 4,
};

/// Its middle frame.
const MIDDLE: usize = (COUNT - 1) / 2;

fn held() -> (Rig, HandleId) {
    let mut rig = open(shapes::icosphere(2));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetFootprints(id, Some(ALL)));
    follow(&mut rig);
    (rig, id)
}

/// The largest distance of the shown handle from its places in the middle frame, both carried along the path.
fn away(rig: &Rig, number: usize) -> f64 {
    let path = rig.editor.document().animation().path().cloned();
    let (here, there) = match path {
        None => (rig.editor.view().body_motion, None),
        Some(_) => {
            let text = rig.editor.edit_file().unwrap().to_json();
            let Beginning::Edit(edit) = Beginning::parse(&text).unwrap() else {
                panic!("{text}");
            };
            let trajectory: Vec<DVec3> = (0..COUNT).map(|number| middle_of(&shape(rig, number))).collect();
            let motions = edit.body_motions(&trajectory);
            (motions[number], Some(motions[MIDDLE]))
        }
    };
    let (middle, file) = (shape(rig, MIDDLE), &rig.model.surface.positions);
    let shown = rig.editor.document().from_file();
    let vertices = &rig.editor.following().handles[0].1;
    let distance = |vertex: &pliant_mesh::SurfaceVertex| {
        let v = vertex.index();
        let (meant, found) = (middle[v], file[v] + shown[v]);
        there
            .map_or(meant, |there| there.moved(meant))
            .distance(here.moved(found))
    };
    vertices.iter().map(distance).fold(0.0, f64::max)
}

#[test]
fn a_held_handle_rests_in_all_frames_on_a_bent_path_too() {
    let (mut rig, id) = held();
    assert_eq!(rig.editor.footprints_of(id), Some(1));
    for number in [0, 5, MIDDLE, 30, COUNT - 1] {
        go_to(&mut rig, number);
        assert!(rig.editor.document().is_settled());
        assert!(away(&rig, number) < 1e-9, "{number}: {}", away(&rig, number));
        let own = shape(&rig, number);
        let far = rig
            .editor
            .document()
            .from_file()
            .iter()
            .zip(&own)
            .zip(&rig.model.surface.positions);
        let bent = far
            .map(|((way, own), file)| (*file + *way).distance(*own))
            .fold(0.0, f64::max);
        assert_eq!(bent > 1e-3, number != MIDDLE, "{number}: {bent}");
    }
    // While the path is bent at a held frame, its footprint is known: no frame is read again.
    go_to(&mut rig, 25);
    rig.command(Command::BendPath(20, DVec3::new(0.3, 0.0, 0.5)));
    assert_eq!(rig.editor.view().wanted_frame, None);
    rig.drain();
    assert!(away(&rig, 25) < 1e-9, "{}", away(&rig, 25));
    for number in [3, 25, COUNT - 1] {
        go_to(&mut rig, number);
        assert!(away(&rig, number) < 1e-9, "{number}: {}", away(&rig, number));
    }
}

#[test]
fn nothing_else_moves_a_held_handle_and_edits_and_projects_have_its_footprints() {
    let (mut rig, id) = held();
    go_to(&mut rig, 5);
    let shown = rig.editor.document().from_file().clone();
    rig.command(Command::KeyHere);
    deliver(&mut rig);
    assert!(rig.editor.document().animation().keys().is_empty());
    let filter = HandleFilter {
        span: [0, 9],
        kind: FilterKind::Smooth,
        width: 2.0,
        amount: 1.0,
    };
    assert!(
        rig.editor
            .unavailable_because(&Command::SetFilter(id, Some(filter)))
            .is_some()
    );
    let text = rig.editor.edit_file().unwrap().to_json();
    let Beginning::Edit(edit) = Beginning::parse(&text).unwrap() else {
        panic!("{text}");
    };
    assert_eq!(edit.footprints_of_handles().unwrap()[0].1.footprints(), ALL);
    let never = HandleFootprints { speed: 1e-9, ..ALL };
    rig.command(Command::SetFootprints(id, Some(never)));
    deliver(&mut rig);
    assert_eq!(rig.editor.footprints_of(id), Some(0));
    assert_eq!(**rig.editor.document().from_file(), *frame(&rig, 5));
    rig.undo();
    rig.drain();
    assert_eq!(*rig.editor.document().from_file(), shown);
    let mut again = reopened(&rig, &saved(&rig));
    give_frames(&mut again);
    follow(&mut again);
    assert_eq!(again.editor.document().animation(), rig.editor.document().animation());
    assert!(away(&again, 5) < 1e-9);
    rig.command(Command::SetFootprints(id, None));
    rig.command(Command::KeyHere);
    deliver(&mut rig);
    assert!(
        rig.editor
            .unavailable_because(&Command::SetFootprints(id, Some(ALL)))
            .is_some()
    );
}

#[test]
fn a_method_that_moves_handles_as_a_whole_is_refused_when_it_is_chosen() {
    let (mut rig, id) = held();
    for declaration in pliant_deform::METHODS {
        let (name, method) = (declaration.name, (declaration.first_choice)());
        let takes_places = method.takes_places();
        let why_not = rig.editor.unavailable_because(&Command::SetMethod(method.clone()));
        assert_eq!(why_not.is_none(), takes_places, "{name}: {why_not:?}");
        rig.command(Command::SetFootprints(id, None));
        rig.command(Command::SetMethod(method));
        let why_not = rig.editor.unavailable_because(&Command::SetFootprints(id, Some(ALL)));
        assert_eq!(why_not.is_none(), takes_places, "{name}: {why_not:?}");
        rig.undo();
        rig.undo();
        assert_eq!(rig.editor.document().animation().footprints()[&id], ALL);
    }
}
