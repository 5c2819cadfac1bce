//! Fills holes: a file in, a file out.

use std::path::Path;
use std::time::Instant;

use pliant_stitch::{Filled, FilledHole, Holes, NewShape, Reason};
use serde_json::json;

use super::look::{Channels, Dressed, Source};
use super::shape_report::judged;
use super::{Made, Remaking, ReportTo, ShapeCounts, Stitched, change_of, counted, lost, refused};
use crate::files::Staging;
use crate::loading::Loaded;
use crate::report::ms_since;
use crate::watch::Watch;
use crate::{EngineError, memory};

/// The input of [`fill`].
#[derive(Clone, Copy, Debug)]
pub struct Fill<'a> {
    /// The file with holes, and the file to write.
    pub remaking: Remaking<'a>,
    /// The holes to fill.
    pub holes: Holes,
}

/// Fills holes of a file and writes the result beside its place.
///
/// # Errors
/// Any refusal of the file, of the holes or of the result.
pub fn fill(job: &Fill<'_>, watch: &Watch, staging: &Staging) -> Result<Stitched, EngineError> {
    let Remaking {
        file, output, report, ..
    } = job.remaking;
    job.remaking.check_paths()?;
    let start = Instant::now();
    let [loaded] = job.remaking.load([file], watch)?;
    let load_ms = ms_since(start);
    let FilledFile { made, filled, fill_ms } = filled(&loaded, job.holes, output, report, watch)?;
    let (points, triangles) = counts(&filled);
    let unfilled = |is_meant: &dyn Fn(Reason) -> bool| {
        let own = filled.unfilled.iter().filter(|unfilled| is_meant(unfilled.reason));
        own.map(|unfilled| unfilled.count).sum::<usize>()
    };
    let file_vertices = loaded.model.first_file_vertices();
    let hole_report = |hole: &FilledHole| {
        json!({
            "vertex": file_vertices[hole.borders[0].vertices[0].index()].0,
            "edges": hole.borders.iter().map(|border| border.vertices.len()).sum::<usize>(),
            "length": hole.borders.iter().map(|border| border.length).sum::<f64>(),
            "points": hole.points.len(),
            "triangles": hole.triangles.len(),
            "faired": hole.is_faired,
        })
    };
    let stitched = job.remaking.stage(
        &made,
        |warnings| {
            json!({
                "holes_filled": filled.holes.len(),
                "passed_over": unfilled(&|reason| reason != Reason::Outer),
                "outer_borders": unfilled(&|reason| reason == Reason::Outer),
                "vertices_added": points,
                "triangles_added": triangles,
                "before": ShapeCounts::of(&loaded.model),
                "after": made.after.map(|(counts, _)| counts),
                "self_intersections_added": made.after.map_or(0, |(_, crossings)| crossings),
                "holes": filled.holes.iter().map(hole_report).collect::<Vec<_>>(),
                "load_ms": load_ms,
                "fill_ms": fill_ms,
                "warnings": warnings,
            })
        },
        staging,
        watch,
    )?;
    Ok(stitched.from(vec![loaded]))
}

/// A file with filled holes.
pub(super) struct FilledFile {
    pub made: Made,
    filled: Filled,
    fill_ms: f64,
}

/// Fills holes of a file, to be written as `output`.
pub(super) fn filled(
    loaded: &Loaded,
    holes: Holes,
    output: &Path,
    report: ReportTo<'_>,
    watch: &Watch,
) -> Result<FilledFile, EngineError> {
    let progress = watch.begin("filling");
    let start = Instant::now();
    let budget = memory::budget();
    let filled = pliant_stitch::fill(&loaded.model, holes, budget, &progress, &watch.cancel);
    let filled = filled.map_err(|error| refused(&loaded.path, error))?;
    let drawn = loaded.model.rest();
    let sources = [Source::of(loaded, &drawn)];
    let channels = Channels::of(&sources);
    let shape = sources[0].with_part(channels, |part| NewShape::filled(part, &filled, budget, &watch.cancel));
    let mut shape = shape.map_err(|error| refused(&loaded.path, error))?;
    let dressed = Dressed::of(&mut shape, &sources, channels);
    let fill_ms = ms_since(start);

    let mut warnings = loaded.scene.notes().to_vec();
    warnings.extend(filled.unfilled.iter().map(ToString::to_string));
    let flat = filled.holes.iter().filter(|hole| !hole.is_faired).count();
    if flat > 0 {
        let holes = counted(flat, "hole was", "holes were");
        warnings.push(format!(
            "{holes} filled without fairing: the equations there could not be solved"
        ));
    }
    warnings.extend(lost(loaded, &dressed, output)?);
    let after = report.wanted(|| judged(&shape, dressed.triangles(), change_of(&shape), watch))?;
    if let Some((_, crossings)) = after.filter(|(_, crossings)| *crossings > 0) {
        let places = counted(crossings, "place", "places");
        warnings.push(format!("the new triangles pass through others in {places}"));
    }
    let triangles = counted(counts(&filled).1, "triangle", "triangles");
    let done = match holes {
        Holes::Between(_) => format!("joined 2 borders by a tube of {triangles}"),
        _ => {
            let holes = counted(filled.holes.len(), "hole", "holes");
            format!("filled {holes} with {triangles}")
        }
    };
    Ok(FilledFile {
        made: Made {
            shape,
            dressed,
            after,
            warnings,
            left_open: filled.unfilled.iter().map(|unfilled| unfilled.vertex).collect(),
            done,
        },
        filled,
        fill_ms,
    })
}

/// The numbers of new points and triangles.
fn counts(filled: &Filled) -> (usize, usize) {
    filled.holes.iter().fold((0, 0), |(points, triangles), hole| {
        (points + hole.points.len(), triangles + hole.triangles.len())
    })
}
