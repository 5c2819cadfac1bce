//! How far hard handles' vertices are from where their transforms take them, for methods that only fit them.

use glam::DVec3;

use super::{Handle, Motion};

/// The hard handles' vertices and their coordinates; empty where handles are held exactly.
#[derive(Clone, Debug, Default)]
pub(crate) struct HandleResidual(Vec<Vec<(u32, [f64; 4])>>);

impl HandleResidual {
    /// Of those handles that are not soft.
    pub fn new(handles: &[Handle], soft: &[Option<f64>], positions: &[DVec3]) -> Self {
        let own = |(handle, soft): (&Handle, &Option<f64>)| {
            let vertices = handle.vertices.iter().filter(|_| soft.is_none());
            vertices
                .map(|&vertex| (vertex, handle.coordinates(positions[vertex as usize])))
                .collect()
        };
        Self(handles.iter().zip(soft).map(own).collect())
    }

    /// The largest distance, in world units.
    pub fn of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let own = self.0.iter().zip(motions).flat_map(|(own, motion)| {
            own.iter()
                .map(|&(vertex, coordinates)| displacements[vertex as usize].distance(motion.displace(coordinates)))
        });
        own.fold(0.0, f64::max)
    }
}
