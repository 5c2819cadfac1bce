//! Smoothing groups: the `s` lines, which apply to the faces after them.

use std::ops::Range;

/// The smoothing groups of a file's faces.
#[derive(Clone, Debug, Default)]
pub(super) struct Smoothing {
    /// Where another group begins: the first triangle, and the group as written. Before the first one there is none.
    changes: Vec<(u32, String)>,
    /// Whether each face is flat, up to the last flat one.
    pub(super) flat_faces: Vec<bool>,
}

/// Returns true if faces of this group are flat.
pub(super) fn is_flat(group: &str) -> bool {
    matches!(group, "off" | "0")
}

impl Smoothing {
    /// Adds the next face, in a group; an empty one is none. `corners_before` and `faces_before` are the numbers of
    /// corners and faces before it, all of which have at least three corners.
    pub(super) fn add_face(&mut self, group: &str, corners_before: usize, faces_before: usize) {
        let present = self.changes.last().map_or("", |(_, group)| group);
        if group != present {
            let first = corners_before - 2 * faces_before;
            self.changes.push((first as u32, group.to_owned()));
        }
        if is_flat(group) {
            self.flat_faces.resize(faces_before, false);
            self.flat_faces.push(true);
        }
    }

    /// Returns true if some faces are flat.
    pub(super) fn has_flat(&self) -> bool {
        !self.flat_faces.is_empty()
    }

    /// Returns true if there are several groups that are not flat, between which edges are hard.
    pub(super) fn has_several(&self) -> bool {
        let mut groups = self
            .changes
            .iter()
            .map(|(_, group)| group)
            .filter(|group| !is_flat(group));
        let first = groups.next();
        groups.any(|group| Some(group) != first)
    }

    /// Returns true if some faces are flat, and others are in another group.
    pub(super) fn is_partly_flat(&self) -> bool {
        self.has_flat() && self.changes.iter().any(|(_, group)| !is_flat(group))
    }

    /// The parts of a range of triangles, each in one group.
    pub(super) fn parts(&self, triangles: &Range<u32>) -> Vec<(Range<u32>, &str)> {
        let first = self.changes.partition_point(|(start, _)| *start <= triangles.start);
        let mut group = first.checked_sub(1).map_or("", |place| &*self.changes[place].1);
        let (mut start, mut parts) = (triangles.start, Vec::new());
        for (next, other) in &self.changes[first..] {
            if *next >= triangles.end {
                break;
            }
            parts.push((start..*next, group));
            (start, group) = (*next, other);
        }
        parts.push((start..triangles.end, group));
        parts
    }
}
