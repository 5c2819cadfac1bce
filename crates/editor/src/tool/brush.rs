//! The brush: a disc of constant size on the screen, on the surface.
//!
//! Between two pointer events there are enough dabs to leave no gap. A dab paints every vertex within its radius that
//! is connected, within that radius, with the point under the pointer and that faces the eye: it does not paint the
//! back of a thin part and a neighbouring finger. A brush that closes round limbs paints their backs, too.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4};
use pliant_mesh::{DistanceSearch, SurfaceVertex};

use crate::view::{Pick, Picking};

/// The smallest and largest radius, in points.
pub const BRUSH_RADIUS_PX: std::ops::RangeInclusive<f64> = 2.0..=400.0;
/// The distance between dabs, as a share of the radius: the remaining scallops are below 1% of the radius.
const SPACING: f64 = 0.25;
const RING_SEGMENTS: usize = 48;
/// The way around half of a limb as thick as the brush, in radii of the brush.
const HALF_TURN: f64 = std::f64::consts::PI;

/// The measure of the brush's radius.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum BrushMetric {
    /// The vertices under the disc on the screen, if they are connected and face the eye.
    #[default]
    Screen,
    /// The vertices under the disc on the screen, visible or not, that are as near along the surface as the back of a
    /// limb as thick as the brush: it closes round limbs, fills folds, and leaves other limbs behind it alone.
    Round,
    /// The vertices within the radius along the surface: into folds and around edges, visible or not.
    Surface,
    /// Everything under the disc, through to the back of the model.
    Through,
}

/// The size of the brush, and its measure.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct BrushSize {
    pub(crate) radius_px: f64,
    pub(crate) metric: BrushMetric,
}

impl BrushSize {
    /// The same with this share of the radius.
    pub(crate) fn scaled(self, share: f64) -> Self {
        Self {
            radius_px: self.radius_px * share,
            ..self
        }
    }
}

/// Finds the vertices under the brush; keeps its memory between dabs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Brush {
    /// The number of the last dab that visited a vertex.
    seen: Vec<u32>,
    dab: u32,
    stack: Vec<(SurfaceVertex, f64)>,
    search: DistanceSearch,
}

impl Brush {
    /// Calls `visit` for every vertex under the brush as it moves from the first of these points of the viewport to the
    /// others, with its distance from the brush's middle as a share of the radius; vertices may be visited more than once.
    pub(crate) fn stroke(
        &mut self,
        picking: &Picking<'_>,
        way_px: &[DVec2],
        size: &BrushSize,
        mut visit: impl FnMut(SurfaceVertex, f64),
    ) {
        // A pick needs a surface, which points don't have.
        let is_of_points = picking.model.surface.triangles.is_empty();
        if is_of_points || size.metric == BrushMetric::Through {
            let moves = way_px.windows(2);
            return moves.for_each(|ends| sweep(picking, [ends[0], ends[1]], size.radius_px, &mut visit));
        }
        let places_px = way_px.windows(2).flat_map(|ends| {
            let (from_px, to_px) = (ends[0], ends[1]);
            let steps = ((to_px - from_px).length() / (size.radius_px * SPACING).max(1.0))
                .ceil()
                .max(1.0) as u32;
            (1..=steps).map(move |step| from_px.lerp(to_px, f64::from(step) / f64::from(steps)))
        });
        let picks = places_px.filter_map(|position_px| picking.at(position_px));
        match size.metric {
            BrushMetric::Screen | BrushMetric::Through => {
                picks.for_each(|pick| self.dab(picking, &pick, size.radius_px, &mut visit))
            }
            BrushMetric::Surface => {
                let picks: Vec<Pick> = picks.collect();
                self.along_surface(picking, &picks, size.radius_px, &mut visit);
            }
            BrushMetric::Round => {
                let picks: Vec<Pick> = picks.collect();
                let path = Path(way_px);
                self.along_surface(picking, &picks, HALF_TURN * size.radius_px, &mut |vertex, _| {
                    let seen_px = picking.sight.project(picking.position(vertex));
                    let off_px = seen_px.map_or(f64::INFINITY, |seen_px| path.distance(seen_px));
                    // The corners of a triangle larger than the brush are painted anyway.
                    if off_px <= size.radius_px || picks.iter().any(|pick| pick.vertex == vertex) {
                        visit(vertex, (off_px / size.radius_px).min(1.0));
                    }
                });
            }
        }
    }

