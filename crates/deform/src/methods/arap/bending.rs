//! The bending term of the smooth energy, which makes point handles safe.
//!
//! The energy over rims is that of a membrane: pulled at one vertex it forms a spike, however fine the mesh, because a
//! point cannot hold a function of which only first derivatives are bounded. So each cell is also tied to its best
//! affine map Φ_i, whose normals turn with the cell:
//!
//! E = E_rims + ½ Σ_i min over Φ_i of β_i Σ_f∋i ⅓ A_f |F_f − Φ_i P_f|² + ν Σ_f∋i ⅓ A_f |(Φ_i − R_i) n_f|²
//!
//! with F_f the gradient of p' on a triangle, P_f the projection into its plane, n_f its normal and A_f its area, times
//! its stiffness. Triangles x apart differ in F by the second derivatives of p' times x, so with β_i like κ A over the
//! cell's squared size (see `ties`), A being the area of all cells, the term is ½ κ A ∫ |Hess p'|²: a thin plate
//! without Poisson's effect, with free borders, and κ a number without unit.
//!
//! An affine map costs nothing, so a bumpy region turns at no cost in the majorising quadratic as well, where
//! |L p' − R L p|² (the second order of [LG15] and [OHS25]) with its rotations held makes it pay
//! κ A times its squared curvature. An affine map of a curved cell could hide a stretch or tilt of its normals; ν
//! resists that as firmly as the membrane resists the rest.
//!
//! With S⁰ = Σ_f ⅓ A_f P_f the cell's rest matrix (the cotangents' Σ w e eᵀ of a triangle is A P), N = Σ_f ⅓ A_f n nᵀ =
//! ½ tr S⁰ − S⁰, μ = ν/β and K = (S⁰ + μ N)⁻¹, all of which commute, the best map is 1 + Φ with Φ = (B + μ (R − 1) N)
//! K, and the rest is
//!
//! ½ β Σ w |D|² − ½ ⟨B β K, B⟩ − ⟨R − 1, ν S⁰ N K + B ν K N⟩:
//!
//! the stencil's weights grow by β, and R is fitted to a further term, in the same fit. So the energy stays a function
//! of the positions, and the majorising quadratic's matrix is that of the first two terms and the rims.

use glam::{DMat3, DVec3};
use pliant_mesh::{Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

use super::barrier::{Facing, STRENGTH};
use super::bend::Bend;
use super::cells::Cells;
use crate::coarse::domain::Domain;
use crate::numerical::eigen::eigenvectors;
use crate::numerical::rows::CHUNK;

/// ν. Without it a bent cylinder flattens, because affine maps hide its curvature; with 0.1 it flattens a little. With
/// 10 or 100 the shape is that of 1, but turning bumpy cells costs energy again: a scan of 43k vertices takes 26 and 42
/// steps instead of 15.
const NORMAL: f64 = 1.0;

/// κ A for cells on this domain.
pub(crate) fn stiffness(surface: &Surface, domain: &Domain, smoothness: f64) -> f64 {
    let area: f64 = domain
        .faces
        .iter()
        .map(|&face| double_area(surface.corners(face as usize)))
        .sum();
    smoothness * 0.5 * area
}

/// β of each cell, for κ A = `stiffness`: ½ κ A over the squared gradients in the triangles of a function with second
/// derivatives of length 1, averaged over the kinds of such functions and over the cell's area.
pub(crate) fn ties(surface: &Surface, topology: &Topology, domain: &Domain, stiffness: f64) -> Vec<f64> {
    domain.vertices[..domain.cell_count]
        .par_iter()
        .with_min_len(CHUNK)
        .map(|&vertex| {
            let own = surface.positions[vertex as usize];
            let (mut area, mut squares) = (0.0, 0.0);
            for face in topology.faces(SurfaceVertex(vertex), &surface.triangles) {
                let corners = surface.triangles[face as usize];
                for k in (0..3).filter(|&k| corners[k].0 == vertex) {
                    let [a, b] = [1, 2].map(|next| surface.positions[corners[(k + next) % 3].index()] - own);
                    let (aa, ab, bb) = (a.length_squared(), a.dot(b), b.length_squared());
                    // With ½ aᵀ H a and ½ bᵀ H b at the corners, summed over an orthonormal basis of H's.
                    let double = a.cross(b).length();
                    area += double;
                    squares += (aa * bb * (aa + bb) - 2.0 * ab.powi(3)) / (4.0 * double);
                }
            }
            let tie = 3.0 * stiffness * area / squares;
            // A triangle without area has unbounded gradients.
            if tie.is_finite() { tie } else { 0.0 }
        })
        .collect()
}

/// Adds the term to all cells, whose weights have grown by the `ties` already.
pub(crate) fn add(cells: &mut Cells, ties: &[f64]) {
    (cells.bending, cells.barriers) = cells
        .rest
        .par_iter_mut()
        .zip(ties)
        .with_min_len(CHUNK)
        .map(|(rest, &tie)| bend(rest, tie))
        .unzip();
}

/// A cell's matrices; its rest matrix gains ν S⁰ N K.
fn bend(rest: &mut [f64; 6], tie: f64) -> (Bend, Facing) {
    let (axes, squares) = eigenvectors(&matrix(rest));
    let own = 0.5 * (squares.x + squares.y + squares.z);
    // β K, ν K N and ν S⁰ N K along each axis; zero along an axis with neither extent nor normal.
    let along = |square: f64| {
        let square = square.max(0.0);
        let across = (own - square).max(0.0);
        let held = tie * square + NORMAL * across;
        if held > own * 1e-12 {
            [
                tie * tie / held,
                NORMAL * tie * across / held,
                NORMAL * tie * square * across / held,
            ]
        } else {
            [0.0; 3]
        }
    };
    let values = squares.to_array().map(along);
    let with = |k: usize| symmetric(&axes, DVec3::from_array(values.map(|value| value[k])));
    let added = with(2);
    for (own, added) in rest.iter_mut().zip(added) {
        *own += added;
    }
    let mut gain = with(1);
    for k in [0, 3, 5] {
        gain[k] += 1.0;
    }
    let facing = facing(
        &axes,
        DVec3::from_array(std::array::from_fn(|k| squares[k] * (1.0 + values[k][1]))),
        own,
    );
    let bend = Bend {
        hold: with(0),
        gain,
        share: (1.0 + tie).recip(),
    };
    (bend, facing)
}

/// The barrier of a cell whose fitted matrix has these unit axes and values along them at rest, and whose area is `area`.
fn facing(axes: &DMat3, squares: DVec3, area: f64) -> Facing {
    let least = squares.min_position();
    let [one, two] = [(least + 1) % 3, (least + 2) % 3];
    // A cell on a line has no area that could collapse.
    if squares[one] * squares[two] < 1e-6 * area * area {
        return [0.0; 7];
    }
    let [p, q] = [one, two].map(|k| (axes.col(k) / squares[k]).as_vec3());
    [p.x, p.y, p.z, q.x, q.y, q.z, (STRENGTH * area) as f32]
}

fn matrix([xx, xy, xz, yy, yz, zz]: &[f64; 6]) -> DMat3 {
    DMat3::from_cols_array(&[*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz])
}

/// The symmetric matrix with these unit axes and values along them.
fn symmetric(axes: &DMat3, values: DVec3) -> [f64; 6] {
    let m = *axes * DMat3::from_diagonal(values) * axes.transpose();
    [m.x_axis.x, m.x_axis.y, m.x_axis.z, m.y_axis.y, m.y_axis.z, m.z_axis.z]
}

fn double_area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length()
}

