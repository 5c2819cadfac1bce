//! The bending term of the smooth energy, which makes point handles safe.
//!
//! E = E_rims + ½ κ A Σ_i |(L p')_i − R_i (L p)_i|² / M_ii with L the cotangent Laplacian, M its areas and A the area of
//! all cells, which makes κ a number without unit. The rims alone are a membrane: pulled at one vertex it draws out to a
//! spike, however fine the mesh, since a point holds no function whose first derivatives alone are bounded. L p' is the
//! curvature; it is to turn with the cell. That is the second order of Levi & Gotsman (2015) and Oehri et al. (2025),
//! here with the cell's own rotation: the term enters the same fit, so the energy stays a function of the positions, and
//! the majorising quadratic's matrix is −L + κ A L M⁻¹ L, a thin plate that also stretches.

use glam::DVec3;
use pliant_mesh::Surface;

use super::cells::{Cells, quad};
use super::domain::Domain;
use crate::Laplacian;

/// κ A for cells on this domain.
pub(crate) fn stiffness(surface: &Surface, domain: &Domain, smoothness: f64) -> f64 {
    let area: f64 = domain
        .faces
        .iter()
        .map(|&face| {
            let [a, b, c] = surface.triangles[face as usize].map(|corner| surface.positions[corner.index()]);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum();
    smoothness * area
}

/// Adds the term of κ A = `stiffness` to all cells; `laplacian` has full rows for them.
pub(crate) fn add(cells: &mut Cells, surface: &Surface, laplacian: &Laplacian, domain: &Domain, stiffness: f64) {
    cells.bending = domain.vertices[..domain.cell_count]
        .iter()
        .map(|&vertex| {
            let Some(local) = laplacian.local(vertex) else {
                return quad(DVec3::ZERO, 0.0);
            };
            let own = surface.positions[vertex as usize];
            let edges = laplacian.neighbours(local).iter().zip(laplacian.weights(local));
            let curvature = edges
                .map(|(&other, &weight)| {
                    let other = laplacian.vertices()[other as usize] as usize;
                    (surface.positions[other] - own) * weight
                })
                .sum();
            quad(curvature, stiffness * laplacian.inverse_areas()[local])
        })
        .collect();
}
