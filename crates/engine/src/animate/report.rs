//! The report about an animation. Times are in milliseconds.

use serde::Serialize;

use crate::loading::Loaded;
use crate::report::FrameTimes;

/// The course of an animation. Every number is finite.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct AnimationReport {
    /// The method's name.
    pub method: String,
    /// The number of the file's vertices.
    pub vertices: usize,
    /// The number of welded vertices.
    pub welded_vertices: usize,
    /// The frames a second.
    pub fps: f64,
    /// The times of the solved frames, and their number.
    pub frames: FrameTimes,
    /// The number of frames that did not settle within the method's limit.
    pub unsettled_frames: usize,
    /// The time from the file on disk to the welded surface.
    pub load_ms: f64,
    /// The time of ordering and binding.
    pub bind_ms: f64,
    /// The time of all saves.
    pub save_ms: f64,
    /// The morph targets, in a glTF.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub morph: Option<MorphReport>,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

/// The morph targets of an animation.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct MorphReport {
    /// Their number.
    pub targets: usize,
    /// The largest permitted distance of a vertex from its place in a frame, in world units.
    pub bound: f64,
    /// The largest distance, before the numbers were rounded to the file's single precision.
    pub largest_error: f64,
    /// The diagonal of the shape's box at rest, of which the bound is a share.
    pub diagonal: f64,
}

impl AnimationReport {
    pub(super) fn at_start(loaded: &Loaded, method: &str, fps: f64) -> Self {
        Self {
            method: method.to_owned(),
            vertices: loaded.model.drawn.file_vertex_count(),
            welded_vertices: loaded.model.surface.positions.len(),
            fps,
            frames: FrameTimes::default(),
            unsettled_frames: 0,
            load_ms: 0.0,
            bind_ms: 0.0,
            save_ms: 0.0,
            morph: None,
            warnings: loaded.scene.notes().to_vec(),
        }
    }

    /// The report as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        // A struct of numbers, strings and lists always serialises.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}
