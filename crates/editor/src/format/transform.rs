//! A handle's transform in both formats: `translation`, `rotation`, `scale` and `pivot`, or a `matrix`.

use std::fmt;

use glam::{DAffine3, DMat4, DQuat, DVec3};
use serde::de::{Deserializer, Error, SeqAccess, Unexpected, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use crate::HandleTransform;

/// `N` numbers. A tuple would be refused as a tuple.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Numbers<const N: usize>(pub [f64; N]);

/// The members in the file, by name.
#[derive(Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct StoredTransform {
    #[serde(skip_serializing_if = "Option::is_none")]
    matrix: Option<Matrix>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pivot: Option<Numbers<3>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<Rotation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<Scale>,
    #[serde(skip_serializing_if = "Option::is_none")]
    translation: Option<Numbers<3>>,
}

/// A unit quaternion; any nonzero one is read.
struct Rotation(DQuat);

/// Factors; zero is refused, because it would flatten the handle for good.
struct Scale(DVec3);

/// An affine map of 16 numbers, column by column; a singular one is refused.
struct Matrix(DAffine3);

impl Serialize for HandleTransform {
    /// Default values are left out.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let stored = match *self {
            Self::Matrix(matrix) => StoredTransform {
                matrix: Some(Matrix(matrix)),
                ..StoredTransform::default()
            },
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => StoredTransform {
                matrix: None,
                pivot: pivot.map(|pivot| Numbers(pivot.to_array())),
                rotation: (rotation != DQuat::IDENTITY).then_some(Rotation(rotation)),
                scale: (scale != DVec3::ONE).then_some(Scale(scale)),
                translation: (translation != DVec3::ZERO).then_some(Numbers(translation.to_array())),
            },
        };
        stored.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for HandleTransform {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredTransform::deserialize(deserializer)?;
        let Some(Matrix(matrix)) = stored.matrix else {
            return Ok(Self::Trs {
                translation: stored.translation.map_or(DVec3::ZERO, |numbers| numbers.0.into()),
                rotation: stored.rotation.map_or(DQuat::IDENTITY, |rotation| rotation.0),
                scale: stored.scale.map_or(DVec3::ONE, |scale| scale.0),
                pivot: stored.pivot.map(|numbers| numbers.0.into()),
            });
        };
        let others = [
            ("translation", stored.translation.is_some()),
            ("rotation", stored.rotation.is_some()),
            ("scale", stored.scale.is_some()),
            ("pivot", stored.pivot.is_some()),
        ];
        match others.iter().find(|(_, is_there)| *is_there) {
            None => Ok(Self::Matrix(matrix)),
            Some((other, _)) => Err(D::Error::custom(format!(
                "has both `matrix` and `{other}`: keep one of them"
            ))),
        }
    }
}

impl<'de> Deserialize<'de> for Rotation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Numbers([x, y, z, w]) = Numbers::deserialize(deserializer)?;
        // Scaled first, so that neither tiny nor huge numbers leave the range of f64 when squared.
        let largest = x.abs().max(y.abs()).max(z.abs()).max(w.abs());
        if largest == 0.0 {
            return refused("0, 0, 0, 0", "a quaternion x, y, z, w with a length above 0");
        }
        let raw = DQuat::from_xyzw(x / largest, y / largest, z / largest, w / largest);
        // A quaternion that is normalised already keeps its bits, so that writing and reading an edit changes nothing.
        let direct = DQuat::from_xyzw(x, y, z, w);
        if (direct.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON {
            Ok(Self(direct))
        } else {
            Ok(Self(raw.normalize()))
        }
    }
}

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let scale = DVec3::from_array(Numbers::deserialize(deserializer)?.0);
        let transform = HandleTransform::Trs {
            translation: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            scale,
            pivot: None,
        };
        if !transform.can_be_undone() {
            let found = format!("{}, {}, {}", scale.x, scale.y, scale.z);
            return refused(&found, "three factors other than 0");
        }
        Ok(Self(scale))
    }
}

impl<'de> Deserialize<'de> for Matrix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Numbers(m) = Numbers::<16>::deserialize(deserializer)?;
        if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
            return refused(
                &format!("a matrix whose last row is {}, {}, {}, {}", m[3], m[7], m[11], m[15]),
                "16 numbers, column by column, with 0, 0, 0, 1 as their last row",
            );
        }
        let matrix = DAffine3::from_mat4(DMat4::from_cols_array(&m));
        if !HandleTransform::Matrix(matrix).can_be_undone() {
            return refused(
                "a matrix that flattens the handle",
                "one whose first three columns point in independent directions",
            );
        }
        Ok(Self(matrix))
    }
}

fn refused<T, E: Error>(found: &str, allowed: &str) -> Result<T, E> {
    Err(E::invalid_value(Unexpected::Other(found), &allowed))
}

impl Serialize for Rotation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.to_array().serialize(serializer)
    }
}

impl Serialize for Scale {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.to_array().serialize(serializer)
    }
}

impl Serialize for Matrix {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        DMat4::from(self.0).to_cols_array().serialize(serializer)
    }
}

impl<const N: usize> Serialize for Numbers<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.as_slice().serialize(serializer)
    }
}

impl<'de, const N: usize> Deserialize<'de> for Numbers<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Form<const N: usize>;

        impl<'de, const N: usize> Visitor<'de> for Form<N> {
            type Value = Numbers<N>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{N} numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Numbers<N>, A::Error> {
                let mut numbers = Vec::with_capacity(N);
                while let Some(number) = elements.next_element::<f64>()? {
                    numbers.push(number);
                }
                let count = numbers.len();
                let numbers = numbers.try_into();
                numbers.map(Numbers).map_err(|_| A::Error::invalid_length(count, &self))
            }
        }

        deserializer.deserialize_seq(Form)
    }
}

/// A point or a direction, as three numbers, for `#[serde(with)]`: glam's own serde feature would affect every crate.
pub(crate) mod vector {
    use super::{DVec3, Deserialize, Deserializer, Numbers, Serialize, Serializer};

    pub fn serialize<S: Serializer>(vector: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
        vector.to_array().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
        Numbers::deserialize(deserializer).map(|numbers| DVec3::from_array(numbers.0))
    }
}

/// The same, if it is there.
pub(crate) mod optional_vector {
    use super::{DVec3, Deserializer, Serialize, Serializer, vector};

    pub fn serialize<S: Serializer>(vector: &Option<DVec3>, serializer: S) -> Result<S::Ok, S::Error> {
        vector.map(|vector| vector.to_array()).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<DVec3>, D::Error> {
        vector::deserialize(deserializer).map(Some)
    }
}
