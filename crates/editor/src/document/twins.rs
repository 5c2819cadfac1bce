//! Making two handles each other's mirror image.

use pliant_mesh::MirrorPlane;

use super::handle::{HandleId, PivotPlace, Twin};
use super::handle_curve::HandleCurve;
use super::handle_line::HandleLine;
use super::mirror_plane::mirrored_transform;
use super::state::Document;

/// Makes `other`, which has its vertices, the twin of `id` across a plane: it gets its name, its mirrored pivot, its
/// reach and softness, its joint's limits, its mirrored free direction, and its mirrored transform.
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
        second.bend_deg = first.bend_deg;
        second.free_along = first.free_along.map(|direction| plane.mirrored_vector(direction));
        second.line = first.line.as_ref().and_then(|line| line.mirrored(&plane));
        second.twin = Some(Twin { handle: id, plane });
    });
    // The twin is known to be at rest; from there it gets its other half's mirrored transform. A sketch has no rest, and
    // the next shape is on its line.
    if first.line.as_ref().and_then(HandleLine::sketch).is_none() {
        document.keep_shape();
    }
    if first.is_displaced() {
        let mirrored = mirrored_transform(&plane, first.transform, first.pivot);
        document.change_handle(other, |second| second.put(mirrored));
        document.unsettle();
    }
}

/// Gives a handle a curve, and its twin the mirror image if that follows a curve, too.
pub(crate) fn put_curve(document: &mut Document, id: HandleId, curve: HandleCurve) {
    let twin = document.handle(id).and_then(|handle| handle.twin);
    if let Some(Twin { handle, plane }) = twin
        && let Some(mirrored) = curve.mirrored(&plane)
    {
        document.change_handle(handle, |twin| {
            twin.line = twin.line.is_some().then_some(HandleLine::Curve(mirrored));
        });
    }
    document.unsettle();
    document.change_handle(id, |handle| handle.line = Some(HandleLine::Curve(curve)));
}
