//! Transforms with and without pivots of their own: within a document a handle has the pivot.

use crate::HandleTransform;
use crate::document::Handle;
use glam::DVec3;

/// The transform without its own pivot, which the handle has within a document.
pub(crate) fn without_pivot(transform: HandleTransform) -> HandleTransform {
    pivoted(transform, None)
}

/// The handle's transform with the handle's pivot.
pub(crate) fn with_pivot(handle: &Handle) -> HandleTransform {
    pivoted(handle.transform, Some(handle.pivot))
}

/// The transform with this pivot. A matrix has no pivot and does not change.
pub(super) fn pivoted(transform: HandleTransform, pivot: Option<DVec3>) -> HandleTransform {
    match transform {
        HandleTransform::Trs {
            translation,
            rotation,
            scale,
            ..
        } => HandleTransform::Trs {
            translation,
            rotation,
            scale,
            pivot,
        },
        HandleTransform::Matrix(_) => transform,
    }
}
