//! The joins format: which places of two shapes `pliant merge` puts together, and how.

use pliant_deform::Method;
use serde::Deserialize;
use serde_json::{Value, json};

use super::edit_error::EditError;
use super::json::parse;
use super::method::read_method;
use super::reader::read;
use super::selector::Selector;
use super::version::check_version;
use crate::HandleTransform;

/// The joins of two shapes, A and B.
#[derive(Clone, PartialEq, Debug)]
pub struct JoinsFile {
    /// The vertices of A that are deleted first.
    pub delete_of_a: Selector,
    /// The vertices of B that are deleted first, by their places in its file.
    pub delete_of_b: Selector,
    /// The transform of B. Its default pivot is the mean of B's welded vertices that are left.
    pub transform: Option<HandleTransform>,
    /// The placement of B after that.
    pub placement: Placement,
    /// Vertices of A and of B that belong together, by the files' numbers.
    pub pairs: Vec<[u32; 2]>,
    /// The distance from the borders within which each part may bend, as a share of its diagonal.
    pub reach: f64,
    /// The method by which both bend.
    pub method: Method,
}

/// The placement of B before both are bent.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase", expecting = "\"fitted\" or \"kept\"")]
pub enum Placement {
    /// It is.
    #[default]
    Fitted,
    /// It stays where its transform puts it.
    Kept,
}

/// The members in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredJoins {
    #[serde(rename = "version")]
    _version: u64,
    #[serde(default)]
    a: StoredA,
    #[serde(default)]
    b: StoredB,
    #[serde(default)]
    pairs: Vec<[u32; 2]>,
    #[serde(default = "a_fifth")]
    reach: f64,
    #[serde(default = "default_method")]
    method: Value,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct StoredA {
    delete: Selector,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct StoredB {
    delete: Selector,
    transform: Option<HandleTransform>,
    placement: Placement,
}

impl Default for StoredA {
    fn default() -> Self {
        Self { delete: Selector::None }
    }
}

impl Default for StoredB {
    fn default() -> Self {
        Self {
            delete: Selector::None,
            transform: None,
            placement: Placement::Fitted,
        }
    }
}

fn a_fifth() -> f64 {
    0.2
}

fn default_method() -> Value {
    json!({ "name": Method::of_merges().name() })
}

impl JoinsFile {
    /// Reads the format's JSON text.
    ///
    /// # Errors
    /// Members that the format does not have, and values out of range, by name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        Self::read(text).map_err(|error| error.at("the joins"))
    }

    fn read(text: &str) -> Result<Self, EditError> {
        let value = parse(text)?;
        check_version(&value)?;
        let stored: StoredJoins = read(&value)?;
        let of_part =
            |selector: &Selector, part: &str| selector.check().map_err(|error| error.under("delete").under(part));
        of_part(&stored.a.delete, "a")?;
        of_part(&stored.b.delete, "b")?;
        let (method, attachments) = read_method(&stored.method).map_err(|error| error.under("method"))?;
        if let Some(name) = attachments.keys().next() {
            return Err(
                EditError::custom(format!("has `{name}`, which joins do not allow: leave it out")).under("method"),
            );
        }
        if !(stored.reach > 0.0 && stored.reach <= 10.0) {
            let found = json!(stored.reach);
            return Err(EditError::out_of_range(&found, "a share of the diagonal above 0, at most 10").under("reach"));
        }
        Ok(Self {
            delete_of_a: stored.a.delete,
            delete_of_b: stored.b.delete,
            transform: stored.b.transform,
            placement: stored.b.placement,
            pairs: stored.pairs,
            reach: stored.reach,
            method,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::{JoinsFile, Placement};

    #[test]
    fn every_member_but_the_version_may_be_left_out() {
        let joins = JoinsFile::parse(r#"{"version": 1}"#).unwrap();
        assert_eq!(
            (joins.reach, joins.method.name(), joins.pairs.len()),
            (0.2, "poisson", 0)
        );
        let joins = r#"{"version": 1, "a": {"delete": {"vertices": [1]}}, "b": {"placement": "kept",
            "transform": {"translation": [1, 2, 3]}}, "pairs": [[1, 2]], "reach": 0.5, "method": {"name": "arap"}}"#;
        let joins = JoinsFile::parse(joins).unwrap();
        assert_eq!(
            (joins.placement, joins.pairs[0], joins.method.name()),
            (Placement::Kept, [1, 2], "arap")
        );
        for (text, says) in [
            ("{}", "version"),
            (r#"{"version": 2}"#, "version"),
            (r#"{"version": 1, "reech": 1}"#, "reech"),
            (r#"{"version": 1, "reach": 0}"#, "reach"),
            (r#"{"version": 1, "pairs": [[1]]}"#, "pairs[0]"),
            (r#"{"version": 1, "b": {"placement": "there"}}"#, "b.placement"),
            (r#"{"version": 1, "method": {"name": "glue"}}"#, "glue"),
            (r#"{"version": 1, "a": {"transform": {}}}"#, "transform"),
        ] {
            let said = JoinsFile::parse(text).unwrap_err().to_string();
            assert!(said.contains(says), "{said}");
        }
    }
}
