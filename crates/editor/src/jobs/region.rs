//! What each vertex does, as it follows from paint and handles: the region of influence around each handle.
//!
//! A handle sets free what lies within its reach along the rest surface and carries no paint. A component that carries
//! no paint and lies wholly within a handle's reach through space (an eye, a button, a strap's buckle) is left to the
//! method as a loose part; one that extends beyond it is held still, as everything else is: nobody who moves a visor
//! means the whole helmet.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Loose, Role};
use pliant_mesh::{Cancel, Cancelled, ContourLine, DistanceSearch, Model, Surface, SurfaceVertex, Topology, face_area};

use super::rim::rims;
use crate::document::{Access, Document, HandleId, Paint, Reach};

/// What the region follows from; shared with the job that measures it.
#[derive(Clone, Debug)]
pub(crate) struct RegionInput {
    pub(crate) model: Arc<Model>,
    pub(crate) paint: Arc<Vec<Paint>>,
    pub(crate) handles: Vec<(HandleId, Reach)>,
    /// The rest shape's displacements from the file's; `None` where it is the file's.
    pub(crate) rest: Option<Arc<Vec<DVec3>>>,
    pub(crate) loose: Loose,
    pub(crate) loose_parts: Arc<BTreeMap<u32, Loose>>,
    pub(crate) access: Arc<Access>,
}

/// The vertices' roles, and the surface that they hold on.
#[derive(Clone, Debug)]
pub struct Region {
    /// What each surface vertex does.
    pub roles: Arc<Vec<Role>>,
    /// The handles that have vertices: [`Role::Handle`]'s number is the index.
    pub handles: Arc<Vec<HandleId>>,
    /// Numbers of vertices by role.
    pub counts: Counts,
    /// The lines between roles.
    pub(crate) rims: Arc<Vec<ContourLine>>,
    /// The components that nothing holds within some handle's reach, and those that a person has told what to do.
    pub loose: Arc<Vec<u32>>,
    /// The rest shape, where it is another than the file's.
    pub(crate) rest_surface: Option<Arc<Surface>>,
}

/// Numbers of surface vertices by role.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// Held still.
    pub fixed: usize,
    /// Free to bend.
    pub free: usize,
    /// In a handle.
    pub handle: usize,
}

impl Region {
    /// Everything held still.
    pub(crate) fn still(vertex_count: usize) -> Self {
        Self {
            roles: Arc::new(vec![Role::Fixed; vertex_count]),
            handles: Arc::new(Vec::new()),
            counts: Counts {
                fixed: vertex_count,
                ..Counts::default()
            },
            rims: Arc::new(Vec::new()),
            loose: Arc::default(),
            rest_surface: None,
        }
    }

    /// Measures the region.
    pub(crate) fn measure(input: &RegionInput, cancel: &Cancel) -> Result<Self, Cancelled> {
        let topology = &input.model.topology;
        let rest_surface = input
            .rest
            .as_ref()
            .map(|rest| Arc::new(displaced(&input.model.surface, rest)));
        let surface = rest_surface.as_deref().unwrap_or(&input.model.surface);
        let locked = input.access.locked_vertices(&input.model);
        let is_locked = |vertex: usize| locked.as_ref().is_some_and(|locked| locked[vertex]);
        let (members, held) = painted(input, is_locked);
        let mut roles = vec![Role::Fixed; input.paint.len()];
        let mut handles = Vec::new();
        let mut search = DistanceSearch::default();
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        // Per component: whether some handle's ball holds all of it.
        let (mut follows, mut within) = (vec![false; held.len()], vec![true; held.len()]);
        for ((id, reach), members) in input.handles.iter().zip(&members) {
            if members.is_empty() {
                continue;
            }
            cancel.check()?;
            let limit = reach_length(*reach, surface, topology, members);
            let seeds: Vec<(SurfaceVertex, f64)> = members.iter().map(|&vertex| (vertex, 0.0)).collect();
            if limit > 0.0 {
                for &(vertex, _) in search.within(&surface.triangles, topology, position, &seeds, limit) {
                    roles[vertex.index()] = Role::Free;
                }
            }
            let ball = Ball::around(members, limit, surface);
            ball.clear_what_extends_beyond(surface, topology, &mut within);
            follows
                .iter_mut()
                .zip(&within)
                .for_each(|(follows, within)| *follows |= within);
            within.fill(true);
            handles.push(*id);
        }
        // Who was told what to do does it however far the handles reach.
        let moves = |component: usize| match input.loose_parts.get(&(component as u32)) {
            Some(loose) => *loose != Loose::Rest && !handles.is_empty(),
            None => input.loose != Loose::Rest && follows[component],
        };
        let is_told = |component: usize| input.loose_parts.contains_key(&(component as u32));
        let loose: Vec<u32> = (0..held.len())
            .filter(|&component| !held[component] && (follows[component] || is_told(component)))
            .map(|component| component as u32)
            .collect();
        let mut counts = Counts::default();
        for (vertex, paint) in input.paint.iter().enumerate() {
            let component = topology.component(SurfaceVertex(vertex as u32)) as usize;
            let is_loose = || !held[component] && moves(component);
            let role = match *paint {
                _ if is_locked(vertex) => Role::Fixed,
                Paint::Fixed => Role::Fixed,
                Paint::Free => Role::Free,
                Paint::Bare if is_loose() => Role::Free,
                Paint::Bare => roles[vertex],
                Paint::Handle(id) => match handles.iter().position(|&handle| handle == id) {
                    Some(index) => Role::Handle(index as u16),
                    None => Role::Fixed,
                },
            };
            match role {
                Role::Fixed => counts.fixed += 1,
                Role::Free => counts.free += 1,
                Role::Handle(_) => counts.handle += 1,
            }
            roles[vertex] = role;
        }
        cancel.check()?;
        let rims = rims(surface, &roles);
        Ok(Self {
            roles: Arc::new(roles),
            handles: Arc::new(handles),
            counts,
            rims: Arc::new(rims),
            loose: Arc::new(loose),
            rest_surface,
        })
    }
}

