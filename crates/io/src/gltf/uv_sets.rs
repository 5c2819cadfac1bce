//! The sets of texture coordinates of a material's images, and their transforms.

use glam::{Mat3, Vec2};

/// KHR_texture_transform: scaled, then turned, then shifted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct UvTransform {
    pub offset: [f32; 2],
    /// Counterclockwise, radians.
    pub rotation: f32,
    pub scale: [f32; 2],
}

impl UvTransform {
    pub const IDENTITY: Self = Self {
        offset: [0.0; 2],
        rotation: 0.0,
        scale: [1.0; 2],
    };

    /// The texture coordinates of the look-up in the image.
    pub fn apply(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        if *self == Self::IDENTITY {
            return [u, v];
        }
        let (sin, cos) = self.rotation.sin_cos();
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        [cos * u + sin * v + self.offset[0], cos * v - sin * u + self.offset[1]]
    }

    /// Its identity.
    pub fn bits(&self) -> [u32; 5] {
        let ([u, v], [s, t]) = (self.offset, self.scale);
        [u, v, self.rotation, s, t].map(f32::to_bits)
    }

    pub fn matrix(&self) -> Mat3 {
        let at = |uv| Vec2::from(self.apply(uv));
        let origin = at([0.0, 0.0]);
        Mat3::from_cols(
            (at([1.0, 0.0]) - origin).extend(0.0),
            (at([0.0, 1.0]) - origin).extend(0.0),
            origin.extend(1.0),
        )
    }
}

/// The sets of texture coordinates of a material's images.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct MaterialMaps {
    /// The set of the base colour's image; without one, of the first other image.
    pub base_set: u32,
    /// The transform of that set on the way to the drawn vertices.
    pub base_transform: UvTransform,
    /// The first other set that an image uses.
    pub second_set: Option<u32>,
}

impl Default for MaterialMaps {
    fn default() -> Self {
        Self {
            base_set: 0,
            base_transform: UvTransform::IDENTITY,
            second_set: None,
        }
    }
}
