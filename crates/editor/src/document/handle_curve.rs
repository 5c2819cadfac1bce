//! A curve that a handle follows.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_mesh::{BendRange, Curve, CurveMotion, CurvePath, CurveRefused, MirrorPlane};

use super::bend_range::{FREE_BEND_DEG, is_bend_range_deg};
use super::crease::Crease;
use super::free_point::FreePoint;

/// A curve through control points at rest and where they go: each vertex of its handle moves with the frame at its
/// nearest place on the curve at rest ([`CurveMotion`]). Copies share it.
#[derive(Clone, PartialEq, Debug)]
pub struct HandleCurve(Arc<Parts>);

#[derive(Clone, PartialEq, Debug)]
struct Parts {
    motion: CurveMotion,
    path: CurvePath,
    twist_deg: Vec<f64>,
    scale: Vec<f64>,
    pinned: Vec<u32>,
    /// A range for each control point, or none if no joint has limits.
    bends_deg: Vec<[f64; 2]>,
    crease: Option<Crease>,
    snap: Option<f64>,
    free: Option<FreePoint>,
}

impl HandleCurve {
    /// The curve through `points`, in world units, which moves nothing yet.
    ///
    /// # Errors
    /// As in [`HandleCurve::new`].
    pub(crate) fn at_rest_through(points: Vec<DVec3>, is_closed: bool) -> Result<Self, (&'static str, CurveRefused)> {
        let (twist_deg, scale) = (vec![0.0; points.len()], vec![1.0; points.len()]);
        Self::new(points.clone(), is_closed, points, twist_deg, scale)
    }

    /// The curve through `points`, in world units, whose control points go to `moved` with a twist about the tangent in
    /// degrees and a scale each.
    ///
    /// # Errors
    /// The name of the list in the formats, and its fault.
    pub fn new(
        points: Vec<DVec3>,
        is_closed: bool,
        moved: Vec<DVec3>,
        twist_deg: Vec<f64>,
        scale: Vec<f64>,
    ) -> Result<Self, (&'static str, CurveRefused)> {
        let expected = points.len();
        let rest = Curve::new(points, is_closed).map_err(|refused| ("points", refused))?;
        let counts = [
            ("moved", moved.len()),
            ("twist", twist_deg.len()),
            ("scale", scale.len()),
        ];
        if let Some((list, found)) = counts.into_iter().find(|(_, found)| *found != expected) {
            return Err((list, CurveRefused::Count { found, expected }));
        }
        let motion = CurveMotion::new(rest, moved, &twist_deg, &scale);
        let motion = motion.map_err(|refused| match refused {
            CurveRefused::Twist { .. } => ("twist", refused),
            CurveRefused::Scale { .. } => ("scale", refused),
            _ => ("moved", refused),
        })?;
        let path = CurvePath::of(&motion);
        Ok(Self(Arc::new(Parts {
            motion,
            path,
            twist_deg,
            scale,
            pinned: Vec::new(),
            bends_deg: Vec::new(),
            crease: None,
            snap: None,
            free: None,
        })))
    }

    /// The same with pinned control points, by their numbers: they stay when another one is pulled as in a chain. Numbers
    /// of no point are left out.
    #[must_use]
    pub fn pinned_at(mut self, mut points: Vec<u32>) -> Self {
        let count = self.rest().points().len();
        points.retain(|point| (*point as usize) < count);
        points.sort_unstable();
        points.dedup();
        if points != self.0.pinned {
            Arc::make_mut(&mut self.0).pinned = points;
        }
        self
    }

    /// The numbers of the pinned control points, ascending.
    pub fn pinned(&self) -> &[u32] {
        &self.0.pinned
    }

    /// The same whose joints bend within limits when one of its points is pulled as in a chain: the least and the most bend
    /// at each control point in degrees, 0 where the segments before and after it are one straight line. The curve itself
    /// keeps its shape. What is no range is [`FREE_BEND_DEG`].
    #[must_use]
    pub fn bent_within(mut self, mut bends_deg: Vec<[f64; 2]>) -> Self {
        bends_deg.resize(self.rest().points().len(), FREE_BEND_DEG);
        for range in bends_deg.iter_mut().filter(|range| !is_bend_range_deg(**range)) {
            *range = FREE_BEND_DEG;
        }
        if bends_deg.iter().all(|range| *range == FREE_BEND_DEG) {
            bends_deg.clear();
        }
        if bends_deg != self.0.bends_deg {
            Arc::make_mut(&mut self.0).bends_deg = bends_deg;
        }
        self
    }

