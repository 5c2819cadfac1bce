//! Warnings and refusals about vertices outside a brought cage or too close to it.

use glam::DVec3;

use super::CageCoordinates;
use super::brought::are_outside;
use super::harmonic::Harmonic;
use super::linear::Unit;
use super::mesh::CageMesh;
use crate::attachment_refused::AttachmentRefused;

/// Reports vertices outside the cage: mean value coordinates are defined there, the others are not.
///
/// # Errors
/// [`AttachmentRefused::Outside`].
pub(super) fn told_outside(
    coordinates: CageCoordinates,
    cage: &CageMesh,
    unit: Unit,
    world_points: &[DVec3],
) -> Result<Option<String>, AttachmentRefused> {
    let points: Vec<DVec3> = world_points.iter().map(|point| unit.local(*point)).collect();
    let count = are_outside(cage, &points).into_iter().filter(|is| *is).count();
    match coordinates {
        _ if count == 0 => Ok(None),
        CageCoordinates::MeanValue => Ok(Some(format!(
            "{count} vertices lie outside the cage and may move against it: enlarge the cage around them"
        ))),
        coordinates => Err(AttachmentRefused::Outside {
            count,
            coordinates: coordinates.name(),
        }),
    }
}

/// Reports vertices so close to the cage that the harmonic grid has too few nodes around them.
///
/// # Errors
/// [`AttachmentRefused::Close`].
pub(super) fn told_close(
    harmonic: &Harmonic,
    unit: Unit,
    world_points: &[DVec3],
) -> Result<Option<String>, AttachmentRefused> {
    let (mut none, mut few) = (0, 0);
    for point in world_points {
        let nodes = harmonic.nodes_around(unit.local(*point));
        none += usize::from(nodes == 0);
        few += usize::from(nodes < 64);
    }
    match (none, few) {
        (0, 0) => Ok(None),
        (0, few) => Ok(Some(format!(
            "{few} vertices lie so close to the cage that they follow it inexactly: move it away from them or raise `grid`"
        ))),
        (count, _) => Err(AttachmentRefused::Close { count }),
    }
}
