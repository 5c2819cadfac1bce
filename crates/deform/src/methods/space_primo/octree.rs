//! The cells: cubes of one size where the surface is, and larger ones inside.

use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

use glam::{DVec3, IVec3};
use rayon::prelude::*;

use super::grid::{EMPTY, FILLED, Grid, SHRUNK, boxed, neighbourhood};
use super::inside::sort_out;
use crate::Role;
use crate::budget::{Limit, bytes_of};
use crate::method::BindInput;
use crate::space::shaping::shaping;

/// The most small cubes along an axis.
const FINEST: i32 = 128;

/// The size of a grid relative to the moving part. It is a little larger, so that the flat sides of a block lie within
/// cubes. A triangle exactly between two cubes belongs to neither, and then the block has coarse cells alone.
const LOOSE: f64 = 1.0 + 1e-4;

/// Bytes of a small cube during its classification.
const CUBE: usize = 32;

/// Bytes of a cell with its joints and its rows of the matrix, before it is factored: as allocated, measured by
/// `tests/memory.rs`.
pub(super) const CELL: usize = 4500;

/// No cell.
const NONE: u32 = u32::MAX;

/// The cells in a grid of small cubes with an empty layer around.
#[derive(Clone, Debug)]
pub(super) struct Octree {
    pub grid: Grid,
    /// The cell of each small cube.
    cell_of: Vec<u32>,
    pub cells: Vec<Cell>,
    /// The small cubes inside that are beside the fixed inside.
    held: Vec<IVec3>,
}

/// A cube of `size` small ones along each axis.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Cell {
    pub low: IVec3,
    pub size: i32,
}

impl Octree {
    /// The finest octree with at most about this many cells around the vertices that move and their triangles, as far
    /// as the budget allows.
    ///
    /// # Errors
    /// Not even the coarsest one fits the budget.
    pub fn of(input: &BindInput<'_>, most: usize) -> Result<Self, Limit> {
        let (mut enough, mut finer) = (Self::with(input, 1)?, 2);
        let fitting = |along: i32| Self::with(input, along).ok().filter(|tried| tried.cells.len() <= most);
        while finer <= FINEST {
            let Some(tried) = fitting(finer) else {
                break;
            };
            (enough, finer) = (tried, 2 * finer);
        }
        let (mut low, mut high) = (finer / 2, finer.min(FINEST + 1));
        while high - low > 1 {
            let middle = low.midpoint(high);
            match fitting(middle) {
                Some(tried) => (enough, low) = (tried, middle),
                None => high = middle,
            }
        }
        Ok(enough)
    }

