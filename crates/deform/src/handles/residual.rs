//! The distance of hard handles' vertices from their targets, for methods that only fit them.

use glam::DVec3;

use super::{Handle, Motion};
use crate::Remedy;

/// Handles that are missed by less than this share of the size of the bending part look met.
const UNSEEN: f64 = 1e-3;

/// The hard handles' vertices and their coordinates; empty if handles are held exactly.
#[derive(Clone, Debug, Default)]
pub(crate) struct HandleResidual {
    handles: Vec<Vec<(u32, [f64; 4])>>,
    method: &'static str,
    size: f64,
}

impl HandleResidual {
    /// The residual of handles that are not soft.
    /// `size` is that of the bending part.
    pub fn new(method: &'static str, size: f64, positions: &[DVec3], handles: &[Handle], soft: &[Option<f64>]) -> Self {
        let own = |(handle, soft): (&Handle, &Option<f64>)| {
            let vertices = handle.vertices.iter().filter(|_| soft.is_none());
            vertices
                .map(|&vertex| (vertex, handle.coordinates(positions[vertex as usize])))
                .collect()
        };
        Self {
            handles: handles.iter().zip(soft).map(own).collect(),
            method,
            size,
        }
    }

    /// The largest distance, in world units.
    pub fn of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let own = self.handles.iter().zip(motions).flat_map(|(own, motion)| {
            own.iter()
                .map(|&(vertex, coordinates)| displacements[vertex as usize].distance(motion.displace(coordinates)))
        });
        own.fold(0.0, f64::max)
    }

    /// A sentence on a visible distance.
    pub fn warning(&self, distance: f64) -> Option<String> {
        let share = distance / self.size;
        (share > UNSEEN).then(|| {
            format!(
                "{} fits the handles only approximately and misses them by up to {:.1}% of the size of the bending \
                 part: refine it by its options, or take {}, which meets them",
                self.method,
                100.0 * share,
                Remedy::OfSpace
            )
        })
    }
}
