//! Laws of the strength: a share of an edit is a pose at which a drag could have stopped, the whole edit is restored to
//! the bit, and the next move continues from the visible shape.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use crate::rig::{Fingerprint, ITERATED, Rig, VIEWPORT_PX};
use glam::{DQuat, DVec3};
use pliant_editor::{
    Beginning, Command, EditFile, Event, HandleId, HandleTransform, InlineExecutor, Key, MeshReference, Paint, Project,
    Setup, geometry_hash,
};
use pliant_mesh::shapes;

fn turned_and_moved() -> HandleTransform {
    HandleTransform::Trs {
        translation: DVec3::new(0.1, 0.0, 0.4),
        rotation: DQuat::from_rotation_z(1.5),
        scale: DVec3::new(1.0, 1.5, 2.0),
        pivot: None,
    }
}

/// A ball with a moved handle.
fn bent(method: &str) -> (Rig, HandleId) {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose(method);
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetHandleTransform(id, turned_and_moved()));
    rig.drain();
    (rig, id)
}

fn shown(rig: &mut Rig, strength: f64) -> Vec<DVec3> {
    rig.command(Command::SetStrength(strength));
    rig.drain();
    assert_eq!(rig.editor.document().strength(), strength);
    assert!(rig.editor.document().is_settled());
    rig.editor.document().from_rest().to_vec()
}

fn largest(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

fn project(rig: &Rig) -> String {
    let mesh = MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    };
    rig.editor.snapshot().unwrap().project(mesh).to_json()
}

fn reopened(rig: &Rig, beginning: Beginning) -> Rig {
    let jobs = InlineExecutor::new();
    let mut editor = pliant_editor::Editor::new(Box::new(jobs.clone()));
    editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
    editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(beginning),
    });
    let mut again = Rig::of(editor, jobs, Arc::clone(&rig.model));
    assert_eq!(again.editor.view().problem, None);
    again.drain();
    again
}

#[test]
fn none_of_an_edit_is_the_rest_shape_and_all_of_it_comes_back() {
    for (method, tolerance) in [("bilaplacian", 1e-9), ("arap", ITERATED), ("shells", ITERATED)] {
        let (mut rig, _) = bent(method);
        let whole = rig.editor.document().from_rest().to_vec();
        let handles = rig.editor.document().handles().to_vec();
        assert!(shown(&mut rig, 0.0).iter().all(|d| *d == DVec3::ZERO), "{method}");
        assert!(!rig.editor.document().is_displaced(), "{method}");
        shown(&mut rig, 0.3);
        let again = shown(&mut rig, 1.0);
        assert!(largest(&whole, &again) < tolerance, "{method}");
        assert_eq!(rig.editor.document().handles(), handles, "{method}");
    }
}

#[test]
fn a_share_is_the_frame_that_a_replay_passes_there() {
    let (mut rig, _) = bent("bilaplacian");
    let edit = rig.editor.edit_file().unwrap();
    let setup = edit.resolve(&rig.model).unwrap();
    for strength in [0.25, 0.5, 0.8] {
        shown(&mut rig, strength);
        let passed = setup.targets(strength)[0];
        let handle = &rig.editor.document().handles()[0];
        assert!(handle.affine().abs_diff_eq(passed, 1e-12), "{strength}");
    }
}

#[test]
fn half_of_a_turn_is_half_the_angle_and_nothing_shrinks() {
    let (mut rig, id) = bent("bilaplacian");
    let turn = HandleTransform::Trs {
        translation: DVec3::ZERO,
        rotation: DQuat::from_rotation_z(2.0),
        scale: DVec3::ONE,
        pivot: None,
    };
    rig.command(Command::SetHandleTransform(id, turn));
    rig.drain();
    let displacements = shown(&mut rig, 0.5);
    let document = rig.editor.document();
    let (pivot, half) = (document.handles()[0].pivot, DQuat::from_rotation_z(1.0));
    for (vertex, paint) in document.paint().iter().enumerate() {
        if *paint == Paint::Handle(id) {
            let rest = rig.model.surface.positions[vertex];
            let turned = pivot + half * (rest - pivot);
            assert!((rest + displacements[vertex]).distance(turned) < 1e-9);
        }
    }
}

#[test]
fn a_turn_beyond_half_a_turn_goes_back_the_way_it_came() {
    let (mut rig, id) = bent("arap");
    rig.command(Command::SetHandleTransform(id, HandleTransform::IDENTITY));
    rig.command(Command::SetTurn(id, DVec3::new(0.0, 0.0, 270.0)));
    rig.drain();
    shown(&mut rig, 1.0 / 3.0);
    let handle = &rig.editor.document().handles()[0];
    assert!(handle.turn_deg.distance(DVec3::Z * 90.0) < 1e-6, "{}", handle.turn_deg);
    // An edit counts no full turns: it has the shown ones.
    let edit = rig.editor.edit_file().unwrap();
    assert_eq!(edit.strength, 1.0);
    let resolved = edit.resolve(&rig.model).unwrap().targets(1.0)[0];
    assert!(resolved.abs_diff_eq(handle.affine(), 1e-9));
    // A project counts them.
    let mut again = reopened(&rig, Beginning::parse(&project(&rig)).unwrap());
    shown(&mut again, 1.0);
    assert_eq!(again.editor.document().handles()[0].turn_deg, DVec3::Z * 270.0);
}

