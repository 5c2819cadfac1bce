//! An image across the plane of symmetry in as many pieces as its handle.
//!
//! Where a limb is bent, counterparts can be missing: the image is torn, or has scraps beside it. Gaps between its pieces
//! are closed as far as they are narrow beside the image, and what is still apart and small is left out.

use std::collections::BTreeMap;

use pliant_mesh::{DistanceSearch, Model, SurfaceVertex};

/// The widths of gaps that are closed, in radii of the image, the smallest first.
const GAPS: [f64; 3] = [0.25, 0.5, 1.0];

/// A piece is left out if it has less than this share of the vertices of the largest one.
const SCRAP: f64 = 0.5;

/// The vertices that enter or leave an image, and whether they are in it then, so that it has at most as many pieces as
/// `pieces` says, if that can be. `radius` is that of the image, in world units, and `may_enter` says which vertices are
/// not decided by anything else.
pub(super) fn in_pieces(
    model: &Model,
    image: &[SurfaceVertex],
    count: usize,
    radius: f64,
    may_enter: impl Fn(SurfaceVertex) -> bool,
) -> BTreeMap<SurfaceVertex, bool> {
    let mut changed = BTreeMap::new();
    if pieces(model, image).len() <= count {
        return changed;
    }
    let mut whole = image.to_vec();
    for gap in GAPS {
        let mut closed = closed(model, image, 0.5 * gap * radius);
        closed.retain(|vertex| may_enter(*vertex));
        closed.extend(image);
        closed.sort_unstable();
        closed.dedup();
        let is_fewer = pieces(model, &closed).len() < pieces(model, &whole).len();
        if is_fewer {
            whole = closed;
        }
        if pieces(model, &whole).len() <= count {
            break;
        }
    }
    let mut found = pieces(model, &whole);
    found.sort_by_key(|piece| std::cmp::Reverse(piece.len()));
    let largest = found.first().map_or(0, Vec::len);
    let is_scrap = |piece: &&Vec<SurfaceVertex>| (piece.len() as f64) < SCRAP * largest as f64;
    let scraps: Vec<SurfaceVertex> = found.iter().skip(count).filter(is_scrap).flatten().copied().collect();
    changed.extend(whole.into_iter().map(|vertex| (vertex, true)));
    changed.extend(scraps.into_iter().map(|vertex| (vertex, false)));
    let mut was_in = vec![false; model.surface.positions.len()];
    image.iter().for_each(|vertex| was_in[vertex.index()] = true);
    changed.retain(|vertex, is_in| was_in[vertex.index()] != *is_in);
    changed
}

/// The connected pieces of these vertices, by their first vertices.
pub(super) fn pieces(model: &Model, vertices: &[SurfaceVertex]) -> Vec<Vec<SurfaceVertex>> {
    let mut is_left = vec![false; model.surface.positions.len()];
    vertices.iter().for_each(|vertex| is_left[vertex.index()] = true);
    let mut pieces = Vec::new();
    for &start in vertices {
        if !std::mem::replace(&mut is_left[start.index()], false) {
            continue;
        }
        let mut piece = vec![start];
        let mut next = 0;
        while let Some(&vertex) = piece.get(next) {
            next += 1;
            for &beside in model.topology.neighbours(vertex) {
                if std::mem::replace(&mut is_left[beside.index()], false) {
                    piece.push(beside);
                }
            }
        }
        pieces.push(piece);
    }
    pieces
}

/// The morphological closing: the vertices around which every disc of this radius along the surface touches these ones.
fn closed(model: &Model, vertices: &[SurfaceVertex], radius: f64) -> Vec<SurfaceVertex> {
    let (surface, topology) = (&model.surface, &model.topology);
    let mut search = DistanceSearch::default();
    let position = |v: SurfaceVertex| surface.positions[v.index()];
    let mut within = |from: &[SurfaceVertex]| -> Vec<(SurfaceVertex, f64)> {
        let seeds: Vec<(SurfaceVertex, f64)> = from.iter().map(|&vertex| (vertex, 0.0)).collect();
        search
            .within(&surface.triangles, topology, position, &seeds, radius)
            .to_vec()
    };
    let grown = within(vertices);
    let mut is_grown = vec![false; surface.positions.len()];
    grown.iter().for_each(|(vertex, _)| is_grown[vertex.index()] = true);
    let around = grown.iter().flat_map(|(vertex, _)| topology.neighbours(*vertex));
    let mut outside: Vec<SurfaceVertex> = around.copied().filter(|vertex| !is_grown[vertex.index()]).collect();
    outside.sort_unstable();
    outside.dedup();
    for (vertex, distance) in within(&outside) {
        is_grown[vertex.index()] &= distance >= radius;
    }
    let grown = grown.into_iter().map(|(vertex, _)| vertex);
    grown.filter(|vertex| is_grown[vertex.index()]).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use pliant_mesh::{SurfaceVertex, shapes};

    use super::{in_pieces, pieces};

    #[test]
    fn narrow_gaps_are_closed_scraps_left_out_and_wide_gaps_and_what_is_decided_stay() {
        let model = shapes::model(shapes::grid(80, 80));
        let positions = &model.surface.positions;
        let all = || (0..positions.len() as u32).map(SurfaceVertex);
        let of = |is_in: &dyn Fn(f64, f64) -> bool| -> Vec<SurfaceVertex> {
            all()
                .filter(|v| is_in(positions[v.index()].x, positions[v.index()].y))
                .collect()
        };
        // A square with a slit of this width through its middle, and a scrap beside it.
        let torn = |slit: f64| {
            of(&|x, y| {
                let is_square = (0.2..0.8).contains(&x) && (0.2..0.8).contains(&y) && (x - 0.5).abs() > slit / 2.0;
                is_square || (x > 0.95 && y > 0.95)
            })
        };
        let changed = |image: &[SurfaceVertex], count, may_enter: &dyn Fn(SurfaceVertex) -> bool| {
            let changed = in_pieces(&model, image, count, 0.3, may_enter);
            let mut now: BTreeSet<SurfaceVertex> = image.iter().copied().collect();
            for (vertex, is_in) in changed {
                assert!(if is_in { now.insert(vertex) } else { now.remove(&vertex) });
            }
            now.into_iter().collect::<Vec<_>>()
        };
        let narrow = torn(0.1);
        assert_eq!(pieces(&model, &narrow).len(), 3);
        let now = changed(&narrow, 1, &|_| true);
        assert_eq!(pieces(&model, &now).len(), 1);
        // All of the square, but for its corners at the slit.
        let square = of(&|x, y| (0.2..0.8).contains(&x) && (0.2..0.8).contains(&y));
        let missing = square.iter().filter(|v| now.binary_search(v).is_err()).count();
        assert!(missing < square.len() / 50, "{missing} of {}", square.len());
        assert!(now.iter().all(|v| square.binary_search(v).is_ok()), "nothing beside it");
        // The halves of a wide gap are both large: the scrap alone goes.
        let wide = torn(0.45);
        assert_eq!(pieces(&model, &changed(&wide, 1, &|_| true)).len(), 2);
        assert_eq!(
            changed(&wide, 3, &|_| true),
            wide,
            "a handle of three pieces has such an image"
        );
        let decided = changed(&narrow, 1, &|_| false);
        assert_eq!(pieces(&model, &decided).len(), 2);
        assert!(decided.iter().all(|v| narrow.binary_search(v).is_ok()));
    }
}
