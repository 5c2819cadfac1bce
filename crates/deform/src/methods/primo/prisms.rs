//! The sorting of triangles: solved prisms, prisms that move with a handle, and their joints.
//!
//! A triangle whose three vertices are all fixed, or all one handle's, is *prescribed*: it moves with its *ground*, the
//! fixed world or the handle. The others are free, and *solved* if a handle reaches them from triangle to triangle. A
//! constrained vertex whose ground holds no triangle around it (a handle of one vertex, or of a line of vertices)
//! *pins* the free prisms there instead, as if the ground held a small stiff ball around the vertex; so it turns with
//! its handle, too.

use std::collections::VecDeque;

use pliant_mesh::SurfaceVertex;

use super::edges::{Edges, sides};
use crate::Role;
use crate::numerical::rows::place_in;

/// No body.
pub(crate) const NONE: u32 = u32::MAX;

/// The solved prisms and their holders.
#[derive(Debug)]
pub(crate) struct Prisms {
    /// The triangle of each solved prism, in the order of elimination after [`Prisms::reorder`].
    pub faces: Vec<u32>,
    /// The body of each triangle: a solved prism's number, or `faces.len()` plus its ground's. Triangles that no handle
    /// reaches belong to the fixed ground.
    pub body_of: Vec<u32>,
    /// Triangle, corner (0 to 2) and ground of each pin, by triangle.
    pub pins: Vec<Pin>,
}

/// A solved prism's vertex that a ground holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Pin {
    pub face: u32,
    pub vertex: u32,
    pub ground: u32,
}

/// The ground of fixed vertices; handle h's is h + 1.
pub(crate) const FIXED: u32 = 0;

/// The ground of a role, [`NONE`] if free.
pub(crate) fn ground_of(role: Role) -> u32 {
    match role {
        Role::Fixed => FIXED,
        Role::Free => NONE,
        Role::Handle(handle) => u32::from(handle) + 1,
    }
}

impl Prisms {
    /// Sorts the triangles; solved prisms are in the order of their triangles.
    pub fn of(edges: &Edges, roles: &[Role]) -> Self {
        let surface = edges.surface;
        let grounds: Vec<u32> = surface
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| ground_of(roles[corner.index()]));
                if a == b && b == c { a } else { NONE }
            })
            .collect();
        let pins = pins(edges, roles, &grounds);
        let is_handle = |ground: u32| ground != FIXED && ground != NONE;
        let mut reached = vec![false; grounds.len()];
        let mut queue = VecDeque::new();
        let neighbours = |face: u32| {
            sides(surface.triangles[face as usize])
                .into_iter()
                .flat_map(move |side| edges.across(face, side))
        };
        for face in 0..grounds.len() as u32 {
            if is_handle(grounds[face as usize]) {
                queue.extend(neighbours(face));
            }
        }
        queue.extend(pins.iter().filter(|pin| is_handle(pin.ground)).map(|pin| pin.face));
        while let Some(face) = queue.pop_front() {
            if grounds[face as usize] == NONE && !std::mem::replace(&mut reached[face as usize], true) {
                queue.extend(neighbours(face));
            }
        }
        let faces: Vec<u32> = (0..grounds.len() as u32)
            .filter(|&face| reached[face as usize])
            .collect();
        let mut prisms = Self {
            body_of: Vec::new(),
            pins: pins.into_iter().filter(|pin| reached[pin.face as usize]).collect(),
            faces,
        };
        let count = prisms.faces.len() as u32;
        let on_ground = |&ground: &u32| count + if ground == NONE { FIXED } else { ground };
        prisms.body_of = grounds.iter().map(on_ground).collect();
        prisms.number();
        prisms
    }

    /// The number of solved prisms.
    pub fn count(&self) -> usize {
        self.faces.len()
    }

    /// The solved neighbours of each solved prism, each once, as compressed rows.
    pub fn graph(&self, edges: &Edges) -> (Vec<u32>, Vec<u32>) {
        let (mut offsets, mut list) = (vec![0], Vec::with_capacity(3 * self.count()));
        let mut seen = vec![NONE; self.count()];
        for (prism, &face) in (0..).zip(&self.faces) {
            for side in sides(edges.surface.triangles[face as usize]) {
                for other in edges.across(face, side) {
                    let body = self.body_of[other as usize];
                    if seen.get(body as usize).is_some_and(|&by| by != prism) {
                        seen[body as usize] = prism;
                        list.push(body);
                    }
                }
            }
            offsets.push(list.len() as u32);
        }
        (offsets, list)
    }

    /// Renumbers the solved prisms: `order` lists the present numbers.
    pub fn reorder(&mut self, order: &[u32]) {
        self.faces = order.iter().map(|&prism| self.faces[prism as usize]).collect();
        self.number();
    }

    fn number(&mut self) {
        for (number, &face) in self.faces.iter().enumerate() {
            self.body_of[face as usize] = number as u32;
        }
    }
}

/// The pins: constrained vertices of free triangles such that no triangle joined to it around the vertex belongs to the
/// vertex's ground.
fn pins(edges: &Edges, roles: &[Role], grounds: &[u32]) -> Vec<Pin> {
    let mut pins = Vec::new();
    for (vertex, &role) in roles.iter().enumerate() {
        let (vertex, ground) = (SurfaceVertex(vertex as u32), ground_of(role));
        if ground == NONE {
            continue;
        }
        let around: Vec<u32> = edges.topology.faces(vertex, &edges.surface.triangles).collect();
        let mut is_met = vec![false; around.len()];
        for first in 0..around.len() {
            if is_met[first] {
                continue;
            }
            let fan = fan(edges, vertex, &around, first, &mut is_met);
            if fan.iter().any(|&face| grounds[face as usize] == ground) {
                continue;
            }
            let free = fan.into_iter().filter(|&face| grounds[face as usize] == NONE);
            pins.extend(free.map(|face| Pin {
                face,
                vertex: vertex.0,
                ground,
            }));
        }
    }
    pins.sort_unstable_by_key(|pin| (pin.face, pin.vertex));
    pins
}

/// The triangles on a walk around the vertex from the first one, from triangle to triangle.
fn fan(edges: &Edges, vertex: SurfaceVertex, around: &[u32], first: usize, is_met: &mut [bool]) -> Vec<u32> {
    let mut fan = vec![around[first]];
    is_met[first] = true;
    let mut next = 0;
    while let Some(&face) = fan.get(next) {
        next += 1;
        let at_vertex = sides(edges.surface.triangles[face as usize]).into_iter();
        for side in at_vertex.filter(|side| side.contains(&vertex)) {
            for other in edges.across(face, side) {
                if let Some(place) = place_in(around, &other)
                    && !std::mem::replace(&mut is_met[place], true)
                {
                    fan.push(other);
                }
            }
        }
    }
    fan
}
