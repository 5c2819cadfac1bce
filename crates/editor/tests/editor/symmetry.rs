//! Laws of symmetry: paint and poses on one side are repeated on the other, as one step; a handle on one side has a
//! twin on the other, and one on both sides of the plane is one handle.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use std::collections::BTreeSet;

use crate::rig::{Fingerprint, Rig, VIEWPORT_PX};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use pliant_deform::Role;
use pliant_editor::{Command, HandleTransform, Key, NamedView, Paint, Reach, StiffnessBrush, Symmetry, ToolMode};
use pliant_mesh::{Drawn, shapes};

/// A body that is symmetric across x = 0 alone, seen from the front, with its arms left and right.
fn body() -> Drawn {
    let mut drawn = shapes::icosphere(4);
    for p in &mut drawn.positions {
        let side = DVec3::new(p.x.abs(), p.y, p.z);
        let arms = 1.2 * (-10.0 * side.distance_squared(DVec3::new(0.95, 0.25, 0.1))).exp();
        *p = DVec3::new(p.x * (0.8 + arms), 1.5 * p.y + 0.2 * p.z, p.z * (0.7 + 0.1 * p.y));
    }
    drawn
}

fn opened(drawn: Drawn, symmetry: Symmetry) -> Rig {
    let mut rig = Rig::open(drawn);
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::SetSymmetry(symmetry));
    rig.drain();
    assert_eq!(rig.editor.view().symmetry, symmetry);
    rig
}

/// The vertices with this paint.
fn painted(rig: &Rig, paint: Paint) -> Vec<DVec3> {
    let all = rig.editor.document().paint().iter().zip(&rig.model.surface.positions);
    all.filter(|(own, _)| **own == paint).map(|(_, p)| *p).collect()
}

fn rounded(points: impl IntoIterator<Item = DVec3>) -> BTreeSet<[i64; 3]> {
    let round = |p: DVec3| (p * 1e6).round().to_array().map(|c| c as i64);
    points.into_iter().map(round).collect()
}

const MIRRORED: DVec3 = DVec3::new(-1.0, 1.0, 1.0);

/// A place on the body's right side, and one on its middle.
const SIDE_PX: DVec2 = DVec2::new(520.0, 300.0);

#[test]
fn a_stroke_paints_the_mirror_image_too_in_one_step() {
    for symmetry in [Symmetry::Found, Symmetry::Axis(0)] {
        for mode in [ToolMode::PaintFree, ToolMode::PaintFixed] {
            let mut rig = opened(body(), symmetry);
            let before = Fingerprint::of(rig.editor.document());
            rig.command(Command::SetTool(mode));
            rig.swipe(&[SIDE_PX, SIDE_PX + DVec2::new(20.0, 30.0)]);
            rig.drain();
            let paint = if mode == ToolMode::PaintFree {
                Paint::Free
            } else {
                Paint::Fixed
            };
            let all = painted(&rig, paint);
            assert!(
                all.iter().any(|p| p.x > 0.2) && all.iter().any(|p| p.x < -0.2),
                "{}",
                all.len()
            );
            assert_eq!(rounded(all.iter().map(|p| *p * MIRRORED)), rounded(all.iter().copied()));
            rig.command(Command::Undo);
            rig.drain();
            assert_eq!(Fingerprint::of(rig.editor.document()), before);
        }
    }
}

/// The vertices that are free to bend.
fn free(rig: &Rig) -> Vec<DVec3> {
    let all = rig.editor.roles().iter().zip(&rig.model.surface.positions);
    all.filter(|(role, _)| **role == Role::Free).map(|(_, p)| *p).collect()
}