    /// The least and the most bend at a control point, in degrees.
    pub fn bend_deg(&self, point: usize) -> [f64; 2] {
        self.0.bends_deg.get(point).copied().unwrap_or(FREE_BEND_DEG)
    }

    /// The same for each control point, or nothing if no joint has limits.
    pub fn bends_deg(&self) -> &[[f64; 2]] {
        &self.0.bends_deg
    }

    /// The same in radians.
    pub(crate) fn bends_rad(&self) -> Vec<BendRange> {
        let bends = self.0.bends_deg.iter();
        bends.map(|range| range.map(f64::to_radians)).collect()
    }

    /// The same along a crease, or along none.
    #[must_use]
    pub fn creased(mut self, crease: Option<Crease>) -> Self {
        if crease != self.0.crease {
            Arc::make_mut(&mut self.0).crease = crease;
        }
        self
    }

    /// The crease along it.
    pub fn crease(&self) -> Option<Crease> {
        self.0.crease
    }

    /// The same whose control points are rough: on a surface it is along the crease or border within this distance of
    /// them, in world units.
    #[must_use]
    pub(crate) fn snapped_within(mut self, distance: Option<f64>) -> Self {
        if distance != self.0.snap {
            Arc::make_mut(&mut self.0).snap = distance;
        }
        self
    }

    /// The distance within which it is still to be put onto a crease or border ([`EditFile::resolve`](crate::EditFile::resolve)).
    pub fn snap(&self) -> Option<f64> {
        self.0.snap
    }

    /// The same with a point that is free in depth, or with none.
    #[must_use]
    pub(crate) fn freed_at(mut self, free: Option<FreePoint>) -> Self {
        if free != self.0.free {
            Arc::make_mut(&mut self.0).free = free;
        }
        self
    }

    /// The point that is free in depth.
    pub(crate) fn free_point(&self) -> Option<FreePoint> {
        self.0.free
    }

    /// How much sharper than at rest its crease is.
    fn sharpen(&self) -> f64 {
        self.crease().map_or(0.0, |crease| crease.sharpen())
    }

    /// The same with a crease that is so much sharper than at rest, if it has one.
    #[must_use]
    pub(crate) fn sharpened(self, sharpen: f64) -> Self {
        let crease = self.crease().map(|crease| crease.sharpened(sharpen));
        self.creased(crease)
    }

    /// The same with a crease as wide as that of another curve, if both have one.
    #[must_use]
    pub(crate) fn with_width_of(self, other: &Self) -> Self {
        let crease = self
            .crease()
            .zip(other.crease())
            .map(|(own, other)| other.sharpened(own.sharpen()));
        let crease = crease.or(self.crease());
        self.creased(crease)
    }

    /// Returns true if what a binding knows of both is the same: the curve at rest and the width of its crease.
    pub(crate) fn binds_as(&self, other: &Self) -> bool {
        let width = |curve: &Self| curve.crease().map(|crease| crease.width());
        self.rest() == other.rest() && width(self) == width(other)
    }

    /// Returns true if the values of one curve, as at a key, are values of the other: they rest in one place, and both or
    /// none have a crease.
    pub(crate) fn is_keyed_as(&self, other: &Self) -> bool {
        self.rest() == other.rest() && self.crease().is_some() == other.crease().is_some()
    }

    /// The curve with the pins, the limits and the crease of another one of as many points.
    #[must_use]
    pub(crate) fn with_settings_of(self, other: &Self) -> Self {
        let pinned = self.pinned_at(other.pinned().to_vec());
        pinned.bent_within(other.bends_deg().to_vec()).creased(other.crease())
    }

    /// The curve at rest.
    pub fn rest(&self) -> &Curve {
        self.0.motion.rest()
    }

