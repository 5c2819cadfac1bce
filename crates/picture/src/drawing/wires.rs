//! Lines of the file and points that no triangle uses, as lines and dots that follow the shape.

use pliant_mesh::{DrawnVertex, Model};
use pliant_render::{EdgePoint, SurfaceLine};

/// The colour of points and lines without a region, sRGB.
const BARE_COLOUR: [u8; 4] = [214, 208, 196, 255];

/// Widths in points.
const DOT_WIDTH: f32 = 3.0;
const LINE_WIDTH: f32 = 1.2;

/// The lines, then a dot for each bare point. `drawn_colours` are the regions' colours of the drawn vertices; it may be
/// empty. Any share of a colour counts in full: a dot has no form to show under its colour.
pub fn wires(model: &Model, drawn_colours: &[[u8; 4]]) -> Vec<SurfaceLine> {
    let drawn = &model.drawn;
    let colour = |vertex: DrawnVertex| {
        drawn_colours
            .get(vertex.index())
            .filter(|[.., share]| *share > 0)
            .map_or(BARE_COLOUR, |&[r, g, b, _]| [r, g, b, 255])
    };
    let is_finite = |end: &DrawnVertex| drawn.surface_vertex(*end).is_some();
    let lines = drawn.lines().iter().filter(|ends| ends.iter().all(is_finite));
    let lines = lines.map(|ends| SurfaceLine {
        ends: ends.map(|end| EdgePoint::at(end.0)),
        colour: colour(ends[0]),
        width_points: LINE_WIDTH,
    });
    let bare = model.topology.bare_points();
    // Only the first of several twins is drawn.
    let mut is_drawn = vec![false; bare.len()];
    let of_points = (0..)
        .map(DrawnVertex)
        .zip(drawn.surface_vertices())
        .filter(|(_, surface)| {
            let place = surface.and_then(|surface| surface.index().checked_sub(bare.start));
            place
                .and_then(|place| is_drawn.get_mut(place))
                .is_some_and(|is_drawn| !std::mem::replace(is_drawn, true))
        });
    let dots = of_points.map(|(vertex, _)| SurfaceLine {
        ends: [EdgePoint::at(vertex.0); 2],
        colour: colour(vertex),
        width_points: DOT_WIDTH,
    });
    match (bare.is_empty(), drawn.lines().is_empty()) {
        (true, true) => Vec::new(),
        (true, false) => lines.collect(),
        (false, _) => lines.chain(dots).collect(),
    }
}