#[test]
fn stiffness_is_painted_on_both_sides_alike() {
    let mut rig = opened(body(), Symmetry::Found);
    rig.command(Command::SetTool(ToolMode::PaintStiffness));
    rig.command(Command::SetStiffnessBrush(StiffnessBrush::default()));
    rig.swipe(&[SIDE_PX, SIDE_PX + DVec2::new(10.0, 10.0)]);
    rig.drain();
    let field = rig.editor.document().stiffness().unwrap();
    let positions = &rig.model.surface.positions;
    let key = |p: DVec3| (p * 1e6).round().to_array().map(|c| c as i64);
    let of: std::collections::BTreeMap<_, f64> = positions.iter().zip(field).map(|(p, s)| (key(*p), *s)).collect();
    assert!(of.values().any(|stiffness| *stiffness > 5.0));
    for (p, stiffness) in positions.iter().zip(field) {
        assert_eq!(of[&key(*p * MIRRORED)], *stiffness, "{p}");
    }
}

#[test]
fn a_handle_on_one_side_has_a_twin_on_the_other_that_moves_in_a_mirror() {
    let mut rig = opened(body(), Symmetry::Found);
    rig.swipe(&[SIDE_PX, SIDE_PX + DVec2::new(10.0, 0.0)]);
    rig.drain();
    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 2);
    let [first, second] = [&handles[0], &handles[1]];
    assert_eq!(first.twin.unwrap().handle, second.id);
    assert_eq!(second.twin.unwrap().handle, first.id);
    let [own, other] = [first, second].map(|handle| painted(&rig, Paint::Handle(handle.id)));
    assert_eq!(
        rounded(own.iter().map(|p| *p * MIRRORED)),
        rounded(other.iter().copied())
    );
    assert_eq!(rig.editor.view().selected, Some(first.id));

    let free = free(&rig);
    assert!(!free.is_empty());
    assert_eq!(
        rounded(free.iter().map(|p| *p * MIRRORED)),
        rounded(free.iter().copied())
    );

    let transform = HandleTransform::Trs {
        translation: DVec3::new(0.2, 0.3, -0.1),
        rotation: DQuat::from_rotation_z(0.8),
        scale: DVec3::ONE,
        pivot: None,
    };
    // In the short region of this feature the method stops where its steps are small, less alike on both sides than in
    // this longer one.
    for id in [first.id, second.id] {
        rig.command(Command::SetReach(id, Reach::Radii(3.0)));
    }
    rig.command(Command::SetHandleTransform(first.id, transform));
    rig.drain();
    let positions = &rig.model.surface.positions;
    let displacements = rig.editor.document().from_rest();
    let key = |p: DVec3| (p * 1e6).round().to_array().map(|c| c as i64);
    let of: std::collections::BTreeMap<_, DVec3> = positions
        .iter()
        .zip(displacements)
        .map(|(p, d)| (key(*p), *d))
        .collect();
    let furthest = displacements.iter().map(|d| d.length()).fold(0.0, f64::max);
    assert!(furthest > 0.2);
    for (p, d) in positions.iter().zip(displacements) {
        assert!(of[&key(*p * MIRRORED)].distance(*d * MIRRORED) < 1e-5 * furthest, "{p}");
    }
}

#[test]
fn a_handle_across_the_plane_is_one_handle_wherever_the_stroke_begins() {
    // Down the middle, and from one side over it.
    for way in [[[0.0, 0.1], [0.0, 0.3]], [[0.4, 0.2], [-0.4, 0.2]]] {
        let mut rig = opened(body(), Symmetry::Found);
        let camera = *rig.editor.view().camera;
        let seen_px = |[x, y]: [f64; 2]| camera.project(DVec3::new(x, y, 0.7), VIEWPORT_PX).unwrap();
        rig.swipe(&way.map(seen_px));
        rig.drain();
        let handles = rig.editor.document().handles().to_vec();
        let counts = handles.iter().map(|h| painted(&rig, Paint::Handle(h.id)).len());
        assert_eq!(handles.len(), 1, "{way:?} {:?}", counts.collect::<Vec<_>>());
        assert_eq!(handles[0].twin, None);
        let own = painted(&rig, Paint::Handle(handles[0].id));
        assert_eq!(rounded(own.iter().map(|p| *p * MIRRORED)), rounded(own.iter().copied()));
    }
}

