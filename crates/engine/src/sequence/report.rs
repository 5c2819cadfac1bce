//! The report about an edited sequence. Times are in milliseconds.

use serde::Serialize;

use crate::animate::MorphReport;

/// The course of an edited sequence. Every number is finite.
#[derive(Clone, PartialEq, Debug, Default, Serialize)]
pub struct SequenceReport {
    /// The method's name.
    pub method: String,
    /// The number of each frame's vertices.
    pub vertices: usize,
    /// The number of frames.
    pub frames: usize,
    /// The number of frames that the edit changed.
    pub bent_frames: usize,
    /// The number of those that did not settle within the method's limit.
    pub unsettled_frames: usize,
    /// The number of footprints that were found.
    pub footprints: usize,
    /// The morph targets, in a glTF.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub morph: Option<MorphReport>,
    /// The time of the whole.
    pub total_ms: f64,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

impl SequenceReport {
    /// Notes warnings, each once.
    pub(super) fn warn(&mut self, warnings: impl IntoIterator<Item = String>) {
        for warning in warnings {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// Notes the end: the time of the whole, and frames that did not settle.
    pub(super) fn conclude(&mut self, total_ms: f64) {
        self.total_ms = total_ms;
        let unsettled = match self.unsettled_frames {
            0 => return,
            1 => "1 frame".to_owned(),
            count => format!("{count} frames"),
        };
        self.warn([format!(
            "{unsettled} did not settle within the step limit: take another method"
        )]);
    }

    /// The report as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        // A struct of numbers, strings and lists always serialises.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}