    /// The positions to which the control points go.
    pub fn moved(&self) -> &[DVec3] {
        self.0.motion.moved().points()
    }

    /// The largest distance between a control point at rest and where it goes.
    pub(crate) fn largest_way(&self) -> f64 {
        let pairs = self.rest().points().iter().zip(self.moved());
        pairs.map(|(from, to)| from.distance(*to)).fold(0.0, f64::max)
    }

    /// The twist at each control point, in degrees.
    pub fn twist_deg(&self) -> &[f64] {
        &self.0.twist_deg
    }

    /// The scale at each control point.
    pub fn scale(&self) -> &[f64] {
        &self.0.scale
    }

    /// Returns true if no control point moves, turns or grows, and no crease gets sharper or flatter.
    pub fn is_rest(&self) -> bool {
        self.0.motion.is_rest() && self.sharpen() == 0.0
    }

    /// The same curve at rest.
    #[must_use]
    pub(crate) fn at_rest(&self) -> Self {
        self.resting(self.rest().points().to_vec())
    }

    /// The curve at rest where it has arrived and the map `then` has moved it.
    #[must_use]
    pub(crate) fn applied(&self, then: &DAffine3) -> Self {
        self.resting(self.moved().iter().map(|point| then.transform_point3(*point)).collect())
    }

    /// A curve through these points, which move nowhere; this one if they make none.
    fn resting(&self, points: Vec<DVec3>) -> Self {
        let resting = Self::at_rest_through(points, self.rest().is_closed());
        resting.map_or_else(|_| self.clone(), |curve| curve.with_settings_of(self).sharpened(0.0))
    }

    /// The curve with the same rest whose control points go to `moved` with these twists and scales; `None` if it would
    /// be no curve.
    pub(crate) fn with(&self, moved: Vec<DVec3>, twist_deg: Vec<f64>, scale: Vec<f64>) -> Option<Self> {
        let rest = self.rest();
        let curve = Self::new(rest.points().to_vec(), rest.is_closed(), moved, twist_deg, scale).ok()?;
        Some(curve.with_settings_of(self))
    }

    /// Its mirror image across a plane.
    pub(crate) fn mirrored(&self, plane: &MirrorPlane) -> Option<Self> {
        let mirrored = |points: &[DVec3]| points.iter().map(|point| plane.mirrored(*point)).collect();
        let rest = self.rest();
        let twist_deg = self.twist_deg().iter().map(|twist| -twist).collect();
        let points = mirrored(rest.points());
        let moved = mirrored(self.moved());
        let curve = Self::new(points, rest.is_closed(), moved, twist_deg, self.scale().to_vec()).ok()?;
        let free = self.free_point().map(|free| FreePoint {
            along: plane.mirrored_vector(free.along),
            ..free
        });
        Some(curve.with_settings_of(self).freed_at(free))
    }

    /// The largest turn or twist of a part of the curve, in radians.
    pub fn largest_turn_rad(&self) -> f64 {
        self.0.path.largest_turn_rad()
    }

    /// The turn with which the surroundings of a place have come from rest, as in [`CurvePath::turn_rad`].
    pub(crate) fn turn_rad(&self, place: f64) -> DVec3 {
        self.0.path.turn_rad(&self.0.motion, place)
    }

    /// The curve at the share `t` of its way ([`motion_at`](Self::motion_at)).
    pub(crate) fn part(&self, t: f64) -> Self {
        if t == 1.0 {
            return self.clone();
        }
        let twist = self.twist_deg().iter().map(|twist| twist * t).collect();
        let scale = self.scale().iter().map(|scale| 1.0 + (scale - 1.0) * t).collect();
        self.with(self.0.path.points_at(t), twist, scale)
            .unwrap_or_else(|| self.clone())
            .sharpened(self.sharpen() * t)
    }

    /// The motion at the share `t` of the way, 0 at rest and 1 at the targets: chords turn, twists grow linearly and so do
    /// scales.
    pub fn motion_at(&self, t: f64) -> CurveMotion {
        // Only a closed curve can come together on its way, where two of its points meet by chance.
        self.part(t).0.motion.clone()
    }
}
