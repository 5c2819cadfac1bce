//! The owner of each following component: the component that it touches most.

use std::collections::BTreeMap;

use pliant_mesh::{Bvh, Cancel, Cancelled, Contact, Surface, SurfaceVertex, Topology, component_areas, contacts};

use crate::Loose;

/// If more components follow than this, they are crumbs: each is tied to a patch of the smallest size, which its
/// neighbours share. Patches as large as each of very many components would take much more memory than the mesh.
pub(crate) const CRUMBS: usize = 10_000;

/// The component that a following one touches most.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Owner {
    /// A vertex on a driven component, or of one that bends along.
    Surface(SurfaceVertex),
    /// A component that follows as a whole, by its index among the followers: both move as one.
    Follower(usize),
}

/// The owner of each of the components `following`: a driven component, or a larger follower; `None` if it touches
/// neither. Crumbs are left out.
pub(crate) fn owners(
    surface: &Surface,
    topology: &Topology,
    following: &[(u32, Loose)],
    driven: &[u32],
    cancel: &Cancel,
) -> Result<Vec<Option<Owner>>, Cancelled> {
    if following.len() > CRUMBS {
        return Ok(vec![None; following.len()]);
    }
    let is_driven = |component: u32| driven.binary_search(&component).is_ok();
    let index_of = |component: u32| following.binary_search_by_key(&component, |&(other, _)| other).ok();
    let areas = component_areas(surface, topology);
    // The order is by area, so that no chain returns to its beginning.
    let is_larger = |other: u32, than: u32| {
        let area = |component: u32| areas[component as usize];
        area(other) > area(than) || area(other) == area(than) && other < than
    };
    let may_hold = |part: u32, other: u32| is_driven(other) || index_of(other).is_some() && is_larger(other, part);
    let tree = hierarchy(surface, topology, |component| {
        is_driven(component) || index_of(component).is_some()
    });
    let parts: Vec<u32> = following.iter().map(|&(component, _)| component).collect();
    let contacts = contacts(surface, topology, &tree, &parts, may_hold, cancel)?;
    let owner = |contacts: &Vec<Contact>| {
        let mut touched: BTreeMap<u32, (f64, Contact)> = BTreeMap::new();
        for contact in contacts {
            let (area, nearest) = touched
                .entry(topology.component(contact.place))
                .or_insert((0.0, *contact));
            *area += contact.area;
            if (contact.distance, contact.place) < (nearest.distance, nearest.place) {
                *nearest = *contact;
            }
        }
        let most = touched
            .into_iter()
            .reduce(|most, other| if other.1.0 > most.1.0 { other } else { most });
        let (component, (_, nearest)) = most?;
        Some(match index_of(component) {
            Some(index) if following[index].1 == Loose::Follow => Owner::Follower(index),
            _ => Owner::Surface(nearest.place),
        })
    };
    Ok(contacts.iter().map(owner).collect())
}

/// The end of a chain of touching components: the one with its own tie.
pub(crate) fn end_of_chain(owners: &[Option<Owner>], mut index: usize) -> usize {
    while let Some(Owner::Follower(next)) = owners[index] {
        index = next;
    }
    index
}

/// A hierarchy over the triangles of some components.
pub(crate) fn hierarchy(surface: &Surface, topology: &Topology, is_in: impl Fn(u32) -> bool) -> Bvh {
    let triangles: Vec<_> = surface
        .triangles
        .iter()
        .copied()
        .filter(|corners| is_in(topology.component(corners[0])))
        .collect();
    Bvh::build(&surface.positions, &triangles)
}
