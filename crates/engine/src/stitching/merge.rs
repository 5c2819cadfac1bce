//! Joins two files: files in, a file out.

use std::path::Path;
use std::time::Instant;

use pliant_editor::{JoinsFile, Placement};
use pliant_mesh::DrawnVertex;
use pliant_stitch::{Joins, Merged, Pair, Part, PlacementOfB, Seam, StitchError, VertexSource};
use serde_json::json;

use super::look::{Channels, Dressed, Source};
use super::prepared::Prepared;
use super::shape_report::{Change, judged};
use super::{Made, Remaking, ReportTo, ShapeCounts, Stitched, counted, flags, lost, refused};
use crate::files::{self, Staging};
use crate::loading::Loaded;
use crate::report::ms_since;
use crate::watch::Watch;
use crate::{EngineError, memory};

/// The input of [`merge`].
#[derive(Clone, Copy, Debug)]
pub struct Merge<'a> {
    /// A, which stays where it is, and the file to write.
    pub remaking: Remaking<'a>,
    /// B, which is put onto it.
    pub second: &'a Path,
    /// The joins.
    pub joins: &'a JoinsFile,
    /// The place that the joins were read from, for messages.
    pub joins_path: &'a Path,
}

/// Joins two files at their borders and writes the result beside its place.
///
/// # Errors
/// Any refusal of the files, of the joins or of the result.
pub fn merge(job: &Merge<'_>, watch: &Watch, staging: &Staging) -> Result<Stitched, EngineError> {
    let Remaking {
        file, output, report, ..
    } = job.remaking;
    job.remaking.check_paths()?;
    let joins = job.joins;
    let of_joins = |source| EngineError::Edit {
        edit: job.joins_path.to_owned(),
        source,
    };
    let start = Instant::now();
    let paths = [file, job.second];
    let loaded = job.remaking.load(paths, watch)?;
    let load_ms = ms_since(start);

    let progress = watch.begin("joining");
    let start = Instant::now();
    let drawn = [0, 1].map(|side| loaded[side].model.rest());
    let sources = [0, 1].map(|side| Source::of(&loaded[side], &drawn[side]));
    let selectors = [&joins.delete_of_a, &joins.delete_of_b];
    let prepare = |side: usize| {
        let selection = selectors[side].evaluate(&loaded[side].model).map_err(of_joins)?;
        let delete = flags(&selection, &loaded[side].model);
        let transform = joins.transform.as_ref().filter(|_| side == 1);
        let refuse = |error| refused(paths[side], error);
        let means = (&progress.part(0.0, 0.0), &watch.cancel);
        Prepared::of(&loaded[side], &sources[side], &delete, (None, transform), refuse, means)
    };
    let prepared = [prepare(0)?, prepare(1)?];
    let pairs = pairs(joins, &loaded, &prepared).map_err(|(side, error)| refused(paths[side], error))?;
    let request = Joins {
        pairs: &pairs,
        placement: placement(joins.placement),
        reach: joins.reach,
        method: &joins.method,
    };
    let files = [&loaded[0], &loaded[1]];
    let MergedFiles { made, merged } = merged(files, &sources, &prepared, &request, (output, report), watch)?;
    let join_ms = ms_since(start);
    let seam = |seam: &Seam| {
        json!({
            "edges": seam.edges, "lengths": seam.lengths, "points": seam.points,
            "gap_mean": seam.gap[0], "gap_max": seam.gap[1],
        })
    };
    let stitched = job.remaking.stage(
        &made,
        |warnings| {
            json!({
                "method": joins.method.name(),
                "joins": merged.seams.iter().map(seam).collect::<Vec<_>>(),
                "motion_of_b": glam::DMat4::from(merged.motion).to_cols_array(),
                "bent_vertices": { "a": merged.bendings[0].vertices, "b": merged.bendings[1].vertices },
                "flipped_faces": { "a": merged.bendings[0].flipped, "b": merged.bendings[1].flipped },
                "converged": merged.bendings.iter().all(|bending| bending.has_converged),
                "a": ShapeCounts::of(&prepared[0].model),
                "b": ShapeCounts::of(&prepared[1].model),
                "after": made.after.map(|(counts, _)| counts),
                "self_intersections_added": made.after.map_or(0, |(_, crossings)| crossings),
                "load_ms": load_ms,
                "join_ms": join_ms,
                "warnings": warnings,
            })
        },
        staging,
        watch,
    )?;
    Ok(stitched.from(loaded.into()))
}

/// Two files that were joined.
pub(super) struct MergedFiles {
    pub made: Made,
    /// The joining in numbers; its shape is the made one.
    merged: Merged,
}

/// The placement of B by its name in the joins format.
pub(super) fn placement(named: Placement) -> PlacementOfB {
    match named {
        Placement::Fitted => PlacementOfB::Fitted,
        Placement::Kept => PlacementOfB::Kept,
    }
}

