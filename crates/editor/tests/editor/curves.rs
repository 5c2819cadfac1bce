//! Handles that follow curves, in the document: opened, moved, undone, saved and applied.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::Arc;

use crate::curve_strokes::px;
use crate::project::{reopened, saved};
use crate::rig::Rig;
use glam::{DQuat, DVec2, DVec3, Vec3Swizzles};
use pliant_editor::{
    Beginning, Command, Event, FREE_BEND_DEG, HandleCurve, HandleLine, Key, MeshReference, NamedView, Project,
    ToolMode, geometry_hash,
};
use pliant_mesh::shapes;
use serde_json::json;

const LENGTH: f64 = 24.0;

/// The pinned point of [`edit`]'s curve, and the bends that it may have there.
const PIN: u32 = 4;
const BEND_DEG: [f64; 2] = [5.0, 140.0];

/// A bar of which every third ring follows its middle line, which bends by 200 degrees and twists.
fn edit(method: &str) -> String {
    let points: Vec<[f64; 3]> = (0..13).map(|i| [2.0 * f64::from(i), 1.0, 1.0]).collect();
    let moved: Vec<[f64; 3]> = points.iter().map(|point| on_arc(point[0]).0.to_array()).collect();
    let drawn = shapes::bar(LENGTH as usize, 2, 2);
    let rings: Vec<usize> = (0..drawn.positions.len())
        .filter(|v| drawn.positions[*v].x % 3.0 == 0.0)
        .collect();
    let bend = |point: u32| if point == PIN { BEND_DEG } else { [0.0, 180.0] };
    let curve = json!({
        "points": points, "moved": moved, "twist": (0..13).map(|i| 10 * i).collect::<Vec<i32>>(),
        "pinned": [PIN], "bends": (0..13).map(bend).collect::<Vec<_>>(),
    });
    json!({
        "version": 1, "method": { "name": method },
        "handles": [{ "name": "spine", "select": { "vertices": rings }, "curve": curve }],
    })
    .to_string()
}

fn on_arc(x: f64) -> (DVec3, f64) {
    let angle = 200.0_f64.to_radians() * x / LENGTH;
    let radius = LENGTH / 200.0_f64.to_radians();
    (
        DVec3::new(radius * angle.sin(), 1.0 + radius * (1.0 - angle.cos()), 1.0),
        angle,
    )
}

/// The largest distance of a vertex of the handle from where the curve takes it, moved further by `then`.
fn missed(rig: &Rig, then: DVec3) -> f64 {
    let shape = rig.editor.document().from_file();
    let rest = &rig.model.surface.positions;
    let held = rest.iter().zip(shape.iter()).filter(|(rest, _)| rest.x % 3.0 == 0.0);
    let misses = held.map(|(rest, way)| {
        let (place, angle) = on_arc(rest.x);
        let twist = DQuat::from_rotation_x((60.0 * rest.x / LENGTH * 2.0).to_radians());
        let arm = DQuat::from_rotation_z(angle) * (twist * DVec3::new(0.0, rest.y - 1.0, rest.z - 1.0));
        (*rest + *way).distance(place + arm + then)
    });
    misses.fold(0.0, f64::max)
}

fn opened(method: &str) -> Rig {
    let mut rig = Rig::open(shapes::bar(LENGTH as usize, 2, 2));
    open(&mut rig, &edit(method));
    rig
}

fn open(rig: &mut Rig, text: &str) {
    rig.editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "a bar".to_owned(),
        beginning: Some(Beginning::parse(text).unwrap()),
    });
    rig.drain();
}

#[test]
fn an_opened_edit_bends_along_its_curve_and_the_handle_moves_further_as_a_whole() {
    for method in ["arap", "bilaplacian", "primo", "shells"] {
        let mut rig = opened(method);
        assert!(rig.editor.document().is_displaced());
        assert!(
            missed(&rig, DVec3::ZERO) < 5e-3,
            "{method}: {:e}",
            missed(&rig, DVec3::ZERO)
        );
        let before = rig.editor.document().handles().to_vec();
        let id = rig.editor.document().handles()[0].id;
        rig.command(Command::SelectHandle(id));
        rig.move_by('z', "2");
        rig.drain();
        assert!(missed(&rig, 2.0 * DVec3::Z) < 5e-3, "{method}");
        rig.undo();
        rig.drain();
        assert!(missed(&rig, DVec3::ZERO) < 5e-3);
        assert_eq!(before, rig.editor.document().handles());
    }
}

