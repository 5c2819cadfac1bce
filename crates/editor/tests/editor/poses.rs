//! Laws of named poses: taking a pose restores the positions at which it was kept, each change of the list is one step,
//! and a project stores it.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Fingerprint, Rig, VIEWPORT_PX};
use glam::{DAffine3, DQuat, DVec3};
use pliant_editor::{
    Beginning, Command, Event, HandleId, HandleTransform, InlineExecutor, MeshReference, Paint, geometry_hash,
};
use pliant_mesh::shapes;

fn trs(translation: DVec3, turn_rad: f64) -> HandleTransform {
    HandleTransform::Trs {
        translation,
        rotation: DQuat::from_rotation_z(turn_rad),
        scale: DVec3::ONE,
        pivot: None,
    }
}

/// A ball with two handles.
fn ball() -> (Rig, [HandleId; 2]) {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    rig.command(Command::NewHandle);
    rig.swipe(&[CENTRE_PX + glam::DVec2::new(-110.0, 40.0)]);
    rig.drain();
    let handles = rig.editor.document().handles();
    assert_eq!(handles.len(), 2);
    let ids = [handles[0].id, handles[1].id];
    (rig, ids)
}

fn put(rig: &mut Rig, id: HandleId, transform: HandleTransform) {
    rig.command(Command::SetHandleTransform(id, transform));
    rig.drain();
}

fn affines(rig: &Rig) -> Vec<DAffine3> {
    rig.editor
        .document()
        .handles()
        .iter()
        .map(|handle| handle.affine())
        .collect()
}

fn alike(a: &[DAffine3], b: &[DAffine3]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.abs_diff_eq(*b, 1e-12))
}

/// A ball with the poses "pose 1", in which it is bent, and "pose 2", its present state, in which it is bent
/// differently.
fn posed() -> (Rig, [HandleId; 2], [Vec<DAffine3>; 2]) {
    let (mut rig, ids) = ball();
    put(&mut rig, ids[0], trs(DVec3::Z * 0.4, 0.5));
    put(&mut rig, ids[1], trs(DVec3::X * 0.1, 0.0));
    rig.command(Command::KeepPose);
    let first = affines(&rig);
    put(&mut rig, ids[0], trs(DVec3::Y * 0.2, -1.0));
    put(&mut rig, ids[1], HandleTransform::IDENTITY);
    rig.command(Command::KeepPose);
    rig.drain();
    let second = affines(&rig);
    let names: Vec<&str> = rig.editor.document().poses().iter().map(|pose| &*pose.name).collect();
    assert_eq!(names, ["pose 1", "pose 2"]);
    (rig, ids, [first, second])
}

#[test]
fn a_pose_that_is_taken_is_where_everything_stood_and_undo_gives_every_bit_back() {
    let (mut rig, _, [first, second]) = posed();
    let before = Fingerprint::of(rig.editor.document());
    rig.command(Command::TakePose(0));
    rig.drain();
    assert!(alike(&affines(&rig), &first));
    let document = rig.editor.document();
    assert!(document.is_settled() && document.is_in_pose(&document.poses()[0]));
    assert!(!document.is_in_pose(&document.poses()[1]));
    assert_eq!(rig.editor.view().undo, Some("Pose pose 1"));
    rig.undo();
    rig.drain();
    assert!(Fingerprint::of(rig.editor.document()) == before);
    assert!(alike(&affines(&rig), &second));
    // Halfway by the strength: a share of the pose is a share of each handle's displacement.
    rig.command(Command::TakePose(0));
    rig.command(Command::SetStrength(0.5));
    rig.drain();
    let handle = &rig.editor.document().handles()[0];
    assert!((handle.turn_deg.z - 0.25_f64.to_degrees()).abs() < 1e-9);
}

