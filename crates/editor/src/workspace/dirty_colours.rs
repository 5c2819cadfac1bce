//! The vertices that changed colour since a revision: a dab on a mesh of millions recolours only its own vertices.

use pliant_mesh::SurfaceVertex;

/// The vertices that changed colour since some revision of the regions.
#[derive(Debug, Default)]
pub(crate) struct DirtyColours {
    vertices: Vec<SurfaceVertex>,
    /// The beginning of the record: everything may have changed with this revision, and since then only `vertices`.
    whole: u64,
    /// The start of the vertices of each later revision.
    starts: Vec<(u64, usize)>,
    /// The number of the vertices with a revision.
    filed: usize,
}

/// Above this number of vertices everything is recoloured: an upload of all costs less than gathering them.
const MOST: usize = 1 << 19;

impl DirtyColours {
    /// Vertices that change colour with the next revision.
    pub(crate) fn add(&mut self, vertices: &[SurfaceVertex]) {
        self.vertices.extend_from_slice(vertices);
    }

    /// Returns true if there are vertices without a revision.
    pub(crate) fn is_pending(&self) -> bool {
        self.filed < self.vertices.len()
    }

    /// Assigns the added vertices to a new revision.
    pub(crate) fn part(&mut self, revision: u64) {
        if self.vertices.len() > MOST {
            return self.whole(revision);
        }
        self.starts.push((revision, self.filed));
        self.filed = self.vertices.len();
    }

    /// Everything may have changed with this revision.
    pub(crate) fn whole(&mut self, revision: u64) {
        self.vertices.clear();
        self.starts.clear();
        (self.whole, self.filed) = (revision, 0);
    }

    /// The changes since a revision; `None` if that may be everything.
    pub(crate) fn since(&self, revision: u64) -> Option<&[SurfaceVertex]> {
        if revision < self.whole {
            return None;
        }
        let first = self.starts.partition_point(|(filed, _)| *filed <= revision);
        let start = self.starts.get(first).map_or(self.filed, |(_, start)| *start);
        self.vertices.get(start..self.filed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_since_a_revision_is_what_was_filed_after_it() {
        let [a, b, c] = [1, 2, 3].map(SurfaceVertex);
        let mut dirty = DirtyColours::default();
        dirty.whole(4);
        dirty.add(&[a, b]);
        assert!(dirty.is_pending());
        dirty.part(5);
        dirty.add(&[c]);
        assert_eq!(
            dirty.since(4),
            Some([a, b].as_slice()),
            "what has no revision is not seen yet"
        );
        dirty.part(6);
        assert!(!dirty.is_pending());
        assert_eq!(dirty.since(3), None);
        assert_eq!(dirty.since(4), Some([a, b, c].as_slice()));
        assert_eq!(dirty.since(5), Some([c].as_slice()));
        assert_eq!(dirty.since(6), Some([].as_slice()));
        dirty.add(&[a]);
        dirty.whole(7);
        assert!(!dirty.is_pending() && dirty.since(6).is_none());
    }
}
