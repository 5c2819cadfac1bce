//! A deserializer over JSON values whose refusals name the place: `handles[0].transform.scale must be 3 numbers, not
//! ..`.
//!
//! Code that serde derives calls the constructors in `refusal`, which keep names and values apart: a refusal can
//! propose the nearest known name. (`serde_path_to_error` over `serde_json` gives the place too, but the rest only as
//! text.) The place is assembled only while a refusal is passed outwards, so reading without one costs nothing.

use serde::de::{self, DeserializeSeed, Deserializer, EnumAccess, Expected, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};
use serde_json::{Map, Value};

use super::edit_error::{EditError, listed};
use super::refusal::unexpected;

/// Reads a value.
///
/// # Errors
/// Members that `T` does not have, by name and place within the value.
pub(crate) fn read<'de, T: Deserialize<'de>>(value: &'de Value) -> Result<T, EditError> {
    T::deserialize(Reader(value))
}

/// Reads a member of an object, which is required.
pub(crate) fn require<'a>(object: &'a Map<String, Value>, member: &'static str) -> Result<&'a Value, EditError> {
    object.get(member).ok_or_else(|| de::Error::missing_field(member))
}

#[derive(Clone, Copy)]
struct Reader<'de>(&'de Value);

impl Reader<'_> {
    /// The refusal of a value of the wrong kind.
    fn wrong_kind(self, expected: &dyn Expected) -> EditError {
        de::Error::invalid_type(unexpected(self.0), expected)
    }

    fn whole<N: TryFrom<u64> + std::fmt::Display>(self, most: N) -> Result<N, EditError> {
        let Value::Number(number) = self.0 else {
            return Err(self.wrong_kind(&"a whole number"));
        };
        let whole = number.as_u64().and_then(|number| N::try_from(number).ok());
        whole.ok_or_else(|| {
            let allowed = format!("a whole number from 0 to {most}");
            de::Error::invalid_value(unexpected(self.0), &&*allowed)
        })
    }
}

macro_rules! whole_numbers {
    ($($deserialize:ident $visit:ident $type:ident),*) => {$(
        fn $deserialize<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
            visitor.$visit(self.whole($type::MAX)?)
        }
    )*};
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = EditError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        match self.0 {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Array(values) => {
                let mut elements = Elements { values, next: 0 };
                let read = visitor.visit_seq(&mut elements)?;
                match elements.next == values.len() {
                    true => Ok(read),
                    false => Err(de::Error::invalid_length(
                        values.len(),
                        &&*format!("{} values", elements.next),
                    )),
                }
            }
            Value::Object(members) => visitor.visit_map(Members {
                members: members.iter(),
                value: None,
            }),
            Value::Number(number) => match (number.as_u64(), number.as_i64(), number.as_f64()) {
                (Some(number), ..) => visitor.visit_u64(number),
                (None, Some(number), _) => visitor.visit_i64(number),
                (None, None, number) => visitor.visit_f64(number.unwrap_or(f64::NAN)),
            },
        }
    }

    whole_numbers! {
        deserialize_u8 visit_u8 u8,
        deserialize_u16 visit_u16 u16,
        deserialize_u32 visit_u32 u32,
        deserialize_u64 visit_u64 u64
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        match self.0.as_f64() {
            Some(number) if number.is_finite() => visitor.visit_f64(number),
            Some(_) => Err(de::Error::invalid_value(unexpected(self.0), &"a finite number")),
            None => Err(self.wrong_kind(&"a number")),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        match self.0 {
            Value::Bool(value) => visitor.visit_bool(*value),
            _ => Err(self.wrong_kind(&"true or false")),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        match self.0 {
            Value::String(text) => visitor.visit_borrowed_str(text),
            _ => Err(self.wrong_kind(&"a string")),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, EditError> {
        let expected = format!("a list of {count} values");
        match self.0 {
            Value::Array(values) if values.len() == count => self.deserialize_any(visitor),
            Value::Array(values) => Err(de::Error::invalid_length(values.len(), &&*expected)),
            _ => Err(self.wrong_kind(&&*expected)),
        }
    }

    /// An existing member has a value: `null` is not allowed.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        visitor.visit_some(self)
    }

    /// Only an object is allowed: a list would not use names.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        members: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, EditError> {
        match self.0 {
            Value::Object(_) => self.deserialize_any(visitor),
            _ => Err(self.wrong_kind(&&*format!("an object with {}", listed(members)))),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, EditError> {
        visitor.visit_newtype_struct(self)
    }

    /// A name, or an object whose only member is one.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, EditError> {
        let variant = match self.0 {
            Value::String(name) => Variant { name, content: None },
            Value::Object(members) => {
                let mut members_of = members.iter();
                match (members_of.next(), members_of.next()) {
                    (Some((name, content)), None) => Variant {
                        name,
                        content: Some(content),
                    },
                    _ => {
                        let found = format!("an object with {} members", members.len());
                        return Err(de::Error::invalid_type(Unexpected::Other(&found), &visitor));
                    }
                }
            }
            _ => return Err(self.wrong_kind(&visitor)),
        };
        visitor.visit_enum(variant)
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u128 f32 char string bytes byte_buf unit unit_struct seq tuple_struct map identifier
        ignored_any
    }
}

struct Elements<'de> {
    values: &'de [Value],
    next: usize,
}

impl<'de> SeqAccess<'de> for &mut Elements<'de> {
    type Error = EditError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, EditError> {
        let Some(value) = self.values.get(self.next) else {
            return Ok(None);
        };
        let index = self.next;
        self.next += 1;
        let element = seed.deserialize(Reader(value));
        element.map(Some).map_err(|error| error.under(&format!("[{index}]")))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.values.len() - self.next)
    }
}

