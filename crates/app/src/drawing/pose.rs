//! One shape in the renderer's numbers.

use glam::DVec3;
use pliant_mesh::Model;
use rayon::prelude::*;

use super::normals::NormalGroups;

/// Positions and normals of the drawn vertices. f32 begins here: positions are relative to the drawing's centre.
#[derive(Debug)]
pub struct Pose {
    /// Positions relative to the drawing's centre.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
}

impl Pose {
    pub(super) fn of(model: &Model, displacements: &[DVec3], centre: DVec3, groups: &NormalGroups) -> Self {
        let mut world = Vec::new();
        model.drawn_positions(displacements, &mut world);
        let normals = groups.at(&world, model);
        let positions = world.par_iter().map(|&position| finite(position - centre)).collect();
        Self { positions, normals }
    }
}

/// A position for the GPU; vertices that the file gives no finite position (they belong to no kept triangle) go to
/// the centre.
fn finite(relative: DVec3) -> [f32; 3] {
    if relative.is_finite() {
        relative.as_vec3().to_array()
    } else {
        [0.0; 3]
    }
}