/// Joins two files, to be written as `output`. `sources` are theirs, and `prepared` their shapes.
pub(super) fn merged(
    files: [&Loaded; 2],
    sources: &[Source<'_>; 2],
    prepared: &[Prepared; 2],
    request: &Joins<'_>,
    (output, report): (&Path, ReportTo<'_>),
    watch: &Watch,
) -> Result<MergedFiles, EngineError> {
    let progress = &watch.begin("joining");
    let channels = Channels::of(sources);
    let has_normals = sources.iter().any(|source| source.look.normals.is_some());
    let value = |side: usize| {
        let (look, own) = (&sources[side].look, &prepared[side]);
        move |vertex: DrawnVertex, channel: usize| channels.value(look, own.source(vertex), channel)
    };
    let group = |side: usize| {
        let (source, own) = (&sources[side], &prepared[side]);
        move |triangle: u32| source.group(own.triangles[triangle as usize])
    };
    let normal = |side: usize| {
        let own = &prepared[side];
        move |vertex: DrawnVertex| own.normals[vertex.index()]
    };
    let (values, groups, normals) = ([value(0), value(1)], [group(0), group(1)], [normal(0), normal(1)]);
    let part = |side: usize| Part {
        model: &prepared[side].model,
        drawn: &prepared[side].drawn,
        group: &groups[side],
        attributes: channels.attributes(&values[side]),
        normals: has_normals.then_some(&normals[side] as _),
    };
    let merged = pliant_stitch::merge([&part(0), &part(1)], request, memory::budget(), progress, &watch.cancel);
    let mut merged = merged.map_err(|error| {
        let source = renumbered(error.source, &prepared[error.part]);
        refused(&files[error.part].path, source)
    })?;
    // B as a whole moved rigidly first.
    let motions = [glam::DAffine3::IDENTITY, merged.motion];
    let touch = prepared[0]
        .model
        .bounds()
        .map_or(0.0, |bounds| 1e-8 * bounds.diagonal());
    let bends = |(source, position): (&VertexSource, &glam::DVec3)| match *source {
        VertexSource::Old { part, vertex } => {
            let side = usize::from(part);
            let there = motions[side].transform_point3(prepared[side].drawn.positions[vertex.index()]);
            there.distance(*position) > touch
        }
        VertexSource::New { .. } => true,
    };
    let bent: Vec<bool> = merged
        .shape
        .vertices
        .iter()
        .zip(&merged.shape.positions)
        .map(bends)
        .collect();
    for source in &mut merged.shape.vertices {
        *source = prepared[usize::from(source.part())].vertex_source(*source);
    }
    for source in &mut merged.shape.triangle_sources {
        *source = prepared[usize::from(source.part)].triangle_source(*source);
    }
    let dressed = Dressed::of(&mut merged.shape, sources, channels);

    let mut warnings = Vec::new();
    for side in 0..2 {
        warnings.extend(files[side].scene.notes().iter().cloned());
        warnings.extend(lost(files[side], &dressed, output)?);
        let turned = prepared[side].turned_parts;
        if turned > 0 {
            let parts = counted(turned, "part of", "parts of");
            let name = ["A", "B"][side];
            warnings.push(format!(
                "{parts} {name} faced inwards and was turned, so that both sides face outwards"
            ));
        }
        let flipped = merged.bendings[side].flipped;
        if flipped > 0 {
            let triangles = counted(flipped, "triangle of", "triangles of");
            warnings.push(format!("bending turned over {triangles} {}", ["A", "B"][side]));
        }
        if !merged.bendings[side].has_converged {
            warnings.push(format!(
                "{} had not settled when the steps of {} ended: take another method or a smaller reach",
                ["A", "B"][side],
                request.method.name()
            ));
        }
    }
    let shape = &merged.shape;
    let change = |place: usize| {
        let corners = dressed.triangles()[place];
        let source = shape.triangle_sources[place];
        match corners.iter().any(|corner| bent[corner.index()]) {
            true => Change::Changed,
            false => Change::OfPart(source.part),
        }
    };
    let after = report.wanted(|| judged(shape, dressed.triangles(), change, watch))?;
    if let Some((_, crossings)) = after.filter(|(_, crossings)| *crossings > 0) {
        let places = counted(crossings, "pair", "pairs");
        warnings.push(format!(
            "the joined surface passes through itself in {places} of triangles"
        ));
    }
    let joined = counted(merged.seams.len(), "border", "borders");
    let made = Made {
        shape: std::mem::take(&mut merged.shape),
        dressed,
        after,
        warnings,
        left_open: Vec::new(),
        done: format!("joined {joined}"),
    };
    Ok(MergedFiles { made, merged })
}

/// Reads the file of the joins of a merge.
///
/// # Errors
/// A file that can't be read, or members that its format does not have, naming the file.
pub fn read_joins(path: &Path, watch: &Watch) -> Result<JoinsFile, EngineError> {
    watch.note_read("--joins", path);
    let joins = JoinsFile::parse(&files::read_text(path)?);
    joins.map_err(|source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    })
}

/// The pairs by the parts' own numbers.
fn pairs(joins: &JoinsFile, loaded: &[Loaded; 2], prepared: &[Prepared; 2]) -> Result<Vec<Pair>, (usize, StitchError)> {
    let counts = [0, 1].map(|side| loaded[side].model.drawn.file_vertex_count());
    let pair = |named: &[u32; 2]| {
        for side in 0..2 {
            let (vertex, count) = (named[side], counts[side]);
            if vertex as usize >= count {
                return Err((side, StitchError::NoVertex { vertex, count }));
            }
        }
        Ok(Pair {
            named: *named,
            file: [0, 1].map(|side| prepared[side].number(named[side])),
        })
    };
    joins.pairs.iter().map(pair).collect()
}

/// The refusal with the numbers of the part's file.
fn renumbered(error: StitchError, own: &Prepared) -> StitchError {
    match error {
        StitchError::FaultyBorder { vertex, fault } => StitchError::FaultyBorder {
            vertex: own.file_number(vertex),
            fault,
        },
        StitchError::PairsOutOfOrder { vertex } => StitchError::PairsOutOfOrder {
            vertex: own.file_number(vertex),
        },
        other => other,
    }
}
