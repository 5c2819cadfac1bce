//! The cells that move a point, with smooth weights.

use glam::{DVec3, Vec3};

use super::octree::Octree;
use crate::space::blend::{Share, normalised};
use crate::space::neighbours::Neighbours;

/// (1 − d²/R²)³ over their sum, with gradients, R being half the cell's side and that of a small cube: cells nearer
/// than that have one of the small cubes around the point. If no cell reaches the point, the nearest one counts.
pub(super) fn weigh(octree: &Octree, centres: &Neighbours, world_point: DVec3) -> Vec<Share> {
    let raw = |cell: u32| {
        let from = world_point - octree.world_centre(cell as usize);
        let reach = 0.5 * octree.world_size(cell as usize) + octree.grid.world_side;
        let square = reach * reach;
        let left = 1.0 - from.length_squared() / square;
        (left > 0.0).then(|| (cell, left.powi(3), from * (-6.0 * left * left / square)))
    };
    let raw: Vec<_> = octree.around(world_point).into_iter().filter_map(raw).collect();
    if raw.iter().map(|(_, weight, _)| weight).sum::<f64>() > 0.0 {
        return normalised(&raw);
    }
    let nearest = centres.nearest(world_point, 1).into_iter();
    nearest
        .map(|(cell, _)| Share {
            source: cell,
            slope: Vec3::ZERO,
            weight: 1.0,
        })
        .collect()
}
