//! Cuts a surface where triangles do not meet as on a manifold.
//!
//! A flow has one way on across an edge. Where more than two triangles meet, where two disagree about the outside, or
//! where sheets touch in a vertex, the sheets are cut apart: each keeps its fluid, as between borders.

use pliant_mesh::{Surface, SurfaceVertex, Topology};

use crate::held::Held;
use crate::hinges::{Hinges, corner_at};

/// A surface on which each vertex has one fan.
#[derive(Debug)]
pub(crate) struct Sheets<'a> {
    pub surface: Held<'a, Surface>,
    pub topology: Held<'a, Topology>,
    /// The number of the given surface's vertices. They keep their numbers; copies follow.
    own_count: usize,
    /// The vertex of which each further one is a copy.
    copied: Vec<u32>,
    /// The triangle here of each triangle given; empty if they are the same.
    triangle_of: Vec<u32>,
}

impl<'a> Sheets<'a> {
    /// The surface itself if it is a manifold.
    pub fn of(surface: Held<'a, Surface>, topology: Held<'a, Topology>) -> Self {
        let own_count = surface.positions.len();
        let is_manifold = topology.non_manifold_edges() == 0
            && topology.non_manifold_vertices() == 0
            && topology.misoriented_edges() == 0;
        if is_manifold {
            return Self {
                surface,
                topology,
                own_count,
                copied: Vec::new(),
                triangle_of: Vec::new(),
            };
        }
        let (cut, copied) = cut(&surface, &topology);
        let (surface, triangle_of) = sorted(cut);
        let topology = Topology::of(&surface);
        Self {
            surface: Held::Own(Box::new(surface)),
            topology: Held::Own(Box::new(topology)),
            own_count,
            copied,
            triangle_of,
        }
    }

    /// The given surface's vertex behind a vertex.
    #[inline]
    pub fn original(&self, vertex: usize) -> usize {
        match vertex.checked_sub(self.own_count) {
            None => vertex,
            Some(copy) => self.copied[copy] as usize,
        }
    }

    /// The number of the given surface's vertices.
    pub fn own_count(&self) -> usize {
        self.own_count
    }

    /// The triangle here of a triangle given.
    pub fn triangle(&self, given: usize) -> usize {
        self.triangle_of.get(given).map_or(given, |&triangle| triangle as usize)
    }

    /// The number of vertices that were added.
    pub fn copies(&self) -> usize {
        self.copied.len()
    }
}

/// Gives all fans of a vertex but the first a copy of it. Returns the vertex of each copy.
fn cut(surface: &Surface, topology: &Topology) -> (Surface, Vec<u32>) {
    let hinges = Hinges::of(surface, topology);
    let mut cut = surface.clone();
    let mut copied = Vec::new();
    for vertex in (0..surface.positions.len() as u32).map(SurfaceVertex) {
        let mut corners: Vec<u32> = topology
            .faces(vertex, &surface.triangles)
            .map(|triangle| corner_at(surface, triangle, vertex))
            .collect();
        let mut is_first = true;
        while let Some(&corner) = corners.first() {
            let (fan, _) = hinges.fan(corner);
            corners.retain(|corner| !fan.contains(corner));
            if !std::mem::take(&mut is_first) {
                let copy = SurfaceVertex(cut.positions.len() as u32);
                cut.positions.push(surface.positions[vertex.index()]);
                copied.push(vertex.0);
                for corner in fan {
                    cut.triangles[corner as usize / 3][corner as usize % 3] = copy;
                }
            }
        }
    }
    (cut, copied)
}

/// The triangles in the order that a topology needs, and the new number of each.
fn sorted(mut surface: Surface) -> (Surface, Vec<u32>) {
    let key = |triangle: [SurfaceVertex; 3]| {
        let mut key = triangle;
        key.sort_unstable();
        key
    };
    let mut order: Vec<u32> = (0..surface.triangles.len() as u32).collect();
    order.sort_by_key(|&t| key(surface.triangles[t as usize]));
    let mut number = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        number[old as usize] = new as u32;
    }
    surface.triangles = order.iter().map(|&t| surface.triangles[t as usize]).collect();
    (surface, number)
}

#[cfg(test)]
mod tests {
    use pliant_mesh::shapes;

    use super::*;

    #[test]
    fn a_cut_surface_is_a_manifold_with_the_same_triangles() {
        for (name, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let sheets = Sheets::of(Held::Lent(&model.surface), Held::Lent(&model.topology));
            assert_eq!(sheets.topology.non_manifold_edges(), 0, "{name}");
            assert_eq!(sheets.topology.non_manifold_vertices(), 0, "{name}");
            assert_eq!(sheets.topology.misoriented_edges(), 0, "{name}");
            for (given, triangle) in model.surface.triangles.iter().enumerate() {
                let own = sheets.surface.triangles[sheets.triangle(given)];
                let original = own.map(|vertex| SurfaceVertex(sheets.original(vertex.index()) as u32));
                assert_eq!(original, *triangle, "{name}");
            }
        }
    }
}
