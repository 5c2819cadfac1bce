//! The pose brush with *Whole limb*: one drag of a hand bends shoulder, elbow and wrist.
#![allow(clippy::unwrap_used, reason = "a test that can't go on fails")]

use std::sync::Arc;

use crate::rig::{Rig, VIEWPORT_PX};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use pliant_editor::{
    Beginning, Button, Command, Event, Handle, Key, MeshReference, Modifiers, Pointer, Symmetry, ToolMode,
    geometry_hash,
};
use pliant_mesh::{Drawn, shapes};

/// The narrow places of the arms of [`body_with_jointed_arms`].
const JOINTS: [f64; 3] = [1.6, 3.2, 4.8];

/// A ball of radius 1.4 about the origin with two arms along x, to 5.8 and -5.8, each with three joints.
fn body_with_jointed_arms() -> Drawn {
    body_with_arms(&JOINTS, 0.0)
}

/// A ball of radius 1.4 about the origin with two arms along x, to 5.8 and -5.8, which are narrow at `joints`, and at the
/// end of each arm a finger of this length.
fn body_with_arms(joints: &[f64], finger: f64) -> Drawn {
    let end = 5.8 + finger;
    let capped = |radius: f64, over: f64| radius * (1.0 - over.max(0.0).powi(2)).max(0.0).sqrt();
    let profile = |share: f64| {
        let x: f64 = end * (1.0 - 2.0 * share);
        let ball = (1.4 * 1.4 - x * x).max(0.0).sqrt();
        let narrow = joints
            .iter()
            .map(|joint| 0.16 * (-((x.abs() - joint) / 0.3).powi(2)).exp());
        let arm = capped(0.42 - narrow.sum::<f64>(), (x.abs() - 5.4) / 0.4);
        let finger = if finger > 0.0 {
            capped(0.15, (x.abs() - end + 0.15) / 0.15)
        } else {
            0.0
        };
        DVec2::new(
            if share % 1.0 == 0.0 {
                0.0
            } else {
                ball.max(arm).max(finger)
            },
            x,
        )
    };
    let along_x = DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X));
    shapes::moved(&shapes::turned(160, 24, profile), along_x)
}

fn open() -> Rig {
    pose(body_with_jointed_arms())
}

fn pose(body: Drawn) -> Rig {
    let mut rig = Rig::open(body);
    rig.command(Command::SetTool(ToolMode::Pose));
    rig.command(Command::ToggleWholeLimb);
    rig
}

/// The visible surface vertex nearest to a point, and its place on the screen.
fn seen(rig: &Rig, near: DVec3) -> (usize, DVec2) {
    let view = rig.editor.view();
    let shown: Vec<DVec3> = (rig.model.surface.positions.iter().zip(view.displacements.iter()))
        .map(|(p, d)| *p + *d)
        .collect();
    let towards_eye = -view.camera.forward();
    let facing = near + towards_eye * 0.4;
    let nearest = (0..shown.len()).min_by(|&a, &b| shown[a].distance(facing).total_cmp(&shown[b].distance(facing)));
    let vertex = nearest.unwrap();
    (vertex, view.camera.project(shown[vertex], VIEWPORT_PX).unwrap())
}

fn drag(rig: &mut Rig, from_px: DVec2, by_px: DVec2, modifiers: Modifiers) {
    let at = |position_px| Pointer { position_px, modifiers };
    rig.send(Event::PointerMoved(at(from_px)));
    rig.drain();
    rig.send(Event::PointerPressed(at(from_px), Button::Primary));
    for step in 1..=6 {
        rig.send(Event::PointerMoved(at(from_px + by_px * (f64::from(step) / 6.0))));
    }
    rig.send(Event::PointerReleased(at(from_px + by_px), Button::Primary));
    rig.drain();
}

/// The distances between the centres of handles, each the child of the one before it.
fn bones(handles: &[Handle]) -> Vec<f64> {
    let bones = handles.windows(2);
    bones.map(|pair| pair[0].centre().distance(pair[1].centre())).collect()
}

