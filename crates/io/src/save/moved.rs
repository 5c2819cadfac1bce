//! Which vertices moved, and to where.

use std::sync::OnceLock;

use glam::DVec3;
use pliant_mesh::{Cancelled, Drawn, DrawnVertex, FileVertex};

use crate::SaveError;
use crate::save::bits::bit_equal;
use crate::save::course::Course;
use crate::save::frames::Frames;

/// Refuses a position that single precision can't hold.
pub(crate) fn check_single(position: DVec3, file_vertex: FileVertex) -> Result<(), SaveError> {
    if position.as_vec3().is_finite() {
        Ok(())
    } else {
        Err(SaveError::NotFinite {
            file_vertex: file_vertex.0,
        })
    }
}

/// The rest shape and the new one, over the drawn vertices.
///
/// A vertex moved if its new position is not bit-equal to its rest position. Every moved vertex's new position is
/// finite in single precision, whatever the format, because nearly every reader keeps no more than that.
pub(crate) struct Moved<'a> {
    pub drawn: &'a Drawn,
    /// New world positions, one per drawn vertex.
    pub positions: &'a [DVec3],
    any: bool,
    of_file: OnceLock<Vec<Option<DVec3>>>,
}

impl<'a> Moved<'a> {
    /// Compares new positions with the rest shape. Refuses a wrong count and a moved vertex that is not finite.
    pub fn of(drawn: &'a Drawn, positions: &'a [DVec3]) -> Result<Self, SaveError> {
        if positions.len() != drawn.positions.len() || drawn.file_vertex.len() != drawn.positions.len() {
            return Err(SaveError::OtherScene {
                given: positions.len(),
                wanted: drawn.positions.len(),
            });
        }
        let mut any = false;
        for ((rest, new), file) in drawn.positions.iter().zip(positions).zip(&drawn.file_vertex) {
            if !bit_equal(*rest, *new) {
                any = true;
                check_single(*new, *file)?;
            }
        }
        Ok(Self {
            drawn,
            positions,
            any,
            of_file: OnceLock::new(),
        })
    }

    /// Whether no vertex moved.
    pub fn is_nothing(&self) -> bool {
        !self.any
    }

    /// Whether a drawn vertex moved.
    pub fn moves(&self, vertex: DrawnVertex) -> bool {
        let v = vertex.index();
        !bit_equal(self.drawn.positions[v], self.positions[v])
    }

    /// The new world position of each *file* vertex that moved, `None` for the others. This is for formats without
    /// nodes, where all drawn vertices of a file vertex are at the same place; the first moved one counts.
    pub fn of_file(&self) -> &[Option<DVec3>] {
        self.of_file.get_or_init(|| {
            let mut out = vec![None; self.drawn.file_vertex_count];
            for (v, file) in self.drawn.file_vertex.iter().enumerate() {
                if let Some(slot) = out.get_mut(file.index())
                    && slot.is_none()
                    && !bit_equal(self.drawn.positions[v], self.positions[v])
                {
                    *slot = Some(self.positions[v]);
                }
            }
            out
        })
    }

    /// The local frames that carry normals and tangents along. `normals` holds each drawn vertex's world-space rest
    /// normal (any length; zero if it has none).
    pub fn frames(&self, normals: &[DVec3], course: &Course<'_>) -> Result<Frames, Cancelled> {
        Frames::of(self.drawn, self.positions, normals, course)
    }
}
