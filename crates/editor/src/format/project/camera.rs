//! The camera in a project.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::view::{Camera, Projection, UpAxis};

#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredCamera {
    target: [f64; 3],
    distance: f64,
    yaw_rad: f64,
    pitch_rad: f64,
    fov_y_rad: f64,
    up: StoredUp,
    scale: f64,
    #[serde(default)]
    roll_rad: f64,
    #[serde(default)]
    projection: StoredProjection,
}

#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StoredProjection {
    #[default]
    Perspective,
    Orthographic,
}

#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StoredUp {
    Y,
    Z,
}

impl StoredCamera {
    pub(super) fn of(camera: &Camera) -> Self {
        Self {
            target: camera.target.to_array(),
            distance: camera.distance,
            yaw_rad: camera.yaw_rad,
            pitch_rad: camera.pitch_rad,
            fov_y_rad: camera.fov_y_rad,
            up: match camera.up {
                UpAxis::Y => StoredUp::Y,
                UpAxis::Z => StoredUp::Z,
            },
            scale: camera.scale,
            roll_rad: camera.roll_rad,
            projection: match camera.projection {
                Projection::Perspective => StoredProjection::Perspective,
                Projection::Orthographic => StoredProjection::Orthographic,
            },
        }
    }

    pub(super) fn camera(self) -> Camera {
        Camera {
            target: DVec3::from_array(self.target),
            distance: self.distance,
            yaw_rad: self.yaw_rad,
            pitch_rad: self.pitch_rad,
            fov_y_rad: self.fov_y_rad,
            up: match self.up {
                StoredUp::Y => UpAxis::Y,
                StoredUp::Z => UpAxis::Z,
            },
            scale: self.scale,
            roll_rad: self.roll_rad,
            projection: match self.projection {
                StoredProjection::Perspective => Projection::Perspective,
                StoredProjection::Orthographic => Projection::Orthographic,
            },
        }
    }
}