#[test]
fn projects_and_exported_edits_keep_the_curve() {
    let mut rig = opened("arap");
    let mesh = MeshReference {
        name: None,
        path: Some("bar.off".to_owned()),
        geometry: geometry_hash(&rig.model),
    };
    let text = rig.editor.snapshot().unwrap().project(mesh).to_json();
    let project = Project::parse(&text).unwrap();
    assert_eq!(project.to_json(), text);
    let curve = rig.editor.document().handles()[0]
        .line
        .as_ref()
        .and_then(HandleLine::curve)
        .cloned();
    assert!(curve.is_some());
    let first = rig.fingerprint();
    let exported = rig.editor.edit_file().unwrap();
    assert_eq!(exported.handles[0].curve, curve);
    open(&mut rig, &text);
    assert_eq!(first, rig.fingerprint());
    open(&mut rig, &exported.to_json());
    assert!(missed(&rig, DVec3::ZERO) < 5e-3);
    // A project bends by the command line as it does in the window.
    let setup = Beginning::from(project).resolve(&rig.model).unwrap();
    assert!(!setup.lines.is_empty());
}

#[test]
fn an_applied_shape_has_its_curve_at_rest_and_a_reset_one_too() {
    let mut rig = opened("arap");
    rig.command(Command::Apply);
    rig.drain();
    assert_joints(&present(&rig), "applied");
    let applied = rig.editor.document().handles()[0].clone();
    assert!(!applied.is_displaced() && missed(&rig, DVec3::ZERO) < 5e-3);
    assert!(applied.line.unwrap().curve().unwrap().rest().points()[12].distance(on_arc(LENGTH).0) < 1e-12);
    rig.command(Command::ResetShape);
    rig.drain();
    assert!(!rig.editor.document().handles()[0].is_displaced());
    assert_eq!(rig.largest_displacement(), 0.0);
}

/// The present curve of the only handle.
fn present(rig: &Rig) -> HandleCurve {
    let handle = &rig.editor.document().handles()[0];
    handle.line.as_ref().and_then(HandleLine::curve).unwrap().clone()
}

/// Checks that a curve still has its pin and its limits.
fn assert_joints(curve: &HandleCurve, case: &str) {
    assert_eq!(curve.pinned(), [PIN], "{case}");
    assert_eq!(curve.bend_deg(PIN as usize), BEND_DEG, "{case}");
    assert_eq!(curve.bend_deg(0), FREE_BEND_DEG, "{case}");
}

#[test]
fn keys_hold_curves_which_pass_from_one_to_the_next_and_projects_and_edits_keep_them() {
    let mut rig = opened("bilaplacian");
    let bent = present(&rig);
    rig.command(Command::KeyHere);
    let go_to = |rig: &mut Rig, time: f64| {
        rig.command(Command::GoToTime(time));
        rig.drain();
    };
    go_to(&mut rig, 1.0);
    rig.command(Command::ResetShape);
    rig.drain();
    let at_rest = present(&rig);
    assert!(at_rest.is_rest() && !bent.is_rest());
    rig.command(Command::KeyHere);
    for (time, expected) in [(0.0, &bent), (1.0, &at_rest)] {
        go_to(&mut rig, time);
        assert_eq!(present(&rig), *expected, "at {time}");
    }
    go_to(&mut rig, 0.5);
    let middle = present(&rig);
    assert_joints(&middle, "between keys");
    for ((point, a), b) in middle.moved().iter().zip(bent.moved()).zip(at_rest.moved()) {
        assert!(
            point.distance(a.midpoint(*b)) < 1e-12,
            "a way that begins and ends at rest is half done by half time"
        );
    }
    assert!(rig.largest_displacement() > 0.1, "the surface follows");
    let shown = rig.fingerprint();
    rig.undo();
    rig.redo();
    rig.drain();
    assert_eq!(rig.fingerprint(), shown);

    let mesh = MeshReference {
        name: None,
        path: None,
        geometry: geometry_hash(&rig.model),
    };
    let animation = rig.editor.document().animation().clone();
    let project = rig.editor.snapshot().unwrap().project(mesh).to_json();
    let edit = rig.editor.edit_file().unwrap();
    open(&mut rig, &project);
    assert_eq!(*rig.editor.document().animation(), animation);
    assert_eq!(rig.fingerprint(), shown);
    open(&mut rig, &edit.to_json());
    assert_eq!(present(&rig), bent, "an edit shows its beginning");
    assert_eq!(rig.editor.edit_file().unwrap().keys, edit.keys);
    go_to(&mut rig, 1.0);
    assert_joints(&present(&rig), "a key of an opened edit");
}

