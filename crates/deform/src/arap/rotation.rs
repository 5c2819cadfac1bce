//! A cell's rotation as it is kept: a quaternion in single precision.

use glam::DQuat;

/// A quaternion: x, y, z, w.
pub(crate) type Rotation = [f32; 4];

/// A rotation, to compute with.
pub(crate) fn wide(rotation: Rotation) -> DQuat {
    DQuat::from_array(rotation.map(f64::from)).normalize()
}

/// A rotation, to keep.
pub(crate) fn narrow(rotation: DQuat) -> Rotation {
    rotation.to_array().map(|value| value as f32)
}

/// The quaternion that turns nothing.
pub(crate) const IDENTITY: Rotation = [0.0, 0.0, 0.0, 1.0];
