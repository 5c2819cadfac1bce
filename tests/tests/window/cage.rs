//! Cages in the whole window: shown, dragged by the pointer, loaded from a file, saved in a project. Skipped by name if
//! there is no graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    dead_code,
    reason = "tests fail by panicking, say what they skip, and do not need every verb of the rig"
)]

use crate::window_rig::Session;
use egui::{Key, Modifiers, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_app::window::{AppDirectories, Source};
use pliant_editor::{Command, ToolMode};
use pliant_mesh::{Drawn, DrawnVertex};
use pliant_tests::Folder;

/// A box around the sample: its middle, and half its sides.
fn boxed(middle: DVec3, half: DVec3) -> Drawn {
    let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) * 2.0 - 1.0;
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Drawn::once(
        (0..8).map(|k| middle + corner(k) * half).collect(),
        triangles.map(|t| t.map(DrawnVertex)).collect(),
    )
}

/// The place in the window of a control point without surface under it.
fn point_beside(session: &Session) -> Pos2 {
    let application = session.harness.state();
    let (editor, view) = (application.editor(), application.editor().view());
    let squares = view.controls[4..].iter().flat_map(|shape| shape.triangles.chunks(2));
    let seen = squares.filter_map(|square| {
        let middle = (square[0][0] + square[0][2]) * 0.5;
        view.camera.project(middle, view.viewport_px)
    });
    let is_within =
        |px: &glam::DVec2| px.cmpgt(glam::DVec2::splat(90.0)).all() && px.cmplt(view.viewport_px - 90.0).all();
    let px = seen
        .filter(is_within)
        .find(|px| editor.pick(*px).is_none())
        .expect("a point beside the sample");
    let corner = application.view_rect().min;
    pos2(corner.x + px.x as f32, corner.y + px.y as f32)
}

fn count(session: &Session) -> usize {
    session
        .harness
        .state()
        .editor()
        .view()
        .control_points
        .map_or(0, |points| points.count)
}

#[test]
fn a_cage_is_shown_dragged_undone_loaded_and_saved() {
    let folder = Folder::new();
    let Some(mut session) = Session::begin_in(Source::Sample, AppDirectories::default()) else {
        return;
    };
    session.palette("load cage");
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.get_by_label_contains("takes no cage");
    session.key(Key::Escape, Modifiers::NONE);
    session.harness.run_steps(2);
    session.palette("method: cage");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle_when(|session| count(session) > 8);
    session.page("Method");
    session.harness.get_by_label_contains("made by the method");
    session.harness.state_mut().command(Command::SetTool(ToolMode::Select));
    session.settle();
    let from = point_beside(&session);
    session.stroke(from, from + vec2(-40.0, 25.0));
    session.harness.get_by_label_contains("1 selected, your own");
    assert!(
        session.shape().iter().any(|d| *d != DVec3::ZERO),
        "{}",
        session.status()
    );
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    session.harness.get_by_label_contains("made by the method");
    assert!(session.shape().iter().all(|d| *d == DVec3::ZERO));

    let bounds = session.harness.state().editor().view().model.unwrap().bounds().unwrap();
    let (middle, half) = (bounds.centre(), (bounds.max - bounds.min) * 0.75);
    let small = folder.write_mesh("small.off", &boxed(middle, half * 0.3));
    let cage = folder.write_mesh("cage.off", &boxed(middle, half));
    let torn = folder.write(
        "torn.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\n",
    );
    session.harness.state_mut().load_cage(torn);
    session.settle_when(|session| session.harness.state().editor().view().problem.is_some());
    let problem = session.harness.state().editor().view().problem.unwrap().to_owned();
    assert!(
        problem.contains("The cage is open at the edge") || problem.contains("face different sides"),
        "{problem}"
    );
    session.harness.state_mut().load_cage(cage);
    session.settle_when(|session| count(session) == 8);
    session
        .harness
        .get_by_label_contains("Cage: 8 points, 0 selected, your own");
    session.harness.state_mut().load_cage(small);
    session.settle_when(|session| {
        let editor = session.harness.state().editor();
        editor
            .warnings()
            .iter()
            .any(|warning| warning.contains("outside the cage"))
    });
    session.harness.state_mut().load_cage(folder.at("none.off"));
    session.settle_when(|session| {
        session
            .harness
            .state()
            .headline()
            .is_some_and(|line| line.contains("none.off"))
    });
}
