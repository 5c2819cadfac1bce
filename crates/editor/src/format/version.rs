//! The version with which every file of the edit format begins.

use serde_json::Value;

use super::edit_error::EditError;
use crate::warning::shortened;

/// The version of the edit format for reading and writing.
pub const EDIT_VERSION: u64 = 1;

/// Refuses another version. It comes before all other members: another one may have some that this one lacks.
///
/// # Errors
/// The version that was found.
pub(super) fn check_version(value: &Value) -> Result<(), EditError> {
    match value.get("version") {
        Some(found) if found.as_u64() != Some(EDIT_VERSION) => Err(EditError::Version {
            found: shortened(&found.to_string()),
        }),
        _ => Ok(()),
    }
}