#[test]
fn a_slide_is_one_step_and_undo_gives_every_bit_back() {
    let (mut rig, _) = bent("arap");
    let before = Fingerprint::of(rig.editor.document());
    for percent in [90, 70, 40] {
        rig.send(Event::Adjust(Command::SetStrength(f64::from(percent) / 100.0)));
        rig.drain();
    }
    rig.send(Event::Adjusted);
    rig.drain();
    let after = Fingerprint::of(rig.editor.document());
    assert_eq!(rig.editor.view().undo, Some("Change strength"));
    rig.undo();
    rig.drain();
    assert!(Fingerprint::of(rig.editor.document()) == before);
    assert_eq!(rig.editor.document().strength(), 1.0);
    rig.redo();
    rig.drain();
    assert!(Fingerprint::of(rig.editor.document()) == after);
    assert_eq!(rig.editor.document().strength(), 0.4);
}

#[test]
fn what_is_moved_next_goes_on_from_what_is_seen() {
    let (mut rig, id) = bent("bilaplacian");
    shown(&mut rig, 0.5);
    let seen = rig.editor.document().handles()[0].affine();
    let before = Fingerprint::of(rig.editor.document());
    rig.command(Command::SelectHandle(id));
    rig.move_by('x', ".25");
    rig.drain();
    let document = rig.editor.document();
    assert_eq!(document.strength(), 1.0, "what is seen is the whole now");
    let moved = document.handles()[0].affine();
    assert!(moved.matrix3.abs_diff_eq(seen.matrix3, 1e-12));
    assert!((moved.translation - seen.translation).distance(DVec3::X * 0.25) < 1e-12);
    rig.undo();
    rig.drain();
    assert!(Fingerprint::of(rig.editor.document()) == before);
    assert_eq!(rig.editor.document().strength(), 0.5);
    // An aborted drag does not change the strength, nor do strokes and names.
    rig.type_keys("gx.5");
    rig.key(Key::Escape);
    rig.command(Command::RenameHandle(id, "arm".to_owned()));
    assert_eq!(rig.editor.document().strength(), 0.5);
    let whole = Beginning::from(rig.editor.edit_file().unwrap())
        .resolve(&rig.model)
        .unwrap();
    shown(&mut rig, 1.0);
    assert!(
        rig.editor.document().handles()[0]
            .affine()
            .abs_diff_eq(turned(&rig, id), 1e-12)
    );
    assert!(whole.targets(1.0)[0].abs_diff_eq(seen, 1e-12));
}

fn turned(rig: &Rig, id: HandleId) -> glam::DAffine3 {
    turned_and_moved().affine(rig.editor.document().handle(id).unwrap().pivot)
}

#[test]
fn a_project_and_an_edit_hold_the_strength_and_what_it_is_of() {
    let (mut rig, id) = bent("bilaplacian");
    shown(&mut rig, 0.25);
    let shape = rig.editor.document().from_rest().to_vec();
    let edit = rig.editor.edit_file().unwrap();
    assert_eq!(edit.strength, 0.25);
    let text = project(&rig);
    for beginning in [
        Beginning::parse(&text).unwrap(),
        Beginning::parse(&edit.to_json()).unwrap(),
    ] {
        let Setup { handles, .. } = beginning.resolve(&rig.model).unwrap();
        let seen = rig.editor.document().handles()[0].affine();
        assert!(handles[0].transform.affine(handles[0].pivot).abs_diff_eq(seen, 1e-12));
        let mut again = reopened(&rig, beginning);
        assert_eq!(again.editor.document().strength(), 0.25);
        assert!(largest(&shape, again.editor.document().from_rest()) < 1e-9);
        shown(&mut again, 1.0);
        let handle = again.editor.document().handle(id).unwrap();
        assert!(handle.affine().abs_diff_eq(turned(&rig, id), 1e-12));
    }
    assert_eq!(project(&reopened(&rig, Beginning::parse(&text).unwrap())), text);
    shown(&mut rig, 0.0);
    assert!(rig.editor.edit_file().unwrap().changes_nothing());
    assert!(Beginning::from(Project::parse(&project(&rig)).unwrap()).changes_nothing());
}

#[test]
fn a_strength_that_can_not_be_is_refused_by_its_name() {
    for strength in ["-0.1", "1.5", "\"half\""] {
        let text = format!(r#"{{"version": 1, "method": {{"name": "arap"}}, "strength": {strength}}}"#);
        let said = EditFile::parse(&text).unwrap_err().to_string();
        assert!(said.contains("strength"), "{said}");
    }
    let (mut rig, _) = bent("bilaplacian");
    for strength in [f64::NAN, 1.1, -0.1] {
        rig.command(Command::SetStrength(strength));
        assert!(rig.editor.view().problem.is_some(), "{strength}");
        assert_eq!(rig.editor.document().strength(), 1.0);
    }
    let fresh = Rig::open(shapes::icosphere(2));
    assert!(fresh.editor.unavailable_because(&Command::SetStrength(0.5)).is_some());
}

#[test]
fn control_points_and_weights_go_along() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose("lattice");
    rig.command(Command::MakeControls);
    rig.drain();
    rig.command(Command::SelectControls);
    rig.move_by('y', ".4");
    rig.drain();
    let moved = |rig: &Rig| rig.editor.document().moved_controls().map(|moved| moved.to_vec());
    let whole = moved(&rig).expect("points that were moved");
    let (method, own) = (
        rig.editor.document().method().clone(),
        rig.editor.document().attachment().unwrap().1.clone(),
    );
    let rest = method.control_rest(&own);
    shown(&mut rig, 0.5);
    let half = moved(&rig).unwrap();
    for ((half, whole), rest) in half.iter().zip(&whole).zip(&rest) {
        assert!(half.distance(rest.midpoint(*whole)) < 1e-12);
    }
    shown(&mut rig, 0.0);
    assert_eq!(moved(&rig), None);
    shown(&mut rig, 1.0);
    assert_eq!(moved(&rig), Some(whole));
}
