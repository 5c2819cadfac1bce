//! Commands on the parts that the selected handle holds: they are mirrored and merged.

use super::entry::{Action, Entry, Reason, Scope, State, always, item, unless};
use super::mesh::{want_rim, when_mesh_may_change};
use crate::stitching::{MergeSettings, REACH_RANGE};
use crate::tool::RimUse;
use crate::workspace::{held_parts, merge_held, mirror_held};

/// For commands on the part that the selected handle holds.
fn when_part_is_held<V>(state: &State<'_>, values: &V) -> Option<Reason> {
    let is_held = || !held_parts(state.workspace).is_empty();
    when_mesh_may_change(state, values)
        .or_else(|| state.unlocked().err())
        .or_else(|| {
            unless(
                is_held(),
                "The selected handle holds no whole part: append a file, or select its handle.",
            )
        })
}

/// Mirrors the part that the selected handle holds, across axis 0, 1, 2 of the handle for x, y, z.
pub(super) const MIRROR_PART: Entry<usize> = Entry {
    listed: &[
        item(
            0,
            "Mirror part in x",
            "Mirrors the part that the selected handle holds, left and right.",
            "flip reflect append",
            &[],
        ),
        item(
            1,
            "Mirror part in y",
            "Mirrors the part that the selected handle holds, up and down.",
            "flip reflect append",
            &[],
        ),
        item(
            2,
            "Mirror part in z",
            "Mirrors the part that the selected handle holds, front and back.",
            "flip reflect append",
            &[],
        ),
    ],
    scope: Scope::Document,
    unavailable: when_part_is_held,
    action: Action::Do(|context, axis| mirror_held(context.workspace, axis)),
};

/// Joins the part that the selected handle holds to the others, at the nearest borders.
pub(super) const MERGE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Merge nearest borders",
        "Joins the part that the selected handle holds to the other parts, where borders are nearest.",
        "join stitch combine append weld",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_part_is_held,
    action: Action::Do(|context, ()| {
        let settings = context.settings.merge.clone();
        merge_held(context.workspace, &[], settings);
    }),
};

/// Joins the part that the selected handle holds to the others, at pairs of places that the next clicks take.
pub(super) const MERGE_PAIRS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Merge at places",
        "Joins borders at pairs of places that you click, first on one side, then on the other; Enter ends.",
        "join stitch combine append pick pair points correspondence",
        &[],
    )],
    scope: Scope::Document,
    unavailable: when_part_is_held,
    action: Action::Do(|context, ()| want_rim(context, RimUse::Merge { first: None })),
};

/// Chooses how parts are merged.
pub(super) const SET_MERGE: Entry<MergeSettings> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, settings| {
        if settings.reach.is_finite() {
            let reach = settings.reach.clamp(*REACH_RANGE.start(), *REACH_RANGE.end());
            context.settings.merge = MergeSettings { reach, ..settings };
        }
    }),
};
