//! The mesh files that an edit names: cages.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use glam::DVec3;
use pliant_editor::Beginning;
use pliant_mesh::Drawn;

use crate::EngineError;
use crate::loading::open;
use crate::watch::Watch;

/// The description of a file that an edit names.
pub(crate) const OF_EDIT: &str = "a file that --edit needs";

/// Reads the meshes that an edit names, by names relative to its own folder, and puts the meshes in their place.
///
/// # Errors
/// A file that can't be read, or a mesh that the method can't use.
pub fn bring(edit: &mut Beginning, edit_path: &Path, watch: &Watch) -> Result<(), EngineError> {
    for (name, file) in edit.attachment_files() {
        let path = edit_path.parent().unwrap_or(Path::new("")).join(file);
        let mesh = control_mesh(&path, watch)?;
        watch.note_read(OF_EDIT, &path);
        edit.bring(name, mesh).map_err(|source| EngineError::Edit {
            edit: edit_path.to_owned(),
            source,
        })?;
    }
    Ok(())
}

/// The vertices and triangles of a mesh's file in world units: the file's own vertices in their order, with those in
/// the same place joined and those without a triangle left out.
///
/// # Errors
/// Those of [`open`].
pub fn control_mesh(path: &Path, watch: &Watch) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), EngineError> {
    Ok(joined(&open(path, watch)?.drawn))
}

fn joined(drawn: &Drawn) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    // Sorted by the file's vertex, which may be shown several times in different places.
    let corners = drawn.triangles.iter().flatten();
    let used: BTreeMap<(u32, u32), DVec3> = corners
        .map(|vertex| {
            let file_vertex = drawn.file_vertex[vertex.index()].0;
            ((file_vertex, vertex.0), drawn.positions[vertex.index()])
        })
        .collect();
    let mut vertices = Vec::new();
    let mut by_place: HashMap<[u64; 3], u32> = HashMap::new();
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    for ((_, vertex), position) in used {
        // Adding zero makes both zeros the same.
        let place = (position + 0.0).to_array().map(f64::to_bits);
        let number = *by_place.entry(place).or_insert_with(|| {
            vertices.push(position);
            vertices.len() as u32 - 1
        });
        numbers.insert(vertex, number);
    }
    let triangles = drawn.triangles.iter();
    let triangles = triangles.map(|corners| corners.map(|vertex| numbers[&vertex.0]));
    (vertices, triangles.collect())
}
