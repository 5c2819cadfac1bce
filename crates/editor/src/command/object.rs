//! What of the file is shown and may be painted.

use super::table::{Listed, alt, character, listed, shift};
use crate::{Command, ObjectAction};

pub(super) const LISTED: &[Listed] = &[
    listed(
        Command::ObjectHere(ObjectAction::Hide),
        "Hide object",
        "Hides the object under the pointer: it is neither drawn nor picked nor painted, and moves along.",
        "invisible",
        &[character('h')],
    ),
    listed(
        Command::ObjectHere(ObjectAction::Solo),
        "Show only this object",
        "Hides all objects but the one under the pointer; once more shows everything.",
        "solo",
        &[shift('h')],
    ),
    listed(
        Command::ObjectHere(ObjectAction::Lock),
        "Lock object",
        "Holds the object under the pointer still, whatever is painted on it.",
        "freeze protect",
        &[],
    ),
    listed(
        Command::Isolate,
        "Isolate part",
        "Shows nothing but the connected part under the pointer; once more shows the others again.",
        "solo local view component",
        &[character('/')],
    ),
    listed(
        Command::ShowEverything,
        "Show everything",
        "Shows all objects and parts that are hidden.",
        "unhide reveal",
        &[alt('h')],
    ),
];
