//! The lattice of a binding: a person's, or one over the region's box with the options' number of cells.

use glam::DVec3;
use std::sync::Arc;

use super::basis::{Axis, MOST};
use super::grid::Grid;
use super::{Lattice, LatticeBasis};
use crate::attachment::{Attachment, ControlLattice};
use crate::attachment_refused::AttachmentRefused;
use crate::space::fit_samples::RegionBox;

/// The most cells of a brought lattice along an axis.
const CELLS: u32 = 20;

/// The most control points of a brought lattice: the normal equations are dense.
const POINTS: usize = 4000;

/// A lattice over the region's box, at rest.
pub(super) fn made(options: &Lattice, within: &RegionBox) -> ControlLattice {
    let own = [options.resolution_x, options.resolution_y, options.resolution_z];
    let cells = own.map(|own| if own == 0 { options.resolution } else { own });
    let lattice = ControlLattice {
        counts: cells.map(|cells| cells + beyond(options)),
        low: within.low,
        high: within.low + within.extent,
        moved: Arc::default(),
    };
    let moved = Arc::new(points(options, &lattice));
    ControlLattice { moved, ..lattice }
}

/// The lattice's functions over its box.
pub(super) fn grid(options: &Lattice, lattice: &ControlLattice) -> Grid {
    let axes = lattice.counts.map(|count| {
        let cells = count.saturating_sub(beyond(options)).max(1) as usize;
        Axis {
            basis: options.basis,
            degree: match options.basis {
                LatticeBasis::BSpline => options.degree as usize,
                LatticeBasis::Bernstein => cells,
            },
            cells,
        }
    });
    Grid::new(axes, lattice.low, lattice.high - lattice.low)
}

/// The rest positions of the control points.
pub(super) fn points(options: &Lattice, lattice: &ControlLattice) -> Vec<DVec3> {
    let grid = grid(options, lattice);
    grid.places().map(|place| grid.rest(place)).collect()
}

/// Refuses counts that the functions can't have, and a flat box.
pub(super) fn check(options: &Lattice, attachment: &Attachment) -> Result<(), AttachmentRefused> {
    let Attachment::Lattice(lattice) = attachment else {
        return Err(AttachmentRefused::Kind);
    };
    let least = 1 + beyond(options);
    let most = match options.basis {
        LatticeBasis::BSpline => CELLS + beyond(options),
        LatticeBasis::Bernstein => MOST as u32,
    };
    for (axis, found) in ['x', 'y', 'z'].into_iter().zip(lattice.counts) {
        if !(least..=most).contains(&found) {
            return Err(AttachmentRefused::Counts {
                axis,
                found,
                least,
                most,
            });
        }
    }
    let found = attachment.point_count();
    if found > POINTS {
        return Err(AttachmentRefused::PointCount {
            found,
            least: 8,
            most: POINTS,
        });
    }
    crate::attachment::finite(&[lattice.low, lattice.high])?;
    let extent = (lattice.high - lattice.low).to_array();
    let flat = ['x', 'y', 'z']
        .into_iter()
        .zip(extent)
        .find(|(_, extent)| *extent <= 0.0);
    match flat {
        Some((axis, _)) => Err(AttachmentRefused::Flat { axis }),
        None => Ok(()),
    }
}

/// The excess of control points over cells along an axis.
fn beyond(options: &Lattice) -> u32 {
    match options.basis {
        LatticeBasis::BSpline => options.degree,
        LatticeBasis::Bernstein => 1,
    }
}
