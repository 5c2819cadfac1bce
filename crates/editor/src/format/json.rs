//! JSON text as a value. An object with a member that occurs twice is refused, because its meaning is unclear.

use std::cell::RefCell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

use super::edit_error::EditError;
use crate::warning::shortened;

/// Reads a text, with or without a byte order mark in front, which some editors write.
///
/// # Errors
/// Text that is not JSON, by line and column; a member that occurs twice, by its place.
pub(crate) fn parse(text: &str) -> Result<Value, EditError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let duplicate = RefCell::new(None);
    let whole = Unique {
        place: Place::Whole,
        duplicate: &duplicate,
    };
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let read = whole
        .deserialize(&mut deserializer)
        .and_then(|value| deserializer.end().map(|()| value));
    match (duplicate.into_inner(), read) {
        (Some(duplicate), _) => Err(duplicate),
        (None, Ok(value)) => Ok(value),
        (None, Err(error)) => Err(EditError::Json(error.to_string())),
    }
}

/// The place of a value, which becomes words only if it must be named.
#[derive(Clone, Copy)]
enum Place<'a> {
    Whole,
    Member(&'a Place<'a>, &'a str),
    Element(&'a Place<'a>, usize),
}

impl Place<'_> {
    /// The refusal with its place within the whole text.
    fn complete(&self, error: EditError) -> EditError {
        match self {
            Self::Whole => error,
            Self::Member(outer, name) => outer.complete(error.under(&shortened(name))),
            Self::Element(outer, index) => outer.complete(error.under(&format!("[{index}]"))),
        }
    }
}

/// Reads a value at a place.
#[derive(Clone, Copy)]
struct Unique<'a> {
    place: Place<'a>,
    duplicate: &'a RefCell<Option<EditError>>,
}

impl<'de> DeserializeSeed<'de> for Unique<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Unique<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        loop {
            let element = Unique {
                place: Place::Element(&self.place, values.len()),
                ..self
            };
            match elements.next_element_seed(element)? {
                Some(value) => values.push(value),
                None => return Ok(Value::Array(values)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Value, A::Error> {
        let mut values = Map::new();
        while let Some(name) = members.next_key::<String>()? {
            let member = Unique {
                place: Place::Member(&self.place, &name),
                ..self
            };
            let value = members.next_value_seed(member)?;
            if values.contains_key(&name) {
                let error = EditError::Duplicate {
                    member: shortened(&name),
                    place: String::new(),
                };
                *self.duplicate.borrow_mut() = Some(self.place.complete(error));
                return Err(A::Error::custom("a member appears twice"));
            }
            values.insert(name, value);
        }
        Ok(Value::Object(values))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_member_twice_is_read_as_serde_json_reads_it() {
        for text in [
            r#"{"a": [1, -2, 0.1, 1e300, 18446744073709551615, true, null, "ü\n"], "b": {"a": {}}}"#,
            "[]",
            "\u{feff}7",
        ] {
            let plain = text.trim_start_matches('\u{feff}');
            assert_eq!(parse(text).unwrap(), serde_json::from_str::<Value>(plain).unwrap());
        }
        for text in ["", "{", "[1,]", "{} {}", "nope", r#"{"a": 1,, "b": 2}"#] {
            let said = parse(text).unwrap_err().at("the edit").to_string();
            assert!(said.contains("not valid JSON") && said.contains("line 1"), "{said}");
        }
    }

    #[test]
    fn a_member_that_stands_twice_is_refused_by_its_place() {
        for (text, member, place) in [
            (r#"{"a": 1, "a": 1}"#, "`a`", "the edit"),
            (r#"{"a": [{}, {"b": {"c": 1, "c": 2}}]}"#, "`c`", "a[1].b"),
            (r#"[[{"x": 1, "x": 2}]]"#, "`x`", "[0][0]"),
        ] {
            let said = parse(text).unwrap_err().at("the edit").to_string();
            assert!(
                said.contains(member) && said.contains(&format!(" in {place}:")),
                "{said}"
            );
        }
    }
}
