//! The Green coordinates of the points that a cage moves.
//!
//! The coordinates are stored, and for small regions their gradients, too. These are three times as many numbers, so a
//! large region's gradients would take longer to read than a frame may: there the normals are computed from the
//! triangles, and the coordinates are in single precision, which costs 1e-7 of the cage's motion.

use glam::DVec3;
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::green::Green;
use super::lane_rows::{LaneRows, lane_rows_bytes};
use super::mesh::CageMesh;
use crate::BindError;
use crate::budget::bytes_of;
use crate::handles::bases::Stored;
use crate::numerical::lanes::LANES;

/// The most bytes of stored gradients: about ten milliseconds of reading.
const MOST_GRADIENTS: u64 = 256 << 20;

/// The points' coordinates.
#[derive(Debug)]
pub(super) enum GreenTable {
    /// The coordinates with their gradients along x, y and z, in single precision, because only normals use them.
    Small(LaneRows<f64>, [LaneRows<f32>; 3]),
    Large(LaneRows<f32>),
}

/// The bytes of the coordinates of `point_count` points.
pub(super) fn green_bytes(cage: &CageMesh, point_count: usize) -> u64 {
    let count = cage.vertices.len() + cage.faces.len();
    let rows = if is_small(point_count, count) {
        lane_rows_bytes::<f64>(point_count, count) + 3 * lane_rows_bytes::<f32>(point_count, count)
    } else {
        lane_rows_bytes::<f32>(point_count, count)
    };
    rows + bytes_of(point_count, 2 * size_of::<DVec3>())
}

fn is_small(point_count: usize, count: usize) -> bool {
    3 * lane_rows_bytes::<f32>(point_count, count) <= MOST_GRADIENTS
}

impl GreenTable {
    /// Computes the coordinates of these points.
    ///
    /// # Errors
    /// It was cancelled, or there is no memory.
    pub fn of(green: &Green<'_>, points: &[DVec3], cancel: &Cancel) -> Result<Self, BindError> {
        if !is_small(points.len(), green.count()) {
            return Ok(Self::Large(green_rows(green, points, cancel)?));
        }
        let mut rows = zeros(points.len(), green)?;
        let mut gradients = [
            zeros(points.len(), green)?,
            zeros(points.len(), green)?,
            zeros(points.len(), green)?,
        ];
        fill_with_gradients(green, points, &mut rows, &mut gradients, cancel)?;
        Ok(Self::Small(rows, gradients))
    }

    /// The sums of coordinates times terms at the eight points of a block.
    pub fn block_product(&self, block: usize, terms: &[DVec3]) -> [DVec3; LANES] {
        match self {
            Self::Small(rows, _) => rows.block_product(block, terms),
            Self::Large(rows) => rows.block_product(block, terms),
        }
    }
}

/// Computes the coordinates of some points.
///
/// # Errors
/// It was cancelled, or there is no memory.
pub(super) fn green_rows<T: Stored>(
    green: &Green<'_>,
    points: &[DVec3],
    cancel: &Cancel,
) -> Result<LaneRows<T>, BindError> {
    let mut rows: LaneRows<T> = zeros(points.len(), green)?;
    let blocks = points.par_chunks(LANES).zip(rows.blocks_mut());
    blocks.try_for_each(|(points, rows)| {
        cancel.check()?;
        let mut values = vec![0.0; green.count()];
        for (lane, &point) in points.iter().enumerate() {
            green.at(point, &mut values, None);
            put(rows, lane, values.iter().copied());
        }
        Ok::<_, BindError>(())
    })?;
    Ok(rows)
}

fn zeros<T: Stored>(point_count: usize, green: &Green<'_>) -> Result<LaneRows<T>, BindError> {
    LaneRows::zeros(point_count, green.count()).map_err(|_| BindError::OutOfMemory {
        free_count: point_count,
    })
}

/// Fills in the coordinates of points and their gradients along the axes.
fn fill_with_gradients(
    green: &Green<'_>,
    points: &[DVec3],
    rows: &mut LaneRows<f64>,
    [x, y, z]: &mut [LaneRows<f32>; 3],
    cancel: &Cancel,
) -> Result<(), BindError> {
    let axes = x.blocks_mut().zip(y.blocks_mut()).zip(z.blocks_mut());
    let blocks = points.par_chunks(LANES).zip(rows.blocks_mut()).zip(axes);
    blocks.try_for_each(|((points, rows), ((x, y), z))| {
        cancel.check()?;
        let (mut values, mut gradients) = (vec![0.0; green.count()], vec![DVec3::ZERO; green.count()]);
        for (lane, &point) in points.iter().enumerate() {
            green.at(point, &mut values, Some(&mut gradients));
            put(rows, lane, values.iter().copied());
            put(x, lane, gradients.iter().map(|gradient| gradient.x));
            put(y, lane, gradients.iter().map(|gradient| gradient.y));
            put(z, lane, gradients.iter().map(|gradient| gradient.z));
        }
        Ok(())
    })
}

/// Writes one row of a block.
fn put<T: Stored>(block: &mut [[T; LANES]], lane: usize, values: impl Iterator<Item = f64>) {
    for (entry, value) in block.iter_mut().zip(values) {
        entry[lane] = T::of(value);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use glam::DVec3;
    use pliant_mesh::Cancel;

    use super::{Green, GreenTable, green_rows};
    use crate::methods::cage::mesh::CageMesh;

    #[test]
    fn tables_of_small_and_of_large_regions_agree_to_single_precision() {
        let vertices = [[0.0; 3], [1.0, 0.1, 0.0], [0.2, 1.3, 0.0], [0.1, 0.2, 0.9]].map(DVec3::from_array);
        let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let cage = CageMesh::new(vertices.to_vec(), faces);
        let green = Green::new(&cage);
        // The points are more than a block, and the last block is not full.
        let points: Vec<DVec3> = (0..13)
            .map(|i| DVec3::splat(0.1) + DVec3::splat(0.01) * f64::from(i))
            .collect();
        let terms: Vec<DVec3> = (0..8).map(|i| DVec3::new(f64::from(i).sin(), 0.3, -1.0)).collect();
        let small = GreenTable::of(&green, &points, &Cancel::new()).unwrap();
        let large = GreenTable::Large(green_rows(&green, &points, &Cancel::new()).unwrap());
        for (number, point) in points.iter().enumerate() {
            let mut values = vec![0.0; green.count()];
            green.at(*point, &mut values, None);
            let expected: DVec3 = values.iter().zip(&terms).map(|(value, term)| *term * *value).sum();
            let of = |table: &GreenTable| table.block_product(number / 8, &terms)[number % 8].distance(expected);
            assert!(of(&small) < 1e-14, "{number}: {:e}", of(&small));
            assert!(of(&large) < 1e-6, "{number}: {:e}", of(&large));
        }
        assert!(matches!(small, GreenTable::Small(..)));
    }
}
