//! Puts a second file beside a first one: both become one shape of several parts.

use std::collections::BTreeSet;
use std::path::Path;

use glam::DVec3;
use pliant_mesh::{DrawnVertex, FileVertex, Model};
use pliant_stitch::{NewShape, TriangleSource, VertexSource};

use super::look::{Channels, Dressed, Source};
use super::{Made, counted, lost};
use crate::EngineError;
use crate::loading::Loaded;

/// The gap between both, as a share of the first one's width.
const GAP: f64 = 0.1;

/// Puts B beside A along x, at the height of A's middle, to be written as `output`.
pub(super) fn appended(files: [&Loaded; 2], output: &Path) -> Result<Made, EngineError> {
    let drawn = files.map(|file| file.model.rest());
    let mut sources = [0, 1].map(|side| Source::of(files[side], &drawn[side]));
    name_nodes(&mut sources, files.map(|file| &*file.path));
    let channels = Channels::of(&sources);
    let [mut shape, second] = [0, 1].map(|side: usize| sources[side].with_part(channels, NewShape::whole));
    let triangles = second.triangles.len();
    add(&mut shape, second, beside(files.map(|file| &*file.model)));
    let dressed = Dressed::of(&mut shape, &sources, channels);
    let mut warnings = Vec::new();
    for file in files {
        warnings.extend(file.scene.notes().iter().cloned());
        warnings.extend(lost(file, &dressed, output)?);
    }
    Ok(Made {
        shape,
        dressed,
        after: None,
        warnings,
        left_open: Vec::new(),
        done: format!("appended {}", counted(triangles, "triangle", "triangles")),
    })
}

/// Gives every node a name: its file's if it has none, with a number if A has a node of this name.
fn name_nodes(sources: &mut [Source<'_>; 2], paths: [&Path; 2]) {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    for (source, path) in sources.iter_mut().zip(paths) {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let free = |name: &str| {
            let name = if name.is_empty() { &*stem } else { name };
            let numbered = (2..).map(|number| format!("{name} {number}"));
            let mut names = std::iter::once(name.to_owned()).chain(numbered);
            names.find(|name| !taken.contains(name)).unwrap_or_default()
        };
        let look = &mut source.look;
        for group in &mut look.groups {
            group.node_name = free(&group.node_name);
        }
        // An OBJ keeps its names of objects and groups apart.
        for [object, group, _] in look.obj.iter_mut().flat_map(|names| &mut names.groups) {
            let own = match object.is_empty() && !group.is_empty() {
                true => group,
                false => object,
            };
            *own = free(own);
        }
        let names = look.groups.iter().map(|group| group.node_name.clone());
        taken = names.collect();
    }
}

/// The way that B moves.
fn beside(models: [&Model; 2]) -> DVec3 {
    match models.map(Model::bounds) {
        [Some(a), Some(b)] => {
            let gap = GAP * (a.max.x - a.min.x);
            let middles = 0.5 * ((a.min + a.max) - (b.min + b.max));
            DVec3::new(a.max.x + gap - b.min.x, middles.y, middles.z)
        }
        _ => DVec3::ZERO,
    }
}

/// Adds the vertices and triangles of B, moved by `way`.
fn add(shape: &mut NewShape, second: NewShape, way: DVec3) {
    let first_drawn = shape.vertices.len() as u32;
    let first_file = shape.file_vertex_count as u32;
    shape
        .vertices
        .extend(second.vertices.iter().map(|source| match *source {
            VertexSource::Old { vertex, .. } => VertexSource::Old { part: 1, vertex },
            VertexSource::New { like, row, .. } => VertexSource::New { part: 1, like, row },
        }));
    shape
        .positions
        .extend(second.positions.iter().map(|position| *position + way));
    let numbers = second
        .file_vertices
        .iter()
        .map(|vertex| FileVertex(vertex.0 + first_file));
    shape.file_vertices.extend(numbers);
    shape.file_vertex_count += second.file_vertex_count;
    let moved = |corners: &[DrawnVertex; 3]| corners.map(|corner| DrawnVertex(corner.0 + first_drawn));
    shape.triangles.extend(second.triangles.iter().map(moved));
    let sources = second.triangle_sources.iter();
    shape
        .triangle_sources
        .extend(sources.map(|source| TriangleSource { part: 1, ..*source }));
}
