//! The bound forms: affine fits, whose frame is a product, and fits with rotations.

use glam::{DVec3, Mat3};
use rayon::prelude::*;

use super::affine::AffineMap;
use super::fit::{Displacing, Turning, displacement, jacobian, origin};
use super::moments::{Entry, moments_at};
use super::points::Points;
use crate::budget::filled;
use crate::handles::Motion;
use crate::method::{BindInput, BoundMethod, Stepped};
use crate::space::linear::BoundLinear;
use crate::space::moving::Moving;
use crate::space::unit::Unit;
use crate::{BindError, SolveError};

/// Fits of rotations, with or without a scale.
#[derive(Debug)]
pub(super) struct BoundTurning {
    turning: Turning,
    unit: Unit,
    moving: Moving,
    /// The position of each row's vertex, in the unit of all points.
    places: Vec<DVec3>,
    /// One row per vertex: the sum of all sets, then each handle.
    entries: Vec<Entry>,
    /// The origin in each handle's coordinates, and its radius.
    handles: Vec<(DVec3, f64)>,
}

/// Bytes of a row of [`BoundTurning`] during binding, without the handles' entries.
pub(super) const TURNING_ROW: usize = 300 + size_of::<Entry>() + size_of::<DVec3>();

/// The number of rows that one task makes at once.
const AT_ONCE: usize = 64;

fn origins(input: &BindInput<'_>, unit: &Unit) -> Vec<(DVec3, f64)> {
    let handles = input.handles.iter();
    handles.map(|handle| (origin(handle, unit), handle.radius)).collect()
}

/// Affine fits, whose frame is a product.
///
/// # Errors
/// Those of [`BoundLinear::bind`].
pub(super) fn bind_affine(points: &Points, half_falloff: f64, input: &BindInput<'_>) -> Result<BoundLinear, BindError> {
    let map = AffineMap {
        points,
        half_falloff,
        positions: &input.problem.surface.positions,
        handles: &origins(input, &points.unit),
    };
    BoundLinear::bind(&map, Vec::new(), input)
}

impl BoundTurning {
    pub fn bind(
        turning: Turning,
        points: &Points,
        half_falloff: f64,
        input: &BindInput<'_>,
    ) -> Result<Self, BindError> {
        let positions = &input.problem.surface.positions;
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
                let moments = moments_at(points, half_falloff, positions, positions[vertex as usize]);
                // Fixed vertices count in the sum alone.
                let all = [&moments.total].into_iter().chain(&moments.sets);
                for (entry, own) in row.iter_mut().zip(all) {
                    *entry = own.stored();
                }
            }
            Ok::<_, BindError>(())
        })?;
        let place = |&vertex: &u32| points.unit.local(positions[vertex as usize]);
        Ok(Self {
            turning,
            unit: points.unit,
            places: moving.vertices.iter().map(place).collect(),
            moving,
            entries: rows,
            handles: origins(input, &points.unit),
        })
    }

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

impl BoundMethod for BoundTurning {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let handles = self.displacing(motions);
        let finite = self.moving.displace(motions, displacements, |number| {
            self.unit.length * displacement(self.turning, self.places[number], self.row(number), &handles)
        });
        Ok(Stepped::at_once(0.0, finite))
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        let handles = self.displacing(motions);
        self.moving.jacobians(motions, out, |number| {
            jacobian(self.turning, self.places[number], self.row(number), &handles).as_mat3()
        });
        true
    }

    fn solved_count(&self) -> usize {
        self.moving.vertices.len()
    }
}