#[test]
fn a_share_of_a_curve_is_keyed_and_exported_as_it_is_shown() {
    let mut rig = opened("bilaplacian");
    let whole = present(&rig);
    rig.command(Command::SetStrength(0.5));
    rig.drain();
    rig.command(Command::KeyHere);
    let edit = rig.editor.edit_file().unwrap();
    assert_eq!(edit.strength, 1.0, "keys have no full values");
    let half = whole.motion_at(0.5);
    assert_eq!(edit.handles[0].curve.as_ref().unwrap().moved(), half.moved().points());
    let shape = rig.editor.document().from_file().to_vec();
    open(&mut rig, &edit.to_json());
    let again = rig.editor.document().from_file();
    let apart = again
        .iter()
        .zip(&shape)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max);
    assert!(apart < 1e-9, "{apart}");
}

/// A bar of which only the ends follow its middle line, whose far end has this twist in degrees.
fn twisted_edit(method: &str, twist: f64) -> String {
    let drawn = shapes::bar(LENGTH as usize, 2, 2);
    let ends: Vec<usize> = (0..drawn.positions.len())
        .filter(|v| !(3.0..=LENGTH - 3.0).contains(&drawn.positions[*v].x))
        .collect();
    let curve = json!({ "points": [[0, 1, 1], [LENGTH, 1, 1]], "twist": [0.0, twist] });
    json!({
        "version": 1, "method": { "name": method },
        "handles": [{ "name": "spine", "select": { "vertices": ends }, "curve": curve }],
    })
    .to_string()
}

/// The angle between the bar's middle cross-section and one that has turned by `degrees`, in degrees.
fn middle_off_deg(rig: &Rig, degrees: f64) -> f64 {
    let shape = rig.editor.document().from_file();
    let middle = rig.model.surface.positions.iter().zip(shape.iter());
    let middle = middle.filter(|(rest, _)| rest.x == LENGTH / 2.0);
    // The sum of the arms' products as complex numbers, in which the section's own way falls out.
    let turn = middle.fold(DVec2::ZERO, |sum, (rest, way)| {
        let (rest, arm) = (rest.yz() - 1.0, rest.yz() + way.yz());
        sum + DVec2::new(rest.x, -rest.y).rotate(arm)
    });
    turn.angle_to(DVec2::from_angle(degrees.to_radians()))
        .abs()
        .to_degrees()
}

#[test]
fn a_full_turn_of_a_bars_end_is_one_when_it_is_opened_dragged_undone_saved_and_opened_again() {
    for method in ["arap", "primo", "shells"] {
        let mut rig = Rig::open(shapes::bar(LENGTH as usize, 2, 2));
        open(&mut rig, &twisted_edit(method, 360.0));
        assert!(
            middle_off_deg(&rig, 180.0) < 2.0,
            "{method}, opened: {}",
            middle_off_deg(&rig, 180.0)
        );

        open(&mut rig, &twisted_edit(method, 0.0));
        assert_eq!(rig.largest_displacement(), 0.0);
        let id = rig.editor.document().handles()[0].id;
        rig.command(Command::SelectHandle(id));
        rig.command(Command::SetTool(ToolMode::Select));
        rig.command(Command::View(NamedView::Front));
        rig.command(Command::FrameAll);
        let end_px = px(&rig, present(&rig).moved()[1]);
        rig.swipe(&[end_px]);
        for _ in 0..6 {
            rig.type_keys("r");
            rig.type_keys("x60");
            rig.key(Key::Enter);
            rig.drain();
        }
        assert!((present(&rig).twist_deg()[1] - 360.0).abs() < 1e-9);
        assert!(middle_off_deg(&rig, 180.0) < 2.0, "{method}, turned");
        rig.undo();
        rig.drain();
        assert!(middle_off_deg(&rig, 150.0) < 2.0, "{method}, undone");
        rig.redo();
        rig.drain();
        assert!(middle_off_deg(&rig, 180.0) < 2.0, "{method}, redone");
        let again = reopened(&rig, &saved(&rig));
        assert!(middle_off_deg(&again, 180.0) < 2.0, "{method}, opened again");
    }
}
