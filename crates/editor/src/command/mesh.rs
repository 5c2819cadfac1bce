//! Commands that change the triangles of the surface.

use super::entry::{Action, Entry, Reason, Scope, State, item, unless};
use crate::stitching::MeshChange;
use crate::tool::RimUse;
use crate::workspace::stitch;

/// For commands that change the mesh: they need the whole shape, and are done one at a time.
fn when_mesh_may_change<V>(state: &State<'_>, _: &V) -> Option<Reason> {
    let is_still = state.workspace.stitching.is_none();
    state.unopened().or_else(|| state.in_work_pose()).or(unless(
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
    action: Action::Do(|context, ()| context.settings.wants_rim = Some(RimUse::Fill)),
};

/// Changes the mesh.
pub(super) const CHANGE_MESH: Entry<MeshChange> = Entry {
    listed: &[],
    scope: Scope::Document,
    unavailable: when_mesh_may_change,
    action: Action::Do(|context, change| stitch(context.workspace, change)),
};
