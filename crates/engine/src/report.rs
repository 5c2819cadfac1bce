//! REPORT.json: the effect of an edit and the time of each part (`docs/edit-format.md`). Times are in milliseconds.

use std::time::Instant;

use glam::DVec3;
use pliant_editor::MatchedByPlace;
use pliant_mesh::{Model, mean_curvatures, mixed_voronoi_areas};
use serde::Serialize;

/// The effect of an edit. Every number is finite.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// The method's name.
    pub method: String,
    /// The number of the file's vertices.
    pub vertices: usize,
    /// The number of welded vertices.
    pub welded_vertices: usize,
    /// The number of solved vertices.
    pub free_vertices: usize,
    /// The time from the file on disk to the welded surface.
    pub load_ms: f64,
    /// The time of the mesh's fill-reducing ordering.
    pub order_ms: f64,
    /// The time of binding: from the ordering and the regions until the first solve is possible.
    pub bind_ms: f64,
    /// The time of saving: from the new positions to synced files that were read back.
    pub save_ms: f64,
    /// The part of that for reading back.
    pub check_ms: f64,
    /// The frames' times.
    pub frames: FrameTimes,
    /// The mean number of iterations per frame.
    pub iterations: f64,
    /// True if the last frame converged.
    pub converged: bool,
    /// The deformation energy.
    pub energy: Energy,
    /// The largest distance of a hard handle's vertex from its target, in world units: 0 for methods that hold handles
    /// exactly.
    pub handle_residual: f64,
    /// The weights of the edit's examples, set or found.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub examples: Vec<ExampleWeight>,
    /// The free handles, and how far they slid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slides: Vec<HandleSlide>,
    /// How much of the edit was found by place, if it was made on another mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matched_by_place: Option<MatchedByPlace>,
    /// The distortion of the shape.
    pub distortion: Distortion,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

/// The times of the frames, from new handle transforms to new positions of every vertex of the file.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct FrameTimes {
    /// The number of solved frames.
    pub count: usize,
    /// Their median.
    pub median_ms: f64,
    /// The 95th percentile.
    pub p95_ms: f64,
    /// The longest.
    pub max_ms: f64,
    /// The median time of the normals, which follow each frame.
    pub normals_ms: f64,
}

/// An example's share in the shape.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct ExampleWeight {
    /// The example's name.
    pub name: String,
    /// 0 at rest, 1 for the example.
    pub weight: f64,
}

/// A free handle's place along its direction.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct HandleSlide {
    /// The handle's name.
    pub name: String,
    /// Its distance from where its transform puts it, along its free direction, in world units.
    pub distance: f64,
}

/// The deformation energy before and after.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Energy {
    /// At rest.
    pub rest: f64,
    /// After the last frame.
    pub r#final: f64,
}

/// The distortion of the shape.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Distortion {
    /// The mean over the edges of the larger of new by old length and old by new.
    pub edge_stretch_mean: f64,
    /// The largest such ratio.
    pub edge_stretch_max: f64,
    /// Faces whose normal turned by more than a right angle against their neighbourhood.
    pub flipped_faces: usize,
    /// The enclosed volume, new by old; 1 if the surface encloses none.
    pub volume_ratio: f64,
}

impl FrameTimes {
    /// The statistics of frames with the times `solve_ms`, and of their normals with `normals_ms`.
    pub fn of(solve_ms: &mut [f64], normals_ms: &mut [f64]) -> Self {
        solve_ms.sort_by(f64::total_cmp);
        normals_ms.sort_by(f64::total_cmp);
        Self {
            count: solve_ms.len(),
            median_ms: quantile(solve_ms, 0.5),
            p95_ms: quantile(solve_ms, 0.95),
            max_ms: quantile(solve_ms, 1.0),
            normals_ms: quantile(normals_ms, 0.5),
        }
    }
}

/// The smallest of `sorted` that at least the share `q` of them does not exceed; 0 if there are none.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

impl Report {
    /// The report as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        // A struct of numbers, strings and lists always serialises.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// The change of the surface's details as seen from the surface: the root of ∫ (H' − H)² dA over the rest shape, with
/// the mean curvatures H and H' before and after. It has no unit, and neither a rigid motion nor a turn of a detail
/// with its surroundings changes it; the edit's own bend counts equally for all methods. `bent` has a position for each
/// surface vertex.
pub fn detail_error(model: &Model, bent: &[DVec3]) -> f64 {
    let (surface, topology) = (&model.surface, &model.topology);
    let curvatures = |positions: &[DVec3]| mean_curvatures(surface, topology, positions);
    let areas = mixed_voronoi_areas(surface);
    let (before, after) = (curvatures(&surface.positions), curvatures(bent));
    let squared: f64 = areas
        .iter()
        .zip(before.iter().zip(&after))
        .map(|(area, (before, after))| area * (after - before).powi(2))
        .sum();
    finite_or(squared.sqrt(), f64::MAX)
}

/// JSON has no infinity and no NaN: they become `instead`.
pub fn finite_or(value: f64, instead: f64) -> f64 {
    if value.is_finite() { value } else { instead }
}

/// Milliseconds since `start`.
pub fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_frames_that_were_measured() {
        let mut frames: Vec<f64> = (1..=20).rev().map(f64::from).collect();
        let times = FrameTimes::of(&mut frames, &mut []);
        assert_eq!(
            (times.count, times.median_ms, times.p95_ms, times.max_ms),
            (20, 10.0, 19.0, 20.0)
        );
        assert_eq!(times.normals_ms, 0.0);
        assert_eq!(FrameTimes::of(&mut [], &mut []), FrameTimes::default());
        assert_eq!(FrameTimes::of(&mut [3.0], &mut [1.0]).p95_ms, 3.0);
    }
}