#[test]
fn a_part_that_the_other_side_lacks_gets_no_twin_and_a_sentence_says_so() {
    // A ball beside the body, on its right side alone.
    let ball = DAffine3::from_scale_rotation_translation(DVec3::splat(0.3), DQuat::IDENTITY, DVec3::new(2.6, 0.0, 0.0));
    let mut rig = opened(
        shapes::together(&[body(), shapes::moved(&shapes::icosphere(3), ball)]),
        Symmetry::Found,
    );
    let camera = *rig.editor.view().camera;
    let ball_px = camera.project(DVec3::new(2.6, 0.0, 0.3), VIEWPORT_PX).unwrap();
    rig.swipe(&[ball_px, ball_px + DVec2::new(4.0, 2.0)]);
    rig.drain();
    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 1);
    assert_eq!(handles[0].twin, None);
    assert!(painted(&rig, Paint::Handle(handles[0].id)).iter().all(|p| p.x > 2.0));
    assert!(rig.editor.view().problem.unwrap().contains("no part like this one"));
}

#[test]
fn an_aborted_stroke_leaves_nothing_on_either_side() {
    let mut rig = opened(body(), Symmetry::Found);
    let before = Fingerprint::of(rig.editor.document());
    rig.press(SIDE_PX);
    rig.move_to(SIDE_PX + DVec2::new(10.0, 0.0));
    rig.key(Key::Escape);
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
}

#[test]
fn the_plane_of_a_scan_that_stands_askew_is_found_and_twins_across_it_are_saved() {
    let motion = DAffine3::from_rotation_translation(
        DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.4, -0.2),
        DVec3::new(5.0, -1.0, 2.0),
    );
    let mut rig = opened(shapes::moved(&body(), motion), Symmetry::Found);
    rig.swipe(&[SIDE_PX, SIDE_PX + DVec2::new(8.0, 0.0)]);
    rig.drain();
    let handles = rig.editor.document().handles().to_vec();
    assert_eq!(handles.len(), 2);
    let plane = handles[0].twin.unwrap().plane;
    assert!(plane.normal().dot(motion.transform_vector3(DVec3::X)).abs() > 1.0 - 1e-6);
    let project = rig.editor.snapshot().unwrap().project(pliant_editor::MeshReference {
        path: None,
        name: None,
        geometry: pliant_editor::geometry_hash(&rig.model),
    });
    let (again, text) = (
        pliant_editor::Project::parse(&project.to_json()).unwrap(),
        project.to_json(),
    );
    assert_eq!(again.to_json(), text);

    // A different scale along each axis is no such scale in an oblique plane: the twin gets a matrix.
    let stretched = HandleTransform::Trs {
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: DVec3::new(1.0, 1.4, 1.0),
        pivot: None,
    };
    rig.command(Command::SetHandleTransform(handles[0].id, stretched));
    rig.drain();
    let [first, second] = [0, 1].map(|place| rig.editor.document().handles()[place].clone());
    let point = DVec3::new(0.3, -0.2, 0.9);
    let other = second.affine().transform_point3(plane.mirrored(point));
    assert!(other.distance(plane.mirrored(first.affine().transform_point3(point))) < 1e-12);
}

#[test]
fn a_shape_without_a_plane_says_so_and_paints_one_side() {
    let mut drawn = shapes::tube(12, 200, 1.0);
    let low = drawn.positions.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let high = drawn.positions.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    for p in &mut drawn.positions {
        let angle = 8.0 * (p.z - low) / (high - low);
        let (sin, cos) = angle.sin_cos();
        *p = DVec3::new(
            cos * (1.0 + 0.1 * p.x),
            sin * (1.0 + 0.1 * p.x),
            0.3 * angle + 0.1 * p.y,
        );
    }
    let mut rig = Rig::open(drawn);
    rig.command(Command::SetSymmetry(Symmetry::Found));
    rig.drain();
    assert_eq!(rig.editor.view().symmetry, Symmetry::None);
    assert!(rig.editor.view().problem.unwrap().contains("no plane of symmetry"));
}

#[test]
fn another_file_begins_without_symmetry() {
    let mut rig = opened(body(), Symmetry::Found);
    rig.send(pliant_editor::Event::Opened {
        model: std::sync::Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: None,
    });
    rig.drain();
    assert_eq!(rig.editor.view().symmetry, Symmetry::None);
}
