//! Edits where only one shape is made.

use super::edit_error::EditError;
use super::edit_file::EditFile;

/// Refuses an edit with keys or filters where only one shape is made; `instead` says what makes all of them.
///
/// # Errors
/// [`EditError::Other`], if there are some.
pub fn refuse_keys(edit: &EditFile, instead: &str) -> Result<(), EditError> {
    let members = [
        ("keys", edit.keys.is_empty()),
        ("filter", edit.filter.is_empty()),
        ("footprints", edit.footprints.is_empty()),
    ];
    let Some((member, _)) = members.into_iter().find(|(_, is_empty)| !is_empty) else {
        return Ok(());
    };
    Err(EditError::Other {
        place: "the edit".to_owned(),
        sentence: format!("has `{member}`, and only one shape is made here: {instead}"),
    })
}
