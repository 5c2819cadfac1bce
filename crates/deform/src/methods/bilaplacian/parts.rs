//! Stiff parts: a part painted stiffer than its surroundings keeps its shape while it turns with them.
//!
//! A linear method turns nothing: a part that resists ∇²d alone would keep its direction in space and shear. So each
//! connected part C of stiffness above s₁ ([`Level`]) has its own motion T_C, and the excess over s₁ resists departures,
//! u = d − (T_C − I) p:
//!
//! ½ k_b ∫ (s − s₁) (|∇²u|² + q⁴ |u|²), q = min(2 κ, π / r),
//!
//! κ being the part's mean |κ₁ + κ₂| and r its radius. (On a tube |∇²u|² does not see the shear of a part that a bend
//! turns; a flat strip has none, and stays the beam of its stiffness.) A part is a soft handle whose target is
//! computed: first the affine T_C of least energy, which is linear in the handles' motions and known once all columns
//! are solved for; then, every frame, the rigid motion next to it. So a frame stays one product. A part with vertices
//! of one handle, or with fixed ones, moves with those; one that has both has only its stiffness.

use faer::Mat;
use glam::DVec3;

use crate::handles::{Handle, Motion};
use crate::numerical::dense::Lu;
use crate::numerical::rigid_fit::RigidMotion;
use crate::operators::hessian::RingKind;
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::systems::natural::NaturalTerm;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::setup::Prescribed;
use crate::systems::stiff_parts::{Guide, Level, hang, stiff_components};
use pliant_mesh::SurfaceVertex;

/// A part that bends by less than this over its radius is flat: no motion of it bends the surface, so it needs none.
const FLAT: f64 = 1e-6;

/// The factors of M tr H, M a and M b in M |H|².
const SHARES: [f64; 3] = [0.5, 2.0, 2.0];

/// A part.
#[derive(Debug)]
struct StiffPart {
    /// Its vertices and its frame.
    handle: Handle,
    /// Its vertices' rest positions.
    rest: Vec<DVec3>,
    guide: Guide,
    rows: Vec<Row>,
}

/// A vertex' Hessian within a part.
#[derive(Debug)]
struct Row {
    local: u32,
    /// k_b (s − s₁) / M.
    density: f64,
    /// M tr H, M a and M b of the part's coordinates.
    rest: [[f64; 4]; 3],
}

/// The parts of a bound problem.
#[derive(Debug, Default)]
pub(crate) struct StiffParts {
    parts: Vec<StiffPart>,
    /// The handles, whose coordinates describe motions.
    handles: Vec<Handle>,
    /// The free parts' affine motions from those of all other parts: four rows for each.
    response: Option<Mat<f64>>,
}

impl StiffParts {
    /// Adds these levels' parts of the components that `may_turn` to the operator; returns their places and coordinates.
    pub fn attach(
        operator: &mut BilaplacianOperator,
        triangulation: &Triangulation,
        problem: &BoundaryProblem,
        handles: &[Handle],
        levels: &[Level],
        may_turn: impl Fn(u32) -> bool,
    ) -> (Self, Vec<Prescribed>) {
        let (mut parts, mut prescribed) = (Self::default(), Vec::new());
        if handles.is_empty() {
            return (parts, prescribed);
        }
        let mut components = Vec::new();
        for level in levels {
            let of_level = stiff_components(operator, triangulation, problem, level);
            components.extend(of_level.into_iter().map(|component| (component, level)));
        }
        for ((vertices, guide), level) in components {
            if !may_turn(problem.topology.component(SurfaceVertex(vertices[0]))) {
                continue;
            }
            let handle = Handle::new(vertices, &problem.surface.positions);
            let excess = |vertex: u32| level.excess(problem, vertex);
            let curvature = mean_curvature(operator, problem, &handle);
            if curvature * handle.radius < FLAT {
                continue;
            }
            let wave_number = (2.0 * curvature).min(std::f64::consts::PI / handle.radius);
            prescribed.push(hang(operator, problem, &handle, wave_number, &excess));
            let rest = handle.vertices.iter();
            parts.parts.push(StiffPart {
                rest: rest.map(|&vertex| problem.surface.positions[vertex as usize]).collect(),
                rows: rows(operator, problem, &handle, &excess),
                handle,
                guide,
            });
        }
        if !parts.parts.is_empty() {
            parts.handles = handles.to_vec();
        }
        (parts, prescribed)
    }

