//! The steps from a file on disk to an edited file on disk: read → weld →
//! resolve the edit → order → bind → frames → distortion → save.
//!
//! Each step is a separate function, so that the window can keep unchanged results; [`apply`] runs all of them and
//! measures their time.

use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use pliant_deform::Method;
use pliant_editor::{Beginning, Intersections, Setup, refuse_keys};
use pliant_io::{MorphDeltas, MorphTarget};
use pliant_mesh::{Bvh, Damage, Model, Progress};

use crate::EngineError;
use crate::binding::check_bends;
use crate::edit_job::EditJob;
use crate::files::{Destination, NewFile, Staging};
use crate::flow::{ColoursToSave, colour_hash, with_dye};
use crate::loading::Loaded;
use crate::memory;
use crate::report::{Distortion, Report, finite_or, ms_since};
use crate::saving::{self, SaveAs};
use crate::solution::{Solution, solve};
use crate::watch::Watch;

/// The input of [`apply`].
#[derive(Clone, Debug)]
pub struct Apply<'a> {
    /// The edit and its files; the output is a file.
    pub job: EditJob<'a>,
    /// Replays the edit as a drag of this many frames; `None` is one solve to the target.
    pub frames: Option<usize>,
    /// Whether the deltas of the file's own morph targets turn with the surface.
    pub deltas: MorphDeltas,
    /// Saves the edit as a morph target beside the unchanged shape.
    pub morph: Option<MorphTarget<'a>>,
}

/// Applies an edit to a file and writes the result and the report, or nothing at all.
///
/// # Errors
/// Any refusal of the file, the edit or the result. OUT is then unchanged.
pub fn apply(apply: &Apply<'_>, watch: &Watch, staging: &Staging) -> Result<Report, EngineError> {
    let job = &apply.job;
    // A path that is not a file is refused before anything is read.
    Destination::of(job.output)?;
    let report_to = job.report_to()?;
    let (loaded, load_ms) = job.load(job.file, watch)?;
    let model = &loaded.model;
    let edit = job.edit_with_examples(&loaded, watch)?;
    job.refuse_outputs(job.output, Some(job.file), watch)?;
    let in_edit = |source| job.refused(source);
    if let Beginning::Edit(edit) = &edit {
        refuse_keys(edit, "use `pliant animate` or `pliant sequence`, or remove them").map_err(in_edit)?;
    }
    let setup = edit.resolve(model).map_err(in_edit)?;
    check_bends(job.file, model, &setup.method)?;

    let solution = if edit.changes_nothing() {
        Solution::at_rest(model, &setup)
    } else {
        solve(job.file, apply.frames, model, &setup, job.budget, watch)?
    };
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }

    let progress = watch.begin("saving");
    let start = Instant::now();
    let ColoursToSave { colours, lost } = kept_dye(job, &loaded, apply.morph.is_some())?;
    let save = SaveAs {
        inside_out: &setup.inside_out,
        deltas: apply.deltas,
        colours: colours.as_deref(),
        morph: apply.morph.as_ref(),
        beside: report_to.as_ref().map(|report| ("--report", report)),
        ..SaveAs::shape(&solution.positions, job.output)
    };
    let saved = saving::stage(&loaded, &save, staging, &progress, &watch.cancel)?;
    let save_ms = ms_since(start);

    let times = FileTimes {
        load_ms,
        save_ms,
        check_ms: saved.check_ms,
    };
    let warnings = saved.warnings.into_iter().chain(lost).collect();
    let report = report(&loaded, &setup, solution, times, warnings, watch)?;
    let mut staged = saved.staged;
    if let Some(to) = report_to {
        let text = report.to_json();
        let file = NewFile {
            to,
            bytes: text.as_bytes(),
        };
        staged = staged.and(staging.stage_watched(&[file], None, &Progress::new(), &watch.cancel)?);
    }
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    loaded.refuse_changed(&staged)?;
    staged.commit()?;
    Ok(report)
}

/// The vertex colours of a project that has kept dye, or a sentence that says why the output has none.
fn kept_dye(job: &EditJob<'_>, loaded: &Loaded, as_morph: bool) -> Result<ColoursToSave, EngineError> {
    let Beginning::Project(project) = job.edit else {
        return Ok(ColoursToSave::default());
    };
    let Some(dye) = project.kept_dye(&loaded.model).map_err(|source| job.refused(source))? else {
        return Ok(ColoursToSave::default());
    };
    if project.mesh_colours().is_some_and(|own| own != colour_hash(loaded)) {
        let sentence = "FILE has other colours than the project's mesh, so the dye that was kept is left out.";
        return Ok(ColoursToSave {
            colours: None,
            lost: Some(sentence.to_owned()),
        });
    }
    Ok(with_dye(loaded, &dye, job.output, as_morph))
}

