//! Continues numbers from a patch's rim over the patch: they are harmonic, so that none leaves the range of those on
//! the rim.

use glam::DVec3;
use pliant_deform::{BilaplacianOrder, Budget, fair};
use pliant_mesh::{Cancel, Surface, SurfaceVertex, Topology};

/// Fills the rows of the points that are not `known`. `rows` has one row of `width` numbers for each point.
///
/// Points that no triangle uses keep their rows. If the equations can't be solved, the points take the mean of the
/// known rows.
pub(super) fn continue_values(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    known: &[bool],
    rows: &mut [f64],
    width: usize,
    (budget, cancel): (Budget, &Cancel),
) {
    let mut is_used = vec![false; points.len()];
    triangles
        .iter()
        .flatten()
        .for_each(|&corner| is_used[corner as usize] = true);
    let used: Vec<u32> = (0..points.len() as u32)
        .filter(|&point| is_used[point as usize])
        .collect();
    let free: Vec<u32> = (0..used.len() as u32)
        .filter(|&own| !known[used[own as usize] as usize])
        .collect();
    if width == 0 || free.is_empty() {
        return;
    }
    let own = |point: u32| SurfaceVertex(used.partition_point(|&other| other < point) as u32);
    let mut corners: Vec<[SurfaceVertex; 3]> = triangles.iter().map(|triangle| triangle.map(own)).collect();
    corners.sort_by_cached_key(|corners| {
        let mut sorted = *corners;
        sorted.sort_unstable();
        sorted
    });
    let surface = Surface {
        positions: used.iter().map(|&point| points[point as usize]).collect(),
        triangles: corners,
    };
    let topology = Topology::of(&surface);
    for first in (0..width).step_by(3) {
        let channels = first..width.min(first + 3);
        let mut values: Vec<[f64; 3]> = used
            .iter()
            .map(|&point| {
                let mut value = [0.0; 3];
                for channel in channels.clone() {
                    value[channel - first] = rows[point as usize * width + channel];
                }
                value
            })
            .collect();
        let solved = fair(
            &surface,
            &topology,
            &free,
            BilaplacianOrder::Membrane,
            &mut values,
            budget,
            cancel,
        );
        if solved.is_err() {
            let held = || (0..used.len()).filter(|&own| known[used[own] as usize]);
            let count = held().count().max(1) as f64;
            let mean = [0, 1, 2].map(|k| held().map(|own| values[own][k]).sum::<f64>() / count);
            free.iter().for_each(|&own| values[own as usize] = mean);
        }
        for &own in &free {
            for channel in channels.clone() {
                rows[used[own as usize] as usize * width + channel] = values[own as usize][channel - first];
            }
        }
    }
}
