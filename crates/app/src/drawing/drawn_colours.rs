//! Colours of surface vertices, handed down to the drawn ones.

use std::ops::Range;

use pliant_mesh::{DrawnVertex, Model, SurfaceVertex};
use rayon::prelude::*;

/// Drawn vertices are recoloured and uploaded in blocks of so many.
const BLOCK: usize = 1024;

/// The colour of each drawn vertex; those that belong to no kept triangle get a transparent one.
pub fn drawn_colours(model: &Model, surface_colours: &[[u8; 4]]) -> Vec<[u8; 4]> {
    (0..model.drawn.vertex_count() as u32)
        .into_par_iter()
        .with_min_len(8192)
        .map(|vertex| {
            (model.drawn.surface_vertex(DrawnVertex(vertex)))
                .and_then(|vertex| surface_colours.get(vertex.index()).copied())
                .unwrap_or_default()
        })
        .collect()
}

/// Gives the drawn vertices behind some surface vertices their new colours, and tells which ranges of `drawn_colours`
/// (one a drawn vertex) changed.
pub fn recolour(
    model: &Model,
    vertices: &[SurfaceVertex],
    colour: impl Fn(SurfaceVertex) -> [u8; 4],
    drawn_colours: &mut [[u8; 4]],
) -> Vec<Range<usize>> {
    let mut is_touched = vec![false; drawn_colours.len().div_ceil(BLOCK)];
    // As many of either: each surface vertex has one drawn one, which any of its triangles names.
    let is_one_to_one = model.drawn.vertex_count() == model.surface.positions.len();
    for &vertex in vertices {
        let colour = colour(vertex);
        // A drawn vertex belongs to a triangle behind one of the surface's around the vertex.
        let faces = model.topology.faces(vertex, &model.surface.triangles);
        let telling = if is_one_to_one { 1 } else { usize::MAX };
        for face in faces.take(telling) {
            for drawn in model.drawn_corners(face as usize) {
                let is_behind = model.drawn.surface_vertex(drawn) == Some(vertex);
                if let (true, Some(present)) = (is_behind, drawn_colours.get_mut(drawn.index())) {
                    *present = colour;
                    is_touched[drawn.index() / BLOCK] = true;
                }
            }
        }
    }
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for block in (0..is_touched.len()).filter(|&block| is_touched[block]) {
        let range = block * BLOCK..((block + 1) * BLOCK).min(drawn_colours.len());
        match ranges.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => ranges.push(range),
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use pliant_mesh::shapes;

    use super::*;

    #[test]
    fn what_is_recoloured_vertex_by_vertex_is_as_if_all_were_coloured_anew() {
        // Each surface vertex drawn once, and several times.
        let torus = shapes::torus(40, 30);
        for (model, is_one_to_one) in [
            (shapes::model(torus.clone()), true),
            (shapes::model(shapes::soup(&torus)), false),
        ] {
            let count = model.surface.positions.len();
            assert_eq!(model.drawn.vertex_count() == count, is_one_to_one);
            let colour = |vertex: SurfaceVertex| (vertex.0 * 7919).to_le_bytes();
            let mut colours = vec![[0; 4]; count];
            let mut drawn = drawn_colours(&model, &colours);
            let some: Vec<SurfaceVertex> = (0..count as u32).step_by(3).map(SurfaceVertex).collect();
            some.iter().for_each(|&v| colours[v.index()] = colour(v));
            let before = drawn.clone();
            let ranges = recolour(&model, &some, colour, &mut drawn);
            assert!(drawn == drawn_colours(&model, &colours));
            let is_told = |place: usize| ranges.iter().any(|range| range.contains(&place));
            assert!((0..drawn.len()).all(|place| drawn[place] == before[place] || is_told(place)));
        }
    }
}
