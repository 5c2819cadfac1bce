//! Edits where only one shape is made.

use super::edit_error::EditError;
use super::edit_file::EditFile;

/// Refuses an edit of keys or of a sequence where only one shape is made; `instead` says what makes all of them.
///
/// # Errors
/// [`EditError::Other`], if there are some.
pub fn refuse_keys(edit: &EditFile, instead: &str) -> Result<(), EditError> {
    let keys = (!edit.keys.is_empty()).then_some("keys");
    let Some(member) = keys.or_else(|| edit.member_of_sequences()) else {
        return Ok(());
    };
    Err(EditError::Other {
        place: "the edit".to_owned(),
        sentence: format!("has `{member}`, and only one shape is made here: {instead}"),
    })
}
