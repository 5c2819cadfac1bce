//! Distances along the surface from creases, which stay the same while a widget is dragged.

use pliant_mesh::SurfaceVertex;

use crate::document::HandleId;

/// If known distances do not suffice, those up to this many times the asked one are searched for, so that a drag outwards
/// does not search at each of its steps.
const AHEAD: f64 = 1.25;

/// The distances from the creases of handles at rest, as far as they are known.
#[derive(Default)]
pub(super) struct CreaseDistances(Vec<Known>);

/// The vertices within a limit of a handle's crease with their distances, nearest first.
struct Known {
    handle: HandleId,
    limit: f64,
    near: Vec<(SurfaceVertex, f64)>,
}

impl CreaseDistances {
    /// The vertices within `limit` of a handle's crease, and maybe others beyond it, nearest first. `search` finds those
    /// within a distance if they are not known.
    pub fn within(
        &mut self,
        handle: HandleId,
        limit: f64,
        search: impl FnOnce(f64) -> Vec<(SurfaceVertex, f64)>,
    ) -> &[(SurfaceVertex, f64)] {
        let is_enough = |known: &Known| known.handle == handle && known.limit >= limit;
        let place = self.0.iter().position(is_enough).unwrap_or_else(|| {
            let before = self.0.len();
            self.0.retain(|known| known.handle != handle);
            let limit = if self.0.len() < before { AHEAD * limit } else { limit };
            self.0.push(Known {
                handle,
                limit,
                near: search(limit),
            });
            self.0.len() - 1
        });
        &self.0[place].near
    }
}
