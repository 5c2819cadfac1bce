//! Moving least squares as one of the methods.

use glam::{DVec3, Mat3};
use rayon::prelude::*;

use super::fit::{Displacing, displacement, jacobian, origin};
use super::moments::{Entry, entries};
use super::points::Points;
use super::{Mls, MlsTransforms};
use crate::budget::filled;
use crate::handles::Motion;
use crate::method::{BindInput, BoundMethod, ConstraintKind, DeformMethod, MethodDeclaration, Needs, Solve, Stepped};
use crate::space::moving::Moving;
use crate::space::unit::Unit;
use crate::{BindError, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "mls",
    title: "Moving least squares",
    when_to_use: "Each place turns and moves as the handles around it do, at once: for quick poses of scans of loose or \
                  broken pieces; what is near in space moves along, whether it is connected or not.",
    keywords: "mls moving least squares schaefer rigid similarity affine space points soup warp",
    options: Mls::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles],
    default: || Mls::default().into(),
    first_choice: || Mls::default().into(),
};

/// The bound method.
#[derive(Debug)]
struct BoundMls {
    transforms: MlsTransforms,
    unit: Unit,
    moving: Moving,
    /// Where each row's vertex is, in the unit of all points.
    places: Vec<DVec3>,
    /// One row a vertex: the sum of all sets, then each handle.
    entries: Vec<Entry>,
    /// Of each handle: the origin in its coordinates, and its radius.
    handles: Vec<(DVec3, f64)>,
}

/// Rows that one task makes at once.
const AT_ONCE: usize = 64;

impl DeformMethod for Mls {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn row_bytes(&self) -> usize {
        300 + size_of::<Entry>() + size_of::<DVec3>()
    }

    fn handle_row_bytes(&self) -> usize {
        size_of::<Entry>()
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let positions = &input.problem.surface.positions;
        let points = Points::of(input);
        input.progress.set(0.1);
        let moving = Moving::of(input);
        let width = 1 + input.handles.len();
        let mut rows = filled(Entry::default(), moving.vertices.len() * width).map_err(|_| BindError::OutOfMemory {
            free_count: moving.vertices.len(),
        })?;
        let chunks = moving
            .vertices
            .par_chunks(AT_ONCE)
            .zip(rows.par_chunks_mut(AT_ONCE * width));
        chunks.try_for_each(|(vertices, rows)| {
            input.cancel.check()?;
            for (&vertex, row) in vertices.iter().zip(rows.chunks_mut(width)) {
                entries(&points, 0.5 * self.falloff, positions, positions[vertex as usize], row);
            }
            Ok::<_, BindError>(())
        })?;
        input.progress.set(1.0);
        let place = |&vertex: &u32| points.unit.local(positions[vertex as usize]);
        Ok(Box::new(BoundMls {
            transforms: self.transforms,
            unit: points.unit,
            places: moving.vertices.iter().map(place).collect(),
            moving,
            entries: rows,
            handles: input
                .handles
                .iter()
                .map(|handle| (origin(handle, &points.unit), handle.radius))
                .collect(),
        }))
    }
}

impl BoundMls {
    fn displacing(&self, motions: &[Motion]) -> Vec<Displacing> {
        let handles = motions.iter().zip(&self.handles);
        handles
            .map(|(motion, &(origin, radius))| Displacing::of(motion, origin, radius, &self.unit))
            .collect()
    }

    fn row(&self, number: usize) -> &[Entry] {
        let width = 1 + self.handles.len();
        &self.entries[number * width..][..width]
    }
}

impl BoundMethod for BoundMls {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let handles = self.displacing(motions);
        let finite = self.moving.displace(motions, displacements, |number| {
            self.unit.length * displacement(self.transforms, self.places[number], self.row(number), &handles)
        });
        Ok(Stepped {
            converged: true,
            energy: 0.0,
            finite,
        })
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        let handles = self.displacing(motions);
        self.moving.jacobians(motions, out, |number| {
            jacobian(self.transforms, self.places[number], self.row(number), &handles).as_mat3()
        });
        true
    }

    fn solved_count(&self) -> usize {
        self.moving.vertices.len()
    }
}
