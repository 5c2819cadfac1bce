//! Lines of the file and points that no triangle uses, as lines and dots that follow the shape.

use pliant_mesh::{DrawnVertex, Model};
use pliant_render::{EdgePoint, SurfaceLine};

/// The colour of points and lines without a region, sRGB.
const BARE_COLOUR: [u8; 4] = [214, 208, 196, 255];

/// Widths in points.
const DOT_WIDTH: f32 = 3.0;
const LINE_WIDTH: f32 = 1.2;

/// The lines, then a dot for each bare point. `drawn_colours` are the regions' colours of the drawn vertices, whose
/// alpha says how much they replace of the plain colour; there may be none.
pub fn wires(model: &Model, drawn_colours: &[[u8; 4]]) -> Vec<SurfaceLine> {
    let drawn = &model.drawn;
    let colour = |vertex: DrawnVertex| {
        drawn_colours
            .get(vertex.index())
            .map_or(BARE_COLOUR, |over| mixed(*over))
    };
    let is_finite = |end: &DrawnVertex| drawn.surface_vertex(*end).is_some();
    let lines = drawn.lines().iter().filter(|ends| ends.iter().all(is_finite));
    let lines = lines.map(|ends| SurfaceLine {
        ends: ends.map(|end| EdgePoint::at(end.0)),
        colour: colour(ends[0]),
        width_points: LINE_WIDTH,
    });
    let bare = model.topology.bare_points();
    // Of twins only the first is drawn.
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

/// A region's colour over the plain one.
fn mixed([r, g, b, share]: [u8; 4]) -> [u8; 4] {
    let over = |plain: u8, colour: u8| {
        let (plain, colour, share) = (u32::from(plain), u32::from(colour), u32::from(share));
        ((plain * (255 - share) + colour * share) / 255) as u8
    };
    let [x, y, z, alpha] = BARE_COLOUR;
    [over(x, r), over(y, g), over(z, b), alpha]
}
