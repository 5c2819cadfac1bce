//! Commands on the method's examples.

use pliant_deform::ExampleShape;

use super::entry::{Action, Entry, Reason, Scope, State, item, unless};
use crate::workspace::{add_example, keep_example, remove_example, rename_example, set_example_weight};

/// Keeps the present shape as a further example.
pub(super) const KEEP_EXAMPLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Keep as example",
        "Keeps the present shape as an example for the methods \"Cloth\" and \"Wrinkles\".",
        "pose shape blend morph interpolate in-between example",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| {
        without_examples(state).or_else(|| {
            let document = &state.workspace.document;
            let is_bent = document.is_displaced();
            unless(is_bent, "Nothing is bent yet: move a handle first.")
        })
    },
    action: Action::Do(|context, ()| keep_example(context.workspace)),
};

/// Adds a shape as a further example.
pub(super) const ADD_EXAMPLE: Entry<ExampleShape> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, shape| {
        without_examples(state).or_else(|| {
            let fits = shape.displacements.len() == state.workspace.document.rest().len();
            unless(fits, "This example belongs to another mesh.")
        })
    },
    action: Action::Do(|context, shape| add_example(context.workspace, shape)),
};

/// Sets the weight of an example, by its place in the list; with `None` the solver finds it.
pub(super) const SET_EXAMPLE_WEIGHT: Entry<(usize, Option<f64>)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (place, _)| gone(state, *place),
    action: Action::Do(|context, (place, weight)| set_example_weight(context.workspace, place, weight)),
};

/// Renames an example.
pub(super) const RENAME_EXAMPLE: Entry<(usize, String)> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, (place, _)| gone(state, *place),
    action: Action::Do(|context, (place, name)| rename_example(context.workspace, place, name)),
};

/// Removes an example.
pub(super) const REMOVE_EXAMPLE: Entry<usize> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, place| gone(state, *place),
    action: Action::Do(|context, place| remove_example(context.workspace, place)),
};

/// The message if the method takes no examples.
pub const WITHOUT_EXAMPLES: &str = "The method takes no examples: choose \"Cloth\" or \"Wrinkles\".";

/// The reason if the method takes no examples.
fn without_examples(state: &State<'_>) -> Option<Reason> {
    state.unopened().or_else(|| {
        let are_taken = state.workspace.document.examples_name().is_some();
        unless(are_taken, WITHOUT_EXAMPLES)
    })
}

fn gone(state: &State<'_>, place: usize) -> Option<Reason> {
    without_examples(state).or_else(|| {
        let examples = state.workspace.document.examples();
        let is_there = examples.is_some_and(|examples| place < examples.shapes.len());
        unless(is_there, "This example no longer exists.")
    })
}
