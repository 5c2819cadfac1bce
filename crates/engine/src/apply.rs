//! The steps from a file on disk to an edited file on disk: read → weld →
//! resolve the edit → order → bind → frames → distortion → save.
//!
//! Each step is a separate function, so that the window can keep unchanged results; [`apply`] runs all of them and
//! measures their time.

use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use pliant_deform::{BindError, Bound, Budget, ExampleShape, Method, Ordering, SolveError, Step};
use pliant_editor::{Beginning, HandleSetup, Intersections, Setup, Start, Until, refuse_keys, sum_of_shapes};
use pliant_io::{MorphDeltas, MorphTarget};
use pliant_mesh::{Bvh, Cancel, Damage, Model, Progress, SurfaceVertex, vertex_normals};
use tracing::info_span;

use crate::EngineError;
use crate::edit_job::EditJob;
use crate::files::{Destination, NewFile, Staging};
use crate::flow::{ColoursToSave, colour_hash, with_dye};
use crate::loading::Loaded;
use crate::memory;
use crate::report::{Distortion, Energy, ExampleWeight, FrameTimes, HandleSlide, Report, finite_or, ms_since};
use crate::saving::{self, SaveAs};
use crate::watch::Watch;

/// Orders a model's equations for a method that needs it, once for all regions: for the Laplacian's factor if the
/// method's own is too large for the remaining memory.
///
/// # Errors
/// [`EngineError::Interrupted`] soon after `cancel` is raised.
pub fn order(
    model: &Model,
    setup: &Setup,
    budget: Budget,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Option<Ordering>, EngineError> {
    let _span = info_span!("order").entered();
    let ordering = setup.problem(model).ordering_within(budget, progress, cancel);
    ordering.map_err(|_| EngineError::Interrupted)
}

/// Binds a setup.
///
/// # Errors
/// The obstacle to a solution, naming `file`.
pub fn bind(
    file: &Path,
    model: &Model,
    setup: &Setup,
    ordering: Option<&Ordering>,
    budget: Budget,
    (progress, cancel): (&Progress, &Cancel),
) -> Result<Bound, EngineError> {
    let _span = info_span!("bind", method = setup.method.name()).entered();
    let bound = setup.problem(model).bind_within(ordering, budget, progress, cancel);
    bound.map_err(|error| refused(file, model, error))
}

/// The refusal of a binding, which names vertices by the file's numbers.
pub(crate) fn refused(file: &Path, model: &Model, error: BindError) -> EngineError {
    match error {
        BindError::Cancelled(_) => EngineError::Interrupted,
        error => EngineError::Bind {
            file: file.to_owned(),
            source: error.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0),
        },
    }
}

/// Refuses a method that bends surfaces for a file with only points.
///
/// # Errors
/// [`BindError::NoTriangles`], naming `file`.
pub fn check_bends(file: &Path, model: &Model, method: &Method) -> Result<(), EngineError> {
    let checked = method.check_bends(&model.surface);
    checked.map_err(|error| refused(file, model, error))
}

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

/// The result of the frames.
struct Solution {
    /// The position of each drawn vertex, in world space.
    positions: Vec<DVec3>,
    /// The position of each surface vertex, in world space.
    surface_positions: Vec<DVec3>,
    free_vertices: usize,
    order_ms: f64,
    bind_ms: f64,
    frames: FrameTimes,
    iterations: f64,
    converged: bool,
    energy: Energy,
    handle_residual: f64,
    examples: Vec<ExampleWeight>,
    slides: Vec<HandleSlide>,
    warnings: Vec<String>,
}

fn example_weights(setup: &Setup, weights: &[f64]) -> Vec<ExampleWeight> {
    let shapes = setup.examples().map_or(&[][..], |examples| &examples.shapes);
    let each = shapes.iter().zip(weights);
    let weight = |(shape, weight): (&ExampleShape, &f64)| ExampleWeight {
        name: shape.name.clone(),
        weight: *weight,
    };
    each.map(weight).collect()
}

/// The last step's places of free handles.
fn slides(setup: &Setup, bound: &Bound) -> Vec<HandleSlide> {
    let handles = setup
        .handles
        .iter()
        .enumerate()
        .filter(|(_, handle)| handle.free_along.is_some());
    let slide = |(number, handle): (usize, &HandleSetup)| HandleSlide {
        name: handle.name.clone(),
        distance: bound.slide(number),
    };
    handles.map(slide).collect()
}

