//! The role of each vertex, from paint and handles: the region of influence around each handle.
//!
//! A handle sets free the unpainted vertices within its reach along the rest surface, and with them the tips that the
//! reach cuts off from the body ([`tips`]). Everything else is fixed. A component without any paint (an eye, a button,
//! a strap's buckle) is left to the method as a loose part if its contacts move ([`loose`]), and fixed otherwise: a
//! person who moves a visor does not mean the whole helmet.
//!
//! A method with control points (a cage, a lattice) or examples can also bend without handles: then all unpainted
//! vertices are free, unless some vertices were painted free.

mod branching;
mod creases;
mod fronts;
mod limb_chain;
mod limb_end;
mod limb_joint;
mod loose;
mod part;
mod reach;
mod rim;
mod tips;
mod twin_reach;

use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Loose, Role};
use pliant_mesh::{Cancel, Cancelled, ContourLine, DistanceSearch, Model, Surface, SurfaceVertex};

use self::creases::CreaseSearch;
pub use self::limb_chain::FoundLimb;
pub(crate) use self::limb_chain::limb_chain;
pub(crate) use self::limb_joint::limb_joint;
use self::loose::Ball;
pub(crate) use self::loose::FileContacts;
use self::part::end_of_part;
use self::reach::most_of;
pub(crate) use self::reach::{centroid, handle_radius};
pub use self::rim::Rim;
pub(crate) use self::rim::bounded;
use self::tips::free_tips;
use self::twin_reach::TwinReach;
use crate::document::{Access, Document, HandleId, PART_RADII, Paint, Reach, Tips};
use crate::region::rim::rims;

/// The input of the region. The job that measures it shares the model.
#[derive(Clone, Debug)]
pub(crate) struct RegionInput<M = Arc<Model>> {
    pub(crate) model: M,
    pub(crate) paint: Arc<Vec<Paint>>,
    pub(crate) handles: Vec<(HandleId, Reach)>,
    /// The first handle of each second one of twins.
    pub(crate) twins: BTreeMap<HandleId, HandleId>,
    /// The rest shape's displacements from the file's; `None` if it is the file's.
    pub(crate) rest: Option<Arc<Vec<DVec3>>>,
    /// True if the region is that of the file's shape, whatever the rest shape is: it holds for all frames of a sequence.
    pub(crate) is_of_file: bool,
    pub(crate) tips: Tips,
    pub(crate) loose: Loose,
    pub(crate) loose_parts: Arc<BTreeMap<u32, Loose>>,
    pub(crate) access: Arc<Access>,
    pub(crate) contacts: FileContacts,
    /// True if the method has control points or examples, which move the surface even without handles.
    pub(crate) has_controls: bool,
}

/// The vertices' roles, and the surface in its rest shape.
#[derive(Clone, Debug)]
pub struct Region {
    /// The role of each surface vertex.
    pub roles: Arc<Vec<Role>>,
    /// The handles that have vertices: [`Role::Handle`]'s number is the index.
    pub handles: Arc<Vec<HandleId>>,
    /// The reach of each of these handles, in world units.
    pub(crate) reaches: Arc<Vec<f64>>,
    /// Numbers of vertices by role.
    pub counts: Counts,
    /// The lines between roles.
    pub(crate) rims: Arc<Vec<ContourLine>>,
    /// The unpainted components that follow their contacts, and those with a person's setting.
    pub loose: Arc<Vec<u32>>,
    /// The rest shape, if it differs from the file's.
    pub(crate) rest_surface: Option<Arc<Surface>>,
}

/// Numbers of surface vertices by role.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// Fixed.
    pub fixed: usize,
    /// Free to bend.
    pub free: usize,
    /// In a handle.
    pub handle: usize,
}

impl Counts {
    fn of(roles: &[Role]) -> Self {
        let mut counts = Self::default();
        for role in roles {
            match role {
                Role::Fixed => counts.fixed += 1,
                Role::Free => counts.free += 1,
                Role::Handle(_) => counts.handle += 1,
            }
        }
        counts
    }
}

impl Region {
    /// A region with everything fixed.
    pub(crate) fn still(vertex_count: usize) -> Self {
        Self {
            roles: Arc::new(vec![Role::Fixed; vertex_count]),
            handles: Arc::default(),
            reaches: Arc::default(),
            counts: Counts {
                fixed: vertex_count,
                ..Counts::default()
            },
            rims: Arc::new(Vec::new()),
            loose: Arc::default(),
            rest_surface: None,
        }
    }

