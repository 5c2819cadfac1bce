//! The refusals of derived code, as an [`EditError`] that keeps names and values apart.
//!
//! The place is the present value: [`EditError::under`] completes it on the way out.

use serde::de::{self, Expected, Unexpected};
use serde_json::Value;

use super::edit_error::{EditError, remedy};
use crate::warning::shortened;

/// A value in serde's terms.
pub(super) fn unexpected(value: &Value) -> Unexpected<'_> {
    match value {
        Value::Null => Unexpected::Unit,
        Value::Bool(value) => Unexpected::Bool(*value),
        Value::String(text) => Unexpected::Str(text),
        Value::Array(_) => Unexpected::Seq,
        Value::Object(_) => Unexpected::Map,
        Value::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(number), _) => Unexpected::Unsigned(number),
            (None, Some(number)) => Unexpected::Signed(number),
            (None, None) => Unexpected::Float(number.as_f64().unwrap_or(f64::NAN)),
        },
    }
}

/// The constructors that derived code calls.
impl de::Error for EditError {
    fn custom<T: std::fmt::Display>(sentence: T) -> Self {
        Self::Other {
            place: String::new(),
            sentence: sentence.to_string(),
        }
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::WrongKind {
            place: String::new(),
            expected: expected.to_string(),
            found: kind(found),
        }
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::OutOfRange {
            place: String::new(),
            found: match found {
                Unexpected::Unsigned(number) => number.to_string(),
                Unexpected::Signed(number) => number.to_string(),
                Unexpected::Float(number) => number.to_string(),
                found => kind(found),
            },
            allowed: expected.to_string(),
        }
    }

    fn invalid_length(count: usize, expected: &dyn Expected) -> Self {
        Self::WrongKind {
            place: String::new(),
            expected: expected.to_string(),
            found: format!("{count} values"),
        }
    }

    fn unknown_variant(name: &str, known: &'static [&'static str]) -> Self {
        Self::unknown_name(name, known)
    }

    fn unknown_field(member: &str, known: &'static [&'static str]) -> Self {
        Self::unknown_member(member, known)
    }

    fn missing_field(member: &'static str) -> Self {
        Self::Missing {
            member,
            place: String::new(),
        }
    }

    fn duplicate_field(member: &'static str) -> Self {
        Self::Duplicate {
            member: member.to_owned(),
            place: String::new(),
        }
    }
}

impl EditError {
    /// The refusal of a name that the format does not have here.
    pub(crate) fn unknown_name(name: &str, known: &[&str]) -> Self {
        Self::UnknownName {
            name: shortened(name),
            place: String::new(),
            remedy: remedy(name, known),
        }
    }

    /// The refusal of a member that the format does not have here.
    pub(crate) fn unknown_member(member: &str, known: &[&str]) -> Self {
        Self::UnknownMember {
            member: shortened(member),
            place: String::new(),
            remedy: remedy(member, known),
        }
    }

    /// The refusal of a value outside `allowed`.
    pub(crate) fn out_of_range(value: &Value, allowed: &str) -> Self {
        de::Error::invalid_value(unexpected(value), &allowed)
    }

    /// The refusal of a value that is not of the `expected` kind.
    pub(crate) fn wrong_kind(value: &Value, expected: &str) -> Self {
        de::Error::invalid_type(unexpected(value), &expected)
    }

    /// `de::Error::custom` for code that knows the type.
    pub(crate) fn custom(sentence: impl std::fmt::Display) -> Self {
        de::Error::custom(sentence)
    }
}

fn kind(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Unit => "null".to_owned(),
        Unexpected::Bool(_) => "true or false".to_owned(),
        Unexpected::Unsigned(number) => format!("the number {number}"),
        Unexpected::Signed(number) => format!("the number {number}"),
        Unexpected::Float(number) => format!("the number {number}"),
        Unexpected::Str(text) => format!("\"{}\"", shortened(text)),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "an object".to_owned(),
        Unexpected::Other(what) => what.to_owned(),
        other => other.to_string(),
    }
}
