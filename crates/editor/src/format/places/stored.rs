//! The places in an edit's file.

use glam::DVec3;
use pliant_mesh::{Bounds, Model};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::recorded::Recorded;
use crate::format::digest::hexadecimal;
use crate::format::edit_error::EditError;
use crate::format::field::lowest_file_vertices;

/// The mesh that an edit was made on: as much of it as another mesh needs to find the edit's sets.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Places {
    /// The number of the file's vertices.
    vertices: u32,
    /// The digest of their numbers and positions.
    positions: String,
    /// The digest of the triangles between welded vertices; empty without triangles.
    triangles: String,
    /// True if each drawn vertex is the vertex of the file with its number.
    shown_once: bool,
    /// The box of its surface, in world space.
    min: [f64; 3],
    max: [f64; 3],
    /// Some of its vertices ([`Recorded`]).
    sample: String,
}

impl Places {
    /// Those of a model of which these vertices are recorded.
    pub(in crate::format) fn of(model: &Model, recorded: &Recorded) -> Self {
        let count = model.drawn.file_vertex_count();
        let mut shown = model.drawn.file_vertices().zip(0..);
        Self {
            vertices: count as u32,
            positions: digest_of_positions(model),
            triangles: digest_of_triangles(model),
            shown_once: model.drawn.vertex_count() == count && shown.all(|(file, drawn)| file.0 == drawn),
            min: recorded.bounds.min.to_array(),
            max: recorded.bounds.max.to_array(),
            sample: recorded.to_base64(),
        }
    }

    /// The number of the file's vertices.
    pub(in crate::format) fn vertex_count(&self) -> usize {
        self.vertices as usize
    }

    pub(in crate::format) fn are_shown_once(&self) -> bool {
        self.shown_once
    }

    /// Returns true if the model has the same vertices, or the same triangles between vertices that were moved.
    pub(in crate::format) fn are_of(&self, model: &Model) -> bool {
        let count = model.drawn.file_vertex_count();
        count == self.vertex_count()
            && (self.positions == digest_of_positions(model)
                || (!self.triangles.is_empty() && self.triangles == digest_of_triangles(model)))
    }

    /// The recorded vertices.
    ///
    /// # Errors
    /// Text that is none.
    pub(in crate::format) fn recorded(&self) -> Result<Recorded, EditError> {
        let bounds = Bounds {
            min: DVec3::from_array(self.min),
            max: DVec3::from_array(self.max),
        };
        let recorded = Recorded::of_base64(&self.sample, bounds).filter(|recorded| {
            let last = recorded.numbers.last();
            last.is_some_and(|last| *last < self.vertices)
        });
        recorded.ok_or_else(|| EditError::Other {
            place: "places".to_owned(),
            sentence: "can't be read: export the edit again".to_owned(),
        })
    }
}

fn digest_of_positions(model: &Model) -> String {
    let mut hash = Sha256::new();
    let drawn = model.rest();
    for (vertex, position) in drawn.file_vertex.iter().zip(&drawn.positions) {
        hash.update(vertex.0.to_le_bytes());
        hash.update(position.to_array().map(f64::to_le_bytes).as_flattened());
    }
    hexadecimal(hash)
}

fn digest_of_triangles(model: &Model) -> String {
    if model.surface.triangles.is_empty() {
        return String::new();
    }
    let numbers = lowest_file_vertices(model);
    let mut hash = Sha256::new();
    for triangle in model.drawn_triangles() {
        let number = |vertex| match model.drawn.surface_vertex(vertex) {
            Some(v) => numbers[v.index()],
            None => u32::MAX,
        };
        hash.update(triangle.map(|vertex| number(vertex).to_le_bytes()).as_flattened());
    }
    hexadecimal(hash)
}
