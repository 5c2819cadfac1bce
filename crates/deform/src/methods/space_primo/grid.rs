//! The grid of small cubes of which the cells consist.

use glam::{DVec3, IVec3};

use super::overlap::overlap;

/// A cube is a little smaller for triangles, so that one in a side of the cube belongs to only one cube.
pub(super) const SHRUNK: f64 = 1.0 - 1e-6;

/// An empty small cube.
pub(super) const EMPTY: u8 = 0;
/// A small cube that contains a part of the surface.
pub(super) const FILLED: u8 = 1;
/// An empty small cube without a cell.
pub(super) const OUTSIDE: u8 = 2;

/// The steps to the cubes that share a side.
pub(super) const SIDES: [IVec3; 6] = [IVec3::X, IVec3::NEG_X, IVec3::Y, IVec3::NEG_Y, IVec3::Z, IVec3::NEG_Z];

/// Adjacent small cubes, from a corner on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub world_low: DVec3,
    /// The side of a small cube, in world units.
    pub world_side: f64,
    pub counts: IVec3,
}

impl Grid {
    /// Visits the small cubes that a triangle meets.
    pub fn cubes_of(&self, corners: [DVec3; 3], mut visit: impl FnMut(IVec3)) {
        let [a, b, c] = corners;
        let inside = |cube: IVec3| cube.clamp(IVec3::ZERO, self.counts - 1);
        let (low, high) = (inside(self.cube(a.min(b).min(c))), inside(self.cube(a.max(b).max(c))));
        for cube in boxed(low, high) {
            let middle = self.world_low + self.world_side * (cube.as_dvec3() + 0.5);
            if overlap(corners.map(|corner| corner - middle), 0.5 * SHRUNK * self.world_side) {
                visit(cube);
            }
        }
    }

    /// A point in units of small cubes from the grid's corner.
    pub fn in_cubes(&self, world_point: DVec3) -> DVec3 {
        (world_point - self.world_low) / self.world_side
    }

    /// The small cube that contains a point; if none does, a cube outside the grid without a neighbour in it.
    pub fn cube(&self, world_point: DVec3) -> IVec3 {
        // Steps from the cube of a very distant point would overflow.
        let (low, high) = (IVec3::splat(-2), self.counts + 1);
        self.in_cubes(world_point).floor().as_ivec3().clamp(low, high)
    }

    /// All small cubes, along x first and along z last.
    pub fn cubes(&self) -> impl Iterator<Item = IVec3> + use<> {
        boxed(IVec3::ZERO, self.counts - 1)
    }

    /// Returns true if the grid contains this cube.
    pub fn has(&self, cube: IVec3) -> bool {
        cube.cmpge(IVec3::ZERO).all() && cube.cmplt(self.counts).all()
    }

    /// The place of a cube in a list of all of them.
    pub fn index(&self, cube: IVec3) -> usize {
        ((cube.z * self.counts.y + cube.y) * self.counts.x + cube.x) as usize
    }

    /// The number of cubes.
    pub fn cube_count(&self) -> usize {
        self.counts.as_usizevec3().element_product()
    }
}

/// The cubes from `low` to `high`, both included.
pub(super) fn boxed(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.z..=high.z)
        .flat_map(move |z| (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| IVec3::new(x, y, z))))
}

/// All steps by at most this many along each axis.
pub(super) fn neighbourhood(reach: i32) -> impl Iterator<Item = IVec3> {
    boxed(IVec3::splat(-reach), IVec3::splat(reach))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cube_is_beside_a_point_that_is_far_away() {
        let grid = Grid {
            world_low: DVec3::ONE,
            world_side: 0.5,
            counts: IVec3::new(3, 4, 5),
        };
        assert_eq!(grid.cube(DVec3::new(1.6, 1.1, 3.4)), IVec3::new(1, 0, 4));
        for far in [1e300, -1e300, 4.0, 0.4] {
            let cube = grid.cube(DVec3::new(1.6, far, 3.4));
            assert!(neighbourhood(1).all(|step| !grid.has(cube + step)), "{far}");
        }
    }
}
