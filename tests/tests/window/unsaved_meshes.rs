//! Changes of the mesh that no file has yet: reloading names them and keeps the rest of the edit, and *Stop* ends them.
//! Skipped by name if there is no graphics device at all.

use std::sync::Arc;

use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_editor::Command;
use pliant_mesh::{Drawn, shapes};
use pliant_tests::Folder;

use crate::disk::{await_words, click, edit, move_up, open, save, says};
use crate::window_rig::Session;

/// A ball with a hole at its lower end.
fn bowl(depth: u32) -> Drawn {
    let mut ball = shapes::icosphere(depth);
    let at = ball.positions.clone();
    ball.triangles
        .retain(|corners| corners.iter().any(|corner| at[corner.index()].y > -0.8));
    ball
}

fn holes(session: &Session) -> usize {
    let model = session.harness.state().editor().view().model.unwrap();
    model.topology.boundary_loops().len()
}

/// The places of the surface's vertices.
fn places(session: &Session) -> Vec<DVec3> {
    let view = session.harness.state().editor().view();
    let rest = &view.model.unwrap().surface.positions;
    let shown = rest.iter().zip(view.displacements.iter());
    shown.map(|(rest, way)| *rest + *way).collect()
}

#[test]
fn reloading_names_the_fill_that_it_loses_and_keeps_the_edit() {
    let folder = Folder::new();
    let file = folder.write_mesh("scan.off", &bowl(3));
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    session.harness.state_mut().command(Command::FillHoles);
    session.settle();
    assert_eq!(holes(&session), 0);
    move_up(&mut session, ".1");
    session.settle();
    let bent = places(&session);
    // Another program moves the whole mesh.
    let mut theirs = bowl(3);
    theirs.positions.iter_mut().for_each(|position| position.x += 1.0);
    folder.write_mesh("scan.off", &theirs);
    save(&mut session);
    click(&mut session, "Save");
    await_words(&mut session, "scan.off has changed");
    assert!(says(&session, "reloading loses them: Fill holes."));
    click(&mut session, "Reload and lose them");
    session.settle();
    assert_eq!(holes(&session), 1);
    let document = session.harness.state().editor().document();
    assert_eq!(document.handles().len(), 1);
    assert!(session.harness.state().editor().view().unsaved);
    // The bends before and after the fill are there.
    let farthest = places(&session)
        .iter()
        .map(|place| {
            let near = bent.iter().map(|bent| bent.distance(*place - DVec3::X));
            near.fold(f64::INFINITY, f64::min)
        })
        .fold(0.0, f64::max);
    assert!(farthest < 1e-3, "{farthest}");
}

#[test]
fn stop_ends_a_fill_and_the_surface_stays() {
    for depth in 5.. {
        let folder = Folder::new();
        let file = folder.write_mesh("scan.off", &bowl(depth));
        let Some(mut session) = open(&file) else { return };
        let before = Arc::clone(session.harness.state().editor().view().model.unwrap());
        while !session.harness.state().editor().view().jobs.is_empty() {
            session.harness.step();
        }
        session.harness.state_mut().command(Command::FillHoles);
        let is_there = |session: &Session| session.harness.query_by_label("Stop").is_some();
        while !is_there(&session) && holes(&session) > 0 {
            session.harness.step();
        }
        // On a fast machine a small mesh is filled before a hand reaches the button.
        if !is_there(&session) {
            assert!(depth < 8, "the button never comes");
            continue;
        }
        click(&mut session, "Stop");
        session.settle();
        let editor = session.harness.state().editor();
        if holes(&session) == 0 {
            assert!(depth < 8, "it never stops");
            continue;
        }
        assert_eq!(
            editor.view().problem,
            Some("Fill holes was stopped: the surface is unchanged.")
        );
        assert!(Arc::ptr_eq(editor.view().model.unwrap(), &before));
        assert!(!editor.view().unsaved && editor.is_enabled(&Command::FillHoles));
        return;
    }
}

#[test]
fn an_appended_part_warns_of_nothing() {
    let folder = Folder::new();
    let file = folder.write_mesh("scan.off", &bowl(3));
    let lid = folder.write_mesh("lid.off", &bowl(2));
    let Some(mut session) = open(&file) else { return };
    session.harness.state_mut().append(lid);
    session.settle();
    move_up(&mut session, ".1");
    session.settle();
    assert_eq!(session.harness.state().editor().warnings(), Vec::<String>::new());
}
