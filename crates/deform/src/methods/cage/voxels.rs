//! Voxels around the region, whose outer faces are a 2-manifold.

use glam::{DVec3, I64Vec3, USizeVec3};

/// A set of cubes, in a box with an empty layer around them.
#[derive(Clone, Debug)]
pub(super) struct Voxels {
    pub low: DVec3,
    pub size: f64,
    counts: USizeVec3,
    filled: Vec<bool>,
}

/// The number of empty layers around the region's own voxels: the dilation fills one, and one remains.
const LAYERS: usize = 2;

impl Voxels {
    /// Makes all cubes of this size that contain a point, and the cubes around them. The box from `low` over `extent`
    /// contains the points.
    pub fn around(points: impl Iterator<Item = DVec3>, low: DVec3, extent: DVec3, size: f64) -> Self {
        let layers = (extent / size).ceil().max(DVec3::ONE);
        let counts = layers.as_usizevec3() + 2 * LAYERS;
        let low = low - LAYERS as f64 * size - 0.5 * (layers * size - extent);
        let mut voxels = Self {
            low,
            size,
            counts,
            filled: vec![false; counts.element_product()],
        };
        let mut own = vec![false; voxels.filled.len()];
        for point in points {
            let cell = ((point - low) / size).floor().as_i64vec3();
            let cell = cell.clamp(I64Vec3::splat(LAYERS as i64), (counts - 1 - LAYERS).as_i64vec3());
            own[voxels.number(cell.as_usizevec3())] = true;
        }
        for cell in all(counts) {
            if !own[voxels.number(cell.as_usizevec3())] {
                continue;
            }
            for step in block(3) {
                let number = voxels.number((cell + step - I64Vec3::ONE).as_usizevec3());
                voxels.filled[number] = true;
            }
        }
        voxels.fill_hollows();
        voxels.make_manifold();
        voxels
    }

    /// True if a cube belongs to the set; those beyond the box do not.
    pub fn contains(&self, cell: I64Vec3) -> bool {
        let is_inside = cell.cmpge(I64Vec3::ZERO).all() && cell.cmplt(self.counts.as_i64vec3()).all();
        is_inside && self.filled[self.number(cell.as_usizevec3())]
    }

    /// All cubes of the set.
    pub fn cells(&self) -> impl Iterator<Item = I64Vec3> {
        all(self.counts).filter(|cell| self.contains(*cell))
    }

    fn number(&self, cell: USizeVec3) -> usize {
        cell.x + self.counts.x * (cell.y + self.counts.y * cell.z)
    }

    /// Fills all cubes that can't be reached from outside.
    fn fill_hollows(&mut self) {
        let mut is_outside = vec![false; self.filled.len()];
        is_outside[0] = true;
        let mut queue = vec![I64Vec3::ZERO];
        while let Some(cell) = queue.pop() {
            for step in I64Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
                let next = cell + step;
                let is_inside = next.cmpge(I64Vec3::ZERO).all() && next.cmplt(self.counts.as_i64vec3()).all();
                if !is_inside || self.contains(next) {
                    continue;
                }
                let number = self.number(next.as_usizevec3());
                if !std::mem::replace(&mut is_outside[number], true) {
                    queue.push(next);
                }
            }
        }
        self.filled = is_outside.into_iter().map(|is| !is).collect();
    }

    /// Fills cubes until no two meet only along an edge or at a corner, and likewise no two gaps [Lat97].
    fn make_manifold(&mut self) {
        loop {
            let mut found = Vec::new();
            for cell in all(self.counts - 1) {
                for (axis, _) in I64Vec3::AXES.iter().enumerate() {
                    let [a, b] = [I64Vec3::AXES[(axis + 1) % 3], I64Vec3::AXES[(axis + 2) % 3]];
                    let cells = [cell, cell + a, cell + b, cell + a + b];
                    let is = cells.map(|cell| self.contains(cell));
                    if is[0] == is[3] && is[1] == is[2] && is[0] != is[1] {
                        found.extend(cells);
                    }
                }
                let is = |step: I64Vec3| self.contains(cell + step);
                for step in block(2).filter(|step| step.z == 0) {
                    let (one, other) = (is(step), is(I64Vec3::ONE - step));
                    let others = || block(2).filter(|place| *place != step && *place != I64Vec3::ONE - step);
                    if one == other && others().all(|place| is(place) != one) {
                        found.extend(block(2).map(|place| cell + place));
                    }
                }
            }
            if found.is_empty() {
                return;
            }
            for cell in found {
                let number = self.number(cell.as_usizevec3());
                self.filled[number] = true;
            }
        }
    }
}

/// The cells of a cube with `side` of them on each side.
fn block(side: usize) -> impl Iterator<Item = I64Vec3> {
    all(USizeVec3::splat(side))
}

fn all(counts: USizeVec3) -> impl Iterator<Item = I64Vec3> {
    let row = move |y, z| (0..counts.x).map(move |x| USizeVec3::new(x, y, z).as_i64vec3());
    (0..counts.z).flat_map(move |z| (0..counts.y).flat_map(move |y| row(y, z)))
}
