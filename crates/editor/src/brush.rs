//! The brush: a disc of constant size on the screen that lies on the surface.
//!
//! Between two pointer events it is set down often enough that no gap is left. Each time it takes every vertex within
//! its radius that is connected, within that radius, with the point under the pointer, and that faces the eye: the
//! back of a thin part and a neighbouring finger stay clean.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use pliant_mesh::SurfaceVertex;

use crate::picking::{Pick, Picking};

/// The smallest and largest radius, in points.
pub const BRUSH_RADIUS_PX: std::ops::RangeInclusive<f64> = 2.0..=400.0;
/// Where the brush is set down again, as a share of its radius: the scallops left are below 1% of the radius.
const SPACING: f64 = 0.25;
const RING_SEGMENTS: usize = 48;

/// Finds the vertices under the brush; keeps its memory between dabs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Brush {
    /// The number of the dab in which a vertex was seen last.
    seen: Vec<u32>,
    dab: u32,
    stack: Vec<SurfaceVertex>,
}

impl Brush {
    /// Calls `visit` for every vertex under the brush as it goes from one point of the viewport to another; vertices
    /// may be visited more than once.
    pub(crate) fn stroke(
        &mut self,
        picking: &Picking<'_>,
        from_px: DVec2,
        to_px: DVec2,
        radius_px: f64,
        mut visit: impl FnMut(SurfaceVertex),
    ) {
        let steps = ((to_px - from_px).length() / (radius_px * SPACING).max(1.0))
            .ceil()
            .max(1.0) as u32;
        for step in 1..=steps {
            let position_px = from_px.lerp(to_px, f64::from(step) / f64::from(steps));
            self.dab(picking, position_px, radius_px, &mut visit);
        }
    }

    /// Calls `visit` once for every vertex under the brush at a point of the viewport.
    pub(crate) fn dab(
        &mut self,
        picking: &Picking<'_>,
        position_px: DVec2,
        radius_px: f64,
        visit: &mut impl FnMut(SurfaceVertex),
    ) {
        let Some(pick) = picking.at(position_px) else { return };
        let radius = radius_px * picking.camera.world_per_px(pick.point, picking.viewport_px);
        self.begin(picking.model.surface.positions.len());
        // However small the brush and large the triangles, something is painted: the nearest corner.
        visit(pick.vertex);
        for vertex in picking.model.surface.triangles[pick.triangle as usize] {
            self.reach(picking, &pick, radius, vertex);
        }
        while let Some(vertex) = self.stack.pop() {
            visit(vertex);
            for &neighbour in picking.model.topology.neighbours(vertex) {
                self.reach(picking, &pick, radius, neighbour);
            }
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
        if position.distance_squared(pick.point) <= radius * radius && faces(picking, vertex, position, pick.front) {
            self.stack.push(vertex);
        }
    }
}

/// Whether any triangle at the vertex shows the eye the side that was met.
fn faces(picking: &Picking<'_>, vertex: SurfaceVertex, position: DVec3, front: bool) -> bool {
    let sight = position - picking.camera.eye();
    picking.model.topology.faces(vertex).iter().any(|&face| {
        let [a, b, c] = picking.corners(face);
        let outward = (b - a).cross(c - a).dot(sight);
        if front { outward <= 0.0 } else { outward >= 0.0 }
    })
}

/// The brush's outline on the surface around a pick, a closed line; where the surface ends it runs on in the plane
/// of the screen.
pub(crate) fn ring(picking: &Picking<'_>, position_px: DVec2, pick: &Pick, radius_px: f64) -> Vec<DVec3> {
    let px = picking.camera.world_per_px(pick.point, picking.viewport_px);
    let radius = radius_px * px;
    // Lifted towards the eye, so that the surface does not swallow it.
    let lifted = |point: DVec3| point + (picking.camera.eye() - point).normalize_or_zero() * px;
    (0..RING_SEGMENTS)
        .map(|step| {
            let angle_rad = TAU * step as f64 / RING_SEGMENTS as f64;
            let offset_px = DVec2::from_angle(angle_rad) * radius_px;
            let ray = picking.camera.ray(position_px + offset_px, picking.viewport_px);
            let on_surface = picking.along(ray).map(|pick| pick.point);
            let near = on_surface.filter(|point| point.distance(pick.point) <= 2.5 * radius);
            lifted(near.unwrap_or_else(|| {
                let forward = picking.camera.forward();
                ray.origin + ray.direction * ((pick.point - ray.origin).dot(forward) / ray.direction.dot(forward))
            }))
        })
        .collect()
}
