//! REPORT.json: what an edit did and how long each part took (`cli.md`). Times are in milliseconds.

use std::time::Instant;

use glam::DVec3;
use pliant_mesh::{Model, mean_curvatures, mixed_voronoi_areas};
use serde::Serialize;

/// What an edit did. Every number is finite.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// The method's name.
    pub method: String,
    /// How many vertices the file has.
    pub vertices: usize,
    /// How many there are once welded.
    pub welded_vertices: usize,
    /// How many were solved for.
    pub free_vertices: usize,
    /// From the file on disk to the welded surface.
    pub load_ms: f64,
    /// The mesh's fill-reducing ordering.
    pub order_ms: f64,
    /// Binding: from the ordering and the regions until the first solve is possible.
    pub bind_ms: f64,
    /// Saving: from the new positions to synced files that were read back.
    pub save_ms: f64,
    /// Of that, reading back what was written.
    pub check_ms: f64,
    /// The frames' times.
    pub frames: FrameTimes,
    /// Mean iterations a frame.
    pub iterations: f64,
    /// Whether the last frame converged.
    pub converged: bool,
    /// The deformation energy.
    pub energy: Energy,
    /// The largest distance of a hard handle's vertex from where the handle takes it, in world units: 0 for methods that
    /// hold handles exactly.
    pub handle_residual: f64,
    /// The weights of the examples that the edit has, as set or as found.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub examples: Vec<ExampleWeight>,
    /// How much the shape was distorted.
    pub distortion: Distortion,
    /// What a person should know, as sentences.
    pub warnings: Vec<String>,
}

/// How long the frames took, from new handle transforms to new positions of every vertex of the file.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct FrameTimes {
    /// How many frames were solved.
    pub count: usize,
    /// Their median.
    pub median_ms: f64,
    /// What 95 of 100 stay under.
    pub p95_ms: f64,
    /// The longest.
    pub max_ms: f64,
    /// The median time of the normals, which follow each frame.
    pub normals_ms: f64,
}

/// How much of an example the shape has taken.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct ExampleWeight {
    /// The example's name.
    pub name: String,
    /// 0 at rest, 1 for the example.
    pub weight: f64,
}

/// The deformation energy before and after.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct Energy {
    /// At rest.
    pub rest: f64,
    /// After the last frame.
    pub r#final: f64,
}

/// How much the shape was distorted.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Distortion {
    /// The mean over the edges of the larger of new by old length and old by new.
    pub edge_stretch_mean: f64,
    /// The largest.
    pub edge_stretch_max: f64,
    /// Faces whose normal turned by more than a right angle against their neighbourhood.
    pub flipped_faces: usize,
    /// The enclosed volume, new by old; 1 where the surface encloses none.
    pub volume_ratio: f64,
}

impl FrameTimes {
    /// The statistics of frames that took `solve_ms` each, and their normals `normals_ms`.
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

/// The smallest of `sorted` that at least the share `q` of them does not exceed; 0 of none.
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

/// How much the surface's details changed as seen from the surface: the root of ∫ (H' − H)² dA over the rest shape,
/// with the mean curvatures H and H' before and after. It has no unit, and neither a rigid motion nor a turn of a detail
/// with its surroundings changes it; what the edit itself bends counts alike for all methods. `bent` has a position for
/// each surface vertex.
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