    /// Calls `visit` once for every vertex under the brush around a point of the surface.
    fn dab(&mut self, picking: &Picking<'_>, pick: &Pick, radius_px: f64, visit: &mut impl FnMut(SurfaceVertex, f64)) {
        let radius = radius_px * picking.camera.world_per_px(pick.point, picking.viewport_px);
        self.begin(picking.model.surface.positions.len());
        // Even if the brush is smaller than the triangles, the nearest corner is painted.
        visit(pick.vertex, 0.0);
        for vertex in picking.model.surface.triangles[pick.triangle as usize] {
            self.reach(picking, pick, radius, vertex);
        }
        while let Some((vertex, share)) = self.stack.pop() {
            visit(vertex, share);
            for &neighbour in picking.model.topology.neighbours(vertex) {
                self.reach(picking, pick, radius, neighbour);
            }
        }
    }

    /// The same around all points of a movement at once, along the surface, in one search for any number of points.
    fn along_surface(
        &mut self,
        picking: &Picking<'_>,
        picks: &[Pick],
        radius_px: f64,
        visit: &mut impl FnMut(SurfaceVertex, f64),
    ) {
        let Some(middle) = picks.last() else { return };
        let radius = radius_px * picking.camera.world_per_px(middle.point, picking.viewport_px);
        let mut seeds: Vec<(SurfaceVertex, f64)> = Vec::with_capacity(3 * picks.len());
        for pick in picks {
            visit(pick.vertex, 0.0);
            let corners = picking.model.surface.triangles[pick.triangle as usize];
            seeds.extend(corners.map(|v| (v, picking.position(v).distance(pick.point))));
        }
        let (triangles, topology) = (&picking.model.surface.triangles, &picking.model.topology);
        let (rest, moved) = (&*picking.model.surface.positions, picking.displacements.as_slice());
        let position = |v: SurfaceVertex| rest[v.index()] + moved[v.index()];
        let reached = self.search.within(triangles, topology, position, &seeds, radius);
        for &(vertex, distance) in reached {
            visit(vertex, distance / radius);
        }
    }

    fn begin(&mut self, vertex_count: usize) {
        if self.seen.len() != vertex_count || self.dab == u32::MAX {
            self.seen = vec![0; vertex_count];
            self.dab = 0;
        }
        self.dab += 1;
        self.stack.clear();
    }

    fn reach(&mut self, picking: &Picking<'_>, pick: &Pick, radius: f64, vertex: SurfaceVertex) {
        let seen = &mut self.seen[vertex.index()];
        if *seen == self.dab {
            return;
        }
        *seen = self.dab;
        let position = picking.position(vertex);
        let distance = position.distance(pick.point);
        if distance <= radius && picking.shows(vertex, position, pick.front) {
            self.stack.push((vertex, distance / radius));
        }
    }
}

/// The way of the brush's middle between pointer events, segments in the viewport.
struct Path<'a>(&'a [DVec2]);

