//! The vertices of hard handles, which follow them exactly.

use glam::DVec3;

use crate::coarse::domain::ABSENT;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};

/// A vertex that follows its handle exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prescribed {
    pub surface_vertex: u32,
    /// The number of the vertex among the solver's; [`ABSENT`] if the energy does not see it.
    pub local: u32,
    coordinates: [f64; 4],
    /// The offset of its target from its handle's motion.
    offset: DVec3,
}

impl Prescribed {
    /// Each handle's vertices; none for a soft handle. `local_of` has the local number of each surface vertex.
    pub fn of(handles: &[Handle], soft: &[Option<f64>], world_rest: &[DVec3], local_of: &[u32]) -> Vec<Vec<Self>> {
        let one = |(handle, soft): (&Handle, &Option<f64>)| {
            let of = |&surface_vertex: &u32| Self {
                surface_vertex,
                local: local_of[surface_vertex as usize],
                coordinates: handle.coordinates(world_rest[surface_vertex as usize]),
                offset: DVec3::ZERO,
            };
            let hard = handle.vertices.iter().filter(|_| soft.is_none());
            hard.map(of).collect()
        };
        handles.iter().zip(soft).map(one).collect()
    }

    /// Sets the offset of its target from its handle's motion.
    pub fn set_offset(&mut self, offsets: &Offsets) {
        self.offset = offsets.at(self.surface_vertex);
    }

    /// Whether its target differs from its handle's motion.
    pub fn has_offset(&self) -> bool {
        self.offset != DVec3::ZERO
    }

    /// The displacement to its target.
    pub fn goes(&self, motion: &Motion) -> DVec3 {
        motion.displace(self.coordinates) + self.offset
    }

    /// The handles' vertices that the energy sees, by their local numbers, each with what belongs to its handle.
    pub fn seen<'a, T: Copy + 'a>(
        each: &'a [Vec<Self>],
        of_handles: impl IntoIterator<Item = T> + 'a,
    ) -> impl Iterator<Item = (usize, &'a Self, T)> + 'a {
        each.iter().zip(of_handles).flat_map(|(own, of_handle)| {
            let seen = own.iter().filter(|vertex| vertex.local != ABSENT);
            seen.map(move |vertex| (vertex.local as usize, vertex, of_handle))
        })
    }

    /// Writes the displacements of the handles' vertices.
    pub fn write(each: &[Vec<Self>], motions: &[Motion], displacements: &mut [DVec3]) {
        for (own, motion) in each.iter().zip(motions) {
            for vertex in own {
                displacements[vertex.surface_vertex as usize] = vertex.goes(motion);
            }
        }
    }
}
