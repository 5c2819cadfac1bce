//! What is done to the document as a whole.

use super::table::{Listed, ctrl, listed};
use crate::{Command, Key, Modifiers, Shortcut};

pub(super) const LISTED: &[Listed] = &[
    listed(
        Command::Undo,
        "Undo",
        "Takes back the last step.",
        "back revert",
        &[ctrl('z')],
    ),
    listed(
        Command::Redo,
        "Redo",
        "Does the step that was taken back again.",
        "again forth",
        &[Shortcut::with(Modifiers::CTRL_SHIFT, Key::Character('z')), ctrl('y')],
    ),
    listed(
        Command::Apply,
        "Apply shape",
        "Makes the present shape the new rest shape.",
        "bake freeze rest shape",
        &[Shortcut::with(Modifiers::CTRL, Key::Enter)],
    ),
    listed(
        Command::ResetShape,
        "Reset shape",
        "Takes the surface back to the file's shape.",
        "original revert",
        &[],
    ),
    listed(
        Command::ClearRegions,
        "Clear regions",
        "Removes all handles and regions; the shape stays as it is.",
        "remove delete all handles",
        &[],
    ),
    listed(
        Command::CancelJobs,
        "Stop",
        "Stops what is being computed.",
        "cancel abort",
        &[],
    ),
];