    /// The number of parts.
    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// The load of a part's coordinates on each of the local vertices `columns`.
    pub fn load(&self, part: usize, operator: &BilaplacianOperator, columns: &[u32]) -> Vec<[f64; 4]> {
        let count = operator.laplacian.vertices().len();
        let Some(natural) = &operator.natural else {
            return vec![[0.0; 4]; columns.len()];
        };
        let (mut traces, mut stress) = (vec![[0.0; 4]; count], vec![[[0.0; 4]; 2]; count]);
        for row in &self.parts[part].rows {
            let scaled = |k: usize| row.rest[k].map(|value| row.density * SHARES[k] * value);
            traces[row.local as usize] = scaled(0);
            stress[row.local as usize] = [scaled(1), scaled(2)];
        }
        let of = |&local: &u32| {
            let trace = operator.laplacian.row(local as usize, &traces);
            let bent = natural.force(&operator.laplacian, local as usize, &stress);
            std::array::from_fn(|k| trace[k] + bent[k])
        };
        columns.iter().map(of).collect()
    }

    /// x̂ᵀ K (δ x̂ − d) of the part's Hessians, δ being 1 if d are the part's own columns.
    pub fn energy<const K: usize>(
        &self,
        part: usize,
        is_own: bool,
        operator: &BilaplacianOperator,
        d: &[[f64; K]],
    ) -> [[f64; 4]; 4] {
        let mut block = [[0.0; 4]; 4];
        let Some(natural) = &operator.natural else {
            return block;
        };
        for row in &self.parts[part].rows {
            let bent = hessian(operator, natural, row.local as usize, d);
            for k in 0..3 {
                let factor = row.density * SHARES[k];
                for i in 0..4 {
                    for j in 0..4 {
                        let own = if is_own { row.rest[k][j] } else { 0.0 };
                        block[i][j] += factor * row.rest[k][i] * (own - bent[k][j]);
                    }
                }
            }
        }
        block
    }

    /// Computes the free parts' dependence on the others from the blocks G of the energy, row-major over handles and
    /// parts.
    pub fn settle(&mut self, blocks: &[[[f64; 4]; 4]]) {
        let count = self.handles.len() + self.parts.len();
        let (known, free) = self.sorted();
        if free.is_empty() {
            return;
        }
        let entry = |a: usize, i: usize, b: usize, j: usize| blocks[a * count + b][i][j];
        let mut own = Mat::from_fn(4 * free.len(), 4 * free.len(), |r, c| {
            entry(free[r / 4], r % 4, free[c / 4], c % 4)
        });
        // A flat part does not determine its normal: the normal would move nothing.
        let largest = (0..own.nrows()).map(|k| own[(k, k)]).fold(f64::MIN_POSITIVE, f64::max);
        (0..own.nrows()).for_each(|k| own[(k, k)] += 1e-13 * largest);
        let others = Mat::from_fn(4 * free.len(), 4 * known.len(), |r, c| {
            -entry(free[r / 4], r % 4, known[c / 4], c % 4)
        });
        let response = Lu::of(own).solved(others);
        let is_finite = (0..response.ncols()).all(|c| (0..response.nrows()).all(|r| response[(r, c)].is_finite()));
        self.response = is_finite.then_some(response);
    }

    /// The places of the parts whose motions are known, and of the free parts, among handles and parts.
    fn sorted(&self) -> (Vec<usize>, Vec<usize>) {
        let first = self.handles.len();
        let is_free = |place: &usize| {
            place
                .checked_sub(first)
                .is_some_and(|p| self.parts[p].guide == Guide::Free)
        };
        let (free, known) = (0..first + self.parts.len()).partition(is_free);
        (known, free)
    }

    /// The motions of all handles and parts from the handles'.
    pub fn motions(&self, motions: &[Motion]) -> Vec<Motion> {
        let mut all = motions.to_vec();
        all.extend(self.parts.iter().map(|part| match part.guide {
            Guide::Handle(handle) => {
                let handle = usize::from(handle);
                part.handle.following(&self.handles[handle], &motions[handle])
            }
            Guide::Free | Guide::Fixed => Motion::default(),
        }));
        let Some(response) = &self.response else {
            return all;
        };
        let (known, free) = self.sorted();
        if known.iter().all(|&place| all[place].is_rest()) {
            return all;
        }
        for (number, &place) in free.iter().enumerate() {
            let mut columns = [DVec3::ZERO; 4];
            for (i, column) in columns.iter_mut().enumerate() {
                for (c, &other) in known.iter().enumerate() {
                    let motion = &all[other];
                    let of = [
                        motion.linear.x_axis,
                        motion.linear.y_axis,
                        motion.linear.z_axis,
                        motion.shift,
                    ];
                    for (j, of) in of.into_iter().enumerate() {
                        *column += of * response[(4 * number + i, 4 * c + j)];
                    }
                }
            }
            let part = &self.parts[place - self.handles.len()];
            let moved = |&position: &DVec3| {
                let [x, y, z, w] = part.handle.coordinates(position);
                columns[0] * x + columns[1] * y + columns[2] * z + columns[3] * w
            };
            all[place] = part.rigid(&part.rest.iter().map(moved).collect::<Vec<_>>());
        }
        all
    }

