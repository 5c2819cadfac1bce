//! Lines and points of the file, as lines and dots that follow the shape.
//!
//! Scans have vertices that no triangle uses, left from edits elsewhere; they are kept, and not shown. A file that has no
//! triangles at all is a cloud of points, all of which are shown.

use pliant_mesh::{DrawnVertex, Model};
use pliant_render::{EdgePoint, SurfaceLine};

/// The colour of points and lines without a region, sRGB.
const BARE_COLOUR: [u8; 4] = [214, 208, 196, 255];

/// Widths in points.
const DOT_WIDTH: f32 = 3.0;
const LINE_WIDTH: f32 = 1.2;

/// The lines and points of a model. `drawn_colours` are the regions' colours of the drawn vertices; it may be empty. Any
/// share of a colour counts in full: a dot has no form to show under its colour.
pub fn wires(model: &Model, drawn_colours: &[[u8; 4]]) -> Vec<SurfaceLine> {
    let drawn = &model.drawn;
    let wire = |ends: [DrawnVertex; 2]| {
        let colour = drawn_colours
            .get(ends[0].index())
            .filter(|[.., share]| *share > 0)
            .map_or(BARE_COLOUR, |&[r, g, b, _]| [r, g, b, 255]);
        SurfaceLine {
            ends: ends.map(|end| EdgePoint::at(end.0)),
            colour,
            width_points: if ends[0] == ends[1] { DOT_WIDTH } else { LINE_WIDTH },
        }
    };
    let is_finite = |end: &DrawnVertex| drawn.surface_vertex(*end).is_some();
    let is_cloud = drawn.triangle_count() == 0;
    // In a cloud all points are shown below.
    let is_shown = |ends: &&[DrawnVertex; 2]| ends.iter().all(is_finite) && !(is_cloud && ends[0] == ends[1]);
    let shown = drawn.lines().iter().filter(is_shown).map(|ends| wire(*ends));
    if !is_cloud {
        return shown.collect();
    }
    // Only the first of several twins is drawn.
    let mut is_drawn = vec![false; model.surface.positions.len()];
    let cloud = (0..).map(DrawnVertex).zip(drawn.surface_vertices());
    let cloud = cloud.filter(|(_, own)| own.is_some_and(|own| !std::mem::replace(&mut is_drawn[own.index()], true)));
    shown.chain(cloud.map(|(vertex, _)| wire([vertex; 2]))).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_mesh::{Drawn, shapes};

    use super::*;

    /// The drawn vertices at which a file has dots.
    fn dots(drawn: Drawn) -> Vec<u32> {
        let wires = wires(&shapes::model(drawn), &[]);
        let dots = wires.iter().filter(|wire| wire.ends[0] == wire.ends[1]);
        dots.map(|dot| dot.ends[0].vertices[0]).collect()
    }

    #[test]
    fn points_are_shown_as_the_file_has_them_and_vertices_without_use_are_not() {
        let mut scan = shapes::grid(2, 2);
        scan.positions.push(DVec3::splat(3.0));
        let left_over = DrawnVertex(9);
        let scan = Drawn::once(scan.positions, scan.triangles);
        assert!(dots(scan.clone()).is_empty());
        let lines = vec![[left_over; 2], [DrawnVertex(0), DrawnVertex(1)]];
        assert_eq!(dots(Drawn { lines, ..scan.clone() }), [9]);
        let cloud = Drawn::once(vec![DVec3::X, DVec3::Y, DVec3::X], Vec::new());
        assert_eq!(dots(cloud.clone()), [0, 1]);
        let lines = vec![[DrawnVertex(0); 2]];
        assert_eq!(dots(Drawn { lines, ..cloud }), [0, 1]);
    }
}
