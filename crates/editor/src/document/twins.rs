//! Making two handles each other's mirror image.

use pliant_mesh::MirrorPlane;

use super::handle::{HandleId, PivotPlace, Twin};
use super::mirror_plane::mirrored_transform;
use super::state::Document;

/// Makes `other`, which has its vertices, the twin of `id` across a plane: it gets its name, its mirrored pivot, its
/// reach and softness, and its mirrored transform.
pub(crate) fn link_twins(document: &mut Document, id: HandleId, other: HandleId, plane: MirrorPlane) {
    let first = document.change_handle(id, |first| {
        first.twin = Some(Twin { handle: other, plane });
        first.clone()
    });
    let Some(first) = first else { return };
    document.change_handle(other, |second| {
        second.name = format!("{} twin", first.name);
        second.reach = first.reach;
        second.pivot = plane.mirrored(first.pivot);
        // Mirrored motion needs mirrored pivots.
        second.pivot_place = PivotPlace::Picked;
        second.soft = first.soft;
        second.twin = Some(Twin { handle: id, plane });
    });
    // The twin is known to be at rest; from there it gets its other half's mirrored transform.
    document.keep_shape();
    if first.is_displaced() {
        let mirrored = mirrored_transform(&plane, first.transform, first.pivot);
        document.change_handle(other, |second| second.put(mirrored));
        document.unsettle();
    }
}
