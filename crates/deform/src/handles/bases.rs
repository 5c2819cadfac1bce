//! Handle bases: a frame as one small product per vertex, without a solve.
//!
//! A handle moves affinely, so a linear method displaces the solved vertices by Σ_h B_h (T_h − I), four columns a
//! handle computed once at bind [BK04]. For the bi-Laplacian B_h = −A_ff⁻¹ A_fh [q 1].
//!
//! If nothing is fixed, the weights of all handles sum to 1. Rounded to f32 they no longer do, and a plain translation
//! would leave dents. So the motion of one *reference* handle's centre is subtracted first and added back exactly: the
//! rounded weights only multiply differences between handles.

use std::collections::TryReserveError;

use glam::{DMat3, DVec3};
use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::budget::filled;
use crate::handles::finite::Finite;
use crate::handles::{FRAME_CHUNK, Motion};

/// The precision in which bases are stored.
pub(crate) trait Stored: Copy + Default + Into<f64> + Send + Sync {
    /// The nearest number.
    fn of(value: f64) -> Self;
}

impl Stored for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }
}

impl Stored for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

/// The effect of the handles' transforms on each solved vertex.
///
/// The columns of handle h are those of q = (p − centre_h) / radius_h and of the constant, so the displacement of a
/// row's vertex is Σ_h radius_h (A_h − I) b_h.xyz + b_h.w t_h, where A_h is the linear part of the handle's transform
/// and t_h the displacement of the handle's centre. Plain bending stores them in **f32**, which costs 1e-7 of the
/// handles' motion; if differences between neighbours matter, the bases are f64.
#[derive(Clone, Debug, Default)]
pub struct HandleBases<T = f32> {
    vertices: Vec<u32>,
    handle_count: usize,
    rows: Vec<[T; 4]>,
    runs: Vec<Run>,
}

/// Successive rows with the same reference handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Run {
    end: usize,
    reference: Option<u16>,
}

impl<T> HandleBases<T> {
    /// The solved surface vertices, ascending: one per row.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The number of a row's handles.
    pub fn handle_count(&self) -> usize {
        self.handle_count
    }

    /// Row-major: `handle_count` entries (x, y, z, constant) per row.
    pub fn rows(&self) -> &[[T; 4]] {
        &self.rows
    }
}

impl HandleBases {
    /// The weight of handle `handle` at each row's vertex: about 1 beside it, 0 at fixed vertices.
    pub fn weight(&self, row: usize, handle: usize) -> f32 {
        self.rows[row * self.handle_count + handle][3]
    }
}

impl<T> HandleBases<T> {
    /// Bases over `vertices` (ascending) from one column block per handle; `reference` names the reference handle of a
    /// vertex in a component where nothing is fixed.
    ///
    /// # Errors
    /// The machine has no memory for them.
    pub(crate) fn new(
        vertices: Vec<u32>,
        blocks: &[Vec<[T; 4]>],
        reference: impl Fn(u32) -> Option<u16>,
    ) -> Result<Self, TryReserveError>
    where
        T: Stored,
    {
        let mut rows = filled([T::default(); 4], vertices.len() * blocks.len())?;
        for (handle, block) in blocks.iter().enumerate() {
            for (row, entry) in block.iter().enumerate() {
                rows[row * blocks.len() + handle] = *entry;
            }
        }
        let mut runs: Vec<Run> = Vec::new();
        for (row, &vertex) in vertices.iter().enumerate() {
            let reference = reference(vertex);
            match runs.last_mut() {
                Some(run) if run.reference == reference => run.end = row + 1,
                _ => runs.push(Run {
                    end: row + 1,
                    reference,
                }),
            }
        }
        Ok(Self {
            vertices,
            handle_count: blocks.len(),
            rows,
            runs,
        })
    }

    /// The bases from rows of `handle_count` entries, one row for each of the vertices, ascending.
    pub(crate) fn of_rows(vertices: Vec<u32>, handle_count: usize, rows: Vec<[T; 4]>) -> Self {
        let end = vertices.len();
        Self {
            vertices,
            handle_count,
            rows,
            runs: vec![Run { end, reference: None }],
        }
    }

