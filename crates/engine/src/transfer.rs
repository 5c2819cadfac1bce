//! Puts a pose of one mesh onto another: files in, a file out.

use std::path::Path;

use glam::DVec3;
use pliant_deform::{DeformationTransfer, Ordering, PosedShape, SolveError};
use pliant_io::{MorphDeltas, MorphTarget};
use pliant_mesh::{Drawn, Model, SurfaceVertex, WeldOptions};
use serde_json::Value;

use crate::binding::refused;
use crate::examples::positions_in_pose;
use crate::files::{self, Destination, Staging, shown};
use crate::loading::{Loaded, check_not_empty, load, open};
use crate::saving::{self, SaveAs};
use crate::watch::Watch;
use crate::{EngineError, memory};

/// The input of [`transfer`].
#[derive(Clone, Debug)]
pub struct Transfer<'a> {
    /// The mesh of the pose, at rest.
    pub source: &'a Path,
    /// The same vertices and triangles in the pose.
    pub pose: &'a Path,
    /// The mesh that takes it on.
    pub target: &'a Path,
    /// The pairs of triangles; `None` is the same triangles in both.
    pub correspondences: Option<&'a Path>,
    /// The file to write.
    pub output: &'a Path,
    /// The joining of TARGET's vertices.
    pub weld: WeldOptions,
    /// The deltas of the target file's own morph targets: turning with the surface, or kept.
    pub deltas: MorphDeltas,
    /// Saves the pose as a morph target beside the unchanged shape.
    pub morph: Option<MorphTarget<'a>>,
}

/// Puts the pose onto the target and writes it, or nothing at all. Returns sentences that a person should know.
///
/// # Errors
/// Any refusal of the files, of the pairs, of the solution or of the result. The output is then unchanged.
pub fn transfer(job: &Transfer<'_>, watch: &Watch, staging: &Staging) -> Result<Vec<String>, EngineError> {
    Destination::of(job.output)?;
    let inputs = [("SOURCE", job.source), ("POSE", job.pose)].into_iter();
    let inputs = inputs.chain(job.correspondences.map(|path| ("--correspondences", path)));
    files::refuse_shared(("--output", job.output), inputs)?;
    let (source, pose) = (open(job.source, watch)?, open(job.pose, watch)?);
    let posed = positions_in_pose(
        (job.pose, &pose.scene, &pose.drawn),
        (job.source, &source.scene, &source.drawn),
    )?;
    let source = source.drawn;
    let loaded = load(job.target, &job.weld, watch)?;
    let model = &loaded.model;
    check_not_empty(job.target, model)?;
    let partners = partners(job, &source, &loaded, watch)?;
    watch.refuse_outputs(&[("--output", job.output)], Some(job.target))?;
    let triangles: Vec<[usize; 3]> = source.triangles.iter().map(|own| own.map(|v| v.index())).collect();
    let posed = PosedShape {
        rest: &source.positions,
        posed: &posed,
        triangles: &triangles,
    };
    let (positions, mut warnings) = transferred(job.target, model, &posed, &partners, watch)?;

    let progress = watch.begin("saving");
    let save = SaveAs {
        morph: job.morph.as_ref(),
        deltas: job.deltas,
        ..SaveAs::shape(&positions, job.output)
    };
    let saved = saving::stage(&loaded, &save, staging, &progress, &watch.cancel)?;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    loaded.refuse_changed(&saved.staged)?;
    saved.staged.commit()?;
    warnings.extend(saved.warnings);
    Ok(warnings)
}

/// The positions of a model's drawn vertices in the pose, and warnings as sentences. `partners` gives the triangle of
/// `posed` for each drawn triangle of the model; refusals name `name`.
///
/// # Errors
/// A surface that can't be bound, or a solution that stays too inaccurate.
pub fn transferred(
    name: &Path,
    model: &Model,
    posed: &PosedShape<'_>,
    partners: &[Option<usize>],
    watch: &Watch,
) -> Result<(Vec<DVec3>, Vec<String>), EngineError> {
    let (partners, warnings) = on_surface(partners, model);
    let progress = watch.begin("ordering");
    let ordering = Ordering::of(&model.topology, 1, &progress, &watch.cancel).map_err(|_| EngineError::Interrupted)?;
    watch.begin("binding");
    let (surface, topology) = (&model.surface, &model.topology);
    let bound = DeformationTransfer::bind(surface, topology, &ordering, memory::budget(), &watch.cancel)
        .map_err(|error| refused(name, model, error))?;
    watch.begin("bending");
    let displacements = bound
        .pose(posed, &partners)
        .map_err(|error: SolveError| EngineError::Solve {
            file: name.to_owned(),
            source: error.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0),
        })?;
    let mut positions = Vec::new();
    model.drawn_positions(&displacements, &mut positions);
    Ok((positions, warnings))
}

