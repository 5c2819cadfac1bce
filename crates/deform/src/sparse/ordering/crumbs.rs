//! Graphs with very many small components, such as a soup of single triangles.
//!
//! Components need no cut between them, and bisecting a million of them repeatedly would cost more than everything
//! else. So small ones are packed together until a pack is as large as a leaf of the dissection.

use pliant_mesh::SurfaceVertex;

use crate::numerical::graph::Graph;

/// This many small components are packed; fewer are bisected like everything else, which costs little.
const MANY: usize = 10_000;

/// Vertices in whole small components, and all others.
pub(crate) struct Crumbs {
    /// Each ascending, of a few hundred vertices.
    pub packs: Vec<Vec<u32>>,
    /// Ascending.
    pub rest: Vec<u32>,
}

/// Packs the components with at most `size` vertices among `vertices` (ascending, of `count`), if there are very many.
pub(crate) fn crumbs<G: Graph>(graph: &G, count: usize, vertices: Vec<u32>, size: usize) -> Crumbs {
    let mut seen = vec![false; count];
    let mut is_crumb = vec![false; count];
    let (mut packs, mut pack, mut found) = (Vec::new(), Vec::new(), 0);
    let mut component = Vec::new();
    for &first in &vertices {
        if std::mem::replace(&mut seen[first as usize], true) {
            continue;
        }
        component.clear();
        component.push(first);
        let mut next = 0;
        while let Some(&vertex) = component.get(next) {
            next += 1;
            for beside in graph.neighbours(SurfaceVertex(vertex)) {
                if !std::mem::replace(&mut seen[beside.index()], true) {
                    component.push(beside.0);
                }
            }
        }
        if component.len() <= size {
            found += 1;
            component.iter().for_each(|&vertex| is_crumb[vertex as usize] = true);
            if pack.len() + component.len() > size {
                packs.push(std::mem::take(&mut pack));
            }
            pack.extend_from_slice(&component);
        }
    }
    if found <= MANY {
        return Crumbs {
            packs: Vec::new(),
            rest: vertices,
        };
    }
    packs.push(pack);
    packs.iter_mut().for_each(|pack| pack.sort_unstable());
    Crumbs {
        packs,
        rest: vertices
            .into_iter()
            .filter(|&vertex| !is_crumb[vertex as usize])
            .collect(),
    }
}
