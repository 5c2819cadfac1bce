//! Changes of topology of an open file: its present shape in, a new shape in memory out.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_editor::{CutPlane, KeptSide, MergeChange, MeshChange};
use pliant_io::{Placement, Saved};
use pliant_mesh::{Progress, SurfaceVertex};
use pliant_stitch::{Holes, Joins, Keep, NewShape, Pair, Plane, VertexSource};

use super::append::appended;
use super::cut::{CutBy, cut_file, on_surface};
use super::fill::filled;
use super::look::Source;
use super::merge::{merged, placement};
use super::prepared::Prepared;
use super::{Made, ReportTo, refused};
use crate::EngineError;
use crate::files::holds;
use crate::loading::{Loaded, check_not_empty, load_saved};
use crate::path_text::{folder_of, neighbour_path};
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
    /// The displacements of the open file's welded vertices to their places in the new shape, if these differ from the
    /// present ones.
    pub moved: Option<Vec<DVec3>>,
    /// A sentence that says how much was done.
    pub done: String,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
    /// A vertex, numbered as in the file, of each border that a warning says stays open.
    pub left_open: Vec<u32>,
}

/// Changes the topology of an open file's present shape. The file on the disk stays. `second` is the file to append.
///
/// # Errors
/// Any refusal of the shape or of the change; [`EngineError::Interrupted`] soon after the watch's `cancel` is raised.
pub fn remake(
    present: &Present<'_>,
    change: &MeshChange,
    second: Option<&Loaded>,
    watch: &Watch,
) -> Result<Remade, EngineError> {
    let changed = changed(present, watch)?;
    let loaded = changed.as_ref().unwrap_or(present.loaded);
    check_not_empty(&loaded.path, &loaded.model)?;
    let path = path_in_memory(loaded);
    let mut moved = None;
    let made = match change {
        MeshChange::FillAll => fill(loaded, Holes::Every, &path, watch)?,
        MeshChange::FillAt(vertex) => fill(loaded, Holes::At(file_vertex(present, *vertex)), &path, watch)?,
        MeshChange::Bridge(vertices) => {
            let between = Holes::Between(vertices.map(|vertex| file_vertex(present, vertex)));
            fill(loaded, between, &path, watch)?
        }
        MeshChange::Delete(vertices) => {
            let deleted = flags(present, vertices, loaded);
            cut_file(loaded, CutBy::Deleted(&deleted), &path, ReportTo::Caller, watch)?.made
        }
        MeshChange::Cut(plane, side, spared) => {
            let spared = flags(present, spared, loaded);
            let by = cut_by(*plane, *side, &spared)?;
            cut_file(loaded, by, &path, ReportTo::Caller, watch)?.made
        }
        MeshChange::CutAlong(curve, side, spared) => {
            let (curve, spared) = (on_surface(curve), flags(present, spared, loaded));
            let by = CutBy::Curve(&curve, kept(*side), &spared);
            cut_file(loaded, by, &path, ReportTo::Caller, watch)?.made
        }
        MeshChange::Append(name) => {
            let missing = || EngineError::Arguments(format!("{name} was not read: append it again"));
            let second = second.ok_or_else(missing)?;
            check_not_empty(&second.path, &second.model)?;
            appended([loaded, second], &path)?
        }
        MeshChange::Merge(joins) => {
            let made = merge_parts(present, loaded, joins, &path, watch)?;
            moved = Some(ways(present, &made.shape));
            made
        }
    };
    Ok(Remade {
        loaded: in_memory_again(present, &made, path, watch)?,
        moved,
        done: made.done,
        warnings: made.warnings,
        left_open: made.left_open,
    })
}

fn fill(loaded: &Loaded, holes: Holes, path: &Path, watch: &Watch) -> Result<Made, EngineError> {
    Ok(filled(loaded, holes, path, ReportTo::Caller, watch)?.made)
}

