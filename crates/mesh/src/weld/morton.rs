//! Morton codes: numbers along a curve that keeps neighbouring positions near each other.

use glam::DVec3;

use crate::Bounds;

/// Bits per coordinate: three coordinates fill all of a `u64` except its top bit.
const BITS: u32 = 21;

/// A cube around a bounding box, divided into `2^BITS` cells per side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MortonGrid {
    origin: DVec3,
    cells_per_unit: f64,
}

impl MortonGrid {
    /// The grid over `bounds`, with cubic cells; a box without extent gets one cell.
    pub(crate) fn over(bounds: &Bounds) -> Self {
        let side = bounds.extent().max_element();
        let cells_per_unit = f64::from(1u32 << BITS) / side;
        // The inverse of a very small side overflows; such a box is treated as a point.
        let cells_per_unit = if cells_per_unit.is_finite() {
            cells_per_unit
        } else {
            0.0
        };
        Self {
            origin: bounds.min,
            cells_per_unit,
        }
    }

    /// Position in units of the finest cells, from 0 to `2^BITS` inside the box.
    #[inline]
    fn in_cells(&self, position: DVec3) -> DVec3 {
        (position - self.origin) * self.cells_per_unit
    }

    /// The code of the finest cell that holds `position`.
    #[inline]
    pub(crate) fn code(&self, position: DVec3) -> u64 {
        let cells = self.in_cells(position);
        // `as` saturates, so positions on the far faces fall into the last cells.
        encode([cells.x, cells.y, cells.z].map(|c| (c as u32).min((1 << BITS) - 1)))
    }
}

/// Interleaves three coordinates below `2^BITS`, with x in the lowest bits.
#[inline]
fn encode(cell: [u32; 3]) -> u64 {
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}

/// Inserts two zero bits between adjacent bits of a number below `2^BITS`.
#[inline]
fn spread(number: u32) -> u64 {
    let mut x = u64::from(number);
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_every_coordinate_has_its_own_place() {
        let mut seen = 0u64;
        for axis in 0..3 {
            for bit in 0..BITS {
                let mut cell = [0; 3];
                cell[axis] = 1 << bit;
                let code = encode(cell);
                assert_eq!(code, 1 << (3 * bit + axis as u32));
                seen |= code;
            }
        }
        assert_eq!(seen, (1 << (3 * BITS)) - 1);
    }

    #[test]
    fn corners_of_the_box_get_the_first_and_the_last_cell() {
        let bounds = Bounds {
            min: DVec3::splat(-3.0),
            max: DVec3::splat(5.0),
        };
        let grid = MortonGrid::over(&bounds);
        assert_eq!(grid.code(bounds.min), 0);
        assert_eq!(grid.code(bounds.max), (1 << (3 * BITS)) - 1);
        let point = MortonGrid::over(&Bounds {
            min: DVec3::ONE,
            max: DVec3::ONE,
        });
        assert_eq!(point.code(DVec3::ONE), 0);
    }
}
