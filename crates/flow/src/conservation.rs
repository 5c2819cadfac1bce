//! Keeps the dye of each component.
//!
//! Looking back along ways does not count the dye: a little is lost or gained in each step. The difference is given back
//! where dye ends: each vertex may go towards the largest or the smallest value around it, and all of a component go the
//! same share of that way. So no new extremes arise, and where dye or clear fluid is even it stays as it is.

use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use crate::dye::{Dye, larger, smaller};
use crate::fluid::Fluid;
use crate::sums::{CHUNK, sums};

/// The integral of the dye over each component.
pub(crate) fn integrals(fluid: &Fluid<'_>, dye: &[Dye]) -> Vec<Dye> {
    let of = |vertex: usize| dye[vertex].map(|value| value * fluid.masses[vertex]);
    sums(dye.len(), fluid.component_count(), |vertex| fluid.component(vertex), of)
}

/// Brings the integral over each component to `wanted`, as far as the values around each vertex allow. `room` is
/// scratch memory of the dye's length.
pub(crate) fn conserve(fluid: &Fluid<'_>, wanted: &[Dye], dye: &mut [Dye], room: &mut [Dye]) {
    let mut missing = integrals(fluid, dye);
    for (missing, wanted) in missing.iter_mut().zip(wanted) {
        *missing = std::array::from_fn(|k| wanted[k] - missing[k]);
    }
    let old = &*dye;
    let toward = |(vertex, room): (usize, &mut Dye)| {
        let (own, missing) = (old[vertex], missing[fluid.component(vertex)]);
        let (mut least, mut most) = (own, own);
        for neighbour in fluid.sheets.topology.neighbours(SurfaceVertex(vertex as u32)) {
            let other = old[neighbour.index()];
            (least, most) = (smaller(least, other), larger(most, other));
        }
        *room = std::array::from_fn(|k| if missing[k] > 0.0 { most[k] } else { least[k] } - own[k]);
    };
    room.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(toward);
    let mut shares = integrals(fluid, room);
    for (share, missing) in shares.iter_mut().zip(&missing) {
        *share = std::array::from_fn(|k| match share[k] {
            0.0 => 0.0,
            possible => (missing[k] / possible).min(1.0),
        });
    }
    let pairs = dye.par_iter_mut().zip(&*room).with_min_len(CHUNK).enumerate();
    pairs.for_each(|(vertex, (own, room))| {
        let share = shares[fluid.component(vertex)];
        for k in 0..4 {
            own[k] += share[k] * room[k];
        }
    });
}
