//! The solution of an edit: the shape after the last frame, with its times and what the report tells about it.

use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use pliant_deform::{Bound, Budget, ExampleShape, SolveError, Step};
use pliant_editor::{HandleSetup, Setup, Start, Until, sum_of_shapes};
use pliant_mesh::{Model, SurfaceVertex, vertex_normals};
use tracing::info_span;

use crate::EngineError;
use crate::binding::{Prepared, prepare};
use crate::report::{Energy, ExampleWeight, FrameTimes, HandleSlide, finite_or, ms_since};
use crate::watch::Watch;

/// The result of the frames.
pub(crate) struct Solution {
    /// The position of each drawn vertex, in world space.
    pub(crate) positions: Vec<DVec3>,
    /// The position of each surface vertex, in world space.
    pub(crate) surface_positions: Vec<DVec3>,
    pub(crate) free_vertices: usize,
    pub(crate) order_ms: f64,
    pub(crate) bind_ms: f64,
    pub(crate) frames: FrameTimes,
    pub(crate) iterations: f64,
    pub(crate) converged: bool,
    pub(crate) energy: Energy,
    pub(crate) handle_residual: f64,
    pub(crate) examples: Vec<ExampleWeight>,
    pub(crate) slides: Vec<HandleSlide>,
    pub(crate) warnings: Vec<String>,
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
    pub(crate) fn at_rest(model: &Model, setup: &Setup) -> Self {
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

/// Binds a setup and moves its handles to their targets in so many frames; `None` is one.
///
/// # Errors
/// The obstacle to a solution, naming `file`; [`EngineError::Interrupted`] soon after the watch's flag is raised.
pub(crate) fn solve(
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
