//! Facets: their normals, and those that changed.

use glam::DVec3;

use crate::save::moved::Moved;

/// A facet's unit normal by the winding of its corners; zero if it has no area, as STL writes unknown normals.
pub(super) fn facet_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The facets with a moved corner, ascending: their number, their new corners, and which corners moved.
pub(super) fn changed_facets<'a>(moved: &'a Moved<'_>) -> impl Iterator<Item = (usize, [DVec3; 3], [bool; 3])> + 'a {
    moved
        .of_file()
        .chunks_exact(3)
        .enumerate()
        .filter(|(_, facet)| facet.iter().any(Option::is_some))
        .map(|(number, facet)| {
            let at = |k: usize| facet[k].unwrap_or(moved.drawn.positions[3 * number + k]);
            (
                number,
                [at(0), at(1), at(2)],
                [0, 1, 2].map(|k: usize| facet[k].is_some()),
            )
        })
}
