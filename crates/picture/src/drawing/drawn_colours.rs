//! Colours of surface vertices, copied to the drawn vertices.

use std::ops::Range;

use pliant_mesh::{DrawnVertex, Model, SurfaceVertex};
use rayon::prelude::*;

/// Number of drawn vertices in a block; colours are uploaded in whole blocks.
const BLOCK: usize = 1024;

/// The colour of each drawn vertex; vertices without a kept triangle are transparent.
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

/// Updates the colours of the drawn vertices of some surface vertices. Returns the changed ranges of `drawn_colours`,
/// which has one entry per drawn vertex.
pub fn recolour(
    model: &Model,
    vertices: &[SurfaceVertex],
    colour: impl Fn(SurfaceVertex) -> [u8; 4],
    drawn_colours: &mut [[u8; 4]],
) -> Vec<Range<usize>> {
    let mut is_touched = vec![false; drawn_colours.len().div_ceil(BLOCK)];
    // Equal counts mean one drawn vertex per surface vertex, which any of its triangles leads to.
    let is_one_to_one = model.drawn.vertex_count() == model.surface.positions.len();
    for &vertex in vertices {
        let colour = colour(vertex);
        // The drawn vertices are corners of the drawn triangles of the faces around the surface vertex.
        let faces = model.topology.faces(vertex, &model.surface.triangles);
        let face_limit = if is_one_to_one { 1 } else { usize::MAX };
        for face in faces.take(face_limit) {
            for drawn in model.drawn_corners(face as usize) {
                let is_of_vertex = model.drawn.surface_vertex(drawn) == Some(vertex);
                if let (true, Some(present)) = (is_of_vertex, drawn_colours.get_mut(drawn.index())) {
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
    fn recolouring_some_vertices_equals_recolouring_all() {
        // One and several drawn vertices per surface vertex.
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
            let is_reported = |place: usize| ranges.iter().any(|range| range.contains(&place));
            assert!((0..drawn.len()).all(|place| drawn[place] == before[place] || is_reported(place)));
        }
    }
}
