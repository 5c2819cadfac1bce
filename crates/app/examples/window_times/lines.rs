//! Handles that follow a line: each drawn by one stroke over the part of the model that is nearest, and a spine's end dragged.

use egui::{Pos2, vec2};
use glam::DVec3;
use pliant_editor::{Command, NamedView, StrokeShape, ToolMode};

use super::session::Session;

const MOVES: usize = 120;

/// Prints a row for each kind of line.
pub fn lines(session: &mut Session) {
    session.command(Command::ClearRegions);
    session.command(Command::View(NamedView::Front));
    for (shape, name) in [
        (StrokeShape::Curve, "curve"),
        (StrokeShape::Spine, "spine"),
        (StrokeShape::Crease, "crease"),
        (StrokeShape::Sketch, "sketch"),
    ] {
        let before = session.harness.state().editor().document().handles().len();
        session.command(Command::SetTool(ToolMode::PaintHandle));
        session.command(Command::SetStrokeShape(shape));
        let (from, to) = ends(session);
        session.begin_row();
        session.drag(MOVES, |share| from + (to - from) * share);
        session.settle();
        let drawn = session.harness.state().editor().document().handles().len() > before;
        session.row(&format!("{name}{}", if drawn { "" } else { " (none drawn)" }));
        if shape == StrokeShape::Spine && drawn {
            drag_end(session);
        }
        while session.harness.state().editor().document().handles().len() > before {
            session.command(Command::Undo);
        }
    }
}

/// The two ends of a stroke over the vertex that is nearest to the viewer, along the model's longest side that is seen
/// from the front.
fn ends(session: &Session) -> (Pos2, Pos2) {
    let application = session.harness.state();
    let model = application.editor().view().model.expect("a file is open");
    let extent = model.bounds().expect("it has vertices").extent();
    let (along, length) = match extent.x > extent.y {
        true => (DVec3::X, extent.x),
        false => (DVec3::Y, extent.y),
    };
    let positions = model.surface.positions.iter();
    let nearest = positions.max_by(|a, b| a.z.total_cmp(&b.z)).expect("it has vertices");
    let aside = along * length / 40.0;
    (session.place_of(*nearest - aside), session.place_of(*nearest + aside))
}

/// Drags the last point of the curve that was drawn last.
fn drag_end(session: &mut Session) {
    session.command(Command::SetTool(ToolMode::Select));
    let document = session.harness.state().editor().document();
    let line = document.handles().last().and_then(|handle| handle.line.as_ref());
    let Some(end) = line.and_then(|line| line.curve()?.moved().last().copied()) else {
        return;
    };
    let end = session.place_of(end);
    session.begin_row();
    session.drag(MOVES, |share| end + vec2(30.0, -60.0) * share);
    session.settle();
    session.row("a curve's point dragged");
    session.command(Command::Undo);
}