#[test]
fn one_drag_of_the_hand_bends_all_joints_and_the_hand_is_under_the_pointer() {
    let mut rig = open();
    let before = rig.fingerprint();
    let (vertex, hand_px) = seen(&rig, DVec3::new(5.3, 0.0, 0.0));
    let by_px = DVec2::new(-90.0, -70.0);
    drag(&mut rig, hand_px, by_px, Modifiers::NONE);

    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 3, "shoulder, elbow and wrist");
    for (handle, joint) in handles.iter().zip(JOINTS) {
        assert!(handle.pivot.distance(DVec3::X * joint) < 0.25, "{}", handle.pivot);
    }
    assert_eq!(handles[0].parent, None);
    assert_eq!(handles[1].parent, Some(handles[0].id));
    assert_eq!(handles[2].parent, Some(handles[1].id));
    assert!(
        handles[0].centre().distance(handles[0].pivot) < 1e-9,
        "the shoulder stays"
    );
    for (bone, at_rest) in bones(&handles).iter().zip([1.6, 1.6]) {
        assert!((bone - at_rest).abs() < 0.3, "{bone}");
    }
    let rest: Vec<f64> = handles
        .windows(2)
        .map(|pair| pair[0].pivot.distance(pair[1].pivot))
        .collect();
    for (bone, rest) in bones(&handles).iter().zip(rest) {
        assert!((bone - rest).abs() < 1e-9, "the bones keep their lengths");
    }
    let bent = handles.iter().filter(|handle| handle.turn_deg.length() > 3.0).count();
    assert!(bent >= 2, "more than one joint bends");
    let view = rig.editor.view();
    let hand = rig.model.surface.positions[vertex] + view.displacements[vertex];
    let met_px = view.camera.project(hand, VIEWPORT_PX).unwrap();
    assert!(
        met_px.distance(hand_px + by_px) < 2.0,
        "{met_px} is not {}",
        hand_px + by_px
    );
    rig.assert_as_meant("the whole limb");

    let document = rig.editor.document();
    for (p, d) in rig.model.surface.positions.iter().zip(document.from_file().iter()) {
        assert!(p.x > 0.9 || d.length() < 1e-9, "the body is held at {p}");
    }
    // The next drags continue with the same parts, however far the limb is bent.
    let mut hand = hand;
    for by_px in [
        DVec2::new(20.0, 160.0),
        DVec2::new(-110.0, 40.0),
        DVec2::new(60.0, -200.0),
    ] {
        let (vertex, hand_px) = seen(&rig, hand);
        drag(&mut rig, hand_px, by_px, Modifiers::NONE);
        let again = rig.editor.document().handles().to_vec();
        assert_eq!(again.len(), 3);
        for (one, other) in bones(&again).iter().zip(bones(&handles)) {
            assert!((one - other).abs() < 1e-9);
        }
        hand = rig.model.surface.positions[vertex] + rig.editor.document().from_file()[vertex];
    }
    for _ in 0..3 {
        rig.undo();
    }
    rig.undo();
    rig.drain();
    assert_eq!(rig.fingerprint(), before, "each drag is one step");
}

#[test]
fn a_smooth_elbow_is_a_joint_and_a_knuckle_is_none() {
    for (joints, finger) in [([1.6, 4.8].as_slice(), 0.0), (&[1.6, 4.8], 0.7), (&JOINTS, 0.7)] {
        let mut rig = pose(body_with_arms(joints, finger));
        let (_, hand_px) = seen(&rig, DVec3::new(5.4 + finger, 0.0, 0.0));
        drag(&mut rig, hand_px, DVec2::new(-60.0, -60.0), Modifiers::NONE);
        let pivots: Vec<DVec3> = rig
            .editor
            .document()
            .handles()
            .iter()
            .map(|handle| handle.pivot)
            .collect();
        assert_eq!(
            pivots.len(),
            3,
            "shoulder, elbow and wrist with a finger of {finger}: {pivots:?}"
        );
        for (pivot, (joint, most)) in pivots.iter().zip([(1.6, 0.25), (3.2, 0.5), (4.8, 0.25)]) {
            assert!(pivot.distance(DVec3::X * joint) < most, "{joint}: {pivot}");
        }
    }
}

