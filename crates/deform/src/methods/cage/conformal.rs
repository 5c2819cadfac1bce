//! The bound cage of Green coordinates. Its faces' normals are not linear in the handles' motions, so steps fit the
//! cage's vertices to the handles, and each step sums up vertices and normals at each point.

use glam::{DMat3, DVec3, Mat3};
use pliant_mesh::{Cancel, Progress};

use super::green::Green;
use super::green_fit::{Asked, GreenFit};
use super::green_steps::{DIRECTIONS, Descent, Progressed};
use super::green_table::GreenTable;
use super::lane_rows::by_blocks;
use super::linear::Unit;
use super::mesh::CageMesh;
use super::moved_cage::{MovedCage, RestCage};
use super::rows::green_rows;
use crate::BindError;
use crate::handles::Motion;
use crate::handles::controls::Controls;
use crate::numerical::lanes::LANES;
use crate::space::affine::AffineParts;
use crate::space::falloff::Falloff;
use crate::space::fit_samples::Sample;
use crate::space::hand_field::outer;

/// The bound form.
#[derive(Debug)]
pub(super) struct Conformal {
    unit: Unit,
    fit: GreenFit,
    affine: AffineParts,
    /// The moving vertices, ascending, with their rest positions and falloff.
    vertices: Vec<u32>,
    points: Vec<DVec3>,
    falloff: Falloff,
    table: GreenTable,
    samples: Vec<Sample>,
    /// The handles' motions and the moves by hand that `descent` belongs to.
    motions: Vec<Motion>,
    by_hand: Vec<DVec3>,
    descent: Option<Descent>,
}

impl Conformal {
    /// Computes the coordinates of the moving vertices.
    #[expect(clippy::too_many_arguments, reason = "its parts, each made by another function")]
    pub fn bind(
        unit: Unit,
        cage: CageMesh,
        samples: Vec<Sample>,
        affine: AffineParts,
        (vertices, falloff): (Vec<u32>, Falloff),
        positions: &[DVec3],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let points: Vec<DVec3> = vertices
            .iter()
            .map(|&vertex| unit.local(positions[vertex as usize]))
            .collect();
        let green = Green::new(&cage);
        let sample_points: Vec<DVec3> = samples.iter().map(|sample| unit.local(sample.world_point)).collect();
        let rows = green_rows(&green, &sample_points);
        let fit = GreenFit::bind(RestCage::new(cage.clone()), sample_points, &samples, &rows)?;
        cancel.check()?;
        progress.set(0.3);
        let table = GreenTable::of(&green, &points, cancel)?;
        progress.set(1.0);
        Ok(Self {
            unit,
            fit,
            affine,
            vertices,
            points,
            falloff,
            table,
            samples,
            motions: Vec::new(),
            by_hand: Vec::new(),
            descent: None,
        })
    }

    /// The most multiplications of a step.
    pub fn work(&self) -> usize {
        DIRECTIONS.saturating_mul(self.fit.work())
    }

    /// Takes one step towards these motions and returns its result; fills all of `displacements`.
    pub fn step(&mut self, controls: &Controls, motions: &[Motion], displacements: &mut [DVec3]) -> Progressed {
        if motions.is_empty() {
            self.fill(&self.fit.cage.moved(&self.linear(controls, motions)), displacements);
            return Progressed::Converged;
        }
        if !self.is_for(controls, motions) {
            let last = self.descent.take().map(|descent| descent.current.shifts);
            let start = self.linear(controls, motions);
            self.descent = Some(Descent::new(&self.fit, self.asked(controls, motions), start, last));
            self.motions = motions.to_vec();
            self.by_hand = controls.corrected().unwrap_or_default().to_vec();
        }
        let Some(descent) = &mut self.descent else {
            return Progressed::Converged;
        };
        descent.step(&self.fit);
        let state = descent.state;
        let Some(descent) = &self.descent else { return state };
        self.fill(&descent.current.moved, displacements);
        state
    }

