//! Rigid motions of components in which nothing is fixed.
//!
//! Linear bending reproduces translations of all handles, but turns only of surfaces that it would not bend. So in a
//! component in which nothing is fixed, the turn R that fits the motion of all its handles best is removed before
//! bending and restored after it. With the linear extension d of the handles' displacements and x̂ of their rest
//! positions, the base b moves to
//!
//! b' = b + d + (R − I) (b − x̂),
//!
//! which is R b + t for rigid motions x ↦ R x + t of all handles, for every operator.

use glam::{DMat3, DQuat, DVec3};
use pliant_mesh::SurfaceVertex;

use crate::handles::Motion;
use crate::method::BindInput;
use crate::methods::bilaplacian::solver::BilaplacianSolver;
use crate::numerical::rotation::fit;
use crate::region::patch::Patch;

/// The components in which nothing is fixed.
#[derive(Debug, Default)]
pub(crate) struct Carried {
    components: Vec<Component>,
    /// Each row's place in `components`, or [`HELD`]. Empty if all are held.
    of_row: Vec<u32>,
    /// b − x̂ of each row.
    residues: Vec<DVec3>,
}

const HELD: u32 = u32::MAX;

/// A component's handles.
#[derive(Debug)]
struct Component {
    handles: Vec<Share>,
    /// Σ (p − c) (p − c)ᵀ over the handles' vertices, c their mean.
    moment: DMat3,
    /// The weight of a handle's own linear map for each of its vertices, so that handles of single points turn, too.
    tripod: f64,
}

/// A handle's part in a component.
#[derive(Debug)]
struct Share {
    handle: usize,
    radius: f64,
    count: f64,
    /// Σ q (p − c)ᵀ and Σ (p − c), q being the handle's coordinates.
    coordinates: DMat3,
    arm: DVec3,
}

/// The tripods' squared size, in units of the handles' mean squared distance from their centre.
const TRIPOD: f64 = 0.01;

impl Carried {
    /// The motions of the base, whose positions are relative to `centre`.
    pub fn of(base: &Patch, centre: DVec3, solver: &BilaplacianSolver<f64>, input: &BindInput<'_>) -> Self {
        let &BindInput {
            problem,
            partition,
            handles,
            ..
        } = input;
        let component_of = |vertex: u32| problem.topology.component(SurfaceVertex(vertex)) as usize;
        let mut place_of = vec![HELD; partition.held.len()];
        let mut count = 0;
        for &vertex in &partition.solved {
            let component = component_of(vertex);
            if !partition.held[component] && place_of[component] == HELD {
                place_of[component] = count;
                count += 1;
            }
        }
        if count == 0 {
            return Self::default();
        }
        let mut points: Vec<Vec<(usize, DVec3)>> = vec![Vec::new(); count as usize];
        for (number, handle) in handles.iter().enumerate() {
            for &vertex in &handle.vertices {
                if let Some(own) = points.get_mut(place_of[component_of(vertex)] as usize) {
                    own.push((number, problem.surface.positions[vertex as usize] - centre));
                }
            }
        }
        let of_row: Vec<u32> = partition
            .solved
            .iter()
            .map(|&vertex| place_of[component_of(vertex)])
            .collect();
        let bases = solver.bases();
        let extended = |row: usize| {
            let own = &bases.rows()[row * bases.handle_count()..][..handles.len()];
            let parts = own.iter().zip(handles);
            parts
                .map(|([x, y, z, w], handle)| {
                    DVec3::new(*x, *y, *z) * handle.radius + (handle.world_centre - centre) * *w
                })
                .sum::<DVec3>()
        };
        let residue = |(row, &local): (usize, &u32)| match of_row[row] {
            HELD => DVec3::ZERO,
            _ => base.rest[local as usize] - extended(row),
        };
        let share = |points: &Vec<(usize, DVec3)>| Component::of(points, input, centre);
        Self {
            residues: base.rows.iter().enumerate().map(residue).collect(),
            components: points.iter().map(share).collect(),
            of_row,
        }
    }

    /// R − I of each component, zero if its handles rest.
    pub fn turns(&self, motions: &[Motion]) -> Vec<DMat3> {
        self.components
            .iter()
            .map(|component| component.turn(motions))
            .collect()
    }

    /// R − I at a row.
    #[inline]
    pub fn turn(&self, row: usize, turns: &[DMat3]) -> DMat3 {
        let component = self.of_row.get(row).copied().unwrap_or(HELD);
        turns.get(component as usize).copied().unwrap_or(DMat3::ZERO)
    }

    /// Adds (R − I) (b − x̂) to the rows' points.
    pub fn correct(&self, rows: &[u32], turns: &[DMat3], posed: &mut [DVec3]) {
        for (row, (&local, residue)) in rows.iter().zip(&self.residues).enumerate() {
            posed[local as usize] += self.turn(row, turns) * *residue;
        }
    }
}

impl Component {
    /// The handle's number and the position relative to `centre` of each handle vertex, handle by handle.
    fn of(points: &[(usize, DVec3)], input: &BindInput<'_>, centre: DVec3) -> Self {
        let count = points.len() as f64;
        let mean = points.iter().map(|(_, point)| *point).sum::<DVec3>() / count;
        let mut moment = DMat3::ZERO;
        let mut handles: Vec<Share> = Vec::new();
        for &(handle, point) in points {
            let arm = point - mean;
            moment += outer(arm, arm);
            let [x, y, z, _] = input.handles[handle].coordinates(point + centre);
            if handles.last().is_none_or(|last| last.handle != handle) {
                handles.push(Share {
                    handle,
                    radius: input.handles[handle].radius,
                    count: 0.0,
                    coordinates: DMat3::ZERO,
                    arm: DVec3::ZERO,
                });
            }
            if let Some(share) = handles.last_mut() {
                share.count += 1.0;
                share.coordinates += outer(DVec3::new(x, y, z), arm);
                share.arm += arm;
            }
        }
        let spread = (moment.x_axis.x + moment.y_axis.y + moment.z_axis.z) / count;
        Self {
            handles,
            moment,
            tripod: if spread > 0.0 { TRIPOD * spread } else { 1.0 },
        }
    }

    /// R − I, R being the rotation that fits the moved vertices and the handles' own turns best.
    fn turn(&self, motions: &[Motion]) -> DMat3 {
        if self.handles.iter().all(|share| motions[share.handle].is_rest()) {
            return DMat3::ZERO;
        }
        // Σ (p' − c') (p − c)ᵀ: the mean of the displacements drops out, since Σ (p − c) = 0.
        let mut covariance = self.moment;
        for share in &self.handles {
            let motion = &motions[share.handle];
            covariance += motion.linear * share.coordinates + outer(motion.shift, share.arm);
            let linear = DMat3::IDENTITY + motion.linear * share.radius.recip();
            covariance += linear * (self.tripod * share.count);
        }
        // The first fit ends as soon as the next step would be small.
        let rotation = fit(&covariance, fit(&covariance, DQuat::IDENTITY));
        DMat3::from_quat(rotation) - DMat3::IDENTITY
    }
}

/// a bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