/// Solves an edit with this setup on a file that was read, and reports on it; nothing is saved.
///
/// # Errors
/// Any refusal of the binding or of the result, naming `file`.
pub fn solved(
    file: &Path,
    edit: &Beginning,
    frames: Option<usize>,
    loaded: &Loaded,
    setup: &Setup,
    watch: &Watch,
) -> Result<Solved, EngineError> {
    check_bends(file, &loaded.model, &setup.method)?;
    let solution = if edit.changes_nothing() {
        Solution::at_rest(&loaded.model, setup)
    } else {
        solve(file, frames, &loaded.model, setup, memory::budget(), watch)?
    };
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    Ok(Solved {
        positions: solution.positions.clone(),
        surface_positions: solution.surface_positions.clone(),
        report: report(loaded, setup, solution, FileTimes::default(), Vec::new(), watch)?,
    })
}

/// A shape and the report about it.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The position of each drawn vertex, in world space.
    pub positions: Vec<DVec3>,
    /// The position of each surface vertex, in world space.
    pub surface_positions: Vec<DVec3>,
    /// Its report, without the times of files.
    pub report: Report,
}

/// The times of the files.
#[derive(Default)]
struct FileTimes {
    load_ms: f64,
    save_ms: f64,
    check_ms: f64,
}

/// The most crossings to search for: the sentence says "and more" beyond them.
const MOST_CROSSINGS: usize = 20_000;

/// The faults of the shape, as sentences.
///
/// # Errors
/// [`EngineError::Interrupted`].
fn faults(model: &Model, method: &Method, solution: &Solution, watch: &Watch) -> Result<Vec<String>, EngineError> {
    if solution.surface_positions == model.surface.positions {
        return Ok(Vec::new());
    }
    let (surface, topology) = (&model.surface, &model.topology);
    let damage = Damage::of(surface, topology, &solution.surface_positions);
    let mut bvh = Bvh::build(&surface.positions, &surface.triangles);
    bvh.refit(|v| solution.surface_positions[v.index()]);
    let progress = watch.begin("finding places where the shape passes through itself");
    let crossings = bvh.new_self_intersections(surface, topology, MOST_CROSSINGS, &progress, &watch.cancel);
    let crossings = crossings.map_err(|_| EngineError::Interrupted)?;
    let mut sentences = Intersections::of(&crossings, damage).sentences(method);
    if !solution.converged {
        let is_limited = method
            .declaration()
            .options
            .iter()
            .any(|option| option.name == "max_iterations");
        let more = if is_limited { "raise `max_iterations`, " } else { "" };
        sentences.push(format!(
            "the shape did not settle within the step limit: {more}lower the strength, or take another method"
        ));
    }
    Ok(sentences)
}

fn report(
    loaded: &Loaded,
    setup: &Setup,
    solution: Solution,
    times: FileTimes,
    saved_warnings: Vec<String>,
    watch: &Watch,
) -> Result<Report, EngineError> {
    let model = &loaded.model;
    let faults = faults(model, &setup.method, &solution, watch)?;
    let distortion = pliant_mesh::Distortion::of(&model.surface, &model.topology, &solution.surface_positions);
    let mut warnings = loaded.scene.notes().to_vec();
    warnings.extend(solution.warnings);
    warnings.extend(faults);
    warnings.extend(saved_warnings);
    Ok(Report {
        method: setup.method.name().to_owned(),
        vertices: model.drawn.file_vertex_count(),
        welded_vertices: model.surface.positions.len(),
        free_vertices: solution.free_vertices,
        load_ms: times.load_ms,
        order_ms: solution.order_ms,
        bind_ms: solution.bind_ms,
        save_ms: times.save_ms,
        check_ms: times.check_ms,
        frames: solution.frames,
        iterations: solution.iterations,
        converged: solution.converged,
        energy: solution.energy,
        handle_residual: solution.handle_residual,
        examples: solution.examples,
        slides: solution.slides,
        matched_by_place: setup.matched.clone(),
        distortion: Distortion {
            edge_stretch_mean: finite_or(distortion.edge_stretch_mean, 1.0),
            edge_stretch_max: finite_or(distortion.edge_stretch_max, f64::MAX),
            flipped_faces: distortion.flipped_faces,
            volume_ratio: finite_or(distortion.volume_ratio, 1.0),
        },
        warnings,
    })
}
