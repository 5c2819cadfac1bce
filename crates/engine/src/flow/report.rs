//! The report about a flow. Times are in milliseconds.

use pliant_editor::FlowFile;
use pliant_flow::Flow;
use serde::Serialize;

use crate::loading::Loaded;
use crate::report::{FrameTimes, finite_or};

/// The course of a flow. Every number is finite.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct FlowReport {
    /// The number of the file's vertices.
    pub vertices: usize,
    /// The number of welded vertices.
    pub welded_vertices: usize,
    /// The number of triangles.
    pub triangles: usize,
    /// The length of a step, in seconds.
    pub step: f64,
    /// The steps' times, and their number.
    #[serde(rename = "frames")]
    pub steps: FrameTimes,
    /// The time from the file on disk to the welded surface.
    pub load_ms: f64,
    /// The time of ordering and factoring the Laplacian, and of laying the surface out.
    pub bind_ms: f64,
    /// The time of all saves.
    pub save_ms: f64,
    /// Half the integral of the squared speed.
    pub kinetic_energy: FromTo<f64>,
    /// The integral over the surface of dye's red, green and blue and of its coverage.
    pub dye: FromTo<[f64; 4]>,
    /// The norm of the divergence at the end over that of the velocity, times the mean edge.
    pub divergence: f64,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

/// A quantity at the start and at the end.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize)]
pub struct FromTo<T> {
    /// At the start.
    pub start: T,
    /// At the end.
    pub end: T,
}

impl FlowReport {
    pub(super) fn at_start(loaded: &Loaded, file: &FlowFile, flow: &Flow<'_>) -> Self {
        let mut report = Self {
            vertices: loaded.model.drawn.file_vertex_count(),
            welded_vertices: loaded.model.surface.positions.len(),
            triangles: loaded.model.surface.triangles.len(),
            step: file.step,
            steps: FrameTimes::default(),
            load_ms: 0.0,
            bind_ms: 0.0,
            save_ms: 0.0,
            kinetic_energy: FromTo::default(),
            dye: FromTo::default(),
            divergence: 0.0,
            warnings: Vec::new(),
        };
        report.at_end(flow);
        report.kinetic_energy.start = report.kinetic_energy.end;
        report.dye.start = report.dye.end;
        report
    }

    pub(super) fn at_end(&mut self, flow: &Flow<'_>) {
        self.kinetic_energy.end = finite_or(flow.kinetic_energy(), f64::MAX);
        self.dye.end = flow.dye_integral();
        let speed = (2.0 * flow.kinetic_energy()).sqrt();
        let unit = speed / flow.mean_edge();
        self.divergence = if unit > 0.0 {
            finite_or(flow.divergence() / unit, f64::MAX)
        } else {
            0.0
        };
    }

    /// The report as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        // A struct of numbers, strings and lists always serialises.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}
