//! The motion of a handle: a translation, rotation and scale about a pivot, or a matrix.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::polar::polar_decomposition;

/// A handle's transform, acting on world positions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum HandleTransform {
    /// p' = pivot + translation + R·S·(p − pivot).
    Trs {
        /// In world units.
        translation: DVec3,
        /// A unit quaternion.
        rotation: DQuat,
        /// One factor per axis; a negative one mirrors.
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

    /// Returns true if every point stays exactly where it is.
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

    /// Returns true if no direction is flattened; the formats require this too. A tiny scale is allowed.
    pub fn can_be_undone(&self) -> bool {
        match self {
            Self::Trs { scale, .. } => scale.is_finite() && !scale.cmpeq(DVec3::ZERO).any(),
            Self::Matrix(matrix) => matrix.is_finite() && !is_singular(&matrix.matrix3),
        }
    }

    /// The pivot of the transform, or else `default`.
    pub fn pivot_or(&self, default: DVec3) -> DVec3 {
        match *self {
            Self::Trs { pivot, .. } => pivot.unwrap_or(default),
            Self::Matrix(_) => default,
        }
    }

    /// The map of world positions; `default_pivot` replaces a missing pivot of the transform.
    ///
    /// A pure translation has no rounding of the pivot, and the identity is the exact identity.
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

    /// The map of world positions at the share `t` of a drag, 0 at rest and 1 at the target: the map of
    /// [`HandleTransform::part`].
    pub fn at(&self, t: f64, default_pivot: DVec3) -> DAffine3 {
        self.part(t, default_pivot).affine(default_pivot)
    }

    /// The transform at the share `t` of a drag, 0 at rest and 1 at the target.
    ///
    /// Translation and scale are interpolated linearly and the rotation by slerp about the pivot, the short way round.
    /// A matrix is split by its polar decomposition about `default_pivot`: its rotation is interpolated by slerp, its
    /// stretch and the pivot's displacement linearly.
    #[must_use]
    pub fn part(&self, t: f64, default_pivot: DVec3) -> Self {
        self.part_turned(t, default_pivot, |rotation| {
            DQuat::IDENTITY.slerp(rotation, t).normalize()
        })
    }

    /// The same with another interpolation of the turn: `part_of` gives the share of a rotation.
    pub(crate) fn part_turned(&self, t: f64, default_pivot: DVec3, part_of: impl FnOnce(DQuat) -> DQuat) -> Self {
        if t == 1.0 {
            return *self;
        }
        match *self {
            Self::Trs { pivot, .. } if t == 0.0 => Self::Trs {
                translation: DVec3::ZERO,
                rotation: DQuat::IDENTITY,
                scale: DVec3::ONE,
                pivot,
            },
            Self::Matrix(_) if t == 0.0 => Self::Matrix(DAffine3::IDENTITY),
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => Self::Trs {
                translation: translation * t,
                rotation: part_of(rotation),
                scale: DVec3::ONE + (scale - DVec3::ONE) * t,
                pivot,
            },
            Self::Matrix(matrix) => {
                let (rotation, stretch) = polar_decomposition(matrix.matrix3);
                let way = matrix.transform_point3(default_pivot) - default_pivot;
                let stretch = DMat3::IDENTITY + (stretch - DMat3::IDENTITY) * t;
                Self::Matrix(about(
                    default_pivot,
                    DMat3::from_quat(part_of(rotation)) * stretch,
                    way * t,
                ))
            }
        }
    }
}

/// A transform in parts that can be interpolated: p' = pivot + translation + rotation·stretch·(p − pivot).
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct SplitTransform {
    /// In world space.
    pub(crate) pivot: DVec3,
    /// In world units.
    pub(crate) translation: DVec3,
    /// A unit quaternion.
    pub(crate) rotation: DQuat,
    /// The scale, or the symmetric factor of a matrix.
    pub(crate) stretch: DMat3,
}

impl SplitTransform {
    /// The parts of a transform; a matrix is split by its polar decomposition about `default_pivot`.
    pub(crate) fn of(transform: &HandleTransform, default_pivot: DVec3) -> Self {
        match *transform {
            HandleTransform::Trs {
                translation,
                rotation,
                scale,
                ..
            } => Self {
                pivot: transform.pivot_or(default_pivot),
                translation,
                rotation,
                stretch: DMat3::from_diagonal(scale),
            },
            HandleTransform::Matrix(matrix) => {
                let (rotation, stretch) = polar_decomposition(matrix.matrix3);
                Self {
                    pivot: default_pivot,
                    translation: matrix.transform_point3(default_pivot) - default_pivot,
                    rotation,
                    stretch,
                }
            }
        }
    }

    /// The map of world positions.
    pub(crate) fn affine(&self) -> DAffine3 {
        let linear = match self.rotation.xyz() == DVec3::ZERO {
            true => self.stretch,
            false => DMat3::from_quat(self.rotation) * self.stretch,
        };
        about(self.pivot, linear, self.translation)
    }

    /// The same map as a handle's transform about its pivot.
    pub(crate) fn about(&self, pivot: DVec3) -> HandleTransform {
        let scale = DVec3::new(self.stretch.x_axis.x, self.stretch.y_axis.y, self.stretch.z_axis.z);
        if self.stretch != DMat3::from_diagonal(scale) {
            return HandleTransform::Matrix(self.affine());
        }
        let is_about_pivot = self.pivot == pivot;
        HandleTransform::Trs {
            translation: match is_about_pivot {
                true => self.translation,
                false => self.affine().transform_point3(pivot) - pivot,
            },
            rotation: self.rotation,
            scale,
            pivot: None,
        }
    }
}

impl Default for HandleTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// Returns true if a column is zero or in the plane of the other two, to the precision of f64. A small or uneven scale
/// does not matter.
fn is_singular(linear: &DMat3) -> bool {
    let unit = |column: DVec3| {
        // Scaled first, so that the length of a tiny column is not zero.
        let largest = column.abs().max_element();
        (column / largest).normalize()
    };
    let directions = DMat3::from_cols(unit(linear.x_axis), unit(linear.y_axis), unit(linear.z_axis));
    // NaN, for a zero column, is singular too.
    directions.determinant().abs().partial_cmp(&(8.0 * f64::EPSILON)) != Some(std::cmp::Ordering::Greater)
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
