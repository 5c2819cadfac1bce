//! A frame of a sequence: a file with the vertices and faces of the first frame, in other places.

use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_io::{SceneAndDrawn, positions_in_pose};
use pliant_mesh::{Drawn, SurfaceVertex};

use crate::EngineError;
use crate::loading::{Loaded, open};
use crate::path_text::shown;
use crate::watch::Watch;

/// A frame's file, and its shape on the surface of the first frame.
#[derive(Debug)]
pub(super) struct Frame {
    pub path: PathBuf,
    pub file: SceneAndDrawn,
    /// The position of each surface vertex.
    pub positions: Vec<DVec3>,
    /// The surface vertex of each of the file's drawn vertices.
    surface_vertices: Vec<Option<SurfaceVertex>>,
}

impl Frame {
    /// Reads a frame. `first` is the first one and `rest` its geometry.
    ///
    /// # Errors
    /// A file that can't be read, with other vertices or faces, or with a vertex that has no finite position.
    pub fn read(path: &Path, first: &Loaded, rest: &Drawn, watch: &Watch) -> Result<Self, EngineError> {
        // Frames are read side by side, so they don't tell a stage.
        let file = open(path, &Watch::cancelled_by(&watch.cancel))?;
        let places = positions_in_pose((&first.scene, rest), (&file.scene, &file.drawn));
        let places = places.ok_or_else(|| other_connectivity((path, &file.drawn), (&first.path, rest)))?;
        let model = &first.model;
        let mut positions: Vec<Option<DVec3>> = vec![None; model.surface.positions.len()];
        for ((vertex, place), number) in model.drawn.surface_vertices().zip(places).zip(&rest.file_vertex) {
            let Some(vertex) = vertex else { continue };
            if !place.is_finite() {
                return Err(EngineError::Unsupported(format!(
                    "{}: vertex {} has no finite position: repair the frame",
                    shown(path),
                    number.0
                )));
            }
            positions[vertex.index()].get_or_insert(place);
        }
        let rest_positions = &model.surface.positions;
        let positions = positions.into_iter().zip(rest_positions);
        Ok(Self {
            path: path.to_owned(),
            positions: positions.map(|(own, rest)| own.unwrap_or(*rest)).collect(),
            surface_vertices: surface_vertices(first, rest, &file.drawn),
            file,
        })
    }

    /// The positions of the file's drawn vertices, displaced with the surface's. Vertices that don't move keep their bits.
    pub fn displaced(&self, displacements: &[DVec3]) -> Vec<DVec3> {
        let pairs = self.file.drawn.positions.iter().zip(&self.surface_vertices);
        let place = |(position, vertex): (&DVec3, &Option<SurfaceVertex>)| match vertex {
            Some(vertex) if displacements[vertex.index()] != DVec3::ZERO => *position + displacements[vertex.index()],
            _ => *position,
        };
        pairs.map(place).collect()
    }
}

/// The surface vertex of each of the drawn vertices of a frame. Two frames may be drawn with different vertices
/// ([`positions_in_pose`]); each vertex of the file is then at one place.
fn surface_vertices(first: &Loaded, rest: &Drawn, drawn: &Drawn) -> Vec<Option<SurfaceVertex>> {
    let of_first = first.model.drawn.surface_vertices();
    if rest.file_vertex == drawn.file_vertex {
        return of_first.collect();
    }
    let mut of_file = vec![None; rest.file_vertex_count];
    for (file_vertex, vertex) in rest.file_vertex.iter().zip(of_first) {
        of_file[file_vertex.index()] = of_file[file_vertex.index()].or(vertex);
    }
    let of_frame = drawn.file_vertex.iter();
    of_frame.map(|file_vertex| of_file[file_vertex.index()]).collect()
}

/// The refusal of a frame with other vertices or faces.
fn other_connectivity((path, drawn): (&Path, &Drawn), (first, rest): (&Path, &Drawn)) -> EngineError {
    let counts = |drawn: &Drawn| {
        let (vertices, triangles) = (drawn.file_vertex_count, drawn.triangles.len());
        format!("{vertices} vertices and {triangles} triangles")
    };
    let (found, expected) = (counts(drawn), counts(rest));
    let found = match found == expected {
        true => format!("{found}, but other ones"),
        false => found,
    };
    EngineError::Unsupported(format!(
        "{} has {found}, and the first frame {} has {expected}: all frames of a sequence must have the same vertices \
         and faces",
        shown(path),
        shown(first)
    ))
}
