//! How a handle is moved: a translation, rotation and scale about a pivot, or a matrix.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::{Value, json};

use super::polar::polar_decomposition;
use crate::edit_error::EditError;
use crate::edit_node::Node;

/// A handle's transform, acting on world positions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum HandleTransform {
    /// p' = pivot + translation + R·S·(p − pivot).
    Trs {
        /// In world units.
        translation: DVec3,
        /// A unit quaternion.
        rotation: DQuat,
        /// One factor an axis; a negative one mirrors.
        scale: DVec3,
        /// In world space; `None` is the mean of the handle's welded rest positions.
        pivot: Option<DVec3>,
    },
    /// Any affine map of world positions.
    Matrix(DAffine3),
}

impl HandleTransform {
    /// The transform that moves nothing.
    pub const IDENTITY: Self = Self::Trs {
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };

    /// Whether every point stays exactly where it is.
    pub fn is_identity(&self) -> bool {
        match *self {
            Self::Trs {
                translation,
                rotation,
                scale,
                ..
            } => translation == DVec3::ZERO && scale == DVec3::ONE && rotation.xyz() == DVec3::ZERO,
            Self::Matrix(matrix) => matrix == DAffine3::IDENTITY,
        }
    }

    /// The pivot that the transform names, or else `default`.
    pub fn pivot_or(&self, default: DVec3) -> DVec3 {
        match *self {
            Self::Trs { pivot, .. } => pivot.unwrap_or(default),
            Self::Matrix(_) => default,
        }
    }

    /// The map of world positions; `default_pivot` stands in for a pivot that the transform does not name.
    ///
    /// A transform that only translates has no rounding of the pivot in it, and the identity is the exact identity.
    pub fn affine(&self, default_pivot: DVec3) -> DAffine3 {
        match *self {
            Self::Trs {
                translation,
                rotation,
                scale,
                ..
            } => {
                let linear = if rotation.xyz() == DVec3::ZERO {
                    DMat3::from_diagonal(scale)
                } else {
                    DMat3::from_quat(rotation) * DMat3::from_diagonal(scale)
                };
                about(self.pivot_or(default_pivot), linear, translation)
            }
            Self::Matrix(matrix) => matrix,
        }
    }

    /// The map of world positions at the share `t` of a drag, 0 at rest and 1 at the target.
    ///
    /// Translation and scale go linearly and the rotation by slerp about the pivot, the short way round. A matrix is
    /// split by its polar decomposition about `default_pivot`: its rotation goes by slerp, its stretch and the
    /// pivot's way linearly.
    pub fn at(&self, t: f64, default_pivot: DVec3) -> DAffine3 {
        if t == 0.0 {
            return DAffine3::IDENTITY;
        }
        if t == 1.0 {
            return self.affine(default_pivot);
        }
        let pivot = self.pivot_or(default_pivot);
        let (rotation, stretch, translation) = match *self {
            Self::Trs {
                translation,
                rotation,
                scale,
                ..
            } => (rotation, DMat3::from_diagonal(scale), translation),
            Self::Matrix(matrix) => {
                let (rotation, stretch) = polar_decomposition(matrix.matrix3);
                (rotation, stretch, matrix.transform_point3(pivot) - pivot)
            }
        };
        let rotation = DQuat::IDENTITY.slerp(rotation, t).normalize();
        let stretch = DMat3::IDENTITY + (stretch - DMat3::IDENTITY) * t;
        let turned = if rotation.xyz() == DVec3::ZERO {
            stretch
        } else {
            DMat3::from_quat(rotation) * stretch
        };
        about(pivot, turned, translation * t)
    }

    pub(crate) fn read(node: &Node<'_>) -> Result<Self, EditError> {
        const KNOWN: [&str; 5] = ["translation", "rotation", "scale", "pivot", "matrix"];
        let members = node.object(
            "an object with `translation`, `rotation`, `scale`, `pivot` or `matrix`",
            &KNOWN,
        )?;
        if let Some(matrix) = members.get("matrix") {
            if let Some(second) = members.names().find(|&name| name != "matrix") {
                let place = node.place().to_owned();
                return Err(EditError::Both {
                    place,
                    first: "matrix",
                    second: second.to_owned(),
                });
            }
            return Ok(Self::Matrix(read_matrix(&matrix)?));
        }
        let vector = |name: &str, default: DVec3| match members.get(name) {
            Some(node) => node.numbers::<3>().map(DVec3::from_array),
            None => Ok(default),
        };
        let rotation = match members.get("rotation") {
            Some(node) => read_rotation(&node)?,
            None => DQuat::IDENTITY,
        };
        let pivot = members
            .get("pivot")
            .map(|node| node.numbers::<3>().map(DVec3::from_array))
            .transpose()?;
        Ok(Self::Trs {
            translation: vector("translation", DVec3::ZERO)?,
            rotation,
            scale: vector("scale", DVec3::ONE)?,
            pivot,
        })
    }

    /// The transform as the edit format has it; what is at its default is left out.
    pub(crate) fn to_value(self) -> Value {
        match self {
            Self::Matrix(matrix) => {
                let columns = glam::DMat4::from(matrix).to_cols_array();
                json!({ "matrix": columns })
            }
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => {
                let mut members = serde_json::Map::new();
                if translation != DVec3::ZERO {
                    members.insert("translation".to_owned(), json!(translation.to_array()));
                }
                if rotation != DQuat::IDENTITY {
                    members.insert("rotation".to_owned(), json!(rotation.to_array()));
                }
                if scale != DVec3::ONE {
                    members.insert("scale".to_owned(), json!(scale.to_array()));
                }
                if let Some(pivot) = pivot {
                    members.insert("pivot".to_owned(), json!(pivot.to_array()));
                }
                Value::Object(members)
            }
        }
    }
}

/// p' = pivot + translation + linear·(p − pivot).
fn about(pivot: DVec3, linear: DMat3, translation: DVec3) -> DAffine3 {
    let shift = if linear == DMat3::IDENTITY {
        translation
    } else {
        pivot + translation - linear * pivot
    };
    DAffine3 {
        matrix3: linear,
        translation: shift,
    }
}

fn read_rotation(node: &Node<'_>) -> Result<DQuat, EditError> {
    let [x, y, z, w] = node.numbers::<4>()?;
    // Scaled first, so that neither tiny nor huge numbers leave the range of f64 when squared.
    let largest = x.abs().max(y.abs()).max(z.abs()).max(w.abs());
    if largest == 0.0 {
        return Err(node.out_of_range("a quaternion x, y, z, w whose length is not 0"));
    }
    let raw = DQuat::from_xyzw(x / largest, y / largest, z / largest, w / largest);
    // What is normalised already keeps its bits, so that writing and reading an edit changes nothing.
    let direct = DQuat::from_xyzw(x, y, z, w);
    if (direct.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON {
        Ok(direct)
    } else {
        Ok(raw.normalize())
    }
}

fn read_matrix(node: &Node<'_>) -> Result<DAffine3, EditError> {
    let m = node.numbers::<16>()?;
    if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
        return Err(EditError::OutOfRange {
            place: node.place().to_owned(),
            found: format!("a matrix whose last row is {}, {}, {}, {}", m[3], m[7], m[11], m[15]),
            allowed: "16 numbers, column by column, with 0, 0, 0, 1 as their last row".to_owned(),
        });
    }
    Ok(DAffine3::from_cols_array(&[
        m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10], m[12], m[13], m[14],
    ]))
}
