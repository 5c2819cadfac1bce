//! Displacement fields that are linear in the handles' motions: d(p) = Σ_h X_h b_h(p), X_h the 3×4 matrix of a motion
//! and b_h the four coefficients of its handle at p. So a frame is a product, and the Jacobian is
//! I + Σ_h X_h ∇b_h.

use glam::{DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::falloff::Falloff;
use crate::budget::filled;
use crate::handles::bases::frame;
use crate::handles::finite::Finite;
use crate::handles::{FRAME_CHUNK, Motion, clear};
use crate::method::BindInput;
use crate::needs::HandleFit;
use crate::{BindError, HandleBases};

/// A handle's coefficients at a point, as in [`HandleBases`], and their gradients per world unit.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct Coefficients {
    pub value: [f64; 4],
    pub gradient: [DVec3; 4],
}

/// A map of space that is linear in the handles' motions.
pub(crate) trait SpaceMap: Sync {
    /// Fills in the coefficients at a few points: for each point those of all handles. `out` contains zeros.
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]);
}

/// The coefficients of every vertex that moves.
#[derive(Debug)]
pub(crate) struct LinearField {
    bases: HandleBases<f64>,
    /// Gradients of the bases' entries, in single precision, because only normals are made of them.
    gradients: Vec<[Vec3; 4]>,
    /// The vertices that move exactly with hard handles, and their coordinates.
    prescribed: Vec<Vec<(u32, [f64; 4])>>,
    /// Each handle's unit of length.
    radii: Vec<f64>,
}

/// Bytes of a handle's coefficients at a vertex.
pub(crate) const FIELD_ROW: usize = size_of::<[f64; 4]>() + size_of::<[Vec3; 4]>();

/// The number of points whose coefficients are computed at once.
const AT_ONCE: usize = 256;

impl LinearField {
    /// Evaluates the map at every vertex that moves, faded by `falloff`, which has the vertices of [`moving`].
    pub fn bind(
        map: &impl SpaceMap,
        falloff: &Falloff,
        fit: HandleFit,
        input: &BindInput<'_>,
    ) -> Result<Self, BindError> {
        let positions = &input.problem.surface.positions;
        let vertices = moving(fit, input);
        let count = input.handles.len();
        let out_of_memory = |_| BindError::OutOfMemory {
            free_count: input.partition.solved.len(),
        };
        let mut rows = filled([0.0; 4], vertices.len() * count).map_err(out_of_memory)?;
        let mut gradients = filled([Vec3::ZERO; 4], vertices.len() * count).map_err(out_of_memory)?;
        let chunks = vertices
            .par_chunks(AT_ONCE)
            .zip(rows.par_chunks_mut(AT_ONCE * count.max(1)))
            .zip(gradients.par_chunks_mut(AT_ONCE * count.max(1)))
            .enumerate();
        chunks.try_for_each(|(chunk, ((vertices, rows), gradients))| {
            input.cancel.check()?;
            let points: Vec<DVec3> = vertices.iter().map(|&vertex| positions[vertex as usize]).collect();
            let mut coefficients = vec![Coefficients::default(); rows.len()];
            map.coefficients(&points, &mut coefficients);
            let entries = rows.iter_mut().zip(gradients).zip(&coefficients);
            for (place, ((row, gradient), entry)) in entries.enumerate() {
                let (factor, slope) = falloff.at(chunk * AT_ONCE + place / count);
                *row = entry.value.map(|value| value * factor);
                for k in 0..4 {
                    gradient[k] = (entry.gradient[k] * factor + slope * entry.value[k]).as_vec3();
                }
            }
            Ok::<_, BindError>(())
        })?;
        let coordinates = |handle: &crate::handles::Handle| {
            let vertices = handle.vertices.iter();
            vertices
                .map(|&vertex| (vertex, handle.coordinates(positions[vertex as usize])))
                .collect()
        };
        Ok(Self {
            bases: HandleBases::of_rows(vertices, count, rows),
            gradients,
            prescribed: match fit {
                HandleFit::Exact => input.handles.iter().map(coordinates).collect(),
                HandleFit::LeastSquares => Vec::new(),
            },
            radii: input.handles.iter().map(|handle| handle.radius).collect(),
        })
    }

    /// Fills all of `displacements`.
    pub fn frame(&self, motions: &[Motion], displacements: &mut [DVec3]) -> Finite {
        if motions.is_empty() {
            clear(displacements);
            return Finite::Yes;
        }
        let vertex = |vertex: u32| vertex as usize;
        frame(&self.bases, &self.prescribed, vertex, motions, displacements)
    }

    /// The Jacobian of the displacements at each surface vertex, zero for a vertex that does not move.
    pub fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) {
        let columns: Vec<[Vec3; 4]> = motions
            .iter()
            .map(|motion| {
                let linear = motion.linear;
                [linear.x_axis, linear.y_axis, linear.z_axis, motion.shift].map(|column| column.as_vec3())
            })
            .collect();
        let count = columns.len();
        let vertices = self.bases.vertices();
        out.par_chunks_mut(FRAME_CHUNK).enumerate().for_each(|(chunk, out)| {
            let first = chunk * FRAME_CHUNK;
            out.fill(Mat3::ZERO);
            for ((own, motion), &radius) in self.prescribed.iter().zip(motions).zip(&self.radii) {
                let place = |end: usize| own.partition_point(|&(vertex, _)| (vertex as usize) < end);
                for &(vertex, _) in &own[place(first)..place(first + out.len())] {
                    out[vertex as usize - first] = (motion.linear * radius.recip()).as_mat3();
                }
            }
            let place = |end: usize| vertices.partition_point(|&vertex| (vertex as usize) < end);
            for row in place(first)..place(first + out.len()) {
                let mut sum = Mat3::ZERO;
                for (gradients, columns) in self.gradients[row * count..][..count].iter().zip(&columns) {
                    for (gradient, column) in gradients.iter().zip(columns) {
                        sum.x_axis += *column * gradient.x;
                        sum.y_axis += *column * gradient.y;
                        sum.z_axis += *column * gradient.z;
                    }
                }
                out[vertices[row] as usize - first] = sum;
            }
        });
    }
}

/// The vertices at which a map is evaluated, ascending: the solved ones and, if handles are only fitted, theirs.
pub(crate) fn moving(fit: HandleFit, input: &BindInput<'_>) -> Vec<u32> {
    match fit {
        HandleFit::Exact => input.partition.solved.clone(),
        HandleFit::LeastSquares => input.partition.moving.clone(),
    }
}
