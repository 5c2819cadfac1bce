//! The line that a handle follows.

use glam::DAffine3;
use pliant_mesh::MirrorPlane;

use super::handle_curve::HandleCurve;
use super::handle_sketch::HandleSketch;

/// The line that a handle's vertices follow before the handle's transform moves them.
#[derive(Clone, PartialEq, Debug)]
pub enum HandleLine {
    /// A curve and where it goes.
    Curve(HandleCurve),
    /// A line drawn for the outline that is seen from somewhere.
    Sketch(HandleSketch),
}

impl HandleLine {
    /// The line of a handle with at most one of both.
    pub(crate) fn of(curve: Option<&HandleCurve>, sketch: Option<&HandleSketch>) -> Option<Self> {
        let curve = curve.cloned().map(Self::Curve);
        curve.or_else(|| sketch.cloned().map(Self::Sketch))
    }

    /// The curve, if it is one.
    pub fn curve(&self) -> Option<&HandleCurve> {
        match self {
            Self::Curve(curve) => Some(curve),
            Self::Sketch(_) => None,
        }
    }

    /// The sketch, if it is one.
    pub fn sketch(&self) -> Option<&HandleSketch> {
        match self {
            Self::Curve(_) => None,
            Self::Sketch(sketch) => Some(sketch),
        }
    }

    /// Returns true if it moves nothing.
    pub fn is_rest(&self) -> bool {
        self.curve().is_some_and(HandleCurve::is_rest)
    }

    /// Its mirror image across a plane.
    pub(crate) fn mirrored(&self, plane: &MirrorPlane) -> Option<Self> {
        match self {
            Self::Curve(curve) => curve.mirrored(plane).map(Self::Curve),
            Self::Sketch(sketch) => sketch.mirrored(plane).map(Self::Sketch),
        }
    }

    /// The line of the handle at rest: a sketch has none.
    pub(crate) fn at_rest(&self) -> Option<Self> {
        self.curve().map(|curve| Self::Curve(curve.at_rest()))
    }

    /// The line of the handle whose present position, after the map `then`, becomes its rest position.
    pub(crate) fn applied(&self, then: &DAffine3) -> Option<Self> {
        self.curve().map(|curve| Self::Curve(curve.applied(then)))
    }
}
