//! The moving vertices: those that a method evaluates one by one, and those that move exactly with hard handles.

use glam::{DVec3, Mat3};
use rayon::prelude::*;

use crate::handles::finite::Finite;
use crate::handles::{FRAME_CHUNK, Motion};
use crate::method::BindInput;

/// The vertices of a frame. All others rest.
#[derive(Debug)]
pub(crate) struct Moving {
    /// The solved vertices, ascending: the rows.
    pub vertices: Vec<u32>,
    /// Hard handles' vertices, ascending, and their coordinates; soft handles have none.
    prescribed: Vec<Vec<(u32, [f64; 4])>>,
    /// Each handle's unit of length.
    radii: Vec<f64>,
}

impl Moving {
    /// Rows for the solved vertices; hard handles hold their vertices exactly.
    pub fn of(input: &BindInput<'_>) -> Self {
        let positions = &input.problem.surface.positions;
        let own = |(handle, soft): (&crate::handles::Handle, &Option<f64>)| {
            let vertices = handle.vertices.iter().filter(|_| soft.is_none());
            vertices
                .map(|&vertex| (vertex, handle.coordinates(positions[vertex as usize])))
                .collect()
        };
        Self {
            vertices: input.partition.solved.clone(),
            prescribed: input.handles.iter().zip(&input.partition.soft).map(own).collect(),
            radii: input.handles.iter().map(|handle| handle.radius).collect(),
        }
    }

    /// Fills all of `displacements`; `row` gives that of each row's vertex.
    pub fn displace(
        &self,
        motions: &[Motion],
        displacements: &mut [DVec3],
        row: impl Fn(usize) -> DVec3 + Sync,
    ) -> Finite {
        let prescribed = |handle: usize, coordinates| motions[handle].displace(coordinates);
        let is_finite = self.fill(displacements, DVec3::ZERO, prescribed, row, |out| {
            out.iter().all(|displacement| displacement.is_finite())
        });
        if is_finite { Finite::Yes } else { Finite::Unknown }
    }

    /// Fills in the Jacobian of the displacements at all vertices; `row` gives that of each row's vertex.
    pub fn jacobians(&self, motions: &[Motion], out: &mut [Mat3], row: impl Fn(usize) -> Mat3 + Sync) {
        let prescribed = |handle: usize, _| (motions[handle].linear * self.radii[handle].recip()).as_mat3();
        self.fill(out, Mat3::ZERO, prescribed, row, |_| true);
    }

    /// Works chunk by chunk, so that each goes through memory once. Returns whether all chunks pass `check`.
    fn fill<T: Copy + Send + Sync>(
        &self,
        out: &mut [T],
        zero: T,
        prescribed: impl Fn(usize, [f64; 4]) -> T + Sync,
        row: impl Fn(usize) -> T + Sync,
        check: impl Fn(&[T]) -> bool + Sync,
    ) -> bool {
        let chunks = out.par_chunks_mut(FRAME_CHUNK).enumerate().map(|(chunk, out)| {
            let first = chunk * FRAME_CHUNK;
            out.fill(zero);
            for (handle, own) in self.prescribed.iter().enumerate() {
                let place = |end: usize| own.partition_point(|&(vertex, _)| (vertex as usize) < end);
                for &(vertex, coordinates) in &own[place(first)..place(first + out.len())] {
                    out[vertex as usize - first] = prescribed(handle, coordinates);
                }
            }
            let place = |end: usize| self.vertices.partition_point(|&vertex| (vertex as usize) < end);
            for number in place(first)..place(first + out.len()) {
                out[self.vertices[number] as usize - first] = row(number);
            }
            check(out)
        });
        chunks.reduce(|| true, |a, b| a && b)
    }
}
