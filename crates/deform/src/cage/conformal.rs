//! The bound cage of Green coordinates. Its faces' normals are not linear in the handles' motions, so each frame moves
//! the cage's vertices, corrects them a few times where the field misses the handles, and sums up vertices and normals
//! at each point.

use faer::Mat;
use glam::{DMat3, DVec3, Mat3};
use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use super::green::Green;
use super::linear::Unit;
use super::mesh::CageMesh;
use crate::BindError;
use crate::budget::filled;
use crate::handles::Motion;
use crate::numerical::rigid_fit::RigidMotion;
use crate::space::controls::Controls;
use crate::space::falloff::Falloff;
use crate::space::fit_samples::Sample;
use crate::space::hand_field::outer;

/// Points that one task takes.
const CHUNK: usize = 256;

/// How often a frame corrects the cage.
const CORRECTIONS: usize = 8;

/// The bound form.
#[derive(Debug)]
pub(super) struct Conformal {
    unit: Unit,
    cage: CageMesh,
    /// The vertices that move, ascending, where they rest, and how they fade.
    vertices: Vec<u32>,
    points: Vec<DVec3>,
    falloff: Falloff,
    /// The points' coordinates, row by row.
    rows: Vec<f64>,
    samples: Vec<Sample>,
    sample_rows: Mat<f64>,
    response: Mat<f64>,
}

/// A moved cage: a rigid motion and what differs from it.
struct MovedCage {
    rigid: Option<RigidMotion>,
    turn: DMat3,
    /// Of each vertex, then of each face's stretched normal.
    differences: Vec<DVec3>,
}

/// The bytes of a point's coordinates.
pub(super) fn row_bytes(cage: &CageMesh) -> usize {
    size_of::<f64>() * (cage.vertices.len() + cage.faces.len()) + 2 * size_of::<DVec3>()
}

impl Conformal {
    /// Computes the coordinates of the vertices that move.
    #[expect(clippy::too_many_arguments, reason = "its parts, each made by another function")]
    pub fn bind(
        unit: Unit,
        cage: CageMesh,
        samples: Vec<Sample>,
        sample_rows: Mat<f64>,
        response: Mat<f64>,
        (vertices, falloff): (Vec<u32>, Falloff),
        positions: &[DVec3],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let out_of_memory = |_| BindError::OutOfMemory {
            free_count: vertices.len(),
        };
        let points: Vec<DVec3> = vertices
            .iter()
            .map(|&vertex| unit.local(positions[vertex as usize]))
            .collect();
        let green = Green::new(&cage);
        let count = green.count();
        let mut rows = filled(0.0, points.len() * count).map_err(out_of_memory)?;
        let chunks = points.par_chunks(CHUNK).zip(rows.par_chunks_mut(CHUNK * count));
        chunks.try_for_each(|(points, rows)| {
            cancel.check()?;
            for (&point, row) in points.iter().zip(rows.chunks_exact_mut(count)) {
                green.at(point, row, None);
            }
            Ok::<_, BindError>(())
        })?;
        progress.set(1.0);
        Ok(Self {
            unit,
            cage,
            vertices,
            points,
            falloff,
            rows,
            samples,
            sample_rows,
            response,
        })
    }

