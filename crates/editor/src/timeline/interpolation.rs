//! A transform between two others.

use crate::document::SplitTransform;

/// The transform at a share of the way: vectors linearly, the rotation by slerp, the short way round.
pub(super) fn between(from: &SplitTransform, to: &SplitTransform, share: f64) -> SplitTransform {
    let turned = match from.rotation.dot(to.rotation) < 0.0 {
        true => -to.rotation,
        false => to.rotation,
    };
    SplitTransform {
        pivot: from.pivot.lerp(to.pivot, share),
        translation: from.translation.lerp(to.translation, share),
        rotation: from.rotation.slerp(turned, share).normalize(),
        stretch: from.stretch * (1.0 - share) + to.stretch * share,
    }
}
