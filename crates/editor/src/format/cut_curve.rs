//! The file of the curve along which `pliant cut` cuts.

use glam::DVec3;
use serde::Deserialize;

use super::edit_error::EditError;
use super::json::parse;
use super::reader::read;
use super::transform::Numbers;
use super::version::check_version;
use crate::cut::{CutCurve, CutSight};

/// The members in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredCutCurve {
    #[serde(rename = "version")]
    _version: u64,
    points: Vec<Numbers<3>>,
    #[serde(default)]
    closed: bool,
}

impl CutCurve {
    /// Reads the format's JSON text.
    ///
    /// # Errors
    /// Members that the format does not have, and values out of range, by name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        Self::read(text).map_err(|error| error.at("the curve"))
    }

    fn read(text: &str) -> Result<Self, EditError> {
        let value = parse(text)?;
        check_version(&value)?;
        let stored: StoredCutCurve = read(&value)?;
        Ok(Self {
            points: stored.points.iter().map(|point| DVec3::from_array(point.0)).collect(),
            is_closed: stored.closed,
            sight: CutSight::Normals,
        })
    }
}
