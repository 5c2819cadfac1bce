//! Changes of the mesh, undone and redone: a cut through the middle, the hole filled, and the other half appended and
//! merged.

use std::path::PathBuf;

use glam::DVec3;
use pliant_editor::{Command, CutPlane, KeptSide, MergeSettings, MeshChange, Paint, Placement};
use pliant_mesh::SurfaceVertex;

use super::session::Session;

/// Prints a row for each change, its undoing and its redoing. `file` is the open one.
pub fn mesh_changes(session: &mut Session, file: &str) {
    let application = session.harness.state();
    let model = application.editor().view().model.expect("a file is open");
    let middle = model.bounds().expect("it has vertices").centre();
    let plane = CutPlane {
        normal: DVec3::Y,
        distance: middle.y,
    };
    let cut = |side, spared| Command::ChangeMesh(MeshChange::Cut(plane, side, spared));
    there_and_back(session, cut(KeptSide::Negative, Vec::new()), "cut");
    there_and_back(session, Command::FillHoles, "fill");
    session.command(Command::Undo);
    session.begin_row();
    session.harness.state_mut().append(PathBuf::from(file));
    session.settle();
    session.row("append");
    let document = session.harness.state().editor().document();
    let of_first = (0..)
        .zip(document.paint())
        .filter(|(_, paint)| !matches!(paint, Paint::Handle(_)));
    let of_first = of_first.map(|(vertex, _)| SurfaceVertex(vertex)).collect();
    session.command(cut(KeptSide::Positive, of_first));
    session.row("cut of a part");
    session.command(Command::SetMerge(MergeSettings {
        placement: Placement::Fitted,
        ..MergeSettings::default()
    }));
    there_and_back(session, Command::Merge, "merge");
}

fn there_and_back(session: &mut Session, command: Command, name: &str) {
    for (command, of) in [
        (command, ""),
        (Command::Undo, "undo of a "),
        (Command::Redo, "redo of a "),
    ] {
        session.begin_row();
        session.command(command);
        if let Some(problem) = &session.harness.state().editor().view().problem {
            println!("{{\"doing\": \"{of}{name}\", \"problem\": \"{problem:?}\"}}");
        }
        session.row(&format!("{of}{name}"));
    }
}
