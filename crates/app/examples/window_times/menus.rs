//! The commands of the menus.

use std::time::Duration;

use pliant_deform::{Bilaplacian, Method};
use pliant_editor::{Command, ObjectAction, RegionAction, Shading};

use super::session::{Session, ms};

/// Every kind of command in a menu, each until all its jobs have ended.
pub fn menus(session: &mut Session) {
    let commands = [
        Command::Region(RegionAction::Grow),
        Command::Region(RegionAction::Invert),
        Command::Undo,
        Command::Region(RegionAction::EverythingBut),
        Command::Undo,
        Command::Redo,
        Command::Undo,
        Command::MakeTwin(0),
        Command::Undo,
        Command::DuplicateHandle,
        Command::Undo,
        Command::SetShading(Shading::Material),
        Command::SetShading(Shading::Curvature),
        Command::SetShading(Shading::Zebra),
        Command::SetShading(Shading::Clay),
        Command::ToggleFlat,
        Command::ToggleWireframe,
        Command::ToggleWireframe,
        Command::ToggleFlat,
        Command::ToggleBorders,
        Command::ToggleRegions,
        Command::ToggleRegions,
        Command::FrameSelected,
        Command::FrameAll,
        Command::Objects(ObjectAction::Lock, vec![0]),
        Command::Undo,
        Command::Objects(ObjectAction::Hide, vec![0]),
        Command::Undo,
        Command::SetMethod(Method::from(Bilaplacian::default())),
        Command::Apply,
        Command::ResetShape,
        Command::ClearRegions,
        Command::GoToStep(0),
    ];
    let mut longest: Vec<(Duration, String)> = Vec::new();
    for command in commands {
        let name = format!("{command:?}");
        session.begin_row();
        session.command(command);
        longest.push((session.longest_frame(), name));
    }
    longest.sort();
    for (time, name) in longest.iter().rev().take(6) {
        println!("{{\"doing\": \"{name}\", \"longest_frame_ms\": {:.1}}}", ms(*time));
    }
}
