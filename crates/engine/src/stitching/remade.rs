//! Changes of topology of an open file: its present shape in, a new shape in memory out.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::PathBuf;

use glam::DVec3;
use pliant_editor::{KeptSide, MeshChange};
use pliant_mesh::SurfaceVertex;
use pliant_stitch::{Holes, Keep, Plane};

use super::cut::{CutBy, cut_file};
use super::fill::filled;
use super::{Made, ReportTo};
use crate::EngineError;
use crate::loading::{Loaded, check_not_empty, load_saved};
use crate::saving::{SaveAs, in_memory, new_in_memory};
use crate::watch::Watch;

/// The present shape of an open file.
#[derive(Clone, Copy, Debug)]
pub struct Present<'a> {
    /// The file as it was read.
    pub loaded: &'a Loaded,
    /// Displacements from the file's shape, per surface vertex.
    pub displacements: &'a [DVec3],
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: &'a BTreeSet<u32>,
}

/// A new shape, as a file in memory.
#[derive(Debug)]
pub struct Remade {
    /// The file. Its path is that of the open one, with the extension of its own format.
    pub loaded: Loaded,
    /// A sentence that says how much was done.
    pub done: String,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

/// Changes the topology of an open file's present shape. The file on the disk stays.
///
/// # Errors
/// Any refusal of the shape or of the change; [`EngineError::Interrupted`] soon after the watch's `cancel` is raised.
pub fn remake(present: &Present<'_>, change: &MeshChange, watch: &Watch) -> Result<Remade, EngineError> {
    let changed = changed(present, watch)?;
    let loaded = changed.as_ref().unwrap_or(present.loaded);
    check_not_empty(&loaded.path, &loaded.model)?;
    let path = path_in_memory(loaded);
    let report = ReportTo::Caller;
    let Made {
        shape,
        dressed,
        warnings,
        done,
        ..
    } = match change {
        MeshChange::FillAll => filled(loaded, Holes::Every, &path, report, watch)?.made,
        MeshChange::FillAt(vertex) => {
            let at = Holes::At(file_vertex(present, *vertex));
            filled(loaded, at, &path, report, watch)?.made
        }
        MeshChange::Bridge(vertices) => {
            let between = Holes::Between(vertices.map(|vertex| file_vertex(present, vertex)));
            filled(loaded, between, &path, report, watch)?.made
        }
        MeshChange::Delete(vertices) => {
            let deleted = flags(present, vertices, loaded);
            cut_file(loaded, CutBy::Deleted(&deleted), &path, report, watch)?.made
        }
        MeshChange::Cut(plane, side) => {
            let plane = Plane::of(plane.normal, plane.distance).ok_or_else(|| {
                EngineError::Arguments("the plane has no direction: draw a longer line across the shape".to_owned())
            })?;
            let keep = match side {
                KeptSide::Positive => Keep::Positive,
                KeptSide::Negative => Keep::Negative,
                KeptSide::Both => Keep::Both,
            };
            cut_file(loaded, CutBy::Plane(plane, keep), &path, report, watch)?.made
        }
    };
    let progress = watch.begin("making the new shape");
    let unsaved = dressed.unsaved(&shape);
    let saved = new_in_memory(&unsaved, &path, &progress, &watch.cancel)?;
    // Neighbours would have to be on a disk: a GLB has everything in itself.
    let (saved, path) = match saved.files.len() {
        1 => (saved, path),
        _ => {
            let alone = path.with_extension("glb");
            (new_in_memory(&unsaved, &alone, &progress, &watch.cancel)?, alone)
        }
    };
    let remade = load_saved(saved, &path, &present.loaded.model.weld, watch)?;
    Ok(Remade {
        loaded: remade,
        done,
        warnings,
    })
}

/// The open file as a save would write it now; `None` if nothing has changed.
fn changed(present: &Present<'_>, watch: &Watch) -> Result<Option<Loaded>, EngineError> {
    let Present {
        loaded,
        displacements,
        inside_out,
    } = *present;
    let is_moved = displacements.iter().any(|displacement| *displacement != DVec3::ZERO);
    if !is_moved && inside_out.is_empty() {
        return Ok(None);
    }
    let progress = watch.begin("taking the present shape");
    let mut positions = Vec::new();
    loaded.model.drawn_positions(displacements, &mut positions);
    let path = path_in_memory(loaded);
    let what = SaveAs {
        inside_out,
        ..SaveAs::shape(&positions, &path)
    };
    let saved = in_memory(loaded, &what, &progress, &watch.cancel)?;
    load_saved(saved, &path, &loaded.model.weld, watch).map(Some)
}

/// The path of a file with the extension of the format in which it can be kept in memory.
fn path_in_memory(loaded: &Loaded) -> PathBuf {
    let path = &loaded.path;
    let is_gltf = path
        .extension()
        .and_then(OsStr::to_str)
        .is_some_and(|extension| extension.eq_ignore_ascii_case("gltf"));
    if is_gltf {
        path.with_extension("glb")
    } else {
        path.clone()
    }
}

fn file_vertex(present: &Present<'_>, vertex: SurfaceVertex) -> u32 {
    present.loaded.model.first_file_vertex(vertex).0
}

/// A flag for each surface vertex of `loaded`, the open file as it was saved. Both draw the same vertices.
fn flags(present: &Present<'_>, vertices: &[SurfaceVertex], loaded: &Loaded) -> Vec<bool> {
    let (before, after) = (&present.loaded.model, &loaded.model);
    let mut chosen = vec![false; before.surface.positions.len()];
    vertices.iter().for_each(|vertex| chosen[vertex.index()] = true);
    let mut flags = vec![false; after.surface.positions.len()];
    for (before, after) in before.drawn.surface_vertices().zip(after.drawn.surface_vertices()) {
        if let (Some(before), Some(after)) = (before, after) {
            flags[after.index()] |= chosen[before.index()];
        }
    }
    flags
}
