//! The coloured files of a flow, written beside their places until all of them are there.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use pliant_mesh::Progress;

use super::colours::Colours;
use crate::EngineError;
use crate::files::{Destination, Staged, Staging};
use crate::loading::Loaded;
use crate::report::ms_since;
use crate::saving::{self, SaveAs};
use crate::watch::Watch;

/// The files so far.
pub(super) struct ColouredFiles<'a> {
    loaded: &'a Loaded,
    /// The position of each drawn vertex in all files.
    positions: &'a [DVec3],
    inside_out: &'a BTreeSet<u32>,
    colours: Colours,
    /// The report, which no file may replace.
    beside: Option<&'a Destination>,
    staging: &'a Staging,
    pub staged: Option<Staged>,
    pub warnings: Vec<String>,
    /// The time of writing, in milliseconds.
    pub save_ms: f64,
}

impl<'a> ColouredFiles<'a> {
    /// No files yet.
    pub fn new(
        loaded: &'a Loaded,
        positions: &'a [DVec3],
        inside_out: &'a BTreeSet<u32>,
        beside: Option<&'a Destination>,
        staging: &'a Staging,
    ) -> Self {
        Self {
            loaded,
            positions,
            inside_out,
            colours: Colours::of(loaded),
            beside,
            staging,
            staged: None,
            warnings: Vec::new(),
            save_ms: 0.0,
        }
    }

    /// Writes a file with a dye for each surface vertex beside its place.
    ///
    /// # Errors
    /// Those of [`saving::stage`].
    pub fn write(&mut self, dyes: &[[f64; 4]], place: &Path, watch: &Watch) -> Result<(), EngineError> {
        let start = Instant::now();
        let colours = self.colours.with(dyes, &self.loaded.model);
        let save = SaveAs {
            inside_out: self.inside_out,
            colours: colours.as_deref(),
            beside: self.beside.map(|report| ("--report", report)),
            ..SaveAs::shape(self.positions, place)
        };
        let saved = saving::stage(self.loaded, &save, self.staging, &Progress::new(), &watch.cancel)?;
        for warning in saved.warnings {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        self.staged = Some(joined(self.staged.take(), saved.staged));
        self.save_ms += ms_since(start);
        Ok(())
    }
}

/// Both, which are then committed together.
pub(super) fn joined(first: Option<Staged>, second: Staged) -> Staged {
    match first {
        Some(first) => first.and(second),
        None => second,
    }
}