#[cfg(test)]
mod tests {
    use glam::{DMat2, DVec2, DVec3};
    use pliant_mesh::shapes;

    use super::{add, stiffness, ties};
    use crate::coarse::domain::Domain;
    use crate::methods::arap::cells::quad;
    use crate::methods::arap::rims;
    use crate::methods::arap::shape::{Guesses, Scratch, Shape};

    /// The energy of ½ xᵀ H x on a sheet of `side` by `side` cells, less that of the rims, in units of ½ κ A |H|² A.
    fn paid(side: usize, hessian: DMat2) -> f64 {
        let model = shapes::model(shapes::grid(side, side));
        let (surface, topology) = (&model.surface, &model.topology);
        let order: Vec<u32> = (0..surface.positions.len() as u32).collect();
        let domain = Domain::of(surface, topology, &order);
        let energy = |smoothness: f64| {
            let bending = stiffness(surface, &domain, smoothness);
            let ties = ties(surface, topology, &domain, bending);
            let unit = vec![1.0; order.len()];
            let mut cells = rims::cells(surface, topology, &unit, &domain, &ties);
            add(&mut cells, &ties);
            let mut shape = Shape::at_rest(order.len(), domain.cell_count, domain.solved_count);
            for (own, &vertex) in shape.displacements.iter_mut().zip(&domain.vertices) {
                let p: DVec2 = surface.positions[vertex as usize].truncate();
                *own = quad(DVec3::Z * (0.5 * SMALL * p.dot(hessian * p)), 0.0);
            }
            cells.measure(&mut shape, Guesses::Own, &mut Scratch::default());
            shape.energy
        };
        let square = hessian.x_axis.length_squared() + hessian.y_axis.length_squared();
        (energy(0.02) - energy(0.01)) / (0.5 * 0.01 * SMALL * SMALL * square)
    }

    /// Small enough to turn nothing noticeably.
    const SMALL: f64 = 1e-4;

    #[test]
    fn a_sheet_pays_for_its_second_derivatives_whichever_they_are() {
        let half = 0.5_f64.sqrt();
        let kinds = [[1.0, 0.0, 0.0, 0.0], [0.0, half, half, 0.0], [0.0, 0.0, 0.0, 1.0]];
        let mean = |side| {
            let paid = kinds.map(|hessian| paid(side, DMat2::from_cols_array(&hessian)));
            for (one, hessian) in paid.iter().zip(kinds) {
                assert!((0.75..1.25).contains(one), "{hessian:?}: {one}");
            }
            paid.iter().sum::<f64>() / 3.0
        };
        let [coarse, fine] = [20, 40].map(|side| (mean(side) - 1.0).abs());
        // The missing part is along the border.
        assert!(fine < 0.05 && fine < 0.55 * coarse, "{coarse} {fine}");
    }
}