/// The source's triangle for each triangle of the target's surface.
fn partners(
    job: &Transfer<'_>,
    source: &Drawn,
    loaded: &Loaded,
    watch: &Watch,
) -> Result<Vec<Option<usize>>, EngineError> {
    let target = loaded.model.rest();
    if let Some(path) = job.correspondences {
        watch.note_read("--correspondences", path);
    }
    Ok(match job.correspondences {
        Some(path) => read_correspondences(path, source.triangles.len(), target.triangles.len())?,
        None if target.triangles == source.triangles => (0..source.triangles.len()).map(Some).collect(),
        None => {
            return Err(EngineError::Unsupported(format!(
                "{} has {} triangles and {} has {} different ones: give the pairs with --correspondences",
                shown(job.target),
                target.triangles.len(),
                shown(job.source),
                source.triangles.len(),
            )));
        }
    })
}

/// The partner of each triangle of the surface, and a warning about parts without partners.
fn on_surface(of_drawn: &[Option<usize>], model: &Model) -> (Vec<Option<usize>>, Vec<String>) {
    let of_surface = model.drawn.triangle_of_surface().iter();
    let partners: Vec<Option<usize>> = of_surface.map(|&drawn| of_drawn[drawn as usize]).collect();
    let mut has_partner = vec![false; model.topology.components().len()];
    let paired = model.surface.triangles.iter().zip(&partners);
    for (corners, _) in paired.filter(|(_, partner)| partner.is_some()) {
        has_partner[model.topology.component(corners[0]) as usize] = true;
    }
    let resting = has_partner.iter().filter(|has| !**has).count();
    let warnings = (resting > 0).then(|| {
        format!(
            "{resting} of {} parts have no triangle that corresponds to one of SOURCE, so they stay",
            has_partner.len()
        )
    });
    (partners, warnings.into_iter().collect())
}

/// `{"triangles": [[source, target], ..]}`, both numbered from 0 as in the files: for each of the target's triangles that
/// of the source.
fn read_correspondences(path: &Path, sources: usize, targets: usize) -> Result<Vec<Option<usize>>, EngineError> {
    let text = files::read_text(path)?;
    let refuse = |what: String| EngineError::Unsupported(format!("{}: {what}", shown(path)));
    let value: Value = serde_json::from_str(&text).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        refuse(format!(
            "it is not JSON at line {line}, column {column}: write {{\"triangles\": [[SOURCE, TARGET], ..]}}"
        ))
    })?;
    let pairs = value.get("triangles").and_then(Value::as_array);
    let pairs = pairs
        .ok_or_else(|| refuse("it has no list `triangles`: write {\"triangles\": [[SOURCE, TARGET], ..]}".into()))?;
    let mut partners = vec![None; targets];
    for (number, pair) in pairs.iter().enumerate() {
        let numbers = pair.as_array().and_then(|pair| match &pair[..] {
            [source, target] => Some((source.as_u64()?, target.as_u64()?)),
            _ => None,
        });
        let (source, target) = numbers.ok_or_else(|| {
            refuse(format!(
                "triangles[{number}] is not a pair of numbers: give a triangle of SOURCE and one of TARGET"
            ))
        })?;
        if source >= sources as u64 || target >= targets as u64 {
            return Err(refuse(format!(
                "triangles[{number}] is [{source}, {target}], but SOURCE has {sources} triangles and TARGET \
                 {targets}: number them from 0"
            )));
        }
        let partner = &mut partners[target as usize];
        if partner.is_some() {
            return Err(refuse(format!(
                "triangles[{number}] names TARGET's triangle {target} again: name it once"
            )));
        }
        *partner = Some(source as usize);
    }
    if pairs.is_empty() {
        return Err(refuse("its list `triangles` is empty: name at least one pair".into()));
    }
    Ok(partners)
}