fn cut_by(plane: CutPlane, side: KeptSide, spared: &[bool]) -> Result<CutBy<'_>, EngineError> {
    let plane = Plane::of(plane.normal, plane.distance).ok_or_else(|| {
        EngineError::Arguments("the plane has no direction: draw a longer line across the shape".to_owned())
    })?;
    Ok(CutBy::Plane(plane, kept(side), spared))
}

fn kept(side: KeptSide) -> Keep {
    match side {
        KeptSide::Positive => Keep::Positive,
        KeptSide::Negative => Keep::Negative,
        KeptSide::Both => Keep::Both,
    }
}

/// Joins the parts of the open file that a change calls B to the others. `now` is the file in its present shape; the
/// open one says which of its vertices are welded, because B may touch A by now.
fn merge_parts(
    present: &Present<'_>,
    now: &Loaded,
    joins: &MergeChange,
    path: &Path,
    watch: &Watch,
) -> Result<Made, EngineError> {
    let open = present.loaded;
    let drawn = now.model.rest();
    let sources = [Source::of(now, &drawn), Source::of(now, &drawn)];
    let mut is_b = vec![false; open.model.surface.positions.len()];
    joins.part.iter().for_each(|vertex| is_b[vertex.index()] = true);
    let is_a: Vec<bool> = is_b.iter().map(|is_b| !is_b).collect();
    let prepare = |side: usize| {
        let refuse = |error| refused(&open.path, error);
        let (progress, cancel) = (Progress::new(), &watch.cancel);
        let means = (&progress, cancel);
        let moved = (Some(present.displacements), None);
        let delete = [&is_b, &is_a][side];
        Prepared::of(open, &sources[side], delete, moved, refuse, means)
    };
    let prepared = [prepare(0)?, prepare(1)?];
    let pair = |[a, b]: &[SurfaceVertex; 2]| {
        let named = [*a, *b].map(|vertex| open.model.first_file_vertex(vertex).0);
        Pair {
            named,
            file: [0, 1].map(|side| prepared[side].number(named[side])),
        }
    };
    let pairs: Vec<Pair> = joins.pairs.iter().map(pair).collect();
    let request = Joins {
        pairs: &pairs,
        placement: placement(joins.settings.placement),
        reach: joins.settings.reach,
        method: &joins.settings.method,
    };
    let files = [now, now];
    Ok(merged(files, &sources, &prepared, &request, (path, ReportTo::Caller), watch)?.made)
}

/// The displacements of the open file's welded vertices to their places in a shape of the same drawn vertices; the
/// present ones for those that are not there.
fn ways(present: &Present<'_>, shape: &NewShape) -> Vec<DVec3> {
    let mut ways = present.displacements.to_vec();
    let model = &present.loaded.model;
    for (source, position) in shape.vertices.iter().zip(&shape.positions) {
        if let VertexSource::Old { vertex, .. } = *source
            && let Some(own) = model.drawn.surface_vertex(vertex)
        {
            ways[own.index()] = *position - model.surface.positions[own.index()];
        }
    }
    ways
}

/// The file of a new shape, written in memory and read again.
fn in_memory_again(present: &Present<'_>, made: &Made, path: PathBuf, watch: &Watch) -> Result<Loaded, EngineError> {
    let progress = watch.begin("making the new shape");
    let unsaved = made.dressed.unsaved(&made.shape, Placement::SameFile);
    let mut saved = new_in_memory(&unsaved, &path, &progress, &watch.cancel)?;
    let are_there = |saved: &Saved| {
        let mut neighbours = saved.files.iter().skip(1);
        neighbours.all(|file| holds(&neighbour_path(folder_of(&path), &file.name), &file.bytes))
    };
    // Other neighbours than those on the disk would have to be written: a GLB has everything in itself.
    let (saved, path) = match are_there(&saved) {
        // They are read from there.
        true => {
            saved.files.truncate(1);
            (saved, path)
        }
        false => {
            let alone = path.with_extension("glb");
            (new_in_memory(&unsaved, &alone, &progress, &watch.cancel)?, alone)
        }
    };
    load_saved(saved, &path, &present.loaded.model.weld, watch)
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
