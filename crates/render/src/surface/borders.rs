//! Boundary and non-manifold edges as lines on the surface.

use super::Surface;
use super::edges::{IrregularEdge, irregular_edges};
use super::lines::LineSet;
use crate::{EdgePoint, Gpu, RenderError, SurfaceLine, border};

/// Factor of alpha for the parts of borders that are behind a surface.
const HIDDEN_BORDERS: f32 = 0.22;

impl Surface {
    /// The borders of each page; empty until they are prepared.
    pub(crate) fn borders(&self) -> &[Option<LineSet>] {
        self.borders.get().map_or(&[], Vec::as_slice)
    }

    /// Finds the borders if they are not known yet.
    pub(crate) fn prepare_borders(&self, gpu: &Gpu) -> Result<(), RenderError> {
        if self.borders.get().is_some() {
            return Ok(());
        }
        let mut edges = irregular_edges(&self.triangles, self.vertex_count, self.welded.as_deref());
        if self.shown.is_some() {
            // Hiding triangles creates no borders, and a border with two hidden ends disappears with them.
            let mut of_shown = vec![false; self.vertex_count];
            let shown = (0..)
                .zip(&self.triangles)
                .filter(|(triangle, _)| self.is_shown(*triangle));
            for &corner in shown.flat_map(|(_, corners)| corners) {
                of_shown[corner as usize] = true;
            }
            edges.retain(|edge| {
                let (IrregularEdge::Boundary(ends) | IrregularEdge::NonManifold(ends)) = edge;
                ends.iter().all(|&end| of_shown[end as usize])
            });
        }
        let made = (self.pages.iter()).map(|page| LineSet::new(gpu, page, border_lines(&edges), HIDDEN_BORDERS));
        let _ = self.borders.set(made.collect::<Result<Vec<_>, _>>()?);
        Ok(())
    }
}

/// The irregular edges as lines. An edge whose ends are on several pages is drawn once on each.
fn border_lines(edges: &[IrregularEdge]) -> impl Iterator<Item = SurfaceLine> {
    const WIDTH_POINTS: f32 = 2.6;
    edges.iter().map(|edge| {
        let (ends, colour) = match edge {
            IrregularEdge::Boundary(ends) => (ends, border::OPEN),
            IrregularEdge::NonManifold(ends) => (ends, border::BRANCHING),
        };
        SurfaceLine {
            ends: ends.map(EdgePoint::at),
            colour,
            width_points: WIDTH_POINTS,
        }
    })
}
