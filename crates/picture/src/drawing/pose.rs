//! One shape, converted for the renderer.

use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec3, Mat3, Vec3A};
use pliant_mesh::{Model, Vector3};
use pliant_render::{ChunkBounds, Chunks, ShapeData};
use rayon::prelude::*;

use super::normals::NormalGroups;
use super::relative::Relative;

/// The number of poses that wait to be reused: the renderer has one while the next is made.
const MOST_SPARE: usize = 2;

/// Positions and normals of the drawn vertices, rounded to f32 after subtracting the drawing's centre.
#[derive(Debug, Default)]
pub struct Pose {
    /// Positions relative to the drawing's centre.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// The bounding box of each of the drawing's chunks.
    pub bounds: Vec<ChunkBounds>,
}

/// The parts of a drawing that its poses are computed from.
#[derive(Debug)]
pub(super) struct Poser {
    pub chunks: Arc<Chunks>,
    pub relative: Relative,
    pub normals: NormalGroups,
    /// Memory for poses, kept from frame to frame: mapping it again takes longer than filling it.
    scratch: Mutex<Scratch>,
    spare: Mutex<Vec<Pose>>,
}

/// The input of a pose, in the precision that the drawing needs.
#[derive(Debug, Default)]
struct Scratch {
    single: Buffers<Vec3A>,
    double: Buffers<DVec3>,
}

/// One for each surface vertex, and then for further groups of normals.
#[derive(Debug)]
struct Buffers<V> {
    positions: Vec<V>,
    normals: Vec<V>,
}

impl<V> Default for Buffers<V> {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
        }
    }
}

impl Poser {
    pub fn new(chunks: Arc<Chunks>, relative: Relative, normals: NormalGroups) -> Self {
        Self {
            chunks,
            relative,
            normals,
            scratch: Mutex::default(),
            spare: Mutex::default(),
        }
    }

    /// One shape; normals are turned by the Jacobians of the displacements, if these are known.
    pub fn pose(&self, model: &Model, displacements: &[DVec3], jacobians: Option<&[Mat3]>) -> Pose {
        let pose = self.spare.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut pose = pose.unwrap_or_default();
        // Another thread that poses the same drawing has the memory: the side view, or a picture that is being saved.
        let mut own = Scratch::default();
        let mut kept = self.scratch.try_lock().ok();
        let Scratch { single, double } = kept.as_deref_mut().unwrap_or(&mut own);
        match self.relative.is_fine {
            true => pose.fill(model, displacements, jacobians, self, double),
            false => pose.fill(model, displacements, jacobians, self, single),
        }
        pose
    }

    /// Takes a pose that is no longer needed.
    pub fn put_back(&self, pose: Pose) {
        let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        if spare.len() < MOST_SPARE {
            spare.push(pose);
        }
    }
}

impl Pose {
    fn fill<V: Vector3>(
        &mut self,
        model: &Model,
        displacements: &[DVec3],
        jacobians: Option<&[Mat3]>,
        poser: &Poser,
        Buffers { positions, normals }: &mut Buffers<V>,
    ) {
        let (relative, chunks) = (&poser.relative, &poser.chunks);
        relative.positions(&model.surface.positions, |v| displacements[v], positions);
        let moved = |stray: DVec3, by: DVec3| finite(stray + by - relative.centre);
        model.spread(
            |v| relative.in_world_units(positions[v.index()]),
            |stray, v| moved(stray, v.map_or(DVec3::ZERO, |v| displacements[v.index()])),
            &mut self.positions,
        );
        match jacobians {
            Some(jacobians) => poser.normals.turned(model, relative, jacobians, &mut self.normals),
            None => poser.normals.at(model, positions, normals, &mut self.normals),
        }
        (0..chunks.count())
            .into_par_iter()
            .map(|chunk| chunks.bounds(chunk, &self.positions))
            .collect_into_vec(&mut self.bounds);
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