    /// The octree with this many small cubes along the longest axis.
    fn with(input: &BindInput<'_>, along: i32) -> Result<Self, Limit> {
        let (surface, roles) = (input.problem.surface, input.problem.roles);
        let moving = input.partition.moving.iter().copied();
        let mut is_moving = vec![false; roles.len()];
        for vertex in shaping(input.problem, moving) {
            is_moving[vertex as usize] = true;
        }
        let moves = |vertex: usize| is_moving[vertex];
        // Fixed vertices hold the triangles that they share with moving ones, however long these are.
        let mut is_held = is_moving.clone();
        for corners in surface
            .triangles
            .iter()
            .map(|corners| corners.map(|corner| corner.index()))
        {
            if corners.into_iter().any(moves) {
                corners.into_iter().for_each(|corner| is_held[corner] = true);
            }
        }
        let bounds = (0..roles.len())
            .filter(|&vertex| is_held[vertex])
            .map(|vertex| surface.positions[vertex]);
        let (low, high) = bounds.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
            (low.min(point), high.max(point))
        });
        let extent = if low.is_finite() { high - low } else { DVec3::ZERO };
        let middle = if low.is_finite() {
            low + 0.5 * extent
        } else {
            DVec3::ZERO
        };
        let longest = extent.max_element();
        let world_side = if longest > 0.0 {
            LOOSE * longest / f64::from(along)
        } else {
            1.0
        };
        // There are two more cubes on each side: one for fixed vertices nearby, and an empty one.
        let counts = (extent / world_side * SHRUNK).ceil().as_ivec3().max(IVec3::ONE) + 4;
        let grid = Grid {
            world_low: middle - 0.5 * world_side * counts.as_dvec3(),
            world_side,
            counts,
        };
        let mut octree = Self {
            grid,
            cell_of: Vec::new(),
            cells: Vec::new(),
            held: Vec::new(),
        };
        let budget = input
            .partition
            .budget
            .without(bytes_of(octree.grid.cube_count(), CUBE))?;
        let filled: Vec<AtomicU8> = (0..octree.grid.cube_count()).map(|_| AtomicU8::new(EMPTY)).collect();
        let mark = |cube: IVec3| filled[octree.grid.index(cube)].store(FILLED, Relaxed);
        (0..roles.len())
            .into_par_iter()
            .with_min_len(4096)
            .filter(|&vertex| moves(vertex))
            .for_each(|vertex| mark(octree.grid.cube(surface.positions[vertex])));
        surface.triangles.par_iter().with_min_len(1024).for_each(|corners| {
            if corners.iter().any(|corner| moves(corner.index())) {
                octree
                    .grid
                    .cubes_of(corners.map(|corner| surface.positions[corner.index()]), mark);
            }
        });
        let mut filled: Vec<u8> = filled.into_iter().map(AtomicU8::into_inner).collect();
        octree.add_fixed(input, &mut filled);
        octree.held = sort_out(&octree.grid, surface, input.problem.topology.is_closed(), &mut filled);
        octree.fill(&filled);
        budget.without(bytes_of(octree.cells.len(), CELL))?;
        Ok(octree)
    }

    /// The small cubes with fixed vertices beside a filled one.
    fn add_fixed(&self, input: &BindInput<'_>, filled: &mut [u8]) {
        let positions = &input.problem.surface.positions;
        let beside = |cube: IVec3| {
            let around = neighbourhood(1).any(|step| {
                let other = cube + step;
                self.grid.has(other) && filled[self.grid.index(other)] == FILLED
            });
            self.grid.has(cube) && around
        };
        let cubes = input.problem.roles.iter().zip(positions);
        let cubes: Vec<usize> = cubes
            .filter(|(role, _)| **role == Role::Fixed)
            .map(|(_, &position)| self.grid.cube(position))
            .filter(|&cube| beside(cube))
            .map(|cube| self.grid.index(cube))
            .collect();
        cubes.into_iter().for_each(|cube| filled[cube] = FILLED);
    }

    /// Makes cells: one for each filled cube, and the largest that fit for the empty ones.
    fn fill(&mut self, filled: &[u8]) {
        self.cell_of = vec![NONE; self.grid.cube_count()];
        let largest = (self.grid.counts.max_element() as u32).next_power_of_two() as i32;
        let mut size = largest;
        while size >= 1 {
            for low in boxed(IVec3::ZERO, (self.grid.counts - 1) / size) {
                let low = low * size;
                let fits = boxed(low, low + (size - 1)).all(|cube| {
                    self.grid.has(cube) && {
                        let index = self.grid.index(cube);
                        self.cell_of[index] == NONE
                            && (filled[index] == EMPTY || (size == 1 && filled[index] == FILLED))
                    }
                });
                if fits {
                    for cube in boxed(low, low + (size - 1)) {
                        let index = self.grid.index(cube);
                        self.cell_of[index] = self.cells.len() as u32;
                    }
                    self.cells.push(Cell { low, size });
                }
            }
            size /= 2;
        }
    }

    /// The common faces of the cells: the two cells, the lower first, and the middle of a small cube's side, in world
    /// units, with the axis across it.
    pub fn faces(&self, mut visit: impl FnMut([u32; 2], DVec3, usize)) {
        for cube in boxed(IVec3::ZERO, self.grid.counts - 2) {
            let own = self.cell_of[self.grid.index(cube)];
            for axis in 0..3 {
                let other = self.cell_of[self.grid.index(cube + IVec3::AXES[axis])];
                if own != NONE && other != NONE && own != other {
                    let middle = cube.as_dvec3() + 0.5 + 0.5 * DVec3::AXES[axis];
                    visit(
                        [own.min(other), own.max(other)],
                        self.grid.world_low + self.grid.world_side * middle,
                        axis,
                    );
                }
            }
        }
    }

    /// The cells that reach a point: those with a small cube in the small cubes around.
    pub fn around(&self, world_point: DVec3) -> Vec<u32> {
        let cube = self.grid.cube(world_point);
        let mut found = Vec::new();
        for step in neighbourhood(1) {
            if self.grid.has(cube + step) {
                let cell = self.cell_of[self.grid.index(cube + step)];
                if cell != NONE && !found.contains(&cell) {
                    found.push(cell);
                }
            }
        }
        found
    }

    /// The cell that contains a point.
    pub fn cell_at(&self, world_point: DVec3) -> Option<u32> {
        let cube = self.grid.cube(world_point);
        let cell = self.grid.has(cube).then(|| self.cell_of[self.grid.index(cube)])?;
        (cell != NONE).then_some(cell)
    }

    /// The middle of a cell, in world units.
    pub fn world_centre(&self, cell: usize) -> DVec3 {
        let Cell { low, size } = self.cells[cell];
        self.grid.world_low + self.grid.world_side * (low.as_dvec3() + 0.5 * f64::from(size))
    }

    /// The side of a cell, in world units.
    pub fn world_size(&self, cell: usize) -> f64 {
        self.grid.world_side * f64::from(self.cells[cell].size)
    }

    /// Renumbers the cells: `order` lists the present numbers.
    pub fn reorder(&mut self, order: &[u32]) {
        let mut number_of = vec![NONE; order.len()];
        for (number, &cell) in (0..).zip(order) {
            number_of[cell as usize] = number;
        }
        self.cells = order.iter().map(|&cell| self.cells[cell as usize]).collect();
        for cell in self.cell_of.iter_mut().filter(|cell| **cell != NONE) {
            *cell = number_of[*cell as usize];
        }
    }

    /// The places beside the cells at which the inside is fixed, in world units.
    pub fn world_held(&self) -> impl Iterator<Item = DVec3> + '_ {
        let middle = |cube: &IVec3| self.grid.world_low + self.grid.world_side * (cube.as_dvec3() + 0.5);
        self.held.iter().map(middle)
    }
}
