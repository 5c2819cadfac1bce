//! The components held by nothing that follow a handle.
//!
//! A part that touches larger ones belongs to them: it follows if at least half of its contacts are on moving places,
//! which are the free region, a handle or another part that follows. So a rivet on a strap moves with the strap, and
//! one that is near a moving hose but sits on the mask stays with the mask. A part never carries a larger one.
//!
//! A part that touches nothing larger follows if it is wholly within the ball of some handle's reach in space.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use pliant_deform::Role;
use pliant_mesh::{
    Bvh, Cancel, Cancelled, Contact, Model, Surface, SurfaceVertex, Topology, component_areas, contacts,
};

use crate::region::reach::centroid;

/// The contacts of a file's components. They depend on the file alone, so they are found once, at the first need.
#[derive(Clone, Debug, Default)]
pub(crate) struct FileContacts(Arc<OnceLock<Touching>>);

/// The contacts of each component with larger ones.
#[derive(Debug)]
pub(super) struct Touching {
    /// The components, larger ones first.
    order: Vec<u32>,
    /// The places of contact, by component.
    contacts: Vec<Vec<Contact>>,
    /// The area of each component, in square world units.
    areas: Vec<f64>,
}

/// A part with less than this share of the area of one that it touches has no limbs of its own.
const OWN_LIMBS: f64 = 0.1;

impl FileContacts {
    /// The contacts of this file's components, in its own shape.
    pub(super) fn of(&self, model: &Model, cancel: &Cancel) -> Result<&Touching, Cancelled> {
        if let Some(found) = self.0.get() {
            return Ok(found);
        }
        let found = touching(&model.surface, &model.topology, cancel)?;
        Ok(self.0.get_or_init(|| found))
    }
}

fn touching(surface: &Surface, topology: &Topology, cancel: &Cancel) -> Result<Touching, Cancelled> {
    let areas = component_areas(surface, topology);
    let all: Vec<u32> = (0..areas.len() as u32).collect();
    let mut order = all.clone();
    order.sort_by(|&a, &b| areas[b as usize].total_cmp(&areas[a as usize]).then(a.cmp(&b)));
    let mut rank = vec![0; order.len()];
    for (place, &component) in order.iter().enumerate() {
        rank[component as usize] = place;
    }
    let is_larger = |part: u32, other: u32| rank[other as usize] < rank[part as usize];
    let tree = Bvh::build(&surface.positions, &surface.triangles);
    let contacts = contacts(surface, topology, &tree, &all, is_larger, cancel)?;
    Ok(Touching { order, contacts, areas })
}

impl Touching {
    /// For each component that is not `painted`: whether it follows, given the `roles` on painted ones. A component's
    /// setting in `told` has priority; one that touches nothing larger follows `within`.
    pub(super) fn going_along(
        &self,
        topology: &Topology,
        roles: &[Role],
        painted: &[bool],
        within: &[bool],
        told: impl Fn(usize) -> Option<bool>,
    ) -> Vec<bool> {
        let mut goes = vec![false; painted.len()];
        for component in self.order.iter().map(|&component| component as usize) {
            let moves = |place: SurfaceVertex| match topology.component(place) as usize {
                other if painted[other] => roles[place.index()] != Role::Fixed,
                other => goes[other],
            };
            let touched = &self.contacts[component];
            let area: f64 = touched.iter().map(|contact| contact.area).sum();
            let moving = touched.iter().filter(|contact| moves(contact.place));
            let moving: f64 = moving.map(|contact| contact.area).sum();
            goes[component] = match told(component) {
                _ if painted[component] => false,
                Some(goes) => goes,
                None if touched.is_empty() => within[component],
                None => 2.0 * moving >= area,
            };
        }
        goes
    }
}

impl Touching {
    /// The place on the part that carries the one of this vertex, nearest to a point, by the present positions; `None`
    /// if the part has limbs of its own.
    pub(super) fn carrier(
        &self,
        topology: &Topology,
        positions: &[DVec3],
        vertex: SurfaceVertex,
        point: DVec3,
    ) -> Option<SurfaceVertex> {
        let mut carrier = None;
        let mut part = topology.component(vertex) as usize;
        loop {
            let away = |contact: &&Contact| positions[contact.place.index()].distance_squared(point);
            let places = self.contacts[part].iter();
            let nearest = places.min_by(|a, b| away(a).total_cmp(&away(b)).then(a.place.cmp(&b.place)));
            let Some(contact) = nearest else { return carrier };
            let larger = topology.component(contact.place) as usize;
            if self.areas[part] >= OWN_LIMBS * self.areas[larger] {
                return carrier;
            }
            (carrier, part) = (Some(contact.place), larger);
        }
    }

    /// The parts that rest on these vertices of the part `body`.
    pub(super) fn riders(&self, topology: &Topology, body: u32, vertices: &[SurfaceVertex]) -> Vec<u32> {
        let mut roles = vec![Role::Fixed; topology.vertex_count()];
        vertices.iter().for_each(|vertex| roles[vertex.index()] = Role::Free);
        let count = self.areas.len();
        let is_body: Vec<bool> = (0..count as u32).map(|part| part == body).collect();
        let goes = self.going_along(topology, &roles, &is_body, &vec![false; count], |_| None);
        (0..count as u32).filter(|part| goes[*part as usize]).collect()
    }
}

/// The ball of a handle's reach in space.
pub(super) struct Ball {
    centre: DVec3,
    radius: f64,
}

impl Ball {
    /// It extends from the farthest of a handle's vertices by its reach.
    pub(super) fn around(members: &[SurfaceVertex], reach: f64, surface: &Surface) -> Self {
        let centre = centroid(&surface.positions, members.iter().copied());
        let extent = members
            .iter()
            .map(|vertex| surface.positions[vertex.index()].distance(centre))
            .fold(0.0, f64::max);
        Self {
            centre,
            radius: extent + reach,
        }
    }

    /// Clears the flag of each component with a vertex outside.
    pub(super) fn clear_what_extends_beyond(&self, surface: &Surface, topology: &Topology, within: &mut [bool]) {
        for (vertex, position) in surface.positions.iter().enumerate() {
            if position.distance_squared(self.centre) > self.radius * self.radius {
                within[topology.component(SurfaceVertex(vertex as u32)) as usize] = false;
            }
        }
    }
}
