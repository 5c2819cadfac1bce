//! A handle's vertices in the handle's own coordinates, and transforms in these coordinates.
//!
//! The coordinates are centred on the handle and scaled to it. Bases in f32 over world coordinates lose 3e-3 at ten
//! thousand diagonals from the origin; over these only 3e-8, for any position of the scan.

pub(crate) mod bases;
pub(crate) mod blend;
pub(crate) mod controls;
pub(crate) mod finite;
pub(crate) mod offsets;
pub(crate) mod polar;
pub(crate) mod residual;
pub(crate) mod screw;
pub(crate) mod turns;

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

use crate::numerical::rigid_fit::RigidMotion;
use crate::{Remedy, Warning};

/// The number of surface vertices that one task displaces.
pub(crate) const FRAME_CHUNK: usize = 4096;

/// Half a turn with room for rounding, in radians.
pub(crate) const HALF_TURN: f64 = std::f64::consts::PI * (1.0 + 1e-9);

/// A handle's vertices and its frame.
#[derive(Clone, Debug)]
pub(crate) struct Handle {
    /// Its surface vertices, ascending.
    pub vertices: Vec<u32>,
    /// The mean of their rest positions.
    pub world_centre: DVec3,
    /// The largest distance of a vertex from the centre; 1 if all are in one place.
    pub radius: f64,
}

/// The change by a transform: the displacement of the point `world_centre + radius * q` is `linear * q + shift`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Motion {
    pub linear: DMat3,
    pub shift: DVec3,
    /// The turn of the whole way from rest if it is known, axis times angle in radians: `linear` shows no full turns.
    pub turn_rad: Option<DVec3>,
}

impl Default for Motion {
    /// This is rest: a matrix's own default is the identity.
    fn default() -> Self {
        Self {
            linear: DMat3::ZERO,
            shift: DVec3::ZERO,
            turn_rad: None,
        }
    }
}

impl Handle {
    /// The frame of a handle with at least one vertex.
    pub fn new(vertices: Vec<u32>, world_positions: &[DVec3]) -> Self {
        let origin = vertices
            .first()
            .map_or(DVec3::ZERO, |&vertex| world_positions[vertex as usize]);
        let offset = vertices
            .iter()
            .map(|&vertex| world_positions[vertex as usize] - origin)
            .sum::<DVec3>();
        let world_centre = origin + offset / vertices.len().max(1) as f64;
        let radius = vertices
            .iter()
            .map(|&vertex| world_positions[vertex as usize].distance(world_centre))
            .fold(0.0, f64::max);
        Self {
            vertices,
            world_centre,
            radius: if radius > 0.0 { radius } else { 1.0 },
        }
    }

    /// The linear part of a motion's map.
    pub fn linear(&self, motion: &Motion) -> DMat3 {
        DMat3::IDENTITY + motion.linear * self.radius.recip()
    }

    /// A point in the handle's own coordinates, with a last entry 1 for the constant.
    pub fn coordinates(&self, world_point: DVec3) -> [f64; 4] {
        let q = (world_point - self.world_centre) / self.radius;
        [q.x, q.y, q.z, 1.0]
    }

    /// The change by `world_target`, zero to the last bit if it is the identity.
    pub fn motion(&self, world_target: &DAffine3) -> Motion {
        let change = world_target.matrix3 - DMat3::IDENTITY;
        Motion {
            linear: change * self.radius,
            shift: change * self.world_centre + world_target.translation,
            turn_rad: None,
        }
    }

    /// Another handle's motion in this one's coordinates.
    pub fn following(&self, other: &Handle, motion: &Motion) -> Motion {
        Motion {
            linear: motion.linear * (self.radius / other.radius),
            shift: motion.displace(other.coordinates(self.world_centre)),
            turn_rad: motion.turn_rad,
        }
    }

    /// A rigid motion in the handle's coordinates.
    pub fn rigid_motion(&self, rigid: &RigidMotion) -> Motion {
        Motion {
            linear: rigid.turn * self.radius,
            shift: rigid.displace(self.world_centre),
            turn_rad: None,
        }
    }
}

impl Motion {
    /// The displacement of a point given by its coordinates.
    pub fn displace(&self, coordinates: [f64; 4]) -> DVec3 {
        self.linear * DVec3::new(coordinates[0], coordinates[1], coordinates[2]) + self.shift * coordinates[3]
    }

    /// Returns true if nothing moves or has turned on its way.
    pub fn is_rest(&self) -> bool {
        self.linear == DMat3::ZERO && self.shift == DVec3::ZERO && !self.is_wound()
    }

    /// Returns true if the way turns by more than half a turn, so that the shape cannot be found from the map alone.
    pub fn is_wound(&self) -> bool {
        self.turn_rad.is_some_and(|turn| turn.length() > HALF_TURN)
    }
}

/// A sentence for handles that are moved but not turned or stretched, for a method that follows only the turn and
/// stretch around a handle. If nothing `is_held` and all handles move alike, everything moves with them.
pub(crate) fn only_moved(method: &str, motions: &[Motion], is_held: bool) -> Option<Warning> {
    /// A turn that moves the handle's rim by less than this share of the handle's displacement is ignored.
    const NEGLIGIBLE: f64 = 1e-3;
    let first = motions.first()?.shift;
    let is_only_moved = |motion: &Motion| {
        let turn = motion
            .linear
            .to_cols_array()
            .into_iter()
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        turn <= NEGLIGIBLE * motion.shift.length()
    };
    let moves = motions.iter().any(|motion| motion.shift != DVec3::ZERO)
        && (is_held || motions.iter().any(|motion| motion.shift != first));
    let sentence = || {
        format!(
            "{method} turns nothing for moves, and the handles only move, so the surface shears between them: turn a \
             handle, or take {}",
            Remedy::TurningByMoves
        )
    };
    (moves && motions.iter().all(is_only_moved)).then(|| sentence().into())
}

/// All zero.
pub(crate) fn clear(displacements: &mut [DVec3]) {
    displacements
        .par_chunks_mut(FRAME_CHUNK)
        .for_each(|chunk| chunk.fill(DVec3::ZERO));
}
