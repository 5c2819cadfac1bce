//! The size of the bending part, the unit of some options.
//!
//! It is √12 times the radius of gyration of the surface's components that have a handle: the length of a thin rod, and
//! the diagonal of the box around a ball or a square. Unlike a box around the scene, it depends neither on the axes'
//! directions nor on other components.

use glam::DVec3;
use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

use crate::Role;

/// A rod's length over its radius of gyration.
const OF_RODS: f64 = 3.464_101_615_137_754_6;

/// The size of the bending part of a problem, in world units; 0 for points in one place.
pub(crate) fn size(surface: &Surface, topology: &Topology, roles: &[Role]) -> f64 {
    let mut bends = vec![false; topology.components().len()];
    for (vertex, role) in (0..).zip(roles) {
        if matches!(role, Role::Handle(_)) {
            bends[topology.component(SurfaceVertex(vertex)) as usize] = true;
        }
    }
    let of_part = |bends: &dyn Fn(usize) -> bool| {
        let of_surface = size_of_triangles(surface, topology, bends);
        if of_surface > 0.0 {
            of_surface
        } else {
            size_of_points(surface, topology, bends)
        }
    };
    let of_handles = of_part(&|component| bends[component]);
    // Examples bend components without a handle.
    if of_handles > 0.0 {
        of_handles
    } else {
        of_part(&|_| true)
    }
}

/// Moments around a point of the part itself, so that no digits are lost far from the origin.
#[derive(Default)]
struct Moments {
    mass: f64,
    first: DVec3,
    second: f64,
}

impl Moments {
    fn add(&mut self, mass: f64, mean: DVec3, mean_square: f64) {
        self.mass += mass;
        self.first += mean * mass;
        self.second += mean_square * mass;
    }

    fn size(&self) -> f64 {
        if self.mass <= 0.0 {
            return 0.0;
        }
        let mean = self.first / self.mass;
        let square = self.second / self.mass - mean.length_squared();
        OF_RODS * square.max(0.0).sqrt()
    }
}

fn size_of_triangles(surface: &Surface, topology: &Topology, bends: &dyn Fn(usize) -> bool) -> f64 {
    let own = |corners: &&[SurfaceVertex; 3]| bends(topology.component(corners[0]) as usize);
    let mut moments = Moments::default();
    let mut origin = None;
    for corners in surface.triangles.iter().filter(own) {
        let origin = *origin.get_or_insert(surface.positions[corners[0].index()]);
        let points = corners.map(|corner| surface.positions[corner.index()] - origin);
        let sum: DVec3 = points.iter().sum();
        let squares: f64 = points.iter().map(|point| point.length_squared()).sum();
        // ∫ |x|² over a triangle is A / 12 (|a|² + |b|² + |c|² + |a + b + c|²).
        moments.add(face_area(points), sum / 3.0, (squares + sum.length_squared()) / 12.0);
    }
    moments.size()
}

fn size_of_points(surface: &Surface, topology: &Topology, bends: &dyn Fn(usize) -> bool) -> f64 {
    let own = (0..surface.positions.len()).filter(|&v| bends(topology.component(SurfaceVertex(v as u32)) as usize));
    let mut moments = Moments::default();
    let mut origin = None;
    for vertex in own {
        let origin = *origin.get_or_insert(surface.positions[vertex]);
        let point = surface.positions[vertex] - origin;
        moments.add(1.0, point, point.length_squared());
    }
    moments.size()
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DQuat, DVec3};
    use pliant_mesh::{Drawn, DrawnVertex, shapes};

    use super::size;
    use crate::Role;

    /// The size of a shape whose first component has a handle.
    fn of(drawn: Drawn) -> f64 {
        let model = shapes::model(drawn);
        let first = model.drawn.surface_vertex(DrawnVertex(0)).map_or(0, |v| v.index());
        let mut roles = vec![Role::Free; model.surface.positions.len()];
        roles[first] = Role::Handle(0);
        size(&model.surface, &model.topology, &roles)
    }

    #[test]
    fn rods_are_as_large_as_long_and_balls_and_squares_as_their_boxes() {
        let rod = shapes::moved(
            &shapes::bar(1, 1, 40),
            DAffine3::from_scale(DVec3::new(0.01, 0.01, 0.25)),
        );
        assert!((of(rod) - 10.0).abs() < 0.01);
        assert!((of(shapes::icosphere(4)) - 12.0_f64.sqrt()).abs() < 0.01);
        assert!((of(shapes::grid(9, 4)) - 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn specks_turns_and_the_place_change_nothing_and_scales_scale() {
        let limb = shapes::tube(12, 9, 4.0);
        let expected = of(limb.clone());
        let motion = DAffine3::from_rotation_translation(
            DQuat::from_rotation_x(0.7) * DQuat::from_rotation_y(1.9),
            DVec3::new(4e5, -3e6, 12.0),
        );
        assert!((of(shapes::moved(&limb, motion)) / expected - 1.0).abs() < 1e-9);
        let speck = shapes::moved(&shapes::bar(1, 1, 1), DAffine3::from_translation(DVec3::splat(1e3)));
        let bare = Drawn::once(vec![DVec3::splat(-5e4)], Vec::new());
        let beside = of(shapes::together(&[limb.clone(), speck, bare]));
        assert_eq!(beside, expected);
        let scaled = of(shapes::moved(&limb, DAffine3::from_scale(DVec3::splat(1e-3))));
        assert!((scaled / expected - 1e-3).abs() < 1e-12);
    }
}
