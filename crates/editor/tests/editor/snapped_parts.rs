//! An appended part that is moved with Ctrl stands on the surface under the pointer.

use glam::{DVec2, DVec3};
use pliant_editor::{Button, Command, Event, Handle, Key, MeshChange, Modifiers, Pointer};
use pliant_mesh::{Bvh, SurfaceVertex};

use crate::project::{reopened, saved};
use crate::rig::new_mesh::{answer, bowl, state, used};
use crate::rig::{CENTRE_PX, Rig, VIEWPORT_PX};

const CTRL: Modifiers = Modifiers {
    ctrl: true,
    ..Modifiers::NONE
};

fn with_ctrl(position_px: DVec2) -> Pointer {
    Pointer {
        position_px,
        modifiers: CTRL,
    }
}

/// A bowl with another, smaller one appended.
fn appended() -> Rig {
    let mut rig = Rig::open(bowl());
    rig.command(Command::ChangeMesh(MeshChange::Append("horn".to_owned())));
    answer(&mut rig);
    rig.type_keys("s.2");
    rig.key(Key::Enter);
    rig.drain();
    rig
}

fn handle(rig: &Rig) -> Handle {
    rig.editor.document().handles()[0].clone()
}

/// Moves the part to these places with Ctrl, and keeps it at the last one.
fn snap(rig: &mut Rig, way_px: &[DVec2]) {
    rig.move_to(CENTRE_PX);
    rig.type_keys("g");
    for &position_px in way_px {
        rig.send(Event::PointerMoved(with_ctrl(position_px)));
        rig.drain();
    }
    let last = with_ctrl(way_px[way_px.len() - 1]);
    rig.send(Event::PointerPressed(last, Button::Primary));
    rig.send(Event::PointerReleased(last, Button::Primary));
    rig.drain();
}

/// The point and the normal of the first bowl alone under a point of the view.
fn under(rig: &Rig, position_px: DVec2) -> Option<(DVec3, DVec3)> {
    let first = used(bowl());
    let triangles: Vec<_> = first
        .triangles
        .iter()
        .map(|corners| corners.map(|corner| SurfaceVertex(corner.0)))
        .collect();
    let ray = rig.editor.view().camera.ray(position_px, VIEWPORT_PX);
    let hit = Bvh::build(&first.positions, &triangles).ray(ray.origin, ray.direction)?;
    let [a, b, c] = triangles[hit.triangle as usize].map(|corner| first.positions[corner.index()]);
    let normal = (b - a).cross(c - a).normalize();
    let facing = if normal.dot(ray.direction) > 0.0 {
        -normal
    } else {
        normal
    };
    Some((ray.origin + hit.distance * ray.direction, facing))
}

/// The part stands upright on its lowest point at a place: its pivot is above it, and nothing of it is below.
fn assert_stands(rig: &Rig, (point, normal): (DVec3, DVec3), case: &str) {
    let (own, count) = (handle(rig), used(bowl()).positions.len());
    let arm = own.centre() - point;
    assert!((arm - arm.dot(normal) * normal).length() < 1e-9, "{case}: {arm}");
    let positions = rig
        .model
        .surface
        .positions
        .iter()
        .zip(rig.editor.document().from_file().iter());
    let heights = positions
        .skip(count)
        .map(|(rest, way)| (*rest + *way - point).dot(normal));
    let lowest = heights.fold(f64::INFINITY, f64::min);
    assert!(lowest.abs() < 1e-9, "{case}: the lowest point is at {lowest}");
    let ways = &rig.editor.document().from_file()[..count];
    assert!(
        ways.iter().all(|way| *way == DVec3::ZERO),
        "{case}: the other part rests"
    );
}

#[test]
fn with_ctrl_an_appended_part_stands_on_the_surface_under_the_pointer() {
    let changes: [(&str, &[Command], &str); 3] = [
        ("as it is", &[], ""),
        ("mirrored", &[Command::MirrorPart(1), Command::MirrorPart(0)], ""),
        ("scaled", &[], "sy3"),
    ];
    for (case, commands, keys) in changes {
        let mut rig = appended();
        commands.iter().for_each(|command| rig.command(command.clone()));
        rig.drain();
        if !keys.is_empty() {
            rig.type_keys(keys);
            rig.key(Key::Enter);
            rig.drain();
        }
        let before = state(&rig);
        // The second place is covered by the part after the first one.
        let ways = [[300.0, 250.0], [304.0, 254.0], [250.0, 330.0], [330.0, 300.0]].map(DVec2::from);
        let mut stood = 0;
        for way in ways {
            let Some(place) = under(&rig, way) else { continue };
            snap(&mut rig, &[way]);
            assert_stands(&rig, place, case);
            stood += 1;
        }
        assert!(stood >= 3, "{case}: only {stood} places are on the bowl");
        let again = reopened(&rig, &saved(&rig));
        assert_eq!(handle(&again).transform, handle(&rig).transform, "{case}");
        (0..stood).for_each(|_| rig.undo());
        rig.drain();
        assert!(state(&rig) == before, "{case}: each place is a step");
        // One move over several places ends as the last alone does.
        snap(&mut rig, &ways[2..]);
        let along = handle(&rig).transform;
        rig.undo();
        rig.drain();
        snap(&mut rig, &ways[3..]);
        assert_eq!(handle(&rig).transform, along, "{case}");
    }
}

#[test]
fn beside_the_surface_and_along_an_axis_ctrl_only_rounds_the_move() {
    let mut rig = appended();
    let turned = handle(&rig).affine().matrix3;
    let beside = DVec2::new(3.0, 3.0);
    assert!(under(&rig, beside).is_none());
    snap(&mut rig, &[beside]);
    assert_eq!(handle(&rig).affine().matrix3, turned);
    rig.undo();
    rig.drain();
    let before = handle(&rig).centre();
    let on = DVec2::new(300.0, 300.0);
    assert!(under(&rig, on).is_some());
    rig.move_to(CENTRE_PX);
    rig.type_keys("g");
    rig.send(Event::PointerMoved(with_ctrl(on)));
    assert!(
        rig.editor.view().status.contains("onto the surface"),
        "{}",
        rig.editor.view().status
    );
    rig.type_keys("x");
    rig.send(Event::PointerMoved(with_ctrl(on)));
    let way = handle(&rig).centre() - before;
    assert!(way.x.abs() > 0.1 && way.y == 0.0 && way.z == 0.0, "{way}");
}