    /// The energy of the last step.
    pub fn energy(&self) -> f64 {
        self.descent.as_ref().map_or(0.0, |descent| descent.current.energy)
    }

    /// Returns to rest.
    pub fn rest(&mut self) {
        self.descent = None;
    }

    fn fill(&self, moved: &MovedCage, displacements: &mut [DVec3]) {
        let own = |block: usize| self.table.block_product(block, &moved.differences);
        displacements.fill(DVec3::ZERO);
        by_blocks(&self.vertices, displacements, |block, entries| {
            for (lane, (out, sum)) in entries.zip(own(block)).enumerate() {
                let number = block * LANES + lane;
                let shift = moved.displaced(self.points[number]) + sum;
                *out = shift * (self.falloff.at(number).0 * self.unit.length);
            }
        });
    }

    /// Writes the Jacobians of the displacements if gradients are stored; returns true if they are.
    pub fn jacobians(&self, controls: &Controls, motions: &[Motion], out: &mut [Mat3]) -> bool {
        let GreenTable::Small(rows, gradients) = &self.table else {
            return false;
        };
        let moved = self.fit.cage.moved(&self.shifts(controls, motions));
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

    /// The positions of the cage's vertices, in world units.
    pub fn control_positions(&self, controls: &Controls, motions: &[Motion]) -> Vec<DVec3> {
        let shifts = self.shifts(controls, motions);
        let places = controls.rest.iter().zip(shifts);
        places.map(|(rest, shift)| *rest + shift * self.unit.length).collect()
    }

    /// True if the descent belongs to these motions and moves by hand.
    fn is_for(&self, controls: &Controls, motions: &[Motion]) -> bool {
        let is_for = self.motions == motions && self.by_hand == controls.corrected().unwrap_or_default();
        self.descent.is_some() && is_for
    }

    /// The displacements of the cage's vertices: those of the last step or, before the first step, the linear ones.
    fn shifts(&self, controls: &Controls, motions: &[Motion]) -> Vec<DVec3> {
        match &self.descent {
            Some(descent) if self.is_for(controls, motions) => descent.current.shifts.clone(),
            _ => self.linear(controls, motions),
        }
    }

    /// The displacements of the cage's vertices that are linear in the motions of handles and the moves by hand.
    fn linear(&self, controls: &Controls, motions: &[Motion]) -> Vec<DVec3> {
        let corrected = controls.corrected();
        let shift = |vertex: usize| {
            let by_hand = corrected.map_or(DVec3::ZERO, |by_hand| by_hand[vertex]);
            (controls.driven(vertex, motions) + by_hand) / self.unit.length
        };
        (0..controls.rest.len()).map(shift).collect()
    }

    /// The targets that handles and moves by hand give the cage.
    fn asked(&self, controls: &Controls, motions: &[Motion]) -> Asked {
        let local = |shift: DVec3| shift / self.unit.length;
        // The handles' fit corrects the moves by hand; so fixed vertices have the displacement by hand for their
        // target.
        let by_hand = controls.displacements();
        let of_hand = by_hand.map(|by_hand| {
            let shifts: Vec<DVec3> = by_hand.iter().map(|shift| local(*shift)).collect();
            self.fit.at_samples(&self.fit.cage.moved(&shifts))
        });
        let target = |(number, sample): (usize, &Sample)| match (sample.handle, &of_hand) {
            (Some((handle, coordinates)), _) => local(motions[handle].displace(coordinates)),
            (None, Some(of_hand)) => of_hand[number],
            (None, None) => DVec3::ZERO,
        };
        let base = |(vertex, world_rest): (usize, &DVec3)| {
            let affine = motions.iter().enumerate();
            let affine = affine.map(|(handle, motion)| motion.displace(self.affine.at(handle, *world_rest)));
            let by_hand = by_hand.map_or(DVec3::ZERO, |by_hand| by_hand[vertex]);
            local(affine.sum::<DVec3>() + by_hand)
        };
        Asked {
            targets: self.samples.iter().enumerate().map(target).collect(),
            base: controls.rest.iter().enumerate().map(base).collect(),
        }
    }
}
