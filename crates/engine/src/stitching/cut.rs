//! Cuts a part out of a file: a file in, a file out.

use std::collections::BTreeSet;
use std::path::Path;

use pliant_editor::{CutCurve, CutSight, Selector};
use pliant_stitch::{Age, Keep, NewShape, Plane, Sight, SurfaceCurve, VertexSource};
use serde_json::json;

use super::look::{Channels, Dressed, Source};
use super::shape_report::judged;
use super::{Made, Remaking, ReportTo, ShapeCounts, Stitched, change_of, counted, flags, lost, refused};
use crate::EngineError;
use crate::files::{self, Staging};
use crate::loading::Loaded;
use crate::watch::Watch;

/// The input of [`cut`].
#[derive(Clone, Copy, Debug)]
pub struct Cut<'a> {
    /// The file to cut, and the file to write.
    pub remaking: Remaking<'a>,
    /// The part that goes.
    pub along: CutAlong<'a>,
}

/// The line along which a file is cut.
#[derive(Clone, Copy, Debug)]
pub enum CutAlong<'a> {
    /// The border of the vertices that a selector deletes, with every triangle that uses one; and the place that the
    /// selector was read from, for messages.
    Selector(&'a Selector, &'a Path),
    /// A plane; triangles that it crosses are split.
    Plane(Plane, Keep),
    /// A curve on the surface; triangles under it are split.
    Curve(&'a CutCurve, Keep),
}

/// Cuts a file and writes the result beside its place.
///
/// # Errors
/// Any refusal of the file, of the selection, of the plane or of the result.
pub fn cut(job: &Cut<'_>, watch: &Watch, staging: &Staging) -> Result<Stitched, EngineError> {
    let Remaking {
        file, output, report, ..
    } = job.remaking;
    job.remaking.check_paths()?;
    let [loaded] = job.remaking.load([file], watch)?;
    let (deleted, curve);
    let by = match job.along {
        CutAlong::Selector(selector, place) => {
            let of_selector = |source| EngineError::Edit {
                edit: place.to_owned(),
                source,
            };
            let selection = selector.evaluate(&loaded.model).map_err(of_selector)?;
            deleted = flags(&selection, &loaded.model);
            CutBy::Deleted(&deleted)
        }
        CutAlong::Plane(plane, keep) => CutBy::Plane(plane, keep, &[]),
        CutAlong::Curve(given, keep) => {
            curve = on_surface(given);
            CutBy::Curve(&curve, keep, &[])
        }
    };
    let CutFile { made, left, gone } = cut_file(&loaded, by, output, report, watch)?;
    let stitched = job.remaking.stage(
        &made,
        |warnings| {
            json!({
                "vertices_deleted": loaded.model.drawn.file_vertex_count() - left.vertices,
                "vertices_added": made.shape.file_vertex_count - left.vertices,
                "triangles_deleted": gone,
                "triangles_split": left.split,
                "before": ShapeCounts::of(&loaded.model),
                "after": made.after.map(|(counts, _)| counts),
                "warnings": warnings,
            })
        },
        staging,
        watch,
    )?;
    Ok(stitched.from(vec![loaded]))
}

/// The line along which a surface is cut.
#[derive(Clone, Copy, Debug)]
pub(super) enum CutBy<'a> {
    /// The border of deleted surface vertices: a flag for each.
    Deleted(&'a [bool]),
    /// A plane, and a flag for each surface vertex that is spared.
    Plane(Plane, Keep, &'a [bool]),
    /// A curve on the surface, and the same flags.
    Curve(&'a SurfaceCurve, Keep, &'a [bool]),
}

/// A curve as the surface is cut along it.
pub(super) fn on_surface(curve: &CutCurve) -> SurfaceCurve {
    SurfaceCurve {
        points: curve.points.clone(),
        is_closed: curve.is_closed,
        sight: match curve.sight {
            CutSight::Normals => Sight::Normals,
            CutSight::From(eye) => Sight::From(eye),
            CutSight::Along(direction) => Sight::Along(direction),
        },
    }
}

/// A file without a part.
pub(super) struct CutFile {
    pub made: Made,
    left: Left,
    /// The number of its triangles of which nothing is left.
    gone: usize,
}

/// Cuts a file, to be written as `output`.
pub(super) fn cut_file(
    loaded: &Loaded,
    by: CutBy<'_>,
    output: &Path,
    report: ReportTo<'_>,
    watch: &Watch,
) -> Result<CutFile, EngineError> {
    watch.begin("cutting");
    let drawn = loaded.model.rest();
    let sources = [Source::of(loaded, &drawn)];
    let channels = Channels::of(&sources);
    let shape = sources[0].with_part(channels, |part| match by {
        CutBy::Plane(plane, keep, spared) => NewShape::cut_along(part, &plane, keep, spared),
        CutBy::Curve(curve, keep, spared) => NewShape::cut_along_curve(part, curve, keep, spared),
        CutBy::Deleted(flags) => NewShape::cut(part, flags),
    });
    let mut shape = shape.map_err(|error| refused(&loaded.path, error))?;
    let dressed = Dressed::of(&mut shape, &sources, channels);
    let left = Left::of(&shape);
    let broken = loaded.model.findings.non_finite_triangles.count;
    let gone = drawn.triangles.len() - broken - left.whole - left.split;
    let mut warnings = loaded.scene.notes().to_vec();
    warnings.extend(lost(loaded, &dressed, output)?);
    let after = report.wanted(|| judged(&shape, dressed.triangles(), change_of(&shape), watch))?;
    let split = match left.split {
        0 => String::new(),
        count => format!(" and split {}", counted(count, "triangle", "triangles")),
    };
    Ok(CutFile {
        made: Made {
            shape,
            dressed,
            after,
            warnings,
            left_open: Vec::new(),
            done: format!("deleted {}{split}", counted(gone, "triangle", "triangles")),
        },
        left,
        gone,
    })
}

/// Reads the file of the selector of a cut.
///
/// # Errors
/// A file that can't be read, or no selector, naming the file.
pub fn read_selector(path: &Path, watch: &Watch) -> Result<Selector, EngineError> {
    watch.note_read("--delete", path);
    let selector = Selector::parse(&files::read_text(path)?);
    selector.map_err(|source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    })
}

/// Reads the file of the curve of a cut.
///
/// # Errors
/// A file that can't be read, or no curve, naming the file.
pub fn read_cut_curve(path: &Path, watch: &Watch) -> Result<CutCurve, EngineError> {
    watch.note_read("--curve", path);
    let curve = CutCurve::parse(&files::read_text(path)?);
    curve.map_err(|source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    })
}

/// The counts of a file's own vertices and triangles in a new shape.
struct Left {
    /// The file's vertices.
    vertices: usize,
    /// Triangles that are as they were.
    whole: usize,
    /// Triangles of which pieces are left.
    split: usize,
}

impl Left {
    fn of(shape: &NewShape) -> Self {
        let mut is_old = vec![false; shape.file_vertex_count];
        for (source, file) in shape.vertices.iter().zip(&shape.file_vertices) {
            is_old[file.index()] |= matches!(source, VertexSource::Old { .. });
        }
        let of_age = |age| shape.triangle_sources.iter().filter(move |source| source.age == age);
        let split: BTreeSet<u32> = of_age(Age::New).map(|source| source.triangle).collect();
        Self {
            vertices: is_old.iter().filter(|is_old| **is_old).count(),
            whole: of_age(Age::Old).count(),
            split: split.len(),
        }
    }
}