impl Path<'_> {
    /// The distance of a point from it, in points.
    fn distance(&self, px: DVec2) -> f64 {
        let distances = self.0.windows(2).map(|ends| {
            let (from_px, to_px) = (ends[0], ends[1]);
            let along = to_px - from_px;
            let length_squared = along.length_squared();
            let share = if length_squared > 0.0 {
                ((px - from_px).dot(along) / length_squared).clamp(0.0, 1.0)
            } else {
                0.0
            };
            px.distance(from_px + along * share)
        });
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// Calls `visit` once for every vertex that appears within `radius_px` of the path from one point of the viewport to
/// the other, even if it is hidden.
fn sweep(
    picking: &Picking<'_>,
    [from_px, to_px]: [DVec2; 2],
    radius_px: f64,
    mut visit: impl FnMut(SurfaceVertex, f64),
) {
    let ends_px = [from_px, to_px];
    let path = Path(&ends_px);
    let mut meet = |vertex: SurfaceVertex, position: DVec3| {
        let Some(seen_px) = picking.sight.project(position) else {
            return;
        };
        let off_px = path.distance(seen_px);
        if off_px <= radius_px {
            visit(vertex, off_px / radius_px);
        }
    };
    // The hierarchy of an earlier shape would miss vertices that have moved under the brush.
    if picking.is_current {
        let planes = tube(picking, from_px, to_px, radius_px);
        picking.bvh.vertices_within(&planes, meet);
    } else {
        let every = (0..picking.model.surface.positions.len() as u32).map(SurfaceVertex);
        every.for_each(|vertex| meet(vertex, picking.position(vertex)));
    }
}

/// The planes around the vertices that appear in the rectangle around the path of a disc, their normals inwards.
fn tube(picking: &Picking<'_>, from_px: DVec2, to_px: DVec2, radius_px: f64) -> [DVec4; 4] {
    let along = (to_px - from_px).normalize_or(DVec2::X) * radius_px;
    let across = along.perp();
    let corners = [
        from_px - along - across,
        to_px + along - across,
        to_px + along + across,
        from_px - along + across,
    ];
    let ray = |position_px: DVec2| picking.camera.ray(position_px, picking.viewport_px);
    let middle = ray(0.5 * (from_px + to_px));
    std::array::from_fn(|corner| {
        let (here, next) = (ray(corners[corner]), ray(corners[(corner + 1) % 4]));
        let side = next.origin + next.direction - here.origin;
        let normal = side.cross(here.direction).normalize_or_zero();
        let plane = normal.extend(-normal.dot(here.origin));
        let is_inside = plane.dot((middle.origin + middle.direction).extend(1.0)) >= 0.0;
        if is_inside { plane } else { -plane }
    })
}

/// The brush's outline around a pick, a closed line. A brush that reaches through is a circle on the screen; any other
/// is on the surface, in the mean plane of the covered part. Beyond the end of the surface the line continues in the
/// brush's own plane.
pub(crate) fn ring(picking: &Picking<'_>, position_px: DVec2, pick: &Pick, size: &BrushSize) -> Vec<DVec3> {
    let px = picking.camera.world_per_px(pick.point, picking.viewport_px);
    let radius = size.radius_px * px;
    let axes = picking.camera.axes();
    let normal = match size.metric {
        BrushMetric::Through => axes.z_axis,
        BrushMetric::Screen | BrushMetric::Round | BrushMetric::Surface => {
            leaning(picking, position_px, pick, size.radius_px, radius)
        }
    };
    let (right, up) = normal.any_orthonormal_pair();
    // It is moved towards the eye, so that the surface does not hide it.
    let lifted = |point: DVec3| point + picking.camera.towards_eye(point) * px;
    (0..RING_SEGMENTS)
        .map(|step| {
            let angle_rad = TAU * step as f64 / RING_SEGMENTS as f64;
            let in_plane = pick.point + (right * angle_rad.cos() + up * angle_rad.sin()) * radius;
            let seen_px = picking.sight.project(in_plane);
            let ray = seen_px.map(|seen_px| picking.camera.ray(seen_px, picking.viewport_px));
            let on_surface = ray.and_then(|ray| picking.along(ray)).map(|pick| pick.point);
            let near = on_surface.filter(|point| point.distance(pick.point) <= 2.5 * radius);
            lifted(near.unwrap_or(in_plane))
        })
        .collect()
}

/// The mean normal of the visible surface under the brush, so that a rough scan does not make the ring flicker.
fn leaning(picking: &Picking<'_>, position_px: DVec2, pick: &Pick, radius_px: f64, radius: f64) -> DVec3 {
    const SAMPLES: usize = 12;
    let around = (0..SAMPLES).filter_map(|sample| {
        let angle_rad = TAU * sample as f64 / SAMPLES as f64;
        let share = if sample % 2 == 0 { 0.4 } else { 0.75 };
        picking.at(position_px + DVec2::from_angle(angle_rad) * radius_px * share)
    });
    let near = around.filter(|other| other.point.distance(pick.point) <= radius);
    let sum: DVec3 = near.map(|other| other.normal).sum();
    (sum + pick.normal).normalize_or(pick.normal)
}
