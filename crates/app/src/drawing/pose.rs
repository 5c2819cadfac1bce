//! One shape, converted for the renderer.

use glam::{DVec3, Mat3};
use pliant_mesh::Model;
use pliant_render::{ChunkBounds, ShapeData};
use rayon::prelude::*;

use super::Drawing;

/// Positions and normals of the drawn vertices, rounded to f32 after subtracting the drawing's centre.
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
    pub(super) fn of(model: &Model, displacements: &[DVec3], jacobians: Option<&[Mat3]>, drawing: &Drawing) -> Self {
        let (centre, chunks) = (drawing.centre, &drawing.chunks);
        let mut world = Vec::new();
        model.drawn_positions(displacements, &mut world);
        let normals = match jacobians {
            Some(jacobians) => drawing.normals.turned(model, &drawing.triangles, jacobians),
            None => drawing.normals.at(&world, &drawing.triangles),
        };
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

    /// The shape as the renderer's type.
    pub fn data(&self) -> ShapeData<'_> {
        ShapeData {
            positions: &self.positions,
            normals: &self.normals,
            bounds: &self.bounds,
        }
    }
}

/// A position in f32. Vertices without a finite position, which belong to no kept triangle, are moved to the centre.
pub(super) fn finite(relative: DVec3) -> [f32; 3] {
    if relative.is_finite() {
        relative.as_vec3().to_array()
    } else {
        [0.0; 3]
    }
}
