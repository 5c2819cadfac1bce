//! The numbers of a handle that a panel or a command sets: its position, turn, reach, continuity and weight.

use pliant_deform::CONTINUITY_RANGE;

use super::handles::{change_handle, count_turn, put_handle};
use super::state::Workspace;
use crate::SOFT_RANGE;
use crate::document::{HandleId, HandleTransform, Reach, is_within, rotation_of};

/// Sets a handle's transform in a separate step.
pub(crate) fn transform_handle(workspace: &mut Workspace, verb: &str, id: HandleId, transform: HandleTransform) {
    let Some(name) = workspace.document.handle(id).map(|handle| handle.name.clone()) else {
        return;
    };
    workspace.step(format!("{verb} {name}"), |workspace| {
        put_handle(workspace, id, transform)
    });
}

/// Turns a handle to these angles about x, y and z in degrees, full turns included.
pub(crate) fn set_turn(workspace: &mut Workspace, id: HandleId, turn_deg: glam::DVec3) {
    if !turn_deg.is_finite() {
        workspace.refuse("The handle's turn is not finite: enter other numbers.");
        return;
    }
    let Some(handle) = workspace.document.handle(id) else {
        return;
    };
    let HandleTransform::Trs {
        translation,
        scale,
        pivot,
        ..
    } = handle.transform
    else {
        workspace.refuse(format!(
            "{} is moved by a matrix: reset it to turn it by angles.",
            handle.name
        ));
        return;
    };
    let turned = HandleTransform::Trs {
        translation,
        rotation: rotation_of(turn_deg),
        scale,
        pivot,
    };
    workspace.step(format!("Turn {}", handle.name.clone()), |workspace| {
        put_handle(workspace, id, turned);
        count_turn(workspace, id, turn_deg);
    });
}

/// Sets a handle's reach. This changes roles: the present shape is kept.
pub(crate) fn set_reach(workspace: &mut Workspace, id: HandleId, reach: Reach) {
    let is_in_range = match reach {
        Reach::Found | Reach::Feature | Reach::Part => true,
        Reach::Bounded(size) | Reach::Creased(size) | Reach::Radii(size) | Reach::Length(size) => {
            size.is_finite() && size >= 0.0
        }
    };
    if !is_in_range {
        workspace.refuse("The reach is out of range: enter a length of at least 0.");
        return;
    }
    if workspace.document.handle(id).is_none_or(|handle| handle.reach == reach) {
        return;
    }
    workspace.jobs.drop_solves();
    workspace.change("Change reach", |document| {
        document.keep_shape();
        document.change_handle(id, |handle| handle.reach = reach);
    });
}

/// Sets the continuity with which the surface joins a handle; `None` is the painted one.
pub(crate) fn set_continuity(workspace: &mut Workspace, id: HandleId, continuity: Option<f64>) {
    if continuity.is_some_and(|value| !CONTINUITY_RANGE.contains(&value)) {
        workspace.refuse("The continuity is out of range: enter 0 (a hinge) to 2 (smooth).");
        return;
    }
    workspace.change("Change continuity", |document| {
        if document
            .handle(id)
            .is_some_and(|handle| handle.continuity != continuity)
        {
            document.unsettle_if_displaced();
            document.change_handle(id, |handle| handle.continuity = continuity);
        }
    });
}

/// Chooses the handle with which a handle rides along from now on.
pub(crate) fn set_parent(workspace: &mut Workspace, id: HandleId, parent: Option<HandleId>) {
    let handles = workspace.document.handles();
    if let Some(parent) = parent.filter(|parent| is_within(handles, *parent, id)) {
        let name = |id| workspace.document.handle(id).map_or("", |handle| handle.name.as_str());
        let sentence = match parent == id {
            true => format!("{} can't ride along with itself: choose another handle.", name(id)),
            false => format!("{} rides along with {}: choose another handle.", name(parent), name(id)),
        };
        workspace.refuse(sentence);
        return;
    }
    if workspace
        .document
        .handle(id)
        .is_some_and(|handle| handle.parent != parent)
    {
        change_handle(workspace, "Choose parent", id, |handle| handle.parent = parent);
    }
}

/// Gives a handle a weight, so that it only pulls; `None` makes it hard.
pub(crate) fn set_soft(workspace: &mut Workspace, id: HandleId, soft: Option<f64>) {
    if soft.is_some_and(|weight| !SOFT_RANGE.contains(&weight)) {
        let (least, most) = (SOFT_RANGE.start(), SOFT_RANGE.end());
        workspace.refuse(format!(
            "The soft handle's weight is out of range: enter {least} to {most}."
        ));
        return;
    }
    workspace.change("Change softness", |document| {
        if document.handle(id).is_some_and(|handle| handle.soft != soft) {
            document.unsettle_if_displaced();
            document.change_handle(id, |handle| handle.soft = soft);
        }
    });
}
