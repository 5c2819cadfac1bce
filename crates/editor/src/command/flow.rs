//! Commands on the flow on the surface.

use super::entry::{Action, Entry, Reason, Scope, State, character, item, unless};
use crate::document::FlowOptions;
use crate::tool::FlowBrush;

/// Begins to play, or pauses.
pub(super) const PLAY_FLOW: Entry<()> = Entry {
    listed: &[item(
        (),
        "Play or pause flow",
        "Lets the dye flow along the surface, or pauses it. A stretch of play is one step to undo.",
        "fluid dye paint run start stop animate simulate",
        &[character(' ')],
    )],
    scope: Scope::Tool,
    unavailable: |state, ()| without_surface(state),
    action: Action::Do(|context, ()| context.workspace.play_or_pause_flow()),
};

/// Pauses.
pub(super) const PAUSE_FLOW: Entry<()> = Entry {
    listed: &[],
    scope: Scope::Tool,
    unavailable: |state, ()| unless(state.workspace.flow.is_playing(), "The flow does not play."),
    action: Action::Do(|context, ()| context.workspace.pause_flow()),
};

/// Takes one step.
pub(super) const STEP_FLOW: Entry<()> = Entry {
    listed: &[item(
        (),
        "Step flow",
        "Lets the dye flow for a sixtieth of a second.",
        "fluid dye frame single",
        &[],
    )],
    scope: Scope::Tool,
    unavailable: |state, ()| without_surface(state).or_else(|| while_playing(state)),
    action: Action::Do(|context, ()| context.workspace.step_flow()),
};

/// Makes the dye vertex colours.
pub(super) const KEEP_DYE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Keep as vertex colours",
        "Makes the dye vertex colours, which are saved with the model. The fluid is clear again.",
        "fluid flow dye bake color COLOR_0 save paint",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        while_playing(state).or_else(|| {
            let has_dye = state.workspace.document.fluid().has_dye();
            unless(has_dye, "There is no dye: pour some with the Flow tool.")
        })
    },
    action: Action::Do(|context, ()| context.workspace.keep_dye()),
};

/// Makes the fluid clear.
pub(super) const CLEAR_DYE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Clear dye",
        "Removes the dye that flows, and stops the fluid. Kept vertex colours stay.",
        "fluid flow wash remove reset paint",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        while_playing(state).or_else(|| {
            let fluid = state.workspace.document.fluid();
            unless(
                fluid.dye.is_some() || fluid.velocity.is_some(),
                "The fluid is clear and rests.",
            )
        })
    },
    action: Action::Do(|context, ()| context.workspace.clear_fluid()),
};

/// Forgets the kept vertex colours.
pub(super) const REMOVE_KEPT_DYE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Remove kept colours",
        "Removes the vertex colours that were kept from the dye. The file's own colours return.",
        "fluid flow dye vertex color",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        while_playing(state).or_else(|| {
            let has_kept = state.workspace.document.fluid().kept.is_some();
            unless(has_kept, "No dye was kept as vertex colours.")
        })
    },
    action: Action::Do(|context, ()| context.workspace.forget_kept_dye()),
};

/// Chooses the forces in the flow.
pub(super) const SET_FLOW_OPTIONS: Entry<FlowOptions> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, _| state.unopened(),
    action: Action::Do(|context, options| context.workspace.set_flow_options(options)),
};

/// The flow brush's action, colour and numbers, clamped to their ranges.
pub(super) const SET_FLOW_BRUSH: Entry<FlowBrush> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: super::entry::always,
    action: Action::Do(|context, brush| {
        if let Some(brush) = brush.clamped() {
            context.settings.flow_brush = brush;
        }
    }),
};

/// The reason if nothing can flow.
fn without_surface(state: &State<'_>) -> Option<Reason> {
    state.unopened().or_else(|| {
        let model = state.workspace.model()?;
        let has_triangles = !model.surface.triangles.is_empty();
        unless(
            has_triangles,
            "This file has only points: open a file with triangles to let dye flow.",
        )
    })
}

/// The reason while a flow plays.
fn while_playing(state: &State<'_>) -> Option<Reason> {
    unless(state.workspace.flow.is_still(), "The flow plays: pause it first.")
}
