//! Commands on the curve of the selected handle.

use super::entry::{Action, Entry, Reason, Scope, State, always, item, unless};
use crate::workspace::{
    divide_curve, pin_or_unpin_curve_points, remove_curve_points, selected_curve, set_bend_range, set_crease_width,
    sharpen_crease,
};

/// Lets the points of curves follow a dragged one at their distances, or no longer.
pub(super) const TOGGLE_CHAIN: Entry<()> = Entry {
    listed: &[item(
        (),
        "Chain",
        "Makes the other points of a curve follow a dragged one at their distances, like the joints of an arm.",
        "curve spine ik inverse kinematics",
        &[],
    )],
    scope: Scope::Tool,
    unavailable: always,
    action: Action::Do(|context, ()| context.settings.chain = !context.settings.chain),
};

/// Lets a drag of the pose brush bend a limb at all its joints, or at one.
pub(super) const TOGGLE_WHOLE_LIMB: Entry<()> = Entry {
    listed: &[item(
        (),
        "Whole limb",
        "Makes a drag with Pose bend a limb at all its joints, from the shoulder to the hand.",
        "chain ik inverse kinematics arm leg bones reach",
        &[],
    )],
    scope: Scope::Tool,
    unavailable: always,
    action: Action::Do(|context, ()| context.settings.whole_limb = !context.settings.whole_limb),
};

/// Adds control points.
pub(super) const DIVIDE_CURVE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Add curve points",
        "Adds a point after each selected point of the curve, or between all of them.",
        "subdivide insert control spline line spine",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| without_curve(state),
    action: Action::Do(|context, ()| divide_curve(context.workspace)),
};

/// Removes control points.
pub(super) const REMOVE_CURVE_POINTS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Delete curve points",
        "Removes the selected points of the curve.",
        "remove control spline line spine",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| without_curve_points(state),
    action: Action::Do(|context, ()| remove_curve_points(context.workspace)),
};

/// Pins control points, or unpins them.
pub(super) const PIN_CURVE_POINTS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Pin or unpin curve points",
        "Pins the selected points of the curve, or unpins them: a pinned point stays while *Chain* pulls another one.",
        "hold joint elbow ik inverse kinematics chain spine",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| without_curve_points(state),
    action: Action::Do(|context, ()| pin_or_unpin_curve_points(context.workspace)),
};

/// Limits the bends at control points, or at the joint of a limb's part.
pub(super) const SET_BEND_RANGE: Entry<[f64; 2]> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, _| without_joint(state),
    action: Action::Do(|context, range_deg| set_bend_range(context.workspace, range_deg)),
};

/// Sharpens or flattens the crease along the curve.
pub(super) const SHARPEN_CREASE: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, _| without_crease(state),
    action: Action::Do(|context, sharpen| sharpen_crease(context.workspace, sharpen)),
};

/// Makes the crease along the curve wider or narrower.
pub(super) const SET_CREASE_WIDTH: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: |state, _| without_crease(state),
    action: Action::Do(|context, width| set_crease_width(context.workspace, width)),
};

fn without_crease(state: &State<'_>) -> Option<Reason> {
    let curve = selected_curve(state.workspace);
    let has_crease = curve.is_some_and(|(_, curve)| curve.crease().is_some());
    let why = "The selected handle follows no crease: draw one with the shape Crease.";
    without_curve(state).or_else(|| unless(has_crease, why))
}

fn without_curve_points(state: &State<'_>) -> Option<Reason> {
    without_curve(state).or_else(|| {
        let is_selected = !state.workspace.controls.is_empty();
        unless(is_selected, "No point of the curve is selected: click one.")
    })
}

fn without_joint(state: &State<'_>) -> Option<Reason> {
    let selected = state.workspace.selected();
    match selected.is_some_and(|handle| handle.line.is_none() && handle.parent.is_some()) {
        true => state.unopened(),
        false => without_curve_points(state),
    }
}

fn without_curve(state: &State<'_>) -> Option<Reason> {
    let has_curve = selected_curve(state.workspace).is_some();
    let why = "The selected handle has no curve: draw one with the shape Curve, Spine or Crease.";
    state.unopened().or_else(|| unless(has_curve, why))
}
