//! What is done to the region in hand as a whole.

use super::table::{Listed, ctrl, listed};
use crate::{Command, RegionAction};

pub(super) const LISTED: &[Listed] = &[
    listed(
        Command::Region(RegionAction::Grow),
        "Grow",
        "Takes in the vertices around the region in hand.",
        "expand dilate more",
        &[ctrl('=')],
    ),
    listed(
        Command::Region(RegionAction::Shrink),
        "Shrink",
        "Gives up the vertices at the border of the region in hand.",
        "erode less contract",
        &[ctrl('-')],
    ),
    listed(
        Command::Region(RegionAction::SmoothBorder),
        "Smooth border",
        "Straightens the border of the region in hand.",
        "boundary relax",
        &[],
    ),
    listed(
        Command::Region(RegionAction::FillParts),
        "Fill parts",
        "Takes in every part of the surface that the region in hand touches.",
        "component connected linked flood",
        &[],
    ),
    listed(
        Command::Region(RegionAction::Invert),
        "Invert",
        "Makes the region in hand what it was not.",
        "inverse complement",
        &[ctrl('i')],
    ),
    listed(
        Command::Region(RegionAction::EverythingBut),
        "Everything but",
        "Holds still all that is not in hand; with what is held still in hand, frees all else.",
        "inverse complement",
        &[],
    ),
    listed(
        Command::Region(RegionAction::Mirror(0)),
        "Mirror across x",
        "Takes in the mirror image of the region in hand, left and right.",
        "symmetry",
        &[],
    ),
    listed(
        Command::Region(RegionAction::Mirror(1)),
        "Mirror across y",
        "Takes in the mirror image of the region in hand, above and below.",
        "symmetry",
        &[],
    ),
    listed(
        Command::Region(RegionAction::Mirror(2)),
        "Mirror across z",
        "Takes in the mirror image of the region in hand, before and behind.",
        "symmetry",
        &[],
    ),
    listed(
        Command::Region(RegionAction::ToFree),
        "Make it the region",
        "Lets what is in hand bend.",
        "copy assign free roi",
        &[],
    ),
    listed(
        Command::Region(RegionAction::ToFixed),
        "Make it fixed",
        "Holds what is in hand still.",
        "copy assign pin anchor",
        &[],
    ),
    listed(
        Command::Region(RegionAction::ToHandle),
        "Make it a handle",
        "Makes what is in hand a handle of its own.",
        "copy assign",
        &[],
    ),
    listed(
        Command::ClearStiffness,
        "Clear stiffness",
        "Makes the whole surface equally stiff.",
        "reset rigidity material",
        &[],
    ),
];
