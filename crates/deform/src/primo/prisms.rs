//! Which triangles are prisms to be solved for, which ones move with a handle, and what joins them.
//!
//! A triangle whose three vertices are all fixed, or all one handle's, is *prescribed*: it moves with its *ground*, the
//! fixed world or the handle. The others are free, and *solved* where a handle reaches them from triangle to triangle.
//! A constrained vertex whose ground holds no triangle around it (a handle of one vertex, or of a line of them) *pins*
//! the free prisms there instead, as if the ground held a small stiff ball around the vertex; so it turns with its
//! handle, too.
//!
//! More than two triangles on an edge are joined each with each, the couplings weaker by as much as there are more: a
//! prism is held at such an edge as firmly as at any other.

use std::collections::VecDeque;

use pliant_mesh::{Surface, SurfaceVertex, Topology};

use crate::Role;

/// Nobody's.
pub(crate) const NONE: u32 = u32::MAX;

/// The solved prisms and who holds them.
#[derive(Debug)]
pub(crate) struct Prisms {
    /// The triangle of each solved prism, in the order of elimination once [`Prisms::reorder`] has given one.
    pub faces: Vec<u32>,
    /// The body of each triangle: a solved prism's number, or `faces.len()` plus its ground's. What no handle reaches
    /// stands on the fixed ground.
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

/// The ground of what is fixed; handle h's is h + 1.
pub(crate) const FIXED: u32 = 0;

/// The ground that a role stands on, [`NONE`] where free.
pub(crate) fn ground_of(role: Role) -> u32 {
    match role {
        Role::Fixed => FIXED,
        Role::Free => NONE,
        Role::Handle(handle) => u32::from(handle) + 1,
    }
}

/// The triangles on the edge from `a` to `b` other than `face`.
pub(crate) fn across<'a>(
    surface: &'a Surface,
    topology: &'a Topology,
    face: u32,
    [a, b]: [SurfaceVertex; 2],
) -> impl Iterator<Item = u32> + 'a {
    let around = topology.faces(a, &surface.triangles);
    around.filter(move |&other| other != face && surface.triangles[other as usize].contains(&b))
}

/// A triangle's edges, each from one corner to the next.
pub(crate) fn edges([a, b, c]: [SurfaceVertex; 3]) -> [[SurfaceVertex; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

impl Prisms {
    /// Sorts the triangles; solved prisms stand by rising triangle.
    pub fn of(surface: &Surface, topology: &Topology, roles: &[Role]) -> Self {
        let grounds: Vec<u32> = surface
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| ground_of(roles[corner.index()]));
                if a == b && b == c { a } else { NONE }
            })
            .collect();
        let pins = pins(surface, topology, roles, &grounds);
        let is_handle = |ground: u32| ground != FIXED && ground != NONE;
        let mut reached = vec![false; grounds.len()];
        let mut queue = VecDeque::new();
        let neighbours = |face: u32| {
            edges(surface.triangles[face as usize])
                .into_iter()
                .flat_map(move |edge| across(surface, topology, face, edge))
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

    /// How many are solved for.
    pub fn count(&self) -> usize {
        self.faces.len()
    }

    /// The solved neighbours of each solved prism, each once, as compressed rows.
    pub fn graph(&self, surface: &Surface, topology: &Topology) -> (Vec<u32>, Vec<u32>) {
        let (mut offsets, mut list) = (vec![0], Vec::with_capacity(3 * self.count()));
        for &face in &self.faces {
            let start = list.len();
            for edge in edges(surface.triangles[face as usize]) {
                for other in across(surface, topology, face, edge) {
                    let body = self.body_of[other as usize];
                    if (body as usize) < self.count() && !list[start..].contains(&body) {
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

/// Every free triangle's vertices that are held and whose ground no triangle joined to it around them stands on.
fn pins(surface: &Surface, topology: &Topology, roles: &[Role], grounds: &[u32]) -> Vec<Pin> {
    let mut pins = Vec::new();
    let mut seen = Vec::new();
    for (vertex, &role) in roles.iter().enumerate() {
        let (vertex, ground) = (SurfaceVertex(vertex as u32), ground_of(role));
        if ground == NONE {
            continue;
        }
        for face in topology.faces(vertex, &surface.triangles) {
            if grounds[face as usize] == NONE && !stands(surface, topology, grounds, (vertex, ground), face, &mut seen)
            {
                pins.push(Pin {
                    face,
                    vertex: vertex.0,
                    ground,
                });
            }
        }
    }
    pins.sort_unstable_by_key(|pin| (pin.face, pin.vertex));
    pins
}

/// Whether walking from `face` around the vertex, from triangle to triangle, comes to one on the ground.
fn stands(
    surface: &Surface,
    topology: &Topology,
    grounds: &[u32],
    (vertex, ground): (SurfaceVertex, u32),
    face: u32,
    seen: &mut Vec<u32>,
) -> bool {
    seen.clear();
    seen.push(face);
    let mut next = 0;
    while let Some(&face) = seen.get(next) {
        next += 1;
        if grounds[face as usize] == ground {
            return true;
        }
        for edge in edges(surface.triangles[face as usize])
            .into_iter()
            .filter(|edge| edge.contains(&vertex))
        {
            for other in across(surface, topology, face, edge) {
                if !seen.contains(&other) {
                    seen.push(other);
                }
            }
        }
    }
    false
}
