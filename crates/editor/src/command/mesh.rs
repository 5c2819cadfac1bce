//! Commands that change the triangles of the surface.

use pliant_mesh::SurfaceVertex;

use super::entry::{Action, Entry, Reason, Scope, State, item, unless};
use crate::cut::{CutStroke, KeptSide};
use crate::document::Paint;
use crate::stitching::MeshChange;
use crate::tool::{Context, RimUse};
use crate::workspace::stitch;

/// For commands that change the mesh: they need the whole shape, and are done one at a time.
pub(super) fn when_mesh_may_change<V>(state: &State<'_>, _: &V) -> Option<Reason> {
    let is_still = state.workspace.stitching.is_none();
    let refused = state.unopened().or_else(|| state.in_work_pose());
    refused.or_else(|| state.in_sequence()).or(unless(
        is_still,
        "A change of the mesh is under way: wait until it has ended, or stop it.",
    ))
}

/// Fills every hole.
pub(super) const FILL_HOLES: Entry<()> = Entry {
    listed: &[item(
        (),
        "Fill all holes",
        "Closes every hole of the surface smoothly; the outer border of an open sheet stays.",
        "close repair cap patch watertight scan",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, ()| stitch(context.workspace, MeshChange::FillAll)),
};

/// Fills the hole whose rim the next click takes.
pub(super) const FILL_HOLE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Fill a hole",
        "Closes the hole whose rim you click next.",
        "close repair cap patch one pick",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, ()| want_rim(context, RimUse::Fill)),
};

/// Joins two borders, which the next clicks take, by a tube.
pub(super) const BRIDGE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Bridge two borders",
        "Joins the two borders that you click next by a smooth tube.",
        "connect tube tunnel handle loops join",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, ()| want_rim(context, RimUse::Bridge { first: None })),
};

pub(super) fn want_rim(context: &mut Context<'_>, wanted: RimUse) {
    context.settings.want_nothing();
    context.settings.wants_rim = Some(wanted);
}

/// Deletes the selected region.
pub(super) const DELETE_REGION: Entry<()> = Entry {
    listed: &[item(
        (),
        "Delete region",
        "Deletes the painted vertices of the selected handle or region, with all triangles at them.",
        "cut remove erase trim",
        &[],
    )],
    scope: Scope::Document,
    unavailable: |state, ()| when_mesh_may_change(state, &()).or_else(|| painted_role(state).err()),
    action: Action::Do(|context, ()| {
        let selected = context.workspace.selection.selected();
        if let Some(role) = context.settings.selected_role(selected) {
            let painted = (0..).zip(context.workspace.document.paint());
            let deleted = painted.filter(|(_, paint)| **paint == role);
            let deleted = deleted.map(|(vertex, _)| SurfaceVertex(vertex)).collect();
            stitch(context.workspace, MeshChange::Delete(deleted));
        }
    }),
};

/// The role whose vertices can be deleted.
fn painted_role(state: &State<'_>) -> Result<Paint, Reason> {
    let role = state.settings.selected_role(state.workspace.selection.selected());
    let role = role.ok_or("No region is selected: select a handle, or choose Paint region or Paint fixed.")?;
    if let Paint::Handle(_) = role {
        state.unlocked()?;
    }
    if !state.workspace.document.paint().contains(&role) {
        return Err("Nothing is painted: paint the part to delete first.".into());
    }
    Ok(role)
}

/// Cuts along the line that the next drag draws.
pub(super) const CUT: Entry<KeptSide> = Entry {
    listed: &[
        item(
            KeptSide::Positive,
            "Cut along a line",
            "Deletes the part to the right of the line that you draw next, seen along it.",
            "plane slice trim knife",
            &[],
        ),
        item(
            KeptSide::Negative,
            "Cut along a line, the left",
            "Deletes the part to the left of the line that you draw next, seen along it.",
            "plane slice trim knife",
            &[],
        ),
        item(
            KeptSide::Both,
            "Add edges along a line",
            "Splits the triangles along the line that you draw next, and deletes nothing.",
            "plane slice knife divide both",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, kept| want_cut(context, CutStroke::Line(kept))),
};

/// Cuts along the curve on the surface that the next drag draws.
pub(super) const CUT_ALONG_CURVE: Entry<KeptSide> = Entry {
    listed: &[
        item(
            KeptSide::Positive,
            "Cut along a curve",
            "Deletes the part to the right of the curve that you draw next on the surface, seen along it.",
            "lasso outline trim knife loop",
            &[],
        ),
        item(
            KeptSide::Negative,
            "Cut along a curve, the left",
            "Deletes the part to the left of the curve that you draw next on the surface, seen along it.",
            "lasso outline trim knife loop",
            &[],
        ),
        item(
            KeptSide::Both,
            "Add edges along a curve",
            "Splits the triangles along the curve that you draw next on the surface, and deletes nothing.",
            "knife divide both loop",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, kept| want_cut(context, CutStroke::Curve(kept))),
};

fn want_cut(context: &mut Context<'_>, wanted: CutStroke) {
    context.settings.want_nothing();
    context.settings.wants_cut = Some(wanted);
}

/// Changes the mesh.
pub(super) const CHANGE_MESH: Entry<MeshChange> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, change| stitch(context.workspace, change)),
};