#[test]
fn a_drag_of_the_forearm_takes_the_hand_along() {
    let mut rig = open();
    let (_, forearm_px) = seen(&rig, DVec3::new(4.0, 0.0, 0.0));
    drag(&mut rig, forearm_px, DVec2::new(-40.0, -60.0), Modifiers::NONE);
    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 2, "shoulder and elbow");
    assert_eq!(rig.editor.view().selected, Some(handles[1].id));
    assert!(
        handles[1].pivot.distance(DVec3::X * JOINTS[1]) < 0.25,
        "{}",
        handles[1].pivot
    );
    let (hand, _) = seen(&rig, handles[1].affine().transform_point3(DVec3::new(5.3, 0.0, 0.0)));
    let p = rig.model.surface.positions[hand];
    let met = p + rig.editor.document().from_file()[hand];
    assert!(p.x > 4.0 && met.distance(handles[1].affine().transform_point3(p)) < 1e-9);
}

#[test]
fn modifiers_pose_one_part_and_escape_leaves_no_trace() {
    let mut rig = open();
    let (_, hand_px) = seen(&rig, DVec3::new(5.3, 0.0, 0.0));
    drag(&mut rig, hand_px, DVec2::new(0.0, 30.0), Modifiers::CTRL);
    assert_eq!(rig.editor.document().handles().len(), 1);

    let mut rig = open();
    let before = rig.fingerprint();
    rig.move_to(hand_px);
    rig.drain();
    rig.press(hand_px);
    rig.move_to(hand_px + DVec2::new(-30.0, -50.0));
    assert_eq!(rig.editor.document().handles().len(), 3);
    rig.key(Key::Escape);
    rig.drain();
    assert_eq!(rig.fingerprint(), before);
}

#[test]
fn with_symmetry_the_other_arm_follows() {
    let mut rig = open();
    rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
    rig.drain();
    let (_, hand_px) = seen(&rig, DVec3::new(5.3, 0.0, 0.0));
    drag(&mut rig, hand_px, DVec2::new(-60.0, -60.0), Modifiers::NONE);
    let handles = rig.editor.document().handles();
    assert_eq!(handles.len(), 6);
    let mirrored = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
    let hand = handles.iter().find(|handle| handle.pivot.x > 4.0).unwrap();
    let other = handles.iter().find(|handle| handle.pivot.x < -4.0).unwrap();
    assert!(
        hand.centre().distance(mirrored(other.centre())) < 0.05,
        "{}",
        other.centre()
    );
    assert!(hand.centre().distance(hand.pivot) > 0.1);
}

