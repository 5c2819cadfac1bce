//! The triangles that an edge joins.
//!
//! Two triangles on an edge are joined. Among more than two, each is joined with each, with couplings that are weaker
//! in proportion, so that a prism is held at such an edge as firmly as at any other. The number of pairs grows with the
//! square of the triangles, so at an edge with very many, a *crowded* one, each is joined only with the largest, as
//! firmly as with all others together. If the triangles are alike that is the same energy, except that the largest
//! follows the mean of the others.

use std::collections::BTreeMap;

use pliant_mesh::{Surface, SurfaceVertex, Topology, area_of_lengths, edge_lengths};

/// A triangle's area counts as at least this share of its longest edge's square, so that one without an area is coupled
/// firmly, but not too firmly for the computation.
const AREA_FLOOR: f64 = 1e-3;

/// Edges with more triangles than this are crowded.
pub(crate) const CROWD: usize = 32;

/// The triangles on a surface's edges.
#[derive(Debug)]
pub(crate) struct Edges<'a> {
    pub surface: &'a Surface,
    pub topology: &'a Topology,
    /// By the edge's vertices, the lower first.
    crowded: BTreeMap<[SurfaceVertex; 2], Crowd>,
}

/// The triangles on a crowded edge, ascending, and the one that is joined with all others.
#[derive(Debug, Default)]
struct Crowd {
    faces: Vec<u32>,
    middle: u32,
    mean_area: f64,
}

impl<'a> Edges<'a> {
    /// Finds the crowded edges.
    pub fn of(surface: &'a Surface, topology: &'a Topology) -> Self {
        let is_crowded = |v: &SurfaceVertex| topology.neighbours(*v).len() > CROWD;
        let mut crowded: BTreeMap<[SurfaceVertex; 2], Crowd> = BTreeMap::new();
        for low in (0..topology.vertex_count() as u32)
            .map(SurfaceVertex)
            .filter(is_crowded)
        {
            for face in topology.faces(low, &surface.triangles) {
                let ends = surface.triangles[face as usize].into_iter();
                for high in ends.filter(|&high| high > low).filter(is_crowded) {
                    crowded.entry([low, high]).or_default().faces.push(face);
                }
            }
        }
        crowded.retain(|_, crowd| crowd.faces.len() > CROWD);
        for crowd in crowded.values_mut() {
            let area = |face: &u32| area(surface, *face);
            let largest = crowd
                .faces
                .iter()
                .max_by(|a, b| area(a).total_cmp(&area(b)).then(b.cmp(a)));
            crowd.middle = largest.copied().unwrap_or_default();
            crowd.mean_area = crowd.faces.iter().map(area).sum::<f64>() / crowd.faces.len() as f64;
        }
        Self {
            surface,
            topology,
            crowded,
        }
    }

    /// The triangles on the edge from `a` to `b` that are joined with `face` there, ascending.
    pub fn across(&self, face: u32, [a, b]: [SurfaceVertex; 2]) -> impl Iterator<Item = u32> + Clone + '_ {
        let crowd = self.crowd([a, b]);
        let (all, middle) = match crowd {
            None => (&[][..], None),
            Some(crowd) if crowd.middle == face => (&crowd.faces[..], None),
            Some(crowd) => (&[][..], Some(crowd.middle)),
        };
        // The triangles are the same, found from the end with fewer.
        let count = |v: SurfaceVertex| self.topology.neighbours(v).len();
        let (from, to) = if count(b) < count(a) { (b, a) } else { (a, b) };
        let around = crowd
            .is_none()
            .then(|| self.topology.faces(from, &self.surface.triangles));
        let beside = around
            .into_iter()
            .flatten()
            .filter(move |&other| self.surface.triangles[other as usize].contains(&to));
        let others = beside.chain(all.iter().copied()).chain(middle);
        others.filter(move |&other| other != face)
    }

    /// The area for the weight of a joint between two triangles at an edge, in either order; `None` if the edge is not
    /// crowded.
    pub fn crowded_areas(&self, [one, two]: [u32; 2], edge: [SurfaceVertex; 2]) -> Option<f64> {
        let crowd = self.crowd(edge)?;
        let outer = if one == crowd.middle { two } else { one };
        Some(area(self.surface, outer) + crowd.mean_area)
    }

    fn crowd(&self, [a, b]: [SurfaceVertex; 2]) -> Option<&Crowd> {
        self.crowded.get(&[a.min(b), a.max(b)])
    }
}

/// A triangle's area for couplings.
pub(crate) fn area(surface: &Surface, face: u32) -> f64 {
    let lengths = edge_lengths(surface.corners(face as usize));
    let longest = lengths[0].max(lengths[1]).max(lengths[2]);
    area_of_lengths(lengths).max(AREA_FLOOR * longest * longest)
}

/// A triangle's sides, each from one corner to the next.
pub(crate) fn sides([a, b, c]: [SurfaceVertex; 3]) -> [[SurfaceVertex; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

#[cfg(test)]
mod tests {
    use pliant_mesh::{Topology, shapes};

    use super::{CROWD, Edges, sides};

    /// The number of joints that the triangles of a fan of this many around one edge see.
    fn joints(count: usize) -> usize {
        let model = shapes::model(shapes::non_manifold_fan(count));
        let topology = Topology::of(&model.surface);
        let edges = Edges::of(&model.surface, &topology);
        let mut joints = 0;
        for (face, corners) in (0..).zip(&model.surface.triangles) {
            for side in sides(*corners) {
                for other in edges.across(face, side) {
                    let back = sides(model.surface.triangles[other as usize]);
                    let sees = back
                        .into_iter()
                        .any(|side| edges.across(other, side).any(|own| own == face));
                    assert!(sees, "{count}: both triangles of a joint see it");
                    joints += 1;
                }
            }
        }
        joints
    }

    #[test]
    fn triangles_on_an_edge_are_joined_each_with_each_until_they_are_too_many() {
        for count in [2, 5, CROWD] {
            assert_eq!(joints(count), count * (count - 1));
        }
        for count in [CROWD + 1, 100, 2000] {
            assert_eq!(joints(count), 2 * (count - 1));
        }
    }
}
