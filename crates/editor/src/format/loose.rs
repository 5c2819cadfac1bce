//! The behaviour of loose parts, in both formats: one word for all, or a list of selections with one each.

use std::fmt;
use std::marker::PhantomData;

use pliant_deform::Loose;
use serde::de::value::{SeqAccessDeserializer, StrDeserializer, U64Deserializer};
use serde::de::{Deserializer, Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

/// [`Loose`] by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", expecting = "\"follow\", \"rest\" or \"bend\"")]
pub(crate) enum StoredLoose {
    Follow,
    Rest,
    Bend,
}

impl From<Loose> for StoredLoose {
    fn from(loose: Loose) -> Self {
        match loose {
            Loose::Follow => Self::Follow,
            Loose::Rest => Self::Rest,
            Loose::Bend => Self::Bend,
        }
    }
}

impl From<StoredLoose> for Loose {
    fn from(stored: StoredLoose) -> Self {
        match stored {
            StoredLoose::Follow => Self::Follow,
            StoredLoose::Rest => Self::Rest,
            StoredLoose::Bend => Self::Bend,
        }
    }
}

/// One value for all, or a list of entries. Serde's `untagged` would give no reason for either.
#[derive(Clone, PartialEq, Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum OneOrList<T, E> {
    One(T),
    List(Vec<E>),
}

/// The description of a place for one value or a list.
pub(crate) trait One {
    const EXPECTED: &str;
}

impl One for StoredLoose {
    const EXPECTED: &str = "\"follow\", \"rest\", \"bend\", or a list of selections with one each";
}

/// A continuity.
impl One for f64 {
    const EXPECTED: &str = "a number from 0 to 2, or a list of selections with one each";
}

impl<'de, T: Deserialize<'de> + One, E: Deserialize<'de>> Deserialize<'de> for OneOrList<T, E> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Form(PhantomData))
    }
}

struct Form<T, E>(PhantomData<(T, E)>);

impl<'de, T: Deserialize<'de> + One, E: Deserialize<'de>> Visitor<'de> for Form<T, E> {
    type Value = OneOrList<T, E>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_str<R: Error>(self, text: &str) -> Result<Self::Value, R> {
        let text: StrDeserializer<'_, R> = text.into_deserializer();
        T::deserialize(text).map(OneOrList::One)
    }

    fn visit_u64<R: Error>(self, number: u64) -> Result<Self::Value, R> {
        let number: U64Deserializer<R> = number.into_deserializer();
        T::deserialize(number).map(OneOrList::One)
    }

    fn visit_i64<R: Error>(self, number: i64) -> Result<Self::Value, R> {
        self.visit_f64(number as f64)
    }

    fn visit_f64<R: Error>(self, number: f64) -> Result<Self::Value, R> {
        T::deserialize(IntoDeserializer::<R>::into_deserializer(number)).map(OneOrList::One)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Self::Value, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(elements)).map(OneOrList::List)
    }
}