    /// The same region on another rest shape, which is so far from the file's `surface`; `None` is the file's own.
    pub(crate) fn on(&self, surface: &Surface, rest: Option<&[DVec3]>) -> Self {
        Self {
            rest_surface: rest.map(|rest| Arc::new(displaced(surface, rest))),
            ..self.clone()
        }
    }

    /// The reach of a handle along the surface, in world units; `None` if it has no vertices.
    pub(crate) fn reach_length(&self, handle: HandleId) -> Option<f64> {
        let place = self.handles.iter().position(|id| *id == handle)?;
        self.reaches.get(place).copied()
    }

    /// Measures the region.
    pub(crate) fn measure<M: Deref<Target = Model>>(
        input: &RegionInput<M>,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let topology = &input.model.topology;
        let rest_surface = input
            .rest
            .as_ref()
            .map(|rest| Arc::new(displaced(&input.model.surface, rest)));
        let measured = rest_surface.as_deref().filter(|_| !input.is_of_file);
        let surface = measured.unwrap_or(&input.model.surface);
        let locked = input.access.locked_vertices(&input.model);
        let is_locked = |vertex: usize| locked.as_ref().is_some_and(|locked| locked[vertex]);
        let (members, painted) = painted(input, is_locked);
        let mut roles = vec![Role::Fixed; input.paint.len()];
        let (mut handles, mut reaches) = (Vec::new(), Vec::new());
        let (mut search, mut creases) = (DistanceSearch::default(), CreaseSearch::default());
        let mut distances = Vec::new();
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let mut twin_reach = TwinReach::new(surface, topology, &input.twins);
        // Per component: whether it is wholly in some handle's ball.
        let (mut within, mut within_this) = (vec![false; painted.len()], vec![true; painted.len()]);
        for ((id, reach), members) in input.handles.iter().zip(&members) {
            if members.is_empty() {
                continue;
            }
            cancel.check()?;
            let most = most_of(*reach, surface, topology, members);
            let mut limit = most;
            if most > 0.0 {
                let seeds: Vec<(SurfaceVertex, f64)> = members.iter().map(|&vertex| (vertex, 0.0)).collect();
                let reached = match *reach {
                    Reach::Feature | Reach::Creased(_) => {
                        let radius = handle_radius(surface, topology, members);
                        creases.within(surface, topology, &seeds, radius, most)
                    }
                    Reach::Found | Reach::Bounded(_) => {
                        let radius = handle_radius(surface, topology, members);
                        // A handle may be as large as its limb. Its reach is then the scale that separates limbs.
                        let scale = radius.min(most / PART_RADII);
                        creases.within_limb(surface, topology, &seeds, [radius, scale], most, cancel)?
                    }
                    Reach::Part | Reach::Radii(_) | Reach::Length(_) => {
                        search.within(&surface.triangles, topology, position, &seeds, most)
                    }
                };
                if matches!(reach, Reach::Found | Reach::Feature | Reach::Part) {
                    distances.resize(surface.positions.len(), f64::NAN);
                    let radius = most / PART_RADII;
                    limit = end_of_part(surface, topology, reached, &mut distances, radius, most);
                }
                limit = twin_reach.limit((*id, *reach), members, reached, limit);
                for (vertex, _) in reached.iter().take_while(|(_, distance)| *distance <= limit) {
                    roles[vertex.index()] = Role::Free;
                }
            }
            let ball = Ball::around(members, limit, surface);
            ball.clear_what_extends_beyond(surface, topology, &mut within_this);
            within
                .iter_mut()
                .zip(&within_this)
                .for_each(|(within, this)| *within |= this);
            within_this.fill(true);
            handles.push(*id);
            reaches.push(limit);
        }
        if handles.is_empty() && input.has_controls && !input.paint.contains(&Paint::Free) {
            roles.fill(Role::Free);
        }
        for (vertex, paint) in input.paint.iter().enumerate() {
            roles[vertex] = match *paint {
                _ if is_locked(vertex) => Role::Fixed,
                Paint::Fixed => Role::Fixed,
                Paint::Free => Role::Free,
                Paint::Bare => roles[vertex],
                Paint::Handle(id) => match handles.iter().position(|&handle| handle == id) {
                    Some(index) => Role::Handle(index as u16),
                    None => Role::Fixed,
                },
            };
        }
        cancel.check()?;
        if input.tips == Tips::ComeAlong && !handles.is_empty() {
            let is_painted =
                |vertex: SurfaceVertex| input.paint[vertex.index()] != Paint::Bare || is_locked(vertex.index());
            free_tips(&mut roles, surface, topology, is_painted);
            cancel.check()?;
        }
        let loose = if handles.is_empty() || painted.iter().all(|&painted| painted) {
            Vec::new()
        } else {
            free_loose(&mut roles, input, &painted, &within, cancel)?
        };
        let rims = rims(surface, &roles);
        Ok(Self {
            handles: Arc::new(handles),
            reaches: Arc::new(reaches),
            counts: Counts::of(&roles),
            roles: Arc::new(roles),
            rims: Arc::new(rims),
            loose: Arc::new(loose),
            rest_surface,
        })
    }
}

