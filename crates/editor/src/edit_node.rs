//! A place in an edit's JSON: a value that knows where it stands, so that every refusal can name it.

use std::fmt::Display;

use serde_json::{Map, Value};

use crate::edit_error::{EditError, remedy};

/// A JSON value and its place in the edit, e.g. `handles[0].transform`.
#[derive(Clone, Debug)]
pub(crate) struct Node<'a> {
    value: &'a Value,
    place: String,
}

/// An object whose members were checked against the format's.
#[derive(Clone, Debug)]
pub(crate) struct Members<'a> {
    members: &'a Map<String, Value>,
    place: String,
}

impl<'a> Node<'a> {
    pub(crate) fn new(value: &'a Value, place: &str) -> Self {
        Self {
            value,
            place: place.to_owned(),
        }
    }

    pub(crate) fn value(&self) -> &'a Value {
        self.value
    }

    pub(crate) fn place(&self) -> &str {
        &self.place
    }

    /// The object here; a member that `known` lacks is refused by name.
    pub(crate) fn object(&self, expected: &str, known: &[&str]) -> Result<Members<'a>, EditError> {
        let members = self.value.as_object().ok_or_else(|| self.wrong_kind(expected))?;
        match members.keys().find(|member| !known.contains(&member.as_str())) {
            Some(member) => Err(EditError::UnknownMember {
                member: shortened(member),
                place: self.place.clone(),
                remedy: remedy(member, known),
            }),
            None => Ok(Members {
                members,
                place: self.place.clone(),
            }),
        }
    }

    /// The elements of the array here.
    pub(crate) fn elements(&self, expected: &str) -> Result<impl ExactSizeIterator<Item = Node<'a>>, EditError> {
        let elements = self.value.as_array().ok_or_else(|| self.wrong_kind(expected))?;
        let place = self.place.clone();
        Ok(elements.iter().enumerate().map(move |(i, value)| Node {
            value,
            place: format!("{place}[{i}]"),
        }))
    }

    /// `N` finite numbers.
    pub(crate) fn numbers<const N: usize>(&self) -> Result<[f64; N], EditError> {
        let expected = format!("{N} numbers");
        let elements = self.value.as_array().ok_or_else(|| self.wrong_kind(&expected))?;
        if elements.len() != N {
            let found = format!("{} values", elements.len());
            return Err(EditError::WrongKind {
                place: self.place.clone(),
                expected,
                found,
            });
        }
        let mut numbers = [0.0; N];
        for (number, node) in numbers.iter_mut().zip(self.elements(&expected)?) {
            *number = node.number()?;
        }
        Ok(numbers)
    }

    /// A list of any length, each element by `read`; only an element that is refused costs a place's name.
    pub(crate) fn list<T>(
        &self,
        expected: &str,
        read: impl Fn(&Node<'a>) -> Result<T, EditError>,
    ) -> Result<Vec<T>, EditError> {
        let elements = self.value.as_array().ok_or_else(|| self.wrong_kind(expected))?;
        let mut list = Vec::with_capacity(elements.len());
        for (i, value) in elements.iter().enumerate() {
            match read(&Node {
                value,
                place: String::new(),
            }) {
                Ok(element) => list.push(element),
                Err(_) => list.push(read(&Node {
                    value,
                    place: format!("{}[{i}]", self.place),
                })?),
            }
        }
        Ok(list)
    }

    /// A finite number.
    pub(crate) fn number(&self) -> Result<f64, EditError> {
        let number = self.value.as_f64().ok_or_else(|| self.wrong_kind("a number"))?;
        if number.is_finite() {
            Ok(number)
        } else {
            Err(self.out_of_range("a finite number"))
        }
    }

    /// A whole number that is not negative.
    pub(crate) fn whole(&self) -> Result<u64, EditError> {
        match self.value.as_u64() {
            Some(whole) => Ok(whole),
            None if self.value.is_number() => Err(self.out_of_range("a whole number from 0 on")),
            None => Err(self.wrong_kind("a whole number")),
        }
    }

    /// A string.
    pub(crate) fn string(&self, expected: &str) -> Result<&'a str, EditError> {
        self.value.as_str().ok_or_else(|| self.wrong_kind(expected))
    }

    /// The refusal of a value of the wrong kind.
    pub(crate) fn wrong_kind(&self, expected: &str) -> EditError {
        EditError::WrongKind {
            place: self.place.clone(),
            expected: expected.to_owned(),
            found: kind(self.value),
        }
    }

    /// The refusal of this value, which lies outside of what is `allowed`.
    pub(crate) fn out_of_range(&self, allowed: impl Display) -> EditError {
        let found = shortened(&self.value.to_string());
        EditError::OutOfRange {
            place: self.place.clone(),
            found,
            allowed: allowed.to_string(),
        }
    }

    /// The refusal of a name that the format does not have.
    pub(crate) fn unknown_name(&self, name: &str, known: &[&str]) -> EditError {
        EditError::UnknownName {
            name: shortened(name),
            place: self.place.clone(),
            remedy: remedy(name, known),
        }
    }
}

impl<'a> Members<'a> {
    /// The member `name`, if it is there.
    pub(crate) fn get(&self, name: &str) -> Option<Node<'a>> {
        let place = if self.place == ROOT {
            name.to_owned()
        } else {
            format!("{}.{name}", self.place)
        };
        self.members.get(name).map(|value| Node { value, place })
    }

    /// The member `name`, which must be there.
    pub(crate) fn require(&self, name: &'static str) -> Result<Node<'a>, EditError> {
        self.get(name).ok_or_else(|| EditError::Missing {
            member: name,
            place: self.place.clone(),
        })
    }

    /// The names that are there.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'a str> {
        self.members.keys().map(String::as_str)
    }
}

/// The place of the whole edit.
pub(crate) const ROOT: &str = "the edit";

fn kind(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(_) => "true or false".to_owned(),
        Value::Number(number) => format!("the number {number}"),
        Value::String(string) => format!("\"{}\"", shortened(string)),
        Value::Array(_) => "a list".to_owned(),
        Value::Object(_) => "an object".to_owned(),
    }
}

/// Keeps a refusal to one readable line, whatever the file holds.
fn shortened(text: &str) -> String {
    let clean: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .take(60)
        .collect();
    if text.chars().count() > 60 { clean + ".." } else { clean }
}