#[test]
fn a_limited_joint_bends_within_its_range_on_both_sides_and_later_too() {
    let mut rig = open();
    rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
    rig.drain();
    let (_, hand_px) = seen(&rig, DVec3::new(5.3, 0.0, 0.0));
    drag(&mut rig, hand_px, DVec2::new(-10.0, -10.0), Modifiers::NONE);
    let parts = |rig: &Rig| -> Vec<Handle> {
        let handles = rig.editor.document().handles().iter();
        handles.filter(|handle| handle.pivot.x > 0.0).cloned().collect()
    };
    let elbow_bend_deg = |rig: &Rig| {
        let centres: Vec<DVec3> = parts(rig).iter().map(Handle::centre).collect();
        (centres[1] - centres[0])
            .angle_between(centres[2] - centres[1])
            .to_degrees()
    };
    assert_eq!(rig.editor.selected_bend_deg(), Some([0.0, 180.0]), "the hand");
    let shoulder = parts(&rig)[0].id;
    rig.command(Command::SelectHandle(shoulder));
    assert_eq!(
        rig.editor.selected_bend_deg(),
        None,
        "a part without a parent has no joint to limit"
    );

    let elbow = parts(&rig)[1].id;
    rig.command(Command::SelectHandle(elbow));
    let before = rig.fingerprint();
    rig.command(Command::SetBendRange([30.0, 40.0]));
    assert_eq!(rig.editor.selected_bend_deg(), Some([30.0, 40.0]));
    let limited = |rig: &Rig| {
        let handles = rig.editor.document().handles().iter();
        handles.filter(|handle| handle.bend_deg == [30.0, 40.0]).count()
    };
    assert_eq!(limited(&rig), 2, "the other arm's elbow, too");
    rig.undo();
    assert_eq!(rig.fingerprint(), before, "the limits are one step");
    rig.command(Command::Redo);
    rig.command(Command::SetBendRange([50.0, 40.0]));
    assert_eq!(limited(&rig), 2, "no range is refused");

    for by_px in [
        DVec2::new(-90.0, -70.0),
        DVec2::new(60.0, 200.0),
        DVec2::new(300.0, 0.0),
        DVec2::new(-200.0, 0.0),
    ] {
        let hand = parts(&rig)[2].affine().transform_point3(DVec3::new(5.3, 0.0, 0.0));
        let (_, hand_px) = seen(&rig, hand);
        drag(&mut rig, hand_px, by_px, Modifiers::NONE);
        let bend = elbow_bend_deg(&rig);
        assert!((30.0 - 1e-6..=40.0 + 1e-6).contains(&bend), "{by_px}: {bend}");
    }

    let mesh = MeshReference {
        name: None,
        path: Some("body.off".to_owned()),
        geometry: geometry_hash(&rig.model),
    };
    let project = rig.editor.snapshot().unwrap().project(mesh).to_json();
    let edit = rig.editor.edit_file().unwrap().to_json();
    for text in [project, edit] {
        rig.send(Event::Opened {
            model: Arc::clone(&rig.model),
            name: "a body".to_owned(),
            beginning: Some(Beginning::parse(&text).unwrap()),
        });
        rig.drain();
        assert_eq!(limited(&rig), 2, "files keep them");
    }
}

#[test]
fn an_upper_arm_beside_a_posed_elbow_means_the_shoulder() {
    let mut rig = open();
    rig.command(Command::ToggleWholeLimb);
    let (_, forearm_px) = seen(&rig, DVec3::new(4.2, 0.0, 0.0));
    drag(&mut rig, forearm_px, DVec2::new(0.0, -60.0), Modifiers::NONE);
    let elbow = rig.editor.document().handles()[0].clone();
    assert!(elbow.pivot.distance(DVec3::X * JOINTS[1]) < 0.25, "{}", elbow.pivot);
    for x in [2.2, 2.6, 2.9] {
        let (_, arm_px) = seen(&rig, DVec3::new(x, 0.0, 0.0));
        drag(&mut rig, arm_px, DVec2::new(0.0, 30.0), Modifiers::NONE);
        let handles = rig.editor.document().handles();
        let shoulder = handles.iter().find(|handle| handle.pivot.x < 2.0);
        let shoulder = shoulder.unwrap_or_else(|| panic!("a drag at {x} moves the shoulder"));
        assert!(
            shoulder.pivot.distance(DVec3::X * JOINTS[0]) < 0.25,
            "{x}: {}",
            shoulder.pivot
        );
        assert_eq!(
            rig.editor.document().handle(elbow.id).unwrap().parent,
            Some(shoulder.id)
        );
        rig.undo();
        rig.drain();
    }
    // The handle itself is taken where the pointer is on it.
    let (_, forearm_px) = seen(&rig, elbow.affine().transform_point3(DVec3::new(4.2, 0.0, 0.0)));
    drag(&mut rig, forearm_px, DVec2::new(0.0, 40.0), Modifiers::NONE);
    assert_eq!(rig.editor.document().handles().len(), 1);
}
