//! Places where connected components touch one another: the part under a rivet, a buckle or an eye.
//!
//! A component touches another if its vertices are within a small distance, a share of its own size, of the other's
//! triangles. The areas of those vertices measure the contact. Distances are to triangles, not to their corners: a
//! small part on a coarse plate is far from every corner of it.

use glam::DVec3;
use rayon::prelude::*;

use crate::{Bvh, Cancel, Cancelled, Surface, SurfaceVertex, Topology, face_area};

/// A place where a component touches another.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Contact {
    /// The other component's vertex next to that place.
    pub place: SurfaceVertex,
    /// The distance between the two, in world units.
    pub distance: f64,
    /// The component's area that touches there, in square world units.
    pub area: f64,
}

/// A component touches everything within this share of the half diagonal of its own bounding box.
const TOUCH: f64 = 0.1;

/// At most this many vertices of a component are tested, evenly spread over their order in the file. With the distance
/// above, testing every vertex of a large component would visit most of its own triangles each time.
const SAMPLES: usize = 512;

/// The area of each component, in square world units.
pub fn component_areas(surface: &Surface, topology: &Topology) -> Vec<f64> {
    let mut areas = vec![0.0; topology.components().len()];
    for corners in &surface.triangles {
        areas[topology.component(corners[0]) as usize] +=
            face_area(corners.map(|corner| surface.positions[corner.index()]));
    }
    areas
}

/// The places where each of the components `of` touches others for which `may_hold(component, other)` is true and whose
/// triangles are in `tree`, a hierarchy over this surface; empty for a component that touches none. A vertex next to
/// several touches the nearest.
///
/// # Errors
/// It was cancelled.
pub fn contacts(
    surface: &Surface,
    topology: &Topology,
    tree: &Bvh,
    of: &[u32],
    may_hold: impl Fn(u32, u32) -> bool + Sync,
    cancel: &Cancel,
) -> Result<Vec<Vec<Contact>>, Cancelled> {
    let touching = |&component: &u32| {
        cancel.check()?;
        Ok(contacts_of(component, surface, topology, tree, &may_hold))
    };
    of.par_iter().map(touching).collect()
}

fn contacts_of(
    component: u32,
    surface: &Surface,
    topology: &Topology,
    tree: &Bvh,
    may_hold: impl Fn(u32, u32) -> bool,
) -> Vec<Contact> {
    let vertices = topology.vertices_of(component);
    let position = |vertex: SurfaceVertex| surface.positions[vertex.index()];
    let (low, high) = vertices
        .clone()
        .map(position)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
            (low.min(point), high.max(point))
        });
    let limit = TOUCH * 0.5 * low.distance(high);
    let stride = vertices.len().div_ceil(SAMPLES).max(1);
    let is_meant = |vertex: SurfaceVertex| {
        let other = topology.component(vertex);
        other != component && may_hold(component, other)
    };
    let area = |vertex: SurfaceVertex| -> f64 {
        let faces = topology.faces(vertex, &surface.triangles);
        let areas = faces.map(|face| face_area(surface.triangles[face as usize].map(position)));
        areas.sum::<f64>() / 3.0 * stride as f64
    };
    let contact = |vertex: SurfaceVertex| {
        let (place, distance) = tree.nearest_on_triangles(position(vertex), limit, is_meant)?;
        Some(Contact {
            place,
            distance,
            area: area(vertex),
        })
    };
    vertices.step_by(stride).filter_map(contact).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::*;
    use crate::shapes;

    /// A cube of this edge whose lowest point is `foot`.
    fn cube(edge: f64, foot: DVec3) -> crate::Drawn {
        let (low, high) = {
            let bounds = crate::bounding_box(&shapes::bar(2, 2, 2).positions).unwrap();
            (bounds.min, bounds.max)
        };
        let scale = edge / (high - low).max_element();
        let lowest = DVec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z) * scale;
        let place = DAffine3::from_translation(foot - lowest) * DAffine3::from_scale(DVec3::splat(scale));
        shapes::moved(&shapes::bar(2, 2, 2), place)
    }

    #[test]
    fn a_box_on_a_coarse_sheet_touches_it_with_its_foot_and_one_in_the_air_touches_nothing() {
        let sheet = shapes::grid(1, 1);
        let on_it = cube(0.1, DVec3::new(0.3, 0.4, 0.001));
        let above = cube(0.1, DVec3::new(0.7, 0.4, 0.05));
        let model = shapes::model(shapes::together(&[sheet, on_it, above]));
        let (surface, topology) = (&model.surface, &model.topology);
        let component_at = |point: DVec3| {
            let vertices = 0..surface.positions.len();
            let nearest = vertices.min_by(|&a, &b| {
                let distance = |v: usize| surface.positions[v].distance(point);
                distance(a).total_cmp(&distance(b))
            });
            topology.component(SurfaceVertex(nearest.unwrap() as u32))
        };
        let [sheet, on_it, above] =
            [DVec3::ZERO, DVec3::new(0.3, 0.4, 0.1), DVec3::new(0.7, 0.4, 0.15)].map(component_at);
        let tree = &Bvh::build(&surface.positions, &surface.triangles);
        let found = contacts(surface, topology, tree, &[on_it, above], |_, _| true, &Cancel::new()).unwrap();
        assert!(!found[0].is_empty() && found[1].is_empty());
        for contact in &found[0] {
            assert_eq!(topology.component(contact.place), sheet);
            assert!((contact.distance - 0.001).abs() < 1e-9);
        }
        let areas = component_areas(surface, topology);
        assert!(areas[sheet as usize] > areas[on_it as usize]);
        let none = contacts(
            surface,
            topology,
            tree,
            &[on_it],
            |_, other| other != sheet,
            &Cancel::new(),
        )
        .unwrap();
        assert!(none[0].is_empty());
    }
}
