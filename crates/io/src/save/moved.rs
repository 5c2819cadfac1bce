//! The vertices that moved, their new places, and those that are turned inside out.

use std::borrow::Cow;
use std::sync::OnceLock;

use glam::DVec3;
use pliant_mesh::{Cancelled, Drawn, DrawnVertex, FileVertex};

use crate::Format;
use crate::SaveError;
use crate::save::bits::bit_equal;
use crate::save::course::Course;
use crate::save::frames::Frames;
use crate::save::turned::triangle_wound_back;

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
/// finite in single precision, in every format, because nearly every reader keeps no more than that.
pub(crate) struct Moved<'a> {
    pub drawn: &'a Drawn,
    /// New world positions, one per drawn vertex.
    pub positions: &'a [DVec3],
    /// True if each drawn vertex's part is turned inside out; empty if none is.
    turned: &'a [bool],
    any: bool,
    of_file: OnceLock<Vec<Option<DVec3>>>,
}

impl<'a> Moved<'a> {
    /// Compares new positions with the rest shape. Refuses a wrong count and a moved vertex that is not finite.
    ///
    /// # Errors
    /// These two, and a file vertex that is turned inside out in only some of the places where it is shown.
    pub fn of(drawn: &'a Drawn, positions: &'a [DVec3], turned: &'a [bool], format: Format) -> Result<Self, SaveError> {
        let is_of_scene = turned.is_empty() || turned.len() == positions.len();
        if positions.len() != drawn.positions.len() || drawn.file_vertex.len() != drawn.positions.len() || !is_of_scene
        {
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
        let is_any_turned = turned.contains(&true);
        if is_any_turned && !is_same_for_file_vertices(drawn, turned) {
            return Err(SaveError::CannotHold {
                what: "a mesh that several nodes show and only some turn inside out".to_owned(),
                format,
                remedy: "turn all of them, or none".to_owned(),
            });
        }
        Ok(Self {
            drawn,
            positions,
            turned: if is_any_turned { turned } else { &[] },
            any,
            of_file: OnceLock::new(),
        })
    }

    /// Returns true if no vertex moved.
    pub fn moves_nothing(&self) -> bool {
        !self.any
    }

    /// Returns true if some part is turned inside out.
    pub fn turns_any(&self) -> bool {
        !self.turned.is_empty()
    }

    /// Returns true if the file does not change.
    pub fn is_nothing(&self) -> bool {
        self.moves_nothing() && !self.turns_any()
    }

    /// Returns true if a drawn vertex's part is turned inside out.
    pub fn turns(&self, vertex: DrawnVertex) -> bool {
        self.turned.get(vertex.index()).is_some_and(|is_turned| *is_turned)
    }

    /// For each *file* vertex, true if its part is turned inside out.
    pub fn turned_of_file(&self) -> Vec<bool> {
        let mut out = vec![false; self.drawn.file_vertex_count];
        for (file, &is_turned) in self.drawn.file_vertex.iter().zip(self.turned) {
            if let Some(slot) = out.get_mut(file.index()) {
                *slot |= is_turned;
            }
        }
        out
    }

    /// The drawn triangles with their final winding.
    pub fn triangles(&self) -> Cow<'a, [[DrawnVertex; 3]]> {
        if !self.turns_any() {
            return Cow::Borrowed(&self.drawn.triangles);
        }
        let triangles = self
            .drawn
            .triangles
            .iter()
            .map(|&triangle| match self.turns(triangle[0]) {
                true => triangle_wound_back(triangle),
                false => triangle,
            });
        Cow::Owned(triangles.collect())
    }

    /// Returns true if a drawn vertex moved.
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

    /// The local frames that carry normals and tangents along. `normals` has each drawn vertex's world-space rest
    /// normal (any length; zero if it has none).
    pub fn frames(&self, normals: &[DVec3], course: &Course<'_>) -> Result<Frames, Cancelled> {
        Frames::of(self.drawn, self.positions, normals, course)
    }
}

/// Returns true if all drawn vertices of each file vertex are turned, or none.
fn is_same_for_file_vertices(drawn: &Drawn, turned: &[bool]) -> bool {
    let mut first: Vec<Option<bool>> = vec![None; drawn.file_vertex_count];
    let mut all = drawn.file_vertex.iter().zip(turned);
    all.all(|(file, &is_turned)| {
        first
            .get_mut(file.index())
            .is_none_or(|first| *first.get_or_insert(is_turned) == is_turned)
    })
}
