//! The bound cage of Green coordinates. Its faces' normals are not linear in the handles' motions, so each frame moves
//! the cage's vertices, corrects them a few times where the field misses the handles, and sums up vertices and normals
//! at each point.

use faer::Mat;
use glam::{DMat3, DVec3, Mat3};
use pliant_mesh::{Cancel, Progress};

use super::green::Green;
use super::green_table::{GreenTable, green_rows};
use super::lane_rows::{LaneRows, by_blocks};
use super::linear::Unit;
use super::mesh::CageMesh;
use crate::BindError;
use crate::handles::Motion;
use crate::numerical::lanes::LANES;
use crate::numerical::rigid_fit::RigidMotion;
use crate::space::controls::Controls;
use crate::space::falloff::Falloff;
use crate::space::fit_samples::Sample;
use crate::space::hand_field::outer;

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
    table: GreenTable,
    samples: Vec<Sample>,
    sample_points: Vec<DVec3>,
    sample_rows: LaneRows<f64>,
    /// How each vertex moves as each sample misses its target by a unit.
    response: LaneRows<f64>,
}

/// A moved cage: a rigid motion and what differs from it.
struct MovedCage {
    rigid: Option<RigidMotion>,
    turn: DMat3,
    /// Of each vertex, then of each face's stretched normal.
    differences: Vec<DVec3>,
}

impl Conformal {
    /// Computes the coordinates of the vertices that move. `response` has a row a vertex of the cage and a column a
    /// sample.
    #[expect(clippy::too_many_arguments, reason = "its parts, each made by another function")]
    pub fn bind(
        unit: Unit,
        cage: CageMesh,
        samples: Vec<Sample>,
        response: &Mat<f64>,
        (vertices, falloff): (Vec<u32>, Falloff),
        positions: &[DVec3],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let free_count = vertices.len();
        let out_of_memory = |_| BindError::OutOfMemory { free_count };
        let points: Vec<DVec3> = vertices
            .iter()
            .map(|&vertex| unit.local(positions[vertex as usize]))
            .collect();
        let sample_points: Vec<DVec3> = samples.iter().map(|sample| unit.local(sample.world_point)).collect();
        let green = Green::new(&cage);
        let sample_rows = green_rows(&green, &sample_points, cancel)?;
        progress.set(0.3);
        let table = GreenTable::of(&green, &points, cancel)?;
        let response = LaneRows::of(response.nrows(), response.ncols(), |vertex, sample| {
            response[(vertex, sample)]
        });
        progress.set(1.0);
        Ok(Self {
            unit,
            response: response.map_err(out_of_memory)?,
            cage,
            vertices,
            points,
            falloff,
            table,
            samples,
            sample_points,
            sample_rows,
        })
    }

    /// Fills all of `displacements`. The corrections begin at where `controls` say that the cage's vertices go.
    pub fn frame(&self, controls: &Controls, motions: &[Motion], displacements: &mut [DVec3]) {
        let (moved, _) = self.moved_cage(controls, motions);
        let own = |block: usize| self.table.block_product(block, &moved.differences);
        displacements.fill(DVec3::ZERO);
        by_blocks(&self.vertices, displacements, |block, entries| {
            for (lane, (out, sum)) in entries.zip(own(block)).enumerate() {
                let number = block * LANES + lane;
                let shift = displaced(moved.rigid.as_ref(), self.points[number]) + sum;
                *out = shift * (self.falloff.at(number).0 * self.unit.length);
            }
        });
    }

    /// The Jacobians of the displacements, where gradients are kept; whether they are.
    pub fn jacobians(&self, controls: &Controls, motions: &[Motion], out: &mut [Mat3]) -> bool {
        let GreenTable::Small(rows, gradients) = &self.table else {
            return false;
        };
        let (moved, _) = self.moved_cage(controls, motions);
        let shifts = moved.at(&self.points, rows);
        let [x, y, z] = gradients.each_ref().map(|axis| axis.product(&moved.differences));
        out.fill(Mat3::ZERO);
        for (number, &vertex) in self.vertices.iter().enumerate() {
            let (factor, slope) = self.falloff.at(number);
            let sum = moved.turn - DMat3::IDENTITY + DMat3::from_cols(x[number], y[number], z[number]);
            let faded = outer(shifts[number], slope * self.unit.length);
            out[vertex as usize] = (sum * factor + faded).as_mat3();
        }
        true
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
        let of_hand = by_hand.map(|by_hand| by_hand.at(&self.sample_points, &self.sample_rows));
        let target = |(number, sample): (usize, &Sample)| match (sample.handle, &of_hand) {
            (Some((handle, coordinates)), _) => motions[handle].displace(coordinates) / self.unit.length,
            (None, Some(of_hand)) => of_hand[number],
            (None, None) => DVec3::ZERO,
        };
        let targets: Vec<DVec3> = self.samples.iter().enumerate().map(target).collect();
        let mut best = (f64::INFINITY, (MovedCage::new(&self.cage, &shifts), shifts.clone()));
        for _ in 0..CORRECTIONS {
            let moved = MovedCage::new(&self.cage, &shifts);
            let mut misses = moved.at(&self.sample_points, &self.sample_rows);
            for (miss, target) in misses.iter_mut().zip(&targets) {
                *miss = *target - *miss;
            }
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
            for (shift, correction) in shifts.iter_mut().zip(self.response.product(&misses)) {
                *shift += correction;
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

    /// The displacements of points with these coordinates. A rigid motion of the whole cage moves every point with it.
    fn at(&self, points: &[DVec3], rows: &LaneRows<f64>) -> Vec<DVec3> {
        let mut sums = rows.product(&self.differences);
        for (sum, point) in sums.iter_mut().zip(points) {
            *sum += displaced(self.rigid.as_ref(), *point);
        }
        sums
    }
}

fn displaced(rigid: Option<&RigidMotion>, point: DVec3) -> DVec3 {
    rigid.map_or(DVec3::ZERO, |rigid| rigid.displace(point))
}
