//! What is done to the region in hand as a whole, and to stiffness.

use super::entry::{Action, Entry, Reason, Scope, State, ctrl, item, unless, unlocked, when_open};
use crate::document::{Paint, Tips};
use crate::workspace::{
    RegionAction, StiffnessChange, act_on_region, change_stiffness, clear_stiffness, set_stiffness, set_tips,
};

const NO_HANDLE: &str = "No handle is selected: select one in the list, or paint one.";

/// Changes the region in hand as a whole.
pub(super) const REGION: Entry<RegionAction> = Entry {
    listed: &[
        item(
            RegionAction::Grow,
            "Grow",
            "Takes in the vertices around the region in hand.",
            "expand dilate more",
            &[ctrl('=')],
        ),
        item(
            RegionAction::Shrink,
            "Shrink",
            "Gives up the vertices at the border of the region in hand.",
            "erode less contract",
            &[ctrl('-')],
        ),
        item(
            RegionAction::SmoothBorder,
            "Smooth border",
            "Straightens the border of the region in hand.",
            "boundary relax",
            &[],
        ),
        item(
            RegionAction::FillParts,
            "Fill parts",
            "Takes in every part of the surface that the region in hand touches.",
            "component connected linked flood",
            &[],
        ),
        item(
            RegionAction::Invert,
            "Invert",
            "Makes the region in hand what it was not.",
            "inverse complement",
            &[ctrl('i')],
        ),
        item(
            RegionAction::EverythingBut,
            "Everything but",
            "Holds still all that is not in hand; with what is held still in hand, frees all else.",
            "inverse complement",
            &[],
        ),
        item(
            RegionAction::Mirror(0),
            "Mirror across x",
            "Takes in the mirror image of the region in hand, left and right.",
            "symmetry",
            &[],
        ),
        item(
            RegionAction::Mirror(1),
            "Mirror across y",
            "Takes in the mirror image of the region in hand, above and below.",
            "symmetry",
            &[],
        ),
        item(
            RegionAction::Mirror(2),
            "Mirror across z",
            "Takes in the mirror image of the region in hand, before and behind.",
            "symmetry",
            &[],
        ),
        item(
            RegionAction::ToFree,
            "Make it the region",
            "Lets what is in hand bend.",
            "copy assign free roi",
            &[],
        ),
        item(
            RegionAction::ToFixed,
            "Make it fixed",
            "Holds what is in hand still.",
            "copy assign pin anchor",
            &[],
        ),
        item(
            RegionAction::ToHandle,
            "Make it a handle",
            "Makes what is in hand a handle of its own.",
            "copy assign",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| match state.settings.role_in_hand(state.workspace.selection.selected()) {
        None => Some("No region is in hand: select a handle, or take the brush of what is free or fixed.".into()),
        Some(Paint::Handle(id)) => {
            let handle = state.workspace.document.handle(id);
            handle.ok_or_else(|| NO_HANDLE.into()).and_then(unlocked).err()
        }
        Some(_) => state.unopened(),
    },
    action: Action::Do(|context, action| {
        let selected = context.workspace.selection.selected();
        if let Some(role) = context.settings.role_in_hand(selected) {
            act_on_region(context.workspace, role, action);
        }
    }),
};

/// Chooses whether the parts that a reach cuts off from the body come along or are held still.
pub(super) const SET_TIPS: Entry<Tips> = Entry {
    listed: &[
        item(
            Tips::Held,
            "Hold the tips",
            "Holds still what a handle's reach cuts off from the body: fingertips, ears, the rest of a limb.",
            "extremity extremities limb island region pin keep",
            &[],
        ),
        item(
            Tips::ComeAlong,
            "Take the tips along",
            "Lets what a handle's reach cuts off from the body come along: fingertips, ears, the rest of a limb.",
            "extremity extremities limb island region topological",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, tips| {
        state.unopened().or_else(|| {
            let reason = match tips {
                Tips::Held => "The tips are held already.",
                Tips::ComeAlong => "The tips come along already.",
            };
            unless(state.workspace.document.tips() != *tips, reason)
        })
    },
    action: Action::Do(|context, tips| set_tips(context.workspace, tips)),
};

/// Changes what is painted of stiffness as a whole.
pub(super) const CHANGE_STIFFNESS: Entry<StiffnessChange> = Entry {
    listed: &[
        item(
            StiffnessChange::Blur,
            "Blur stiffness",
            "Takes the stiffness of every vertex towards that of its neighbours.",
            "mask soften smooth rigidity",
            &[],
        ),
        item(
            StiffnessChange::Sharpen,
            "Sharpen stiffness",
            "Makes what is stiff end more sharply.",
            "mask contrast harden rigidity",
            &[],
        ),
        item(
            StiffnessChange::Grow,
            "Grow stiffness",
            "Takes in the vertices around what is painted stiff or soft.",
            "mask expand dilate rigidity",
            &[],
        ),
        item(
            StiffnessChange::Shrink,
            "Shrink stiffness",
            "Gives up the vertices at the border of what is painted stiff or soft.",
            "mask erode contract rigidity",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| is_stiffness_painted(state),
    action: Action::Do(|context, change| change_stiffness(context.workspace, change)),
};

fn is_stiffness_painted(state: &State<'_>) -> Option<Reason> {
    let is_any = state.workspace.document.stiffness().is_some();
    unless(is_any, "No stiffness is painted.")
}

/// Makes the whole surface equally stiff.
pub(super) const CLEAR_STIFFNESS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Clear stiffness",
        "Makes the whole surface equally stiff.",
        "reset rigidity material",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| is_stiffness_painted(state),
    action: Action::Do(|context, ()| clear_stiffness(context.workspace)),
};

/// Sets the stiffness (0.001 to 1000; 1 is a vertex left alone) of every vertex.
pub(super) const SET_STIFFNESS: Entry<Vec<f64>> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, field| set_stiffness(context.workspace, field)),
};
