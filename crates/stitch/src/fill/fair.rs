//! Fairs a patch so that it joins the surrounding surface with continuous tangents.
//!
//! The patch with the triangles around its rim is a small surface of its own, in which the points inside are free. The
//! bi-Laplacian takes its metric from the patch's present shape, which is flat at first: after a fairing the patch may
//! bulge, so it is refined and faired again, until the metric fits the shape.
//!
//! A rim of n edges asks for n² / 11 points, so the shape of a large patch is found with few points, dense at the rim
//! and coarse in the middle; only the last fairing has all of them.

use glam::DVec3;
use pliant_deform::{BilaplacianOrder, BindError, Budget, fair};
use pliant_mesh::{Cancel, Surface, SurfaceVertex, Topology};

use super::patch::Patch;
use super::refine::{Density, refine};

/// The rounds of fairing and refining. After these a half sphere is within 1e-3 of its limit.
const ROUNDS: usize = 4;

/// The points with which the shape of a large patch is found.
const FEW_POINTS: usize = 6_000;

/// The most points of a patch: that of a round hole with 1,150 edges. Patches with longer rims are coarser in their
/// middle.
const MOST_POINTS: usize = 120_000;

/// The surface around a patch: triangles whose corners are points of the rim or of `points`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    /// Points that are not on the rim.
    pub points: Vec<DVec3>,
    /// Corners below the rim's count are points of the rim, those above it are `points`.
    pub triangles: Vec<[u32; 3]>,
}

/// Refines and fairs a patch; `scales` has an entry for each of its points.
///
/// # Errors
/// The errors of fairing. The patch then has its shape before the failed round.
pub(crate) fn refine_and_fair(
    patch: &mut Patch,
    scales: Vec<f64>,
    around: &Surroundings,
    budget: Budget,
    cancel: &Cancel,
) -> Result<(), BindError> {
    let mut density = Density::of(scales);
    refine(patch, &mut density, FEW_POINTS);
    let mut is_dense = true;
    for _ in 0..ROUNDS {
        if patch.points.len() == patch.rim {
            return Ok(());
        }
        fair_once(patch, around, budget, cancel)?;
        is_dense = refine(patch, &mut density, FEW_POINTS);
    }
    if !is_dense {
        fair_once(patch, around, budget, cancel)?;
        refine(patch, &mut density, MOST_POINTS);
    }
    fair_once(patch, around, budget, cancel)
}

/// Fairs those points inside a patch that are `near` its rim, and leaves the others where they are. `near` has an entry
/// for each point inside.
///
/// # Errors
/// The errors of fairing. The patch then has its shape before the failed round.
pub(crate) fn fair_ends(
    patch: &mut Patch,
    near: &[bool],
    around: &Surroundings,
    budget: Budget,
    cancel: &Cancel,
) -> Result<(), BindError> {
    let inside = (patch.rim as u32..).zip(near);
    let free: Vec<u32> = inside.filter(|(_, near)| **near).map(|(point, _)| point).collect();
    for _ in 0..ROUNDS {
        fair_points(patch, &free, around, budget, cancel)?;
    }
    Ok(())
}

/// Fairs the points inside once.
fn fair_once(patch: &mut Patch, around: &Surroundings, budget: Budget, cancel: &Cancel) -> Result<(), BindError> {
    let free: Vec<u32> = (patch.rim as u32..patch.points.len() as u32).collect();
    fair_points(patch, &free, around, budget, cancel)
}

/// Fairs the `free` points, ascending, once.
fn fair_points(
    patch: &mut Patch,
    free: &[u32],
    around: &Surroundings,
    budget: Budget,
    cancel: &Cancel,
) -> Result<(), BindError> {
    let (inside, rim) = (patch.points.len(), patch.rim);
    if free.is_empty() {
        return Ok(());
    }
    let mut triangles: Vec<[SurfaceVertex; 3]> = Vec::with_capacity(patch.triangles.len() + around.triangles.len());
    triangles.extend(patch.triangles.iter().map(|corners| corners.map(SurfaceVertex)));
    let beyond = |corner: u32| {
        SurfaceVertex(if corner < rim as u32 {
            corner
        } else {
            corner + (inside - rim) as u32
        })
    };
    triangles.extend(around.triangles.iter().map(|corners| corners.map(beyond)));
    triangles.sort_by_cached_key(|corners| {
        let mut sorted = *corners;
        sorted.sort_unstable();
        sorted
    });
    let surface = Surface {
        positions: [&patch.points[..], &around.points].concat(),
        triangles,
    };
    let topology = Topology::of(&surface);
    let centre = patch.points[..rim].iter().sum::<DVec3>() / rim as f64;
    let mut values: Vec<[f64; 3]> = surface
        .positions
        .iter()
        .map(|point| (*point - centre).to_array())
        .collect();
    fair(
        &surface,
        &topology,
        free,
        BilaplacianOrder::ThinPlate,
        &mut values,
        budget,
        cancel,
    )?;
    for &point in free {
        patch.points[point as usize] = DVec3::from_array(values[point as usize]) + centre;
    }
    Ok(())
}
