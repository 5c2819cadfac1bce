//! Picking under the pointer: rays against a hierarchy that a job refits whenever the shape settles.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::{Bvh, Model, SurfaceVertex};

use super::camera::{Camera, Ray};
use super::sight::Sight;
use crate::pickable::Pickable;

/// A point of the surface under the pointer.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pick {
    /// The surface triangle.
    pub triangle: u32,
    /// The corner nearest to the point.
    pub vertex: SurfaceVertex,
    /// The point, in world space.
    pub point: DVec3,
    /// The unit normal of the triangle on the side of the hit.
    pub normal: DVec3,
    /// True if the hit is on the outer side.
    pub front: bool,
}

/// The present shape and the hierarchy for rays, which may lag behind it.
#[derive(Clone)]
pub(crate) struct Picking<'a> {
    pub(crate) model: &'a Model,
    /// Displacements of the surface from the file's shape.
    pub(crate) displacements: &'a Arc<Vec<DVec3>>,
    pub(crate) bvh: &'a Bvh,
    /// The surface's triangles that rays may hit; `None` is all of them.
    pub(crate) triangles: Option<&'a [u32]>,
    pub(crate) camera: &'a Camera,
    pub(crate) viewport_px: DVec2,
    /// The camera, prepared for many points.
    pub(crate) sight: Sight,
    /// True if the hierarchy for rays is that of the present shape.
    pub(crate) is_current: bool,
}

impl<'a> Picking<'a> {
    /// The view of a camera in a viewport.
    pub(crate) fn of(
        model: &'a Model,
        displacements: &'a Arc<Vec<DVec3>>,
        pickable: &'a Pickable,
        (camera, viewport_px): (&'a Camera, DVec2),
        is_current: bool,
    ) -> Self {
        Self {
            model,
            displacements,
            bvh: &pickable.bvh,
            triangles: pickable.shown.triangles.as_deref().map(Vec::as_slice),
            camera,
            viewport_px,
            sight: Sight::of(camera, viewport_px),
            is_current,
        }
    }

    /// The present position of a surface vertex.
    pub(crate) fn position(&self, vertex: SurfaceVertex) -> DVec3 {
        self.model.surface.positions[vertex.index()] + self.displacements[vertex.index()]
    }

    /// The present corners of a triangle.
    pub(crate) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.model.surface.triangles[triangle as usize].map(|vertex| self.position(vertex))
    }

    /// Returns true if any triangle at the vertex faces the eye with its front, or else with its back; a bare point has
    /// both.
    pub(crate) fn shows(&self, vertex: SurfaceVertex, position: DVec3, front: bool) -> bool {
        let to_eye = self.sight.towards_eye(position);
        let model = &self.model;
        let is_bare = model.topology.neighbours(vertex).is_empty();
        is_bare
            || model.topology.faces(vertex, &model.surface.triangles).any(|face| {
                let [a, b, c] = self.corners(face);
                let outward = (b - a).cross(c - a).dot(to_eye);
                if front { outward >= 0.0 } else { outward <= 0.0 }
            })
    }

    /// Returns true if nothing is between the eye and a vertex at `position`, and the surface there faces it.
    pub(crate) fn is_seen(&self, vertex: SurfaceVertex, position: DVec3, eye: DVec3) -> bool {
        if !self.shows(vertex, position, true) {
            return false;
        }
        let sight = position - eye;
        // The ray ends just before the vertex's own triangles.
        self.bvh.ray(eye, sight).is_none_or(|hit| {
            let triangle = self.of_surface(hit.triangle) as usize;
            hit.distance >= 1.0 - 1e-4 || self.model.surface.triangles[triangle].contains(&vertex)
        })
    }

    /// The surface's triangle of a hit.
    fn of_surface(&self, hit: u32) -> u32 {
        let of = self.triangles.and_then(|triangles| triangles.get(hit as usize));
        of.copied().unwrap_or(hit)
    }

    /// The first point of the surface under a point of the viewport.
    pub(crate) fn at(&self, position_px: DVec2) -> Option<Pick> {
        self.along(self.camera.ray(position_px, self.viewport_px))
    }

    /// The first point of the surface along a ray.
    pub(crate) fn along(&self, ray: Ray) -> Option<Pick> {
        let hit = self.bvh.ray(ray.origin, ray.direction)?;
        let triangle = self.of_surface(hit.triangle);
        let vertices = self.model.surface.triangles.get(triangle as usize)?;
        let corners = self.corners(triangle);
        let [u, v, w] = hit.barycentric;
        let nearest = if u >= v && u >= w {
            0
        } else if v >= w {
            1
        } else {
            2
        };
        let outward = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let front = outward.dot(ray.direction) <= 0.0;
        let facing = if front { outward } else { -outward };
        Some(Pick {
            triangle,
            vertex: vertices[nearest],
            point: corners[0] * u + corners[1] * v + corners[2] * w,
            normal: facing.normalize_or(-ray.direction),
            front,
        })
    }
}