    /// The displacements of the solved vertices among those from `first` on.
    #[inline(always)]
    fn evaluate(&self, tables: &Tables, first: usize, out: &mut [DVec3])
    where
        T: Stored,
    {
        let place = |vertex: usize| self.vertices.partition_point(|&other| (other as usize) < vertex);
        let (mut row, end) = (place(first), place(first + out.len()));
        let mut run = self.runs.partition_point(|run| run.end <= row);
        while row < end {
            let Run {
                end: run_end,
                reference,
            } = self.runs[run];
            let (base, table) = tables.get(reference);
            let until = run_end.min(end);
            let entries = self.rows[row * self.handle_count..until * self.handle_count].chunks_exact(self.handle_count);
            for (&vertex, entries) in self.vertices[row..until].iter().zip(entries) {
                let mut sum = base;
                for (entry, motion) in entries.iter().zip(table) {
                    // All computation with the stored basis is in f64.
                    let [x, y, z, w] = entry.map(Into::into);
                    sum += motion[0] * x + motion[1] * y + motion[2] * z + motion[3] * w;
                }
                out[vertex as usize - first] = sum;
            }
            row = until;
            run += 1;
        }
    }
}

/// The motions' columns relative to each reference handle in use.
struct Tables {
    plain: Vec<[DVec3; 4]>,
    relative: Vec<Option<Relative>>,
}

/// The reference handle's shift and the motions' columns without it.
type Relative = (DVec3, Vec<[DVec3; 4]>);

impl Tables {
    /// The motions, prepared for `bases`.
    pub fn of<T>(motions: &[Motion], bases: &HandleBases<T>) -> Self {
        let columns = |base: DVec3| {
            let column = |motion: &Motion| {
                let DMat3 { x_axis, y_axis, z_axis } = motion.linear;
                [x_axis, y_axis, z_axis, motion.shift - base]
            };
            motions.iter().map(column).collect::<Vec<_>>()
        };
        let mut relative = vec![None; motions.len()];
        for reference in bases.runs.iter().filter_map(|run| run.reference).map(usize::from) {
            let base = motions[reference].shift;
            relative[reference].get_or_insert_with(|| (base, columns(base)));
        }
        Self {
            plain: columns(DVec3::ZERO),
            relative,
        }
    }

    fn get(&self, reference: Option<u16>) -> (DVec3, &[[DVec3; 4]]) {
        match reference.and_then(|handle| self.relative[usize::from(handle)].as_ref()) {
            Some((base, table)) => (*base, table),
            None => (DVec3::ZERO, &self.plain),
        }
    }
}

/// Fills all of `displacements`: those of the handles' vertices from the motions, those of the bases' vertices from the
/// bases, zeros elsewhere. It works chunk by chunk, so that each goes through memory once.
///
/// `prescribed` has each handle's places, ascending, and their coordinates; `vertex` gives the vertex of a place.
pub(crate) fn frame<T: Stored>(
    bases: &HandleBases<T>,
    prescribed: &[Vec<(u32, [f64; 4])>],
    vertex: impl Fn(u32) -> usize + Sync,
    motions: &[Motion],
    displacements: &mut [DVec3],
) -> Finite {
    let tables = Tables::of(motions, bases);
    let arch = vectors();
    let is_finite = displacements
        .par_chunks_mut(FRAME_CHUNK)
        .enumerate()
        .map(|(chunk, out)| {
            let first = chunk * FRAME_CHUNK;
            out.fill(DVec3::ZERO);
            for (own, motion) in prescribed.iter().zip(motions) {
                let place = |end: usize| own.partition_point(|&(place, _)| vertex(place) < end);
                for &(at, coordinates) in &own[place(first)..place(first + out.len())] {
                    out[vertex(at) - first] = motion.displace(coordinates);
                }
            }
            arch.dispatch(Evaluation {
                bases,
                tables: &tables,
                first,
                out,
            })
        })
        .reduce(|| true, |a, b| a && b);
    if is_finite { Finite::Yes } else { Finite::Unknown }
}

/// A chunk of a frame: the displacements of the vertices from `first` on, and whether all are finite.
///
/// A closure would be compiled without the vector instructions of its caller.
struct Evaluation<'a, T> {
    bases: &'a HandleBases<T>,
    tables: &'a Tables,
    first: usize,
    out: &'a mut [DVec3],
}

impl<T: Stored> WithSimd for Evaluation<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        self.bases.evaluate(self.tables, self.first, self.out);
        self.out.iter().all(|displacement| displacement.is_finite())
    }
}