struct Members<'de> {
    members: serde_json::map::Iter<'de>,
    value: Option<(&'de String, &'de Value)>,
}

impl<'de> MapAccess<'de> for Members<'de> {
    type Error = EditError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, EditError> {
        self.value = self.members.next();
        self.value.map(|(name, _)| seed.deserialize(Name(name))).transpose()
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, EditError> {
        let (name, value) = self.value.take().ok_or_else(|| EditError::custom("has no value"))?;
        seed.deserialize(Reader(value)).map_err(|error| error.under(name))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.members.len())
    }
}

/// A member's name, which may be a number.
struct Name<'de>(&'de str);

impl<'de> Deserializer<'de> for Name<'de> {
    type Error = EditError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        visitor.visit_borrowed_str(self.0)
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, EditError> {
        match self.0.parse() {
            Ok(number) => visitor.visit_u32(number),
            Err(_) => Err(de::Error::invalid_value(Unexpected::Str(self.0), &"a whole number")),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

struct Variant<'de> {
    name: &'de str,
    content: Option<&'de Value>,
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = EditError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), EditError> {
        Ok((seed.deserialize(Name(self.name))?, self))
    }
}

impl<'de> de::VariantAccess<'de> for Variant<'de> {
    type Error = EditError;

    fn unit_variant(self) -> Result<(), EditError> {
        match self.content {
            None => Ok(()),
            Some(_) => Err(EditError::custom(format!(
                "must be \"{}\" alone, without a value",
                self.name
            ))),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, EditError> {
        let read = seed.deserialize(Reader(self.content()?));
        read.map_err(|error| error.under(self.name))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, EditError> {
        let read = Reader(self.content()?).deserialize_any(visitor);
        read.map_err(|error| error.under(self.name))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, EditError> {
        let read = Reader(self.content()?).deserialize_struct("", names, visitor);
        read.map_err(|error| error.under(self.name))
    }
}

impl<'de> Variant<'de> {
    fn content(&self) -> Result<&'de Value, EditError> {
        self.content.ok_or_else(|| {
            let expected = format!("an object such as {{\"{}\": ..}}", self.name);
            de::Error::invalid_type(Unexpected::Str(self.name), &&*expected)
        })
    }
}