    /// The rigid motion of each part that fits the surface's displacements best.
    pub fn fitted(&self, displacements: &[DVec3]) -> Vec<Motion> {
        let fit = |part: &StiffPart| {
            let moved: Vec<DVec3> = part
                .handle
                .vertices
                .iter()
                .map(|&v| displacements[v as usize])
                .collect();
            part.rigid(&moved)
        };
        self.parts.iter().map(fit).collect()
    }

    /// The decrease of the energy of displacements if the parts have moved, compared with parts at rest.
    pub fn relief(&self, operator: &BilaplacianOperator, d: &[[f64; 3]], of_parts: &[Motion]) -> f64 {
        let Some(natural) = &operator.natural else {
            return 0.0;
        };
        let mut sum = 0.0;
        for (part, motion) in self.parts.iter().zip(of_parts) {
            for row in &part.rows {
                let bent = hessian(operator, natural, row.local as usize, d);
                for k in 0..3 {
                    let (whole, of_part) = (DVec3::from_array(bent[k]), motion.displace(row.rest[k]));
                    let lost = whole.length_squared() - (whole - of_part).length_squared();
                    sum += 0.5 * row.density * SHARES[k] * lost;
                }
            }
        }
        sum
    }
}

impl StiffPart {
    fn rigid(&self, moved: &[DVec3]) -> Motion {
        let fit = RigidMotion::fit(&self.rest, moved);
        fit.map_or(Motion::default(), |fit| self.handle.rigid_motion(&fit))
    }
}

/// M tr H, M a and M b of K functions at a local vertex.
fn hessian<const K: usize>(
    operator: &BilaplacianOperator,
    natural: &NaturalTerm,
    local: usize,
    d: &[[f64; K]],
) -> [[f64; K]; 3] {
    let [a, b] = natural.hessian.row(&operator.laplacian, local, d);
    [operator.laplacian.row(local, d), a, b]
}

/// The mean of |κ₁ + κ₂| over the vertices of a part inside its triangles.
fn mean_curvature(operator: &BilaplacianOperator, problem: &BoundaryProblem, part: &Handle) -> f64 {
    let (laplacian, Some(natural)) = (&operator.laplacian, &operator.natural) else {
        return 0.0;
    };
    let vertices = laplacian.vertices().iter();
    let arms: Vec<[f64; 3]> = vertices
        .map(|&vertex| (problem.surface.positions[vertex as usize] - part.world_centre).to_array())
        .collect();
    let (mut bent, mut area) = (0.0, 0.0);
    for &vertex in &part.vertices {
        let is_inner = |&local: &usize| natural.hessian.kinds()[local] == RingKind::Closed;
        let Some(local) = laplacian.local(vertex).filter(is_inner) else {
            continue;
        };
        let inverse_area = laplacian.inverse_areas()[local];
        if inverse_area > 0.0 {
            bent += DVec3::from_array(laplacian.row(local, &arms)).length();
            area += inverse_area.recip();
        }
    }
    if area > 0.0 { bent / area } else { 0.0 }
}

/// The Hessians within a part.
fn rows(
    operator: &BilaplacianOperator,
    problem: &BoundaryProblem,
    part: &Handle,
    excess: &impl Fn(u32) -> f64,
) -> Vec<Row> {
    let (laplacian, Some(natural)) = (&operator.laplacian, &operator.natural) else {
        return Vec::new();
    };
    let vertices = laplacian.vertices().iter();
    let coordinates: Vec<[f64; 4]> = vertices
        .map(|&vertex| part.coordinates(problem.surface.positions[vertex as usize]))
        .collect();
    let row = |&vertex: &u32| {
        let local = laplacian.local(vertex).filter(|&local| natural.weights[local] > 0.0)?;
        Some(Row {
            local: local as u32,
            density: operator.bending * excess(vertex) * laplacian.inverse_areas()[local],
            rest: hessian(operator, natural, local, &coordinates),
        })
    };
    part.vertices.iter().filter_map(row).collect()
}
