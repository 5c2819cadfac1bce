//! The energy that rounding alone gives a surface.

/// Energies below this share of the surface's area are rounding.
const NOTHING: f64 = 1e-20;

/// The energy of rounding for a surface of this area and size whose coordinates reach this far.
///
/// Handles that move alike are rounded each by itself, in world coordinates, which strains the surface between them.
pub(super) fn rounding(area: f64, reach: f64, size: f64) -> f64 {
    let strain = if size > 0.0 { f64::EPSILON * reach / size } else { 0.0 };
    area * (NOTHING + strain * strain)
}
