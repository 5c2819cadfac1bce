//! The selected points of the method's cage or lattice.

/// The control points for commands and the gizmo, ascending.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct ControlSelection {
    points: Vec<u32>,
}

impl ControlSelection {
    /// The selected points.
    pub(crate) fn points(&self) -> &[u32] {
        &self.points
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    pub(crate) fn contains(&self, point: u32) -> bool {
        self.points.binary_search(&point).is_ok()
    }

    /// Selects these and no others.
    pub(crate) fn put(&mut self, points: impl IntoIterator<Item = u32>) {
        self.points = points.into_iter().collect();
        self.points.sort_unstable();
        self.points.dedup();
    }

    /// Selects these too.
    pub(crate) fn add(&mut self, points: impl IntoIterator<Item = u32>) {
        let all: Vec<u32> = self.points.iter().copied().chain(points).collect();
        self.put(all);
    }

    /// Selects a point in addition to the others, or deselects it.
    pub(crate) fn toggle(&mut self, point: u32) {
        match self.points.binary_search(&point) {
            Ok(place) => drop(self.points.remove(place)),
            Err(place) => self.points.insert(place, point),
        }
    }

    /// Selects a clicked point; its selected group stays selected.
    pub(crate) fn click(&mut self, point: u32) {
        if !self.contains(point) {
            self.put([point]);
        }
    }

    /// Deselects points that no longer exist.
    pub(super) fn drop_lost(&mut self, count: usize) {
        self.points.retain(|point| (*point as usize) < count);
    }
}
