//! The edges of a triangle mesh.

/// The edges of `triangles` without duplicates, lower vertex index first, in ascending order. Degenerate edges from a
/// vertex to itself are left out.
///
/// The method is a counting sort by the lower vertex, linear in the triangles, then a sort of each small bucket.
/// Drawing edges rather than triangles in line mode draws every line once, so that its alpha is right, and needs no
/// optional device feature.
pub(crate) fn unique_edges(triangles: &[[u32; 3]], vertex_count: usize) -> Vec<[u32; 2]> {
    let mut starts = vec![0_u32; vertex_count + 1];
    for_each_edge(triangles, |low, _| starts[low as usize + 1] += 1);
    for vertex in 0..vertex_count {
        starts[vertex + 1] += starts[vertex];
    }
    let mut highs = vec![0_u32; starts[vertex_count] as usize];
    let mut next = starts.clone();
    for_each_edge(triangles, |low, high| {
        let slot = &mut next[low as usize];
        highs[*slot as usize] = high;
        *slot += 1;
    });
    let mut edges = Vec::with_capacity(highs.len() / 2 + 3);
    for low in 0..vertex_count {
        let bucket = &mut highs[starts[low] as usize..starts[low + 1] as usize];
        bucket.sort_unstable();
        let mut last = low as u32;
        for &high in bucket.iter().filter(|&&high| high != low as u32) {
            if high != last {
                edges.push([low as u32, high]);
                last = high;
            }
        }
    }
    edges
}

fn for_each_edge(triangles: &[[u32; 3]], mut visit: impl FnMut(u32, u32)) {
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            visit(from.min(to), from.max(to));
        }
    }
}

/// An edge that a closed manifold does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum IrregularEdge {
    /// It belongs to one triangle.
    Boundary([u32; 2]),
    /// It belongs to more than two triangles.
    NonManifold([u32; 2]),
}

/// The edges that belong to one triangle, or to more than two, in the order of [`unique_edges`]. `welded` maps each
/// vertex to the lowest vertex at the same position, so that texture seams are not borders; without it, no vertices are
/// welded.
pub(crate) fn irregular_edges(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    welded: Option<&[u32]>,
) -> Vec<IrregularEdge> {
    let joined = |vertex: u32| welded.map_or(vertex, |welded| welded[vertex as usize]);
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for &triangle in triangles {
        let corners = triangle.map(joined);
        // Degenerate triangles have no edges.
        if corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0] {
            for_each_edge(&[corners], |low, high| edges.push([low, high]));
        }
    }
    debug_assert!(edges.iter().all(|edge| (edge[1] as usize) < vertex_count));
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| a == b)
        .filter_map(|same| match same.len() {
            1 => Some(IrregularEdge::Boundary(same[0])),
            2 => None,
            _ => Some(IrregularEdge::NonManifold(same[0])),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_edge_is_listed_once_on_closed_open_and_broken_meshes() {
        let tetrahedron = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        assert_eq!(
            unique_edges(&tetrahedron, 4),
            [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
        );
        let strip = [[0, 1, 2], [2, 1, 3]];
        assert_eq!(unique_edges(&strip, 5), [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
        let twice_and_collapsed = [[2, 1, 0], [0, 1, 2], [1, 1, 2]];
        assert_eq!(unique_edges(&twice_and_collapsed, 3), [[0, 1], [0, 2], [1, 2]]);
        assert!(unique_edges(&[], 0).is_empty());
    }

    #[test]
    fn borders_and_branches_are_found_across_seams() {
        let square = [[0, 1, 2], [1, 3, 2]];
        let border = |low, high| IrregularEdge::Boundary([low, high]);
        let around = [border(0, 1), border(0, 2), border(1, 3), border(2, 3)];
        assert_eq!(irregular_edges(&square, 4, None), around);
        // The same square with its diagonal split by a seam.
        let split = [[0, 1, 2], [4, 3, 5]];
        assert_eq!(irregular_edges(&split, 6, Some(&[0, 1, 2, 3, 1, 2])), around);
        assert_eq!(irregular_edges(&split, 6, None).len(), 6);
        let fan = [[0, 1, 2], [0, 1, 3], [1, 0, 4]];
        assert!(irregular_edges(&fan, 5, None).contains(&IrregularEdge::NonManifold([0, 1])));
        let tetrahedron = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        assert!(irregular_edges(&tetrahedron, 4, None).is_empty());
        assert!(irregular_edges(&[[0, 0, 1]], 2, None).is_empty());
    }
}
