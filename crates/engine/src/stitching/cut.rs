//! Cuts a part out of a file: a file in, a file out.

use std::path::Path;

use pliant_editor::Selector;
use pliant_stitch::{Attributes, NewShape, Part};
use serde_json::json;

use super::look::{Channels, Dressed, Source};
use super::shape_report::{Change, judged};
use super::{Remaking, ShapeCounts, Stitched, counted, lost, refused};
use crate::EngineError;
use crate::files::{self, Staging};
use crate::watch::Watch;

/// The input of [`cut`].
#[derive(Clone, Copy, Debug)]
pub struct Cut<'a> {
    /// The file to cut, and the file to write.
    pub remaking: Remaking<'a>,
    /// The file of the selector whose vertices are deleted.
    pub delete: &'a Path,
}

/// Deletes vertices of a file, with the triangles that use them, and writes the result beside its place.
///
/// # Errors
/// Any refusal of the file, of the selection or of the result.
pub fn cut(job: &Cut<'_>, watch: &Watch, staging: &Staging) -> Result<Stitched, EngineError> {
    let Remaking {
        file, output, report, ..
    } = job.remaking;
    job.remaking.check_paths()?;
    watch.note_read("--delete", job.delete);
    let of_selector = |source| EngineError::Edit {
        edit: job.delete.to_owned(),
        source,
    };
    let selector = Selector::parse(&files::read_text(job.delete)?).map_err(of_selector)?;
    let [loaded] = job.remaking.load([file], watch)?;
    let selection = selector.evaluate(&loaded.model).map_err(of_selector)?;
    let mut delete = vec![false; loaded.model.surface.positions.len()];
    selection.iter().for_each(|vertex| delete[vertex.index()] = true);

    watch.begin("cutting");
    let drawn = loaded.model.rest();
    let sources = [Source::of(&loaded, &drawn)];
    let part = Part {
        model: &loaded.model,
        drawn: &drawn,
        group: &|_| 0,
        attributes: Attributes::NONE,
        normals: None,
    };
    let mut shape = NewShape::cut(&part, &delete).map_err(|error| refused(file, error))?;
    let dressed = Dressed::of(&mut shape, &sources, Channels::of(&sources));
    let broken = loaded.model.findings.non_finite_triangles.count;
    let gone = drawn.triangles.len() - broken - dressed.triangles().len();
    let mut warnings = loaded.scene.notes().to_vec();
    warnings.extend(lost(&loaded, output)?);
    let after = report
        .map(|_| judged(&shape, dressed.triangles(), |_| Change::OfPart(0), watch))
        .transpose()?;
    let (staged, warnings) = job.remaking.stage(
        (&shape, &dressed),
        |warnings| {
            json!({
                "vertices_deleted": drawn.file_vertex_count - shape.file_vertex_count,
                "triangles_deleted": gone,
                "before": ShapeCounts::of(&loaded.model),
                "after": after.map(|(counts, _)| counts),
                "warnings": warnings,
            })
        },
        warnings,
        staging,
        watch,
    )?;
    Ok(Stitched {
        staged,
        done: format!("deleted {}", counted(gone, "triangle", "triangles")),
        warnings,
        loaded: vec![loaded],
    })
}
