//! The keys of an edit: handles' transforms at times, or at frames of a sequence.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use crate::HandleTransform;
use crate::timeline::Ease;

/// The transforms of some handles at a time.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyEntry {
    /// In seconds, at least 0.
    pub time: f64,
    /// The way to the next key.
    #[serde(default, skip_serializing_if = "is_smooth")]
    pub ease: Ease,
    /// The transforms, by the handles' names.
    #[serde(default)]
    pub handles: BTreeMap<String, HandleTransform>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
fn is_smooth(ease: &Ease) -> bool {
    *ease == Ease::Smooth
}

/// Refuses an edit with keys where only one shape is made; `instead` says what makes all of them.
///
/// # Errors
/// [`EditError::Other`], if there are keys.
pub fn refuse_keys(keys: &[KeyEntry], instead: &str) -> Result<(), EditError> {
    match keys {
        [] => Ok(()),
        _ => Err(EditError::Other {
            place: "the edit".to_owned(),
            sentence: format!("has `keys`, and only one shape is made here: {instead}"),
        }),
    }
}

/// Refuses times below 0, and two keys at the same time.
pub(super) fn check_keys(keys: &[KeyEntry]) -> Result<(), EditError> {
    for (place, key) in keys.iter().enumerate() {
        let allowed = if key.time < 0.0 {
            "a time in seconds of at least 0"
        } else if keys[..place].iter().any(|other| other.time == key.time) {
            "a time that no other key has"
        } else {
            continue;
        };
        return Err(EditError::OutOfRange {
            place: format!("keys[{place}].time"),
            found: key.time.to_string(),
            allowed: allowed.to_owned(),
        });
    }
    Ok(())
}
