//! The examples that an edit names: files with the same vertices and triangles, and morph targets of the file itself.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Beginning, ExampleSource};
use pliant_io::Scene;
use pliant_mesh::{Drawn, Model};

use crate::EngineError;
use crate::control_mesh::OF_EDIT;
use crate::loading::{Loaded, open};
use crate::path_text::shown;
use crate::watch::Watch;

/// Reads the files and the morph targets that the edit's examples name.
///
/// # Errors
/// A file that can't be read or has other vertices or triangles, and a morph target that `loaded` does not have.
pub fn bring(edit: &mut Beginning, edit_path: &Path, loaded: &Loaded, watch: &Watch) -> Result<(), EngineError> {
    let folder = edit_path.parent().unwrap_or(Path::new(""));
    for example in edit.examples_mut() {
        let displacements = match &example.source {
            ExampleSource::File(file) => {
                let path = folder.join(file);
                let displacements = from_file(&path, loaded, watch)?;
                watch.note_read(OF_EDIT, &path);
                displacements
            }
            ExampleSource::MorphTarget(target) => from_morph_target(target, loaded, watch)?,
            ExampleSource::PerVertex(_) => continue,
        };
        example.displacements = Some(Arc::new(displacements));
    }
    Ok(())
}

/// The displacements of the surface's vertices in the shape of the file at `path`.
///
/// # Errors
/// A file that can't be read, or has other vertices or triangles.
pub fn from_file(path: &Path, loaded: &Loaded, watch: &Watch) -> Result<Vec<DVec3>, EngineError> {
    Ok(of_surface(&loaded.model, &displacements_to(path, loaded, watch)?))
}

/// The displacements of the surface's vertices by the file's morph targets of this name at full weight.
///
/// # Errors
/// The file has none of this name, or it can't be read.
pub fn from_morph_target(target: &str, loaded: &Loaded, watch: &Watch) -> Result<Vec<DVec3>, EngineError> {
    Ok(of_surface(&loaded.model, &morph_target(target, loaded, watch)?))
}

fn displacements_to(path: &Path, loaded: &Loaded, watch: &Watch) -> Result<Vec<DVec3>, EngineError> {
    let other = open(path, watch)?;
    let own = loaded.model.rest();
    let positions = positions_in_pose((path, &other.scene, &other.drawn), (&loaded.path, &loaded.scene, &own))?;
    if let Some(vertex) = positions.iter().position(|position| !position.is_finite()) {
        let shown = shown(path);
        let sentence = format!("{shown}: vertex {vertex} has no finite position: repair the example");
        return Err(EngineError::Unsupported(sentence));
    }
    let each = positions.iter().zip(&own.positions);
    Ok(each.map(|(to, from)| *to - *from).collect())
}

/// The positions of the file's drawn vertices in a pose.
///
/// # Errors
/// [`EngineError::Example`] if it has other vertices or faces than the file.
pub fn positions_in_pose(
    (path, posed_scene, posed): (&Path, &Scene, &Drawn),
    (file, scene, own): (&Path, &Scene, &Drawn),
) -> Result<Vec<DVec3>, EngineError> {
    let found = pliant_io::positions_in_pose((scene, own), (posed_scene, posed));
    found.ok_or_else(|| {
        let counts = |drawn: &Drawn| {
            let (vertices, triangles) = (drawn.file_vertex_count, drawn.triangles.len());
            format!("{vertices} vertices and {triangles} triangles")
        };
        let (found, expected) = (counts(posed), counts(own));
        EngineError::Example {
            example: path.to_owned(),
            what: match found == expected {
                true => format!("{found}, but other triangles"),
                false => found,
            },
            file: file.to_owned(),
            expected,
        }
    })
}

fn morph_target(target: &str, loaded: &Loaded, watch: &Watch) -> Result<Vec<DVec3>, EngineError> {
    let name = loaded.path.to_string_lossy();
    let count = loaded.model.drawn.vertex_count();
    let found = loaded.scene.morph_target(&name, target, count, &watch.cancel);
    found?.ok_or_else(|| {
        let known = loaded.scene.morph_targets();
        let remedy = match known.is_empty() {
            true => "it has none: name a `file`".to_owned(),
            false => format!("it has {}", known.join(", ")),
        };
        let shown = shown(&loaded.path);
        EngineError::Unsupported(format!("{shown} has no morph target {target:?}: {remedy}"))
    })
}

/// The displacement of each surface vertex' first drawn vertex.
fn of_surface(model: &Model, of_drawn: &[DVec3]) -> Vec<DVec3> {
    let mut displacements = vec![None; model.surface.positions.len()];
    for (vertex, displacement) in model.drawn.surface_vertices().zip(of_drawn) {
        if let Some(vertex) = vertex {
            displacements[vertex.index()].get_or_insert(*displacement);
        }
    }
    displacements.into_iter().map(Option::unwrap_or_default).collect()
}
