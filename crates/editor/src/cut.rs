//! The lines along which a shape is cut, and their sides.

use glam::DVec3;

/// A plane: the points p with `normal` · p = `distance`, in world units. The normal may have any length.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CutPlane {
    /// The normal.
    pub normal: DVec3,
    /// The distance along it.
    pub distance: f64,
}

/// A curve on the surface: points joined along it, each by the section with the plane through two of them and the
/// direction of sight.
#[derive(Clone, PartialEq, Debug)]
pub struct CutCurve {
    /// In world space, on the surface or near it.
    pub points: Vec<DVec3>,
    /// True if the last point is joined to the first; otherwise both are at a border.
    pub is_closed: bool,
    /// The direction of sight.
    pub sight: CutSight,
}

/// The direction in which a curve on the surface is seen.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum CutSight {
    /// Everywhere against the surface.
    Normals,
    /// From an eye at this place.
    From(DVec3),
    /// Along this direction.
    Along(DVec3),
}

/// The side of a plane or curve that a cut keeps.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum KeptSide {
    /// The side to which the plane's normal points, or to the left of the curve, seen from outside along it.
    #[default]
    Positive,
    /// The other one.
    Negative,
    /// Both: the surface only gets edges along the plane or curve.
    Both,
}

/// The line that the next drag draws, and the side that is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CutStroke {
    /// A straight line over the view; the positive side is to its left.
    Line(KeptSide),
    /// A curve on the surface.
    Curve(KeptSide),
}