#[test]
fn each_change_of_the_list_is_one_step() {
    let (mut rig, ids, _) = posed();
    put(&mut rig, ids[1], trs(DVec3::X * 0.05, 0.0));
    let steps = [
        Command::KeepPose,
        Command::RenamePose(1, "smile".to_owned()),
        Command::RenewPose(0),
        Command::RemovePose(0),
    ];
    for step in steps {
        let (before, shape) = (rig.editor.document().poses().to_vec(), rig.drawn());
        rig.command(step.clone());
        rig.drain();
        let after = rig.editor.document().poses().to_vec();
        assert!(before != after, "{step:?}");
        assert!(rig.drawn() == shape, "{step:?} moves nothing");
        rig.undo();
        assert_eq!(rig.editor.document().poses(), before, "{step:?}");
        rig.redo();
        assert_eq!(rig.editor.document().poses(), after, "{step:?}");
    }
    assert!(rig.editor.unavailable_because(&Command::TakePose(5)).is_some());
    assert!(
        Rig::open(shapes::icosphere(1))
            .editor
            .unavailable_because(&Command::KeepPose)
            .is_some()
    );
}

#[test]
fn what_is_locked_pinned_or_newer_stays_and_what_is_gone_is_left_out() {
    let (mut rig, ids, [first, second]) = posed();
    rig.command(Command::ToggleHandleLocked(ids[1]));
    rig.command(Command::TakePose(0));
    rig.drain();
    let now = affines(&rig);
    assert!(alike(&now[..1], &first[..1]) && alike(&now[1..], &second[1..]));
    rig.command(Command::ToggleHandleLocked(ids[1]));
    put(&mut rig, ids[1], HandleTransform::IDENTITY);
    rig.command(Command::SelectHandle(ids[1]));
    rig.command(Command::DeleteHandle);
    rig.drain();
    rig.command(Command::TakePose(1));
    rig.drain();
    assert!(alike(&affines(&rig), &second[..1]));
}

#[test]
fn another_pivot_and_another_rest_shape_leave_a_pose_where_it_is() {
    let (mut rig, ids, [first, _]) = posed();
    rig.command(Command::SetPivot(ids[0], DVec3::new(0.3, -0.2, 0.1)));
    rig.command(Command::TakePose(0));
    rig.drain();
    assert!(alike(&affines(&rig), &first));
    // The visible positions of a handle's vertices in the pose.
    let seen = |rig: &Rig| -> Vec<DVec3> {
        let document = rig.editor.document();
        let positions = rig.model.surface.positions.iter().zip(document.from_file().iter());
        let painted = positions.zip(document.paint());
        painted
            .filter(|(_, paint)| matches!(paint, Paint::Handle(_)))
            .map(|((rest, moved), _)| *rest + *moved)
            .collect()
    };
    let wanted = seen(&rig);
    rig.command(Command::TakePose(1));
    rig.drain();
    rig.command(Command::Apply);
    rig.drain();
    assert!(
        rig.editor
            .document()
            .handles()
            .iter()
            .all(|handle| !handle.is_displaced())
    );
    rig.command(Command::TakePose(0));
    rig.drain();
    for (now, wanted) in seen(&rig).iter().zip(&wanted) {
        assert!(now.distance(*wanted) < 1e-9, "{now} {wanted}");
    }
    for _ in 0..2 {
        rig.undo();
    }
    rig.command(Command::TakePose(0));
    rig.drain();
    assert!(alike(&affines(&rig), &first));
}

#[test]
fn a_project_holds_the_poses() {
    let (mut rig, ids, _) = posed();
    rig.command(Command::SetTurn(ids[0], DVec3::Z * 400.0));
    rig.command(Command::KeepPose);
    rig.drain();
    let mesh = MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    };
    let text = rig.editor.snapshot().unwrap().project(mesh).to_json();
    let jobs = InlineExecutor::new();
    let mut editor = pliant_editor::Editor::new(Box::new(jobs.clone()));
    editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
    editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(Beginning::parse(&text).unwrap()),
    });
    assert_eq!(editor.view().problem, None);
    assert_eq!(editor.document().poses(), rig.editor.document().poses());
}

#[test]
fn control_points_are_part_of_a_pose() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose("lattice");
    rig.command(Command::MakeControls);
    rig.drain();
    let moved = |rig: &Rig| rig.editor.document().moved_controls().map(|moved| moved.to_vec());
    rig.command(Command::SelectControls);
    rig.move_by('y', ".4");
    rig.drain();
    let up = moved(&rig);
    assert!(up.is_some());
    rig.command(Command::KeepPose);
    rig.command(Command::ResetControls);
    rig.drain();
    assert_eq!(moved(&rig), None);
    rig.command(Command::TakePose(0));
    rig.drain();
    assert_eq!(moved(&rig), up);
}
