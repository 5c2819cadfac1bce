//! Laws of the ghosts of a sequence: they are the frames as they are shown, in the space of the shown one, they disturb
//! nothing, and a frame that can't be read has none.

use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Command, Event, HandleTransform, Skins};
use pliant_mesh::shapes;

use crate::rig::{Fingerprint, Rig};
use crate::sequences::{COUNT, follow, frame, go_to, keyed, lifted, open};

/// Reads the frames that ghosts need, and runs all jobs. Returns the frames.
fn read_ghosts(rig: &mut Rig) -> Vec<usize> {
    let mut read = Vec::new();
    while let Some(wanted) = rig.editor.view().wanted_frame {
        assert!(rig.editor.is_settled(), "nothing waits for ghosts");
        let shape = frame(rig, wanted);
        rig.send(Event::Frame(wanted, Ok(shape)));
        read.push(wanted);
    }
    rig.drain();
    read
}

/// The shown ghosts: their places and shapes.
fn ghosts(rig: &Rig) -> Vec<(i8, Arc<Vec<DVec3>>)> {
    let skins = rig.editor.view().skins.iter();
    skins.map(|skin| (skin.place, Arc::clone(&skin.from_file))).collect()
}

/// The largest distance between ghosts and shapes at the same places. Pivots ride along from frame to frame, so they
/// differ by rounding.
fn apart(a: &[(i8, Arc<Vec<DVec3>>)], b: &[(i8, Arc<Vec<DVec3>>)]) -> f64 {
    let places = |of: &[(i8, Arc<Vec<DVec3>>)]| of.iter().map(|(place, _)| *place).collect::<Vec<_>>();
    assert_eq!(places(a), places(b));
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.1.iter().zip(&*b.1));
    pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// The shapes of these frames, one after the other, in the world.
fn shown_in(rig: &mut Rig, frames: &[(i8, usize)]) -> Vec<(i8, Arc<Vec<DVec3>>)> {
    let shown = |(place, number): &(i8, usize)| {
        go_to(rig, *number);
        (*place, Arc::clone(rig.editor.document().from_file()))
    };
    frames.iter().map(shown).collect()
}

#[test]
fn ghosts_of_a_sequence_are_its_frames_with_the_edit_and_disturb_nothing() {
    let (mut rig, id) = keyed();
    let around = [(-2, 6), (-1, 10), (1, 18), (2, 22)];
    let frames = shown_in(&mut rig, &around);
    go_to(&mut rig, 14);
    let before = Fingerprint::of(rig.editor.document());
    assert_eq!(rig.editor.view().wanted_frame, None);
    rig.command(Command::ToggleSkins);
    assert_eq!(read_ghosts(&mut rig), [6, 10, 18, 22]);
    let far = apart(&ghosts(&rig), &frames);
    assert!(far < 1e-12, "{far}");
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
    // A pose that has no key yet counts as one.
    rig.command(Command::SetHandleTransform(id, lifted(-0.3)));
    rig.drain();
    assert_eq!(read_ghosts(&mut rig), Vec::<usize>::new(), "they are known");
    let posed = ghosts(&rig);
    assert!(apart(&posed, &frames) > 0.01);
    rig.command(Command::ToggleSkins);
    assert!(ghosts(&rig).is_empty());
    rig.command(Command::KeyHere);
    rig.drain();
    let far = apart(&shown_in(&mut rig, &around), &posed);
    assert!(far < 1e-12, "{far}");
    // None lies outside the sequence, and none is shown while it plays.
    rig.command(Command::ToggleSkins);
    go_to(&mut rig, COUNT - 1);
    read_ghosts(&mut rig);
    let places: Vec<i8> = ghosts(&rig).iter().map(|(place, _)| *place).collect();
    assert_eq!(places, [-2, -1]);
    rig.command(Command::PlayKeys);
    assert!(ghosts(&rig).is_empty());
}

#[test]
fn ghosts_on_a_bent_path_are_seen_from_the_shown_frame() {
    let mut rig = open(shapes::icosphere(2));
    rig.command(Command::BendPath(20, DVec3::new(0.3, 0.0, 0.8)));
    follow(&mut rig);
    let mut in_world = |number: usize| -> Vec<DVec3> {
        go_to(&mut rig, number);
        let motion = rig.editor.view().body_motion;
        assert!(motion.moves());
        let file = rig.model.surface.positions.iter();
        let places = file.zip(&**rig.editor.document().from_file());
        places.map(|(file, way)| motion.moved(*file + *way)).collect()
    };
    let meant = [11, 19].map(&mut in_world);
    go_to(&mut rig, 15);
    let motion = rig.editor.view().body_motion;
    rig.command(Command::SetSkins(Skins {
        shown: true,
        before: 1,
        after: 1,
        ..Skins::default()
    }));
    read_ghosts(&mut rig);
    let found = ghosts(&rig);
    assert_eq!(found.len(), 2);
    for ((_, ghost), meant) in found.iter().zip(&meant) {
        let file = rig.model.surface.positions.iter();
        let apart = file
            .zip(&**ghost)
            .zip(meant)
            .map(|((file, way), meant)| motion.moved(*file + *way).distance(*meant));
        assert!(apart.fold(0.0, f64::max) < 1e-12);
    }
}

#[test]
fn a_frame_that_cannot_be_read_has_no_ghost_and_is_no_problem() {
    let mut rig = open(shapes::icosphere(1));
    go_to(&mut rig, 20);
    rig.command(Command::ToggleSkins);
    while let Some(wanted) = rig.editor.view().wanted_frame {
        let shape = match wanted {
            16 => Err("walk-16.obj is gone: put it back".to_owned()),
            _ => Ok(frame(&rig, wanted)),
        };
        rig.send(Event::Frame(wanted, shape));
    }
    rig.drain();
    let places: Vec<i8> = ghosts(&rig).iter().map(|(place, _)| *place).collect();
    assert_eq!(places, [-2, 1, 2]);
    assert_eq!(rig.editor.view().problem, None);
    // The last ghosts stay while another frame is on its way.
    rig.command(Command::GoToTime(0.0));
    assert_eq!(ghosts(&rig).len(), 3);
    assert_eq!(rig.editor.view().wanted_frame, Some(0));
}

#[test]
fn a_drag_keeps_the_last_ghosts_and_its_end_brings_new_ones() {
    let (mut rig, id) = keyed();
    go_to(&mut rig, 14);
    rig.command(Command::ToggleSkins);
    read_ghosts(&mut rig);
    let before = ghosts(&rig);
    let drag = |lift: f64| Event::Adjust(Command::SetHandleTransform(id, lifted(lift)));
    for lift in [0.5, 0.7] {
        rig.send(drag(lift));
        rig.drain();
        assert!(ghosts(&rig) == before);
    }
    rig.send(Event::Adjusted);
    rig.drain();
    assert!(ghosts(&rig) != before);
    rig.command(Command::SetHandleTransform(id, HandleTransform::IDENTITY));
    rig.drain();
    assert_eq!(ghosts(&rig).len(), before.len());
}

#[test]
fn a_large_mesh_has_the_nearest_ghosts_alone() {
    assert!(Skins::most_on(100_000) >= 2 * usize::from(Skins::MOST));
    let most = [1_000_000, 4_000_000, 100_000_000].map(Skins::most_on);
    assert_eq!(most, [4, 1, 1]);
}