/// Sets free the unpainted components that follow. Returns these, and those with a person's setting, without bare
/// points.
fn free_loose<M: Deref<Target = Model>>(
    roles: &mut [Role],
    input: &RegionInput<M>,
    painted: &[bool],
    within: &[bool],
    cancel: &Cancel,
) -> Result<Vec<u32>, Cancelled> {
    let topology = &input.model.topology;
    let touching = input.contacts.of(&input.model, cancel)?;
    let told = |component: usize| input.loose_parts.get(&(component as u32)).copied();
    // If all rest, the list still shows the ones that would follow.
    let goes = touching.going_along(topology, roles, painted, within, |component| {
        told(component).map(|loose| loose != Loose::Rest)
    });
    let mut loose = Vec::new();
    for (component, goes) in goes.into_iter().enumerate() {
        if goes && told(component).unwrap_or(input.loose) != Loose::Rest {
            for vertex in topology.vertices_of(component as u32) {
                roles[vertex.index()] = Role::Free;
            }
        }
        let has_faces = topology.components()[component].face_count > 0;
        if has_faces && (goes || !painted[component] && told(component).is_some()) {
            loose.push(component as u32);
        }
    }
    Ok(loose)
}

/// The vertices of each handle that are not locked, and the components with paint or a lock.
fn painted<M: Deref<Target = Model>>(
    input: &RegionInput<M>,
    is_locked: impl Fn(usize) -> bool,
) -> (Vec<Vec<SurfaceVertex>>, Vec<bool>) {
    let topology = &input.model.topology;
    let mut members: Vec<Vec<SurfaceVertex>> = vec![Vec::new(); input.handles.len()];
    let mut held = vec![false; topology.components().len()];
    for (vertex, paint) in input.paint.iter().enumerate() {
        let is_locked = is_locked(vertex);
        let vertex = SurfaceVertex(vertex as u32);
        if *paint != Paint::Bare || is_locked {
            held[topology.component(vertex) as usize] = true;
        }
        if let Paint::Handle(id) = *paint
            && !is_locked
            && let Some(index) = input.handles.iter().position(|(handle, _)| *handle == id)
        {
            members[index].push(vertex);
        }
    }
    (members, held)
}

/// The surface with every vertex moved by its displacement.
pub(crate) fn displaced(surface: &Surface, displacements: &[DVec3]) -> Surface {
    let positions = surface
        .positions
        .iter()
        .zip(displacements)
        .map(|(&p, &d)| p + d)
        .collect();
    Surface {
        positions,
        triangles: surface.triangles.clone(),
    }
}

/// The whole input of the region.
pub(crate) fn region_input<M>(model: M, document: &Document, contacts: &FileContacts) -> RegionInput<M> {
    RegionInput {
        model,
        paint: Arc::clone(&document.paint),
        handles: document
            .handles
            .iter()
            .map(|handle| (handle.id, handle.reach))
            .collect(),
        twins: document
            .handles
            .iter()
            .filter_map(|handle| Some((handle.id, handle.twin?.handle)))
            .filter(|(second, first)| first < second)
            .collect(),
        rest: document.applied.then(|| Arc::clone(&document.rest)),
        is_of_file: document.animation.frames().is_some(),
        tips: document.tips,
        loose: document.loose,
        loose_parts: Arc::clone(&document.loose_parts),
        access: Arc::clone(&document.access),
        contacts: contacts.clone(),
        has_controls: document.bends_without_handles(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod limb_tests;
#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests;