/// The vertices of each handle that are not locked, and which components carry paint or a lock.
fn painted(input: &RegionInput, is_locked: impl Fn(usize) -> bool) -> (Vec<Vec<SurfaceVertex>>, Vec<bool>) {
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

/// What a handle reaches through space.
struct Ball {
    centre: DVec3,
    radius: f64,
}

impl Ball {
    /// As far from the farthest of a handle's vertices as its reach.
    fn around(members: &[SurfaceVertex], reach: f64, surface: &Surface) -> Self {
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
    fn clear_what_extends_beyond(&self, surface: &Surface, topology: &Topology, within: &mut [bool]) {
        for (vertex, position) in surface.positions.iter().enumerate() {
            if position.distance_squared(self.centre) > self.radius * self.radius {
                within[topology.component(SurfaceVertex(vertex as u32)) as usize] = false;
            }
        }
    }
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

/// A reach in world units.
pub(crate) fn reach_length(reach: Reach, surface: &Surface, topology: &Topology, members: &[SurfaceVertex]) -> f64 {
    match reach {
        Reach::Length(length) => length,
        Reach::Radii(radii) => radii * handle_radius(surface, topology, members),
    }
}

/// A handle's radius: that of the disc with its area.
///
/// Farthest distances or moments would do as well for one round patch, but a handle of two patches far apart would
/// then reach across everything between them.
fn handle_radius(surface: &Surface, topology: &Topology, members: &[SurfaceVertex]) -> f64 {
    let area_of = |face: u32| face_area(surface.triangles[face as usize].map(|v| surface.positions[v.index()]));
    let area: f64 = members
        .iter()
        .map(|&vertex| topology.faces(vertex, &surface.triangles).map(area_of).sum::<f64>() / 3.0)
        .sum();
    (area / PI).sqrt()
}

/// The mean position of some vertices; the origin for none.
pub(crate) fn centroid(positions: &[DVec3], vertices: impl Iterator<Item = SurfaceVertex>) -> DVec3 {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for vertex in vertices {
        sum += positions[vertex.index()];
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { DVec3::ZERO }
}

/// Everything that the region follows from.
pub(crate) fn region_input(model: &Arc<Model>, document: &Document) -> RegionInput {
    RegionInput {
        model: Arc::clone(model),
        paint: Arc::clone(&document.paint),
        handles: document
            .handles
            .iter()
            .map(|handle| (handle.id, handle.reach))
            .collect(),
        rest: document.applied.then(|| Arc::clone(&document.rest)),
        loose: document.loose,
        loose_parts: Arc::clone(&document.loose_parts),
        access: Arc::clone(&document.access),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::sync::Arc;

    use pliant_deform::{Loose, Role};
    use pliant_mesh::{Cancel, Model, Progress, WeldOptions, shapes};

    use super::{Region, RegionInput};
    use crate::Reach;
    use crate::document::{HandleId, Paint};

    /// A sheet over the unit square whose vertices within `radius` of its middle are a handle.
    fn sheet_with_disc(radius: f64, reach: Reach) -> RegionInput {
        let drawn = shapes::grid(60, 60);
        let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
        let middle = glam::DVec3::new(0.5, 0.5, 0.0);
        let is_inside = |p: &glam::DVec3| p.distance(middle) <= radius;
        let paint = |p| {
            if is_inside(p) {
                Paint::Handle(HandleId(7))
            } else {
                Paint::Bare
            }
        };
        RegionInput {
            paint: Arc::new(model.surface.positions.iter().map(paint).collect()),
            model: Arc::new(model),
            handles: vec![(HandleId(3), reach), (HandleId(7), reach)],
            rest: None,
            loose: Loose::Follow,
            loose_parts: Arc::default(),
            access: Arc::default(),
        }
    }

    #[test]
    fn a_disc_reaches_three_of_its_radii_beyond_its_rim() {
        let radius = 0.08;
        let input = sheet_with_disc(radius, Reach::default());
        let region = Region::measure(&input, &Cancel::new()).unwrap();
        assert_eq!(*region.handles, [HandleId(7)], "a handle without vertices is none");
        for (position, role) in input.model.surface.positions.iter().zip(region.roles.iter()) {
            let from_middle = position.distance(glam::DVec3::new(0.5, 0.5, 0.0));
            let expected = match from_middle / radius {
                ..=1.0 => Some(Role::Handle(0)),
                1.2..3.6 => Some(Role::Free),
                4.4.. => Some(Role::Fixed),
                _ => None,
            };
            assert!(
                expected.is_none_or(|expected| expected == *role),
                "{role:?} at {from_middle}"
            );
        }
    }

    #[test]
    fn a_reach_of_nothing_frees_nothing_and_paint_wins_over_reach() {
        let input = sheet_with_disc(0.1, Reach::Length(0.0));
        assert_eq!(Region::measure(&input, &Cancel::new()).unwrap().counts.free, 0);
        let mut input = sheet_with_disc(0.1, Reach::Length(10.0));
        for (paint, position) in Arc::make_mut(&mut input.paint)
            .iter_mut()
            .zip(&input.model.surface.positions)
        {
            if position.x < 0.2 {
                *paint = Paint::Fixed;
            }
        }
        let region = Region::measure(&input, &Cancel::new()).unwrap();
        for (position, role) in input.model.surface.positions.iter().zip(region.roles.iter()) {
            assert_eq!(position.x < 0.2, *role == Role::Fixed);
        }
    }
}