impl Solution {
    /// The result without a solve, if nothing changes.
    fn at_rest(model: &Model, setup: &Setup) -> Self {
        let (mut positions, mut surface_positions) = (model.rest_positions(), model.surface.positions.clone());
        // This is the correction by hand, which nothing else bends.
        if let Some(kept) = &setup.kept {
            model.drawn_positions(&kept.shape.shape, &mut positions);
            let moved = surface_positions.iter_mut().zip(kept.shape.shape.iter());
            moved.for_each(|(position, by)| *position += *by);
        }
        Self {
            positions,
            surface_positions,
            free_vertices: setup.free_count(),
            order_ms: 0.0,
            bind_ms: 0.0,
            frames: FrameTimes::default(),
            iterations: 0.0,
            converged: true,
            energy: Energy::default(),
            handle_residual: 0.0,
            examples: example_weights(setup, &vec![0.0; setup.examples().map_or(0, |own| own.shapes.len())]),
            slides: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

/// A binding, and its times.
#[derive(Debug)]
pub struct Prepared {
    /// The bound problem.
    pub bound: Bound,
    /// The time of the mesh's ordering, in milliseconds.
    pub order_ms: f64,
    /// The time from the ordering to the binding, in milliseconds.
    pub bind_ms: f64,
}

/// Orders and binds a setup, once its tables are known to fit the budget.
///
/// # Errors
/// Those of [`bind`]; [`EngineError::Interrupted`] soon after the watch's flag is raised.
pub fn prepare(
    file: &Path,
    model: &Model,
    setup: &Setup,
    budget: Budget,
    watch: &Watch,
) -> Result<Prepared, EngineError> {
    let start = Instant::now();
    let checked = setup.problem(model).check_tables(budget);
    checked.map_err(|error| refused(file, model, error))?;
    let ordering = order(model, setup, budget, &watch.begin("ordering"), &watch.cancel)?;
    let order_ms = ms_since(start);
    let start = Instant::now();
    let bound = bind(
        file,
        model,
        setup,
        ordering.as_ref(),
        budget,
        (&watch.begin("binding"), &watch.cancel),
    )?;
    let bind_ms = ms_since(start);
    Ok(Prepared {
        bound,
        order_ms,
        bind_ms,
    })
}

fn solve(
    file: &Path,
    frames: Option<usize>,
    model: &Model,
    setup: &Setup,
    budget: Budget,
    watch: &Watch,
) -> Result<Solution, EngineError> {
    let Prepared {
        mut bound,
        order_ms,
        bind_ms,
    } = prepare(file, model, setup, budget, watch)?;
    let frames = frames.unwrap_or(1);
    let bent = info_span!("solve", frames).in_scope(|| bend(file, frames, model, setup, &mut bound, watch))?;
    Ok(Solution {
        positions: bent.positions,
        surface_positions: bent.surface_positions,
        free_vertices: bound.free_count(),
        order_ms,
        bind_ms,
        frames: bent.frames,
        iterations: bent.iterations,
        converged: bent.last.converged,
        handle_residual: bent.last.handle_residual,
        energy: Energy {
            // Every method's energy is 0 at rest.
            rest: 0.0,
            r#final: finite_or(bent.last.energy, f64::MAX),
        },
        examples: example_weights(setup, bound.weights()),
        slides: slides(setup, &bound),
        warnings: {
            let mut warnings = setup.worded(bound.warnings());
            warnings.extend(setup.problem(model).counted_otherwise());
            warnings
        },
    })
}

/// The shape after the last frame, and the frames' times.
struct Bent {
    /// The position of each drawn vertex, in world space.
    positions: Vec<DVec3>,
    /// The position of each surface vertex, in world space.
    surface_positions: Vec<DVec3>,
    frames: FrameTimes,
    /// The mean number of iterations per frame.
    iterations: f64,
    last: Step,
}

/// Moves the handles to their targets frame by frame.
fn bend(
    file: &Path,
    count: usize,
    model: &Model,
    setup: &Setup,
    bound: &mut Bound,
    watch: &Watch,
) -> Result<Bent, EngineError> {
    let refuse = |error: SolveError| EngineError::Solve {
        file: file.to_owned(),
        source: error.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0),
    };
    let progress = watch.begin("bending");
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    let (mut solve_ms, mut normals_ms) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut surface_positions = model.surface.positions.clone();
    let (mut iterations, mut last) = (0_u64, Step::default());
    bound.set_cancel(&watch.cancel);
    let mut start = match (&setup.kept, count) {
        // Starts at the end of the descent to which the kept shape is compared.
        (Some(kept), 1) => Start::Kept(kept.clone()),
        (kept, _) => Start::replay(kept.clone(), bound, &setup.targets_at(1.0), &watch.cancel).map_err(refuse)?,
    };
    let rest = setup.rest.as_ref().map(|rest| &rest.displacements);
    for frame in 1..=count {
        if watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        let targets = setup.targets_at(frame as f64 / count as f64);
        let began = Instant::now();
        let bent = start.bend(bound, &targets, Until::End, &watch.cancel).map_err(refuse)?;
        last = bent.step;
        let from_file = sum_of_shapes(rest, &bent.shown);
        start = bent.next();
        model.drawn_positions(&from_file, &mut positions);
        solve_ms.push(ms_since(began));
        iterations += u64::from(last.iteration);

        for ((new, rest), d) in surface_positions
            .iter_mut()
            .zip(&model.surface.positions)
            .zip(from_file.iter())
        {
            *new = *rest + *d;
        }
        let began = Instant::now();
        vertex_normals(
            &model.surface.triangles,
            &model.topology,
            &surface_positions,
            &mut normals,
        );
        normals_ms.push(ms_since(began));
        progress.set(frame as f32 / count as f32);
    }
    Ok(Bent {
        positions,
        surface_positions,
        frames: FrameTimes::of(&mut solve_ms, &mut normals_ms),
        iterations: iterations as f64 / count.max(1) as f64,
        last,
    })
}
