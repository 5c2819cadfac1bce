//! Coordinates of a brought cage, stored for every moving vertex: the field of the moves by hand is a product with
//! them.

use glam::{DMat3, DVec3, Mat3};
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::lane_rows::{BLOCKS, LaneRows, by_blocks};
use super::mean_value_at::Weight;
use crate::BindError;
use crate::numerical::lanes::LANES;
use crate::space::falloff::Falloff;
use crate::space::hand_field::outer;

/// The field, which fades towards fixed vertices.
#[derive(Debug)]
pub(super) struct StoredField {
    /// The moving vertices, ascending, with their falloff.
    vertices: Vec<u32>,
    falloff: Falloff,
    rows: LaneRows<f64>,
    /// The gradients along x, y and z per world unit; in single precision, because only normals use them.
    gradients: [LaneRows<f32>; 3],
}

/// The bytes of a vertex' coordinates in a cage with `vertex_count` vertices.
pub(super) fn stored_bytes(vertex_count: usize) -> usize {
    vertex_count * (size_of::<f64>() + 3 * size_of::<f32>()) + 2 * size_of::<DVec3>()
}

impl StoredField {
    /// Stores `count` coordinates at these points, one point for each of `vertices`. `length` is the points' unit in
    /// world units. `visit_each` visits some points' coordinates, each with its gradient.
    ///
    /// # Errors
    /// It was cancelled, or there is no memory.
    pub fn of(
        count: usize,
        (vertices, falloff): (Vec<u32>, Falloff),
        points: &[DVec3],
        length: f64,
        cancel: &Cancel,
        visit_each: impl Fn(&[DVec3], &mut dyn FnMut(usize, &[Weight])) + Sync,
    ) -> Result<Self, BindError> {
        let out_of_memory = |_| BindError::OutOfMemory {
            free_count: points.len(),
        };
        let mut rows = LaneRows::zeros(points.len(), count).map_err(out_of_memory)?;
        let axis = || LaneRows::zeros(points.len(), count).map_err(out_of_memory);
        let [mut x, mut y, mut z] = [axis()?, axis()?, axis()?];
        let axes = x.tasks_mut().zip(y.tasks_mut()).zip(z.tasks_mut());
        let tasks = points.par_chunks(LANES * BLOCKS).zip(rows.tasks_mut()).zip(axes);
        tasks.try_for_each(|((points, rows), ((x, y), z))| {
            cancel.check()?;
            visit_each(points, &mut |place, weights| {
                let (first, lane) = (place / LANES * count, place % LANES);
                for (column, (value, gradient)) in weights.iter().enumerate() {
                    let gradient = (*gradient / length).as_vec3();
                    rows[first + column][lane] = *value;
                    x[first + column][lane] = gradient.x;
                    y[first + column][lane] = gradient.y;
                    z[first + column][lane] = gradient.z;
                }
            });
            Ok::<_, BindError>(())
        })?;
        Ok(Self {
            vertices,
            falloff,
            rows,
            gradients: [x, y, z],
        })
    }

    /// Adds the displacements of the vertices.
    pub fn add(&self, moves: &[DVec3], displacements: &mut [DVec3]) {
        by_blocks(&self.vertices, displacements, |block, own| {
            for (lane, (out, sum)) in own.zip(self.rows.block_product(block, moves)).enumerate() {
                *out += sum * self.falloff.at(block * LANES + lane).0;
            }
        });
    }

    /// Adds the Jacobians of the displacements.
    pub fn add_jacobians(&self, moves: &[DVec3], out: &mut [Mat3]) {
        by_blocks(&self.vertices, out, |block, own| {
            let [x, y, z] = self.gradients.each_ref().map(|axis| axis.block_product(block, moves));
            let fades: [(f64, DVec3); LANES] = std::array::from_fn(|lane| self.falloff.at(block * LANES + lane));
            // The values matter only where the field fades.
            let sums = match fades.iter().any(|(_, slope)| *slope != DVec3::ZERO) {
                true => self.rows.block_product(block, moves),
                false => [DVec3::ZERO; LANES],
            };
            for (lane, out) in own.enumerate() {
                let (factor, slope) = fades[lane];
                let jacobian = DMat3::from_cols(x[lane], y[lane], z[lane]) * factor + outer(sums[lane], slope);
                *out += jacobian.as_mat3();
            }
        });
    }
}
