//! The firmness of a brush between its middle and its rim.

/// The firmness at a share of the radius: 1 inside, 0 at the rim, and a smooth step between. `falloff` is the width of
/// the step, as a share of the radius.
pub(super) fn firmness(falloff: f64, share: f64) -> f64 {
    let inner = 1.0 - falloff;
    if share <= inner || falloff == 0.0 {
        return 1.0;
    }
    let t = ((1.0 - share) / falloff).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
