//! The effect of dragging on a handle's transform: a move, a turn about its pivot, a scale along its own axes.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::handle_transform::HandleTransform;

impl HandleTransform {
    /// A further move by `translation`, in world units.
    pub(crate) fn moved_by(self, way: DVec3) -> Self {
        match self {
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => Self::Trs {
                translation: translation + way,
                rotation,
                scale,
                pivot,
            },
            Self::Matrix(matrix) => Self::Matrix(DAffine3 {
                matrix3: matrix.matrix3,
                translation: matrix.translation + way,
            }),
        }
    }

    /// A further rotation about the present position of the rest shape's `pivot`.
    pub(crate) fn turned_by(self, turn: DQuat, pivot: DVec3) -> Self {
        match self {
            _ if turn == DQuat::IDENTITY => self,
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => Self::Trs {
                translation,
                rotation: (turn * rotation).normalize(),
                scale,
                pivot,
            },
            Self::Matrix(matrix) => Self::Matrix(with_linear(matrix, DMat3::from_quat(turn) * matrix.matrix3, pivot)),
        }
    }

    /// A further factor for each of the handle's own axes, about the present position of the rest shape's `pivot`.
    pub(crate) fn scaled_by(self, factors: DVec3, pivot: DVec3) -> Self {
        match self {
            Self::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => Self::Trs {
                translation,
                rotation,
                scale: scale * factors,
                pivot,
            },
            Self::Matrix(matrix) => Self::Matrix(with_linear(
                matrix,
                matrix.matrix3 * DMat3::from_diagonal(factors),
                pivot,
            )),
        }
    }
}

/// The map with another linear part and the same image of `pivot`.
fn with_linear(map: DAffine3, linear: DMat3, pivot: DVec3) -> DAffine3 {
    DAffine3 {
        matrix3: linear,
        translation: map.transform_point3(pivot) - linear * pivot,
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DQuat, DVec3};

    use super::super::handle_transform::HandleTransform;

    #[test]
    fn turning_and_scaling_leave_the_pivot_where_it_is_in_either_form() {
        let pivot = DVec3::new(1.0, -2.0, 0.5);
        let trs = HandleTransform::IDENTITY.moved_by(DVec3::new(0.0, 3.0, 1.0));
        for start in [trs, HandleTransform::Matrix(trs.affine(pivot))] {
            let centre = start.affine(pivot).transform_point3(pivot);
            let turned = start
                .turned_by(DQuat::from_rotation_z(0.7), pivot)
                .scaled_by(DVec3::new(2.0, 1.0, 0.5), pivot);
            assert!(turned.affine(pivot).transform_point3(pivot).distance(centre) < 1e-12);
        }
    }

    #[test]
    fn both_forms_do_the_same() {
        let pivot = DVec3::new(0.2, 0.4, -1.0);
        let go = |start: HandleTransform| -> DAffine3 {
            start
                .moved_by(DVec3::X)
                .turned_by(DQuat::from_rotation_y(1.1), pivot)
                .scaled_by(DVec3::new(1.5, 0.8, 1.0), pivot)
                .turned_by(DQuat::from_rotation_x(-0.4), pivot)
                .affine(pivot)
        };
        let (a, b) = (
            go(HandleTransform::IDENTITY),
            go(HandleTransform::Matrix(DAffine3::IDENTITY)),
        );
        assert!(a.abs_diff_eq(b, 1e-12), "{a:?} {b:?}");
    }
}
