//! Commands on the whole selected region, and on stiffness.

use super::entry::{Action, Entry, Reason, Scope, State, ctrl, item, unless, unlocked, when_open};
use crate::document::{Paint, Tips};
use crate::workspace::{
    RegionAction, StiffnessChange, act_on_region, change_stiffness, clear_stiffness, set_stiffness, set_tips,
};

const NO_HANDLE: &str = "No handle is selected: select one in the list, or paint one.";

/// Changes the selected region as a whole.
pub(super) const REGION: Entry<RegionAction> = Entry {
    listed: &[
        item(
            RegionAction::Grow,
            "Grow",
            "Grows the selected region by one ring of vertices.",
            "expand dilate more",
            &[ctrl('=')],
        ),
        item(
            RegionAction::Shrink,
            "Shrink",
            "Shrinks the selected region by one ring of vertices.",
            "erode less contract",
            &[ctrl('-')],
        ),
        item(
            RegionAction::SmoothBorder,
            "Smooth border",
            "Smooths the border of the selected region.",
            "boundary relax",
            &[],
        ),
        item(
            RegionAction::FillParts,
            "Fill parts",
            "Extends the selected region to every connected part that it touches.",
            "component connected linked flood",
            &[],
        ),
        item(
            RegionAction::Invert,
            "Invert",
            "Swaps the selected region with the rest of the surface.",
            "inverse complement",
            &[ctrl('i')],
        ),
        item(
            RegionAction::EverythingBut,
            "Fix the rest",
            "Fixes everything outside the selected region, or frees it if the fixed region is selected.",
            "inverse complement",
            &[],
        ),
        item(
            RegionAction::Mirror(0),
            "Mirror across x",
            "Adds the mirror image of the selected region, left and right.",
            "symmetry",
            &[],
        ),
        item(
            RegionAction::Mirror(1),
            "Mirror across y",
            "Adds the mirror image of the selected region, above and below.",
            "symmetry",
            &[],
        ),
        item(
            RegionAction::Mirror(2),
            "Mirror across z",
            "Adds the mirror image of the selected region, front and back.",
            "symmetry",
            &[],
        ),
        item(
            RegionAction::Clear,
            "Clear this region",
            "Removes the paint of the selected region alone. The shape stays.",
            "remove delete unpaint bare",
            &[],
        ),
        item(
            RegionAction::ToFree,
            "Make region",
            "Frees the selected region, so that it bends.",
            "copy assign free roi",
            &[],
        ),
        item(
            RegionAction::ToFixed,
            "Make fixed",
            "Fixes the selected region.",
            "copy assign pin anchor",
            &[],
        ),
        item(
            RegionAction::ToHandle,
            "Make handle",
            "Makes the selected region a new handle.",
            "copy assign",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, _| match state.settings.selected_role(state.workspace.selection.selected()) {
        None => Some("No region is selected: select a handle, or choose Paint region or Paint fixed.".into()),
        Some(Paint::Handle(id)) => {
            let handle = state.workspace.document.handle(id);
            handle.ok_or_else(|| NO_HANDLE.into()).and_then(unlocked).err()
        }
        Some(_) => state.unopened(),
    },
    action: Action::Do(|context, action| {
        let selected = context.workspace.selection.selected();
        if let Some(role) = context.settings.selected_role(selected) {
            act_on_region(context.workspace, role, action);
        }
    }),
};

/// Changes the region of a role as a whole, whichever is selected.
pub(super) const REGION_OF: Entry<(Paint, RegionAction)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, (role, action)| act_on_region(context.workspace, role, action)),
};

/// Chooses whether the parts that a reach cuts off from the body are free or fixed.
pub(super) const SET_TIPS: Entry<Tips> = Entry {
    listed: &[
        item(
            Tips::Held,
            "Fix tips",
            "Fixes the parts that a handle's reach cuts off from the body: fingertips, ears, the rest of a limb.",
            "extremity extremities limb island region pin keep",
            &[],
        ),
        item(
            Tips::ComeAlong,
            "Free tips",
            "Frees the parts that a handle's reach cuts off from the body: fingertips, ears, the rest of a limb.",
            "extremity extremities limb island region topological",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: |state, tips| {
        state.unopened().or_else(|| {
            let reason = match tips {
                Tips::Held => "The tips are already fixed.",
                Tips::ComeAlong => "The tips are already free.",
            };
            unless(state.workspace.document.tips() != *tips, reason)
        })
    },
    action: Action::Do(|context, tips| set_tips(context.workspace, tips)),
};

/// Changes the painted stiffness as a whole.
pub(super) const CHANGE_STIFFNESS: Entry<StiffnessChange> = Entry {
    listed: &[
        item(
            StiffnessChange::Blur,
            "Blur stiffness",
            "Smooths the painted stiffness.",
            "mask soften smooth rigidity",
            &[],
        ),
        item(
            StiffnessChange::Sharpen,
            "Sharpen stiffness",
            "Sharpens the borders of the painted stiffness.",
            "mask contrast harden rigidity",
            &[],
        ),
        item(
            StiffnessChange::Grow,
            "Grow stiffness",
            "Grows the painted stiffness by one ring of vertices.",
            "mask expand dilate rigidity",
            &[],
        ),
        item(
            StiffnessChange::Shrink,
            "Shrink stiffness",
            "Shrinks the painted stiffness by one ring of vertices.",
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

/// Makes the stiffness of the whole surface even.
pub(super) const CLEAR_STIFFNESS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Clear stiffness",
        "Resets the stiffness of the whole surface to 1.",
        "reset rigidity material",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| is_stiffness_painted(state),
    action: Action::Do(|context, ()| clear_stiffness(context.workspace)),
};

/// Sets the stiffness (0.001 to 1000; 1 is that of an unpainted vertex) of every vertex.
pub(super) const SET_STIFFNESS: Entry<Vec<f64>> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_open,
    action: Action::Do(|context, field| set_stiffness(context.workspace, field)),
};
