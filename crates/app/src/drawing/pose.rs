//! One shape in the renderer's numbers.

use glam::DVec3;
use pliant_mesh::Model;
use pliant_render::{ChunkBounds, ShapeData};
use rayon::prelude::*;

use super::Drawing;

/// Positions and normals of the drawn vertices. f32 begins here: positions are relative to the drawing's centre.
#[derive(Debug)]
pub struct Pose {
    /// Positions relative to the drawing's centre.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// The bounding box of each of the drawing's chunks.
    pub bounds: Vec<ChunkBounds>,
}

impl Pose {
    pub(super) fn of(model: &Model, displacements: &[DVec3], drawing: &Drawing) -> Self {
        let (centre, chunks) = (drawing.centre, &drawing.chunks);
        let mut world = Vec::new();
        model.drawn_positions(displacements, &mut world);
        let normals = drawing.normals.at(&world, &drawing.triangles);
        let positions: Vec<[f32; 3]> = world.par_iter().map(|&position| finite(position - centre)).collect();
        let bounds = (0..chunks.count())
            .into_par_iter()
            .map(|chunk| chunks.bounds(chunk, &positions))
            .collect();
        Self {
            positions,
            normals,
            bounds,
        }
    }

    /// What the renderer takes.
    pub fn data(&self) -> ShapeData<'_> {
        ShapeData {
            positions: &self.positions,
            normals: &self.normals,
            bounds: &self.bounds,
        }
    }
}

/// A position for the GPU; vertices that the file gives no finite position (they belong to no kept triangle) go to
/// the centre.
pub(super) fn finite(relative: DVec3) -> [f32; 3] {
    if relative.is_finite() {
        relative.as_vec3().to_array()
    } else {
        [0.0; 3]
    }
}
