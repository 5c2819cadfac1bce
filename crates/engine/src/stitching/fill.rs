//! Fills holes: a file in, a file out.

use std::time::Instant;

use pliant_stitch::{Age, FilledHole, Holes, NewShape, Reason};
use serde_json::json;

use super::look::{Channels, Dressed, Source};
use super::shape_report::{Change, judged};
use super::{Remaking, ShapeCounts, Stitched, counted, lost, refused};
use crate::files::Staging;
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

    let progress = watch.begin("filling");
    let start = Instant::now();
    let budget = memory::budget();
    let filled = pliant_stitch::fill(&loaded.model, job.holes, budget, &progress, &watch.cancel);
    let filled = filled.map_err(|error| refused(file, error))?;
    let drawn = loaded.model.rest();
    let sources = [Source::of(&loaded, &drawn)];
    let channels = Channels::of(&sources);
    let shape = sources[0].with_part(channels, |part| NewShape::filled(part, &filled, budget, &watch.cancel));
    let mut shape = shape.map_err(|error| refused(file, error))?;
    let dressed = Dressed::of(&mut shape, &sources, channels);
    let fill_ms = ms_since(start);

    let (points, triangles) = filled.holes.iter().fold((0, 0), |(points, triangles), hole| {
        (points + hole.points.len(), triangles + hole.triangles.len())
    });
    let mut warnings = loaded.scene.notes().to_vec();
    warnings.extend(filled.unfilled.iter().map(ToString::to_string));
    let flat = filled.holes.iter().filter(|hole| !hole.is_faired).count();
    if flat > 0 {
        let holes = counted(flat, "hole was", "holes were");
        warnings.push(format!(
            "{holes} filled without fairing: the equations there could not be solved"
        ));
    }
    warnings.extend(lost(&loaded, output)?);
    let change = |place: usize| match shape.triangle_sources[place].age {
        Age::New => Change::Changed,
        Age::Old => Change::OfPart(0),
    };
    let after = report.wanted(|| judged(&shape, dressed.triangles(), change, watch))?;
    if let Some((_, crossings)) = after.filter(|(_, crossings)| *crossings > 0) {
        let places = counted(crossings, "place", "places");
        warnings.push(format!("the new triangles pass through others in {places}"));
    }
    let unfilled = |is_meant: &dyn Fn(Reason) -> bool| {
        let own = filled.unfilled.iter().filter(|unfilled| is_meant(unfilled.reason));
        own.map(|unfilled| unfilled.count).sum::<usize>()
    };
    let hole_report = |hole: &FilledHole| {
        json!({
            "vertex": loaded.model.first_file_vertex(hole.borders[0].vertices[0]).0,
            "edges": hole.borders.iter().map(|border| border.vertices.len()).sum::<usize>(),
            "length": hole.borders.iter().map(|border| border.length).sum::<f64>(),
            "points": hole.points.len(),
            "triangles": hole.triangles.len(),
            "faired": hole.is_faired,
        })
    };
    let written = job.remaking.stage(
        (&shape, &dressed),
        |warnings| {
            json!({
                "holes_filled": filled.holes.len(),
                "passed_over": unfilled(&|reason| reason != Reason::Outer),
                "outer_borders": unfilled(&|reason| reason == Reason::Outer),
                "vertices_added": points,
                "triangles_added": triangles,
                "before": ShapeCounts::of(&loaded.model),
                "after": after.map(|(counts, _)| counts),
                "self_intersections_added": after.map_or(0, |(_, crossings)| crossings),
                "holes": filled.holes.iter().map(hole_report).collect::<Vec<_>>(),
                "load_ms": load_ms,
                "fill_ms": fill_ms,
                "warnings": warnings,
            })
        },
        warnings,
        staging,
        watch,
    )?;
    let triangles = counted(triangles, "triangle", "triangles");
    let done = match job.holes {
        Holes::Between(_) => format!("joined 2 borders by a tube of {triangles}"),
        _ => {
            let holes = counted(filled.holes.len(), "hole", "holes");
            format!("filled {holes} with {triangles}")
        }
    };
    Ok(Stitched {
        staged: written.staged,
        done,
        report: written.report,
        warnings: written.warnings,
        loaded: vec![loaded],
    })
}
