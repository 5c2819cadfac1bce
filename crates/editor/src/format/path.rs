//! The bent path of a body through a sequence.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use super::transform::Numbers;
use crate::document::BodyPath;
use crate::ground_axis::GroundAxis;

/// The path of a whole body, bent by moving it at some frames.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathEntry {
    /// The name of the handle whose middle makes the path, such as the hips; without a name it is the middle of the whole
    /// body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub handle: Option<String>,
    /// The frames at which the path is moved, ascending, at least two.
    pub frames: Vec<u32>,
    /// The way of the body at each of them, in world units.
    translations: Vec<Numbers<3>>,
    /// The axis about which the body turns with the path.
    #[serde(default)]
    pub up: GroundAxis,
}

impl PathEntry {
    /// The path of the whole body.
    pub(super) fn of(path: &BodyPath) -> Self {
        Self {
            handle: None,
            frames: path.shifts().map(|(frame, _)| frame as u32).collect(),
            translations: path.shifts().map(|(_, shift)| Numbers(shift.to_array())).collect(),
            up: path.up(),
        }
    }

    /// The same for a document; `None` with fewer than two frames.
    pub(super) fn path(&self) -> Option<BodyPath> {
        BodyPath::of(self.shifts(1.0).into_iter().collect(), self.up)
    }

    /// The frames, and the share `strength` of the way of the body at each.
    pub(super) fn shifts(&self, strength: f64) -> Vec<(usize, DVec3)> {
        let ways = self.translations.iter().map(|way| DVec3::from_array(way.0) * strength);
        self.frames.iter().map(|frame| *frame as usize).zip(ways).collect()
    }

    /// Refuses frames that do not ascend and do not fit the translations.
    pub(super) fn check(&self) -> Result<(), EditError> {
        let refuse = |sentence: String| EditError::Other {
            place: "path".to_owned(),
            sentence,
        };
        let (frames, translations) = (self.frames.len(), self.translations.len());
        if frames != translations {
            return Err(refuse(format!(
                "has {frames} frames and {translations} translations: give one translation for each frame"
            )));
        }
        if frames < 2 {
            return Err(refuse("has fewer than two frames: give two at least".to_owned()));
        }
        if let Some(pair) = self.frames.windows(2).find(|pair| pair[0] >= pair[1]) {
            let [before, after] = [pair[0], pair[1]];
            return Err(refuse(format!(
                "has frame {after} after frame {before}: give them in ascending order, each once"
            )));
        }
        Ok(())
    }

    /// Refuses those of [`check`](Self::check), and the path of a handle: that of a document is the whole body's.
    pub(super) fn check_of_document(&self) -> Result<(), EditError> {
        if self.handle.is_some() {
            return Err(EditError::Other {
                place: "path".to_owned(),
                sentence: "has a `handle`, but the path of a project is that of the whole body: remove it".to_owned(),
            });
        }
        self.check()
    }

    /// Refuses frames that a sequence of `count` frames does not have.
    pub(super) fn check_frames(&self, count: usize) -> Result<(), EditError> {
        match self.frames.last().filter(|last| **last as usize >= count) {
            None => Ok(()),
            Some(last) => Err(EditError::OutOfRange {
                place: "path.frames".to_owned(),
                found: last.to_string(),
                allowed: format!("frames from 0 to {}", count.saturating_sub(1)),
            }),
        }
    }
}
