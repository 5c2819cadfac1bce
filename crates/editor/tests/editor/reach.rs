//! The reach of a handle: of a new one, of one in an older project, and changed by the pointer.
#![allow(clippy::unwrap_used, reason = "a test that can't go on fails")]

use glam::DVec2;
use pliant_deform::Role;
use pliant_editor::{Command, HandleId, NamedView, Reach};
use pliant_mesh::shapes;
use serde_json::Value;

use crate::project::{reopened, saved};
use crate::rig::{CENTRE_PX, Rig};

const HANDLE: HandleId = HandleId(0);

/// A handle that was painted on the top of a half ball, seen from above.
fn on_a_half_ball() -> Rig {
    let mut rig = Rig::open(shapes::half_ball(60, 1.0));
    rig.choose("bilaplacian");
    rig.command(Command::View(NamedView::Front));
    rig.paint_handle();
    rig.drain();
    rig
}

/// A project of it that was saved before reaches ended in creases.
fn of_an_older_project(rig: &Rig) -> Rig {
    let mut project: Value = serde_json::from_str(&saved(rig)).unwrap();
    assert_eq!(project["handles"][0]["reach"], "found");
    project["handles"][0]["reach"] = "part".into();
    reopened(rig, &project.to_string())
}

fn stored_reach(rig: &Rig) -> Value {
    let project: Value = serde_json::from_str(&saved(rig)).unwrap();
    project["handles"][0]["reach"].clone()
}

/// The farthest distance of a free vertex from the ball's axis, which is z.
fn farthest_free(rig: &Rig) -> f64 {
    let vertices = rig.model.surface.positions.iter().zip(rig.editor.roles());
    let free = vertices.filter(|(_, role)| **role == Role::Free);
    free.map(|(p, _)| p.truncate().length()).fold(0.0, f64::max)
}

#[test]
fn an_older_project_keeps_its_region_and_a_new_handle_ends_in_the_crease() {
    let rig = on_a_half_ball();
    let mut older = of_an_older_project(&rig);
    assert_eq!(older.editor.document().handles()[0].reach, Reach::Part);
    let ends = [&rig, &older].map(farthest_free);
    assert!(ends[0] < 0.2 && ends[1] > 0.25, "the ball's radius is .15: {ends:?}");

    // Its region is that of a plain distance, and so is its shape after it was saved and opened again.
    let roles = older.editor.roles().to_vec();
    older.move_by('x', ".02");
    older.drain();
    let shape = older.drawn();
    assert_eq!(stored_reach(&older), "part");
    let again = reopened(&older, &saved(&older));
    assert_eq!(again.editor.roles(), roles);
    assert!(again.drawn() == shape);
    let end = older.editor.reach_length(HANDLE).unwrap();
    older.command(Command::SetReach(HANDLE, Reach::Length(end)));
    older.drain();
    assert_eq!(older.editor.roles(), roles);
}

#[test]
fn a_reach_that_the_pointer_widens_goes_on_to_count_creases_or_not_to() {
    for is_older in [false, true] {
        let mut rig = on_a_half_ball();
        if is_older {
            rig = of_an_older_project(&rig);
        }
        let before = rig.editor.reach_length(HANDLE).unwrap();
        rig.move_to(CENTRE_PX + DVec2::X * 50.0);
        rig.type_keys("e");
        rig.swipe(&[CENTRE_PX + DVec2::X * 60.0]);
        rig.drain();
        let length = match rig.editor.document().handles()[0].reach {
            Reach::Bounded(length) if !is_older => length,
            Reach::Length(length) if is_older => length,
            other => panic!("older {is_older}: {other:?}"),
        };
        assert!(length > 1.1 * before, "{before} {length}");
        assert_eq!(farthest_free(&rig) < 0.2, !is_older, "{}", farthest_free(&rig));
    }
}
