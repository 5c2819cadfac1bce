//! The stored form of a cell's rotation: a quaternion in single precision.

use glam::DQuat;

/// A quaternion: x, y, z, w.
pub(crate) type Rotation = [f32; 4];

/// A rotation for computing.
pub(crate) fn wide(rotation: Rotation) -> DQuat {
    DQuat::from_array(rotation.map(f64::from)).normalize()
}

/// A rotation for storage.
pub(crate) fn narrow(rotation: DQuat) -> Rotation {
    rotation.to_array().map(|value| value as f32)
}

/// The identity.
pub(crate) const IDENTITY: Rotation = [0.0, 0.0, 0.0, 1.0];