    /// Fills all of `displacements`. The corrections begin at where `controls` say that the cage's vertices go.
    pub fn frame(&self, controls: &Controls, motions: &[Motion], displacements: &mut [DVec3]) {
        let (moved, _) = self.moved_cage(controls, motions);
        let count = moved.differences.len();
        let mut own = vec![DVec3::ZERO; self.points.len()];
        own.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, own)| {
            for (place, own) in own.iter_mut().enumerate() {
                let number = chunk * CHUNK + place;
                let row = &self.rows[number * count..][..count];
                let (factor, _) = self.falloff.at(number);
                *own = moved.at(self.points[number], row.iter().copied()) * (factor * self.unit.length);
            }
        });
        displacements.fill(DVec3::ZERO);
        for (&vertex, own) in self.vertices.iter().zip(own) {
            displacements[vertex as usize] = own;
        }
    }

    /// The Jacobians of the displacements. The gradients of the coordinates are computed anew each time, because they
    /// are three times as many numbers as the coordinates themselves.
    pub fn jacobians(&self, controls: &Controls, motions: &[Motion], out: &mut [Mat3]) {
        let (moved, _) = self.moved_cage(controls, motions);
        let green = Green::new(&self.cage);
        let mut own = vec![Mat3::ZERO; self.points.len()];
        own.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, own)| {
            let (mut values, mut gradients) = (vec![0.0; green.count()], vec![DVec3::ZERO; green.count()]);
            for (place, own) in own.iter_mut().enumerate() {
                let number = chunk * CHUNK + place;
                let point = self.points[number];
                green.at(point, &mut values, Some(&mut gradients));
                let (factor, slope) = self.falloff.at(number);
                let shift = moved.at(point, values.iter().copied());
                let mut sum = (moved.turn - DMat3::IDENTITY) * factor + outer(shift, slope * self.unit.length);
                for (difference, gradient) in moved.differences.iter().zip(&gradients) {
                    sum += outer(*difference, *gradient * factor);
                }
                *own = sum.as_mat3();
            }
        });
        out.fill(Mat3::ZERO);
        for (&vertex, own) in self.vertices.iter().zip(own) {
            out[vertex as usize] = own;
        }
    }

    /// Where the cage's vertices are, in world units.
    pub fn control_positions(&self, controls: &Controls, motions: &[Motion]) -> Vec<DVec3> {
        let (_, shifts) = self.moved_cage(controls, motions);
        let places = controls.rest.iter().zip(shifts);
        places.map(|(rest, shift)| *rest + shift * self.unit.length).collect()
    }

    /// Moves the cage so that the field meets the handles as well as it can; with it the displacements of its vertices.
    fn moved_cage(&self, controls: &Controls, motions: &[Motion]) -> (MovedCage, Vec<DVec3>) {
        let by_hand = controls.corrected();
        let mut shifts: Vec<DVec3> = (0..self.cage.vertices.len())
            .map(|vertex| {
                let by_hand = by_hand.map_or(DVec3::ZERO, |by_hand| by_hand[vertex]);
                (controls.driven(vertex, motions) + by_hand) / self.unit.length
            })
            .collect();
        if motions.is_empty() {
            return (MovedCage::new(&self.cage, &shifts), shifts);
        }
        // Handles are fitted by what the hand leaves; so what is fixed has the hand's displacement for its target.
        let by_hand = controls.displacements().map(|by_hand| {
            let shifts: Vec<DVec3> = by_hand.iter().map(|shift| *shift / self.unit.length).collect();
            MovedCage::new(&self.cage, &shifts)
        });
        let row = |number: usize| (0..self.sample_rows.ncols()).map(move |column| self.sample_rows[(number, column)]);
        let target = |(number, sample): (usize, &Sample)| match (sample.handle, &by_hand) {
            (Some((handle, coordinates)), _) => motions[handle].displace(coordinates) / self.unit.length,
            (None, Some(by_hand)) => by_hand.at(self.unit.local(sample.world_point), row(number)),
            (None, None) => DVec3::ZERO,
        };
        let targets: Vec<DVec3> = self.samples.iter().enumerate().map(target).collect();
        let mut best = (f64::INFINITY, (MovedCage::new(&self.cage, &shifts), shifts.clone()));
        for _ in 0..CORRECTIONS {
            let moved = MovedCage::new(&self.cage, &shifts);
            let misses: Vec<DVec3> = self
                .samples
                .iter()
                .zip(&targets)
                .enumerate()
                .map(|(number, (sample, target))| *target - moved.at(self.unit.local(sample.world_point), row(number)))
                .collect();
            let squares = misses.iter().zip(&self.samples);
            let error: f64 = squares
                .map(|(miss, sample)| miss.length_squared() * sample.weight)
                .sum();
            // Not less by a hundredth: this is as good as it gets.
            let is_better = error < 0.99 * best.0;
            if error < best.0 {
                best = (error, (moved, shifts.clone()));
            }
            if !is_better {
                break;
            }
            for (vertex, shift) in shifts.iter_mut().enumerate() {
                let columns = misses.iter().enumerate();
                *shift += columns
                    .map(|(sample, miss)| *miss * self.response[(vertex, sample)])
                    .sum::<DVec3>();
            }
        }
        best.1
    }
}

impl MovedCage {
    /// Of the vertices' displacements.
    fn new(cage: &CageMesh, shifts: &[DVec3]) -> Self {
        let green = Green::new(cage);
        let rigid = RigidMotion::fit(&cage.vertices, shifts);
        let turn = rigid.map_or(DMat3::IDENTITY, |rigid| DMat3::from_quat(rigid.rotation()));
        let moved: Vec<DVec3> = cage
            .vertices
            .iter()
            .zip(shifts)
            .map(|(rest, shift)| *rest + *shift)
            .collect();
        let of_vertices = cage.vertices.iter().zip(shifts);
        let of_vertices = of_vertices.map(|(rest, shift)| *shift - displaced(rigid.as_ref(), *rest));
        let normals = green.stretched_normals(&moved);
        let of_faces = normals
            .iter()
            .zip(green.normals())
            .map(|(moved, rest)| *moved - turn * rest);
        let differences = of_vertices.chain(of_faces).collect();
        Self {
            rigid,
            turn,
            differences,
        }
    }

    /// The displacement of a point with these coordinates. A rigid motion of the whole cage moves every point with it.
    fn at(&self, point: DVec3, coordinates: impl Iterator<Item = f64>) -> DVec3 {
        let terms = self.differences.iter().zip(coordinates);
        let sum: DVec3 = terms.map(|(difference, value)| *difference * value).sum();
        displaced(self.rigid.as_ref(), point) + sum
    }
}

fn displaced(rigid: Option<&RigidMotion>, point: DVec3) -> DVec3 {
    rigid.map_or(DVec3::ZERO, |rigid| rigid.displace(point))
}
