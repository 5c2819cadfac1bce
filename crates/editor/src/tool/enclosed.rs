//! The vertices inside a closed line on the screen, found by a job, because visibility takes one ray per vertex.

use glam::DVec2;
use pliant_mesh::{Cancel, Cancelled, Progress, SurfaceVertex};
use rayon::prelude::*;

use super::drawn_shape::DrawnShape;
use super::mode::Depth;
use crate::view::{Picking, View};
use crate::workspace::Workspace;

/// The number of vertices tested between two updates of the progress.
const BATCH: usize = 16_384;
/// The closed line's edges are sorted into bands of this height, so that a point is compared with a few of them.
const BAND_PX: f64 = 4.0;

/// The search with all its data.
pub(super) struct Search {
    shape: DrawnShape,
    line: ClosedLine,
    depth: Depth,
}

impl Search {
    /// A search in the drawn shape; `None` while its hierarchy is not ready, or for a line without an inside.
    pub(super) fn of(workspace: &Workspace, view: &View, corners_px: &[DVec2], depth: Depth) -> Option<Self> {
        Some(Self {
            shape: DrawnShape::of(workspace, view)?,
            line: ClosedLine::of(corners_px)?,
            depth,
        })
    }

    /// The vertices whose image is in the closed line, ascending.
    ///
    /// # Errors
    /// It was cancelled.
    pub(super) fn run(&self, progress: &Progress, cancel: &Cancel) -> Result<Vec<SurfaceVertex>, Cancelled> {
        let picking = self.shape.picking();
        let count = self.shape.model.surface.positions.len();
        let mut found = Vec::new();
        for start in (0..count).step_by(BATCH) {
            cancel.check()?;
            let batch = start as u32..(start + BATCH).min(count) as u32;
            found.par_extend(
                batch
                    .into_par_iter()
                    .map(SurfaceVertex)
                    .filter(|&vertex| self.holds(&picking, vertex)),
            );
            progress.set(start as f32 / count as f32);
        }
        Ok(found)
    }

    fn holds(&self, picking: &Picking<'_>, vertex: SurfaceVertex) -> bool {
        let position = picking.position(vertex);
        let Some(px) = picking.sight.project(position).filter(|&px| self.line.holds(px)) else {
            return false;
        };
        // The start of the line of sight through the vertex: the eye itself, except for an orthographic view.
        self.depth == Depth::Through
            || picking.is_seen(vertex, position, picking.camera.ray(px, picking.viewport_px).origin)
    }
}

/// A closed line with its edges by height.
#[derive(Debug)]
struct ClosedLine {
    low: DVec2,
    high: DVec2,
    /// The edges that reach into each band of [`BAND_PX`], from `low` on.
    bands: Vec<Vec<[DVec2; 2]>>,
}

impl ClosedLine {
    /// The line; `None` for fewer than three corners.
    fn of(corners: &[DVec2]) -> Option<Self> {
        if corners.len() < 3 {
            return None;
        }
        let low = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let band = |y: f64| ((y - low.y) / BAND_PX) as usize;
        let mut bands = vec![Vec::new(); band(high.y) + 1];
        for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            bands[band(a.y.min(b.y))..=band(a.y.max(b.y))]
                .iter_mut()
                .for_each(|edges| edges.push([a, b]));
        }
        Some(Self { low, high, bands })
    }

    /// Returns true if a point is inside, by the number of edges to its right.
    fn holds(&self, p: DVec2) -> bool {
        if !(p.cmpge(self.low).all() && p.cmple(self.high).all()) {
            return false;
        }
        self.bands[((p.y - self.low.y) / BAND_PX) as usize]
            .iter()
            .filter(|[a, b]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            .count()
            % 2
            == 1
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use glam::DVec2;

    use super::ClosedLine;

    #[test]
    fn a_hook_has_its_mouth_outside_however_many_bands_it_crosses() {
        for scale in [0.1, 1.0, 10.0, 100.0] {
            let hook = [
                (0.0, 0.0),
                (6.0, 0.0),
                (6.0, 6.0),
                (4.0, 6.0),
                (4.0, 2.0),
                (2.0, 2.0),
                (2.0, 6.0),
                (0.0, 6.0),
            ];
            let at = |(x, y): (f64, f64)| DVec2::new(x - 3.0, y + 7.0) * scale;
            let line = ClosedLine::of(&hook.map(at)).unwrap();
            for (x, y, inside) in [
                (1.0, 5.0, true),
                (3.0, 4.0, false),
                (5.0, 5.0, true),
                (3.0, 1.0, true),
                (7.0, 3.0, false),
                (3.0, -1.0, false),
                (1.0, 6.5, false),
            ] {
                assert_eq!(line.holds(at((x, y))), inside, "{x} {y} at scale {scale}");
            }
        }
        assert!(ClosedLine::of(&[DVec2::ZERO, DVec2::X]).is_none());
    }
}
